"""Bring plotly's script into a page, where it is installed."""

from __future__ import annotations

from markupsafe import Markup

__all__ = ["plotly_script"]


def plotly_script() -> Markup:
    """Return plotly's own script, or nothing where plotly is not installed (extra ``web``).

    The page holds it whole, so that it works without any network.
    """
    try:
        from plotly.offline import get_plotlyjs  # noqa: PLC0415 - an extra
    except ImportError:
        return Markup()
    # a part of plotly itself, nothing that came from outside
    return Markup(get_plotlyjs().replace("</script", "<\\/script"))  # noqa: S704

"""Fill in pages: templates that escape what they are given, pictures inside the page."""

from __future__ import annotations

import base64
from pathlib import Path

import numpy as np
from jinja2 import Environment, PackageLoader, StrictUndefined, Template

from trundle.criteria import Verdict
from trundle.report.canvas import Picture
from trundle.report.tables import written
from trundle.signals import nominal_frequency

__all__ = ["embedded", "template"]


def template(name: str) -> Template:
    """Return a page's template; everything put into it is escaped."""
    environment = Environment(
        loader=PackageLoader("trundle.report"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["sig"] = written
    environment.filters["rank"] = _rank
    environment.filters["between"] = _between
    environment.filters["hertz"] = _hertz
    return environment.get_template(name)


def embedded(picture: Picture, figures: Path) -> dict[str, str]:
    """Return a finished picture as a page takes it, its data inside."""
    png = (figures / f"{picture.name}.png").read_bytes()
    return {
        "name": picture.name,
        "title": picture.title,
        "caption": picture.caption,
        "data": base64.b64encode(png).decode("ascii"),
    }


def _between(verdict: Verdict) -> str:
    """Write a margin with its interval."""
    low, high = verdict.interval
    if not np.isfinite(low) or not np.isfinite(high):
        return f"{verdict.margin:.3g}"
    between = f"{low:.3g}-{high:.3g}" if low > 0.0 else f"at most {high:.3g}"
    return f"{verdict.margin:.3g} ({between})"


def _hertz(f: float) -> str:
    """Write a mid-band frequency by its name; nothing for a single number."""
    return f"{nominal_frequency(f):g}" if np.isfinite(f) else ""


def _rank(value: float) -> str:
    """Name a percentile; below the lowest run it is 'below all', above the highest 'above all'."""
    if value <= 0.0:
        return "below all"
    if value >= 100.0:
        return "above all"
    return f"{value:.0f} %"

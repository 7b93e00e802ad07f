"""Show formulas as MathML, which browsers draw themselves: no script, no font from elsewhere."""

from __future__ import annotations

import re

from docutils import nodes
from docutils.utils.math import latex2mathml
from sphinx.application import Sphinx
from sphinx.util import logging

__all__ = ["as_mathml", "setup"]

# environments of whole lines, for which aligned ones stand inside a block
_ENVIRONMENT = re.compile(r"\\(begin|end)\{(?:align|gather|equation|split|multline)\*?\}")
_SIZES = re.compile(r"\\[bB]igg?[lrm]?(?![A-Za-z])")  # brackets grow by themselves
_LOGGER = logging.getLogger(__name__)


def as_mathml(formula: str, *, block: bool) -> str:
    """Return a formula of LaTeX as MathML.

    Raises
    ------
    docutils.utils.math.MathError
        A formula that is not understood.
    """
    plain = _SIZES.sub("", formula)
    plain = _ENVIRONMENT.sub(lambda found: f"\\{found[1]}{{aligned}}", plain)
    if block and ("&" in plain or "\\\\" in plain) and "\\begin" not in plain:
        plain = f"\\begin{{aligned}}{plain}\\end{{aligned}}"
    return str(latex2mathml.tex2mathml(plain, as_block=block))


def _show(self: object, node: nodes.Element, *, block: bool) -> None:
    formula = node.astext()
    try:
        made = as_mathml(formula, block=block)
    except Exception as error:  # whatever the converter trips over, the page has to say so
        _LOGGER.warning("formula %r: %s", formula, error, location=node)
        made = f"<code>{nodes.unescape(formula)}</code>"
    number = node.get("number") if block else None
    mark = f'<span class="eqno">({number})</span>' if number else ""
    self.body.append(f'<div class="math">{mark}{made}</div>' if block else made)  # type: ignore[attr-defined]
    raise nodes.SkipNode


def _inline(self: object, node: nodes.Element) -> None:
    _show(self, node, block=False)


def _block(self: object, node: nodes.Element) -> None:
    for name in node["ids"]:
        self.body.append(f'<span id="{name}"></span>')  # type: ignore[attr-defined]
    _show(self, node, block=True)


def setup(app: Sphinx) -> dict[str, bool]:
    """Offer the renderer to Sphinx."""
    app.add_html_math_renderer("mathml", (_inline, None), (_block, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}

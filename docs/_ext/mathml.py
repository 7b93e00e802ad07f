"""Show formulas as MathML, which browsers draw themselves: no script, no font from elsewhere."""

from __future__ import annotations

import re
from xml.etree import ElementTree as ET

from docutils import nodes
from docutils.utils.math import latex2mathml
from sphinx.application import Sphinx
from sphinx.util import logging

__all__ = ["as_mathml", "setup"]

# environments of whole lines, for which aligned ones stand inside a block
_ENVIRONMENT = re.compile(r"\\(begin|end)\{(?:align|gather|equation|split|multline)\*?\}")
_SIZES = re.compile(r"\\[bB]igg?[lrm]?(?![A-Za-z])")  # brackets grow by themselves
# without braces the converter takes all digits for one number
_HALVES = re.compile(r"\\([dt]?frac)\s*(\d)\s*(\d)")
_NAMES = "http://www.w3.org/1998/Math/MathML"
_ACCENTS = frozenset("˙¨ˉˆ^~˜")
_LOGGER = logging.getLogger(__name__)


def as_mathml(formula: str, *, block: bool) -> str:
    """Return a formula of LaTeX as MathML.

    Raises
    ------
    docutils.utils.math.MathError
        A formula that is not understood.
    """
    plain = _HALVES.sub(r"\\\1{\2}{\3}", _SIZES.sub("", formula))
    plain = _ENVIRONMENT.sub(lambda found: f"\\{found[1]}{{aligned}}", plain)
    if block and ("&" in plain or "\\\\" in plain) and "\\begin" not in plain:
        plain = f"\\begin{{aligned}}{plain}\\end{{aligned}}"
    return _accented(str(latex2mathml.tex2mathml(plain, as_block=block)))


def _accented(made: str) -> str:
    """Hang what stands below an accented letter, as the converter has it, on it as its index."""
    if "<munderover" not in made:
        return made
    ET.register_namespace("", _NAMES)
    root = ET.fromstring(made)  # noqa: S314 - the converter made it
    for one in root.iter(f"{{{_NAMES}}}munderover"):
        letter, index, accent = one
        if (accent.text or "").strip() in _ACCENTS:
            over = ET.Element(f"{{{_NAMES}}}mover", {"accent": "true"})
            over.extend((letter, accent))
            one.tag = f"{{{_NAMES}}}msub"
            one[:] = (over, index)
    return ET.tostring(root, encoding="unicode")


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

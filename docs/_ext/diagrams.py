"""Draw the two diagrams of the manual as SVG: the chain, and the layers that imports obey."""

from __future__ import annotations

import tomllib
from collections.abc import Sequence
from html import escape

from pages import GENERATED, ROOT, write_page

__all__ = ["layers", "write_diagrams"]

_CHAIN = (
    ("Road", "a class of ISO 8608, a survey, joints", "displacement under every wheel"),
    ("Vehicle", "axles, bodies, tyres, along a route", "contact forces"),
    ("Floor", "slabs, beams, columns and their modes", "motion at points, and all over"),
    ("Levels", "one-third octaves, 1 to 80 Hz, of many roads", "RMS by band, with percentiles"),
    (
        "Verdict",
        "VC curves, limits of makers and standards",
        "pass, fail or not assessed; a class map",
    ),
)
_FILLS = ("#DCE9F5", "#FBE3D3", "#D5EFE6", "#F4DFEA", "#FBEFCF")
_FONT = "system-ui, -apple-system, 'Segoe UI', Helvetica, Arial, sans-serif"
_LINE, _INK = "#8A8A8A", "#1B1B1B"


def write_diagrams() -> None:
    """Write both."""
    folder = GENERATED / "diagrams"
    write_page(folder / "chain.svg", chain())
    write_page(folder / "layers.svg", stack(layers()))


def layers() -> list[str]:
    """Return the layers of the code, from the top down, as import-linter's contract has them."""
    tool = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["tool"]
    contracts = tool["importlinter"]["contracts"]
    return next(one["layers"] for one in contracts if one["type"] == "layers")


def chain() -> str:
    """Draw what goes into each link of the chain, and what comes out."""
    height, gap, width = 58, 34, 560
    parts: list[str] = []
    for i, (name, what, out) in enumerate(_CHAIN):
        y = 8 + i * (height + gap)
        parts.append(_box(8, y, width - 16, height, _FILLS[i]))
        parts.append(_text(26, y + 36, name, size=20, weight=600))
        parts.append(_text(150, y + 35, what, size=16))
        last = i == len(_CHAIN) - 1
        parts += [] if last else [_arrow(66, y + height, y + height + gap)]
        parts.append(_text(88, y + height + 23, out, size=15, colour="#6B6B6B", style="italic"))
    return _svg(
        width, 8 + len(_CHAIN) * (height + gap) + 4, parts, "The chain from road to verdict"
    )


def stack(rows: Sequence[str]) -> str:
    """Draw layers on each other, packages of one layer side by side."""
    height, gap, width = 40, 8, 620
    parts: list[str] = []
    for i, row in enumerate(rows):
        names = [one.strip().removeprefix("trundle.") for one in row.replace("|", ":").split(":")]
        shown = [name for name in names if not name.startswith("_")]
        each = (width - 16 - gap * (len(shown) - 1)) / len(shown)
        for k, name in enumerate(shown):
            x, y = 8 + k * (each + gap), 8 + i * (height + gap)
            parts.append(_box(x, y, each, height, _FILLS[i % len(_FILLS)]))
            parts.append(_text(x + each / 2, y + 26, name, size=15, anchor="middle"))
    return _svg(width, 8 + len(rows) * (height + gap), parts, "Layers: imports point down only")


def _box(x: float, y: float, width: float, height: float, fill: str) -> str:
    return (
        f'<rect x="{x:.1f}" y="{y}" width="{width:.1f}" height="{height}" rx="7" fill="{fill}" '
        f'stroke="{_LINE}"/>'
    )


def _arrow(x: float, y0: float, y1: float) -> str:
    return (
        f'<path d="M{x} {y0 + 3}V{y1 - 9}" stroke="{_LINE}" stroke-width="2" fill="none"/>'
        f'<path d="M{x - 6} {y1 - 11}h12l-6 9z" fill="{_LINE}"/>'
    )


def _text(
    x: float, y: float, text: str, *, size: int, weight: int = 400, colour: str = _INK,
    anchor: str = "start", style: str = "normal",
) -> str:  # fmt: skip
    return (
        f'<text x="{x:.1f}" y="{y}" font-size="{size}" font-weight="{weight}" fill="{colour}" '
        f'text-anchor="{anchor}" font-style="{style}">{escape(text)}</text>'
    )


def _svg(width: int, height: int, parts: Sequence[str], title: str) -> str:
    head = (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" '
        f'height="{height}" font-family="{escape(_FONT)}"><title>{escape(title)}</title>'
    )
    return "\n".join([head, *parts, "</svg>", ""])

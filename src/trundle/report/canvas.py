"""Make figures of one look: colour-blind-safe, without a screen, saved as PNG and SVG."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib import colormaps, rc_context
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_hex
from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter, StrMethodFormatter

__all__ = ["COLOURS", "STYLE", "Drawing", "class_colours", "make_logarithmic", "new_figure"]

# Okabe and Ito's palette (2008), told apart by nearly everybody.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000", "#7F7F7F")

STYLE: dict[Any, Any] = {
    "font.size": 9.0,
    "text.parse_math": False,  # names come from outside and may hold a dollar sign
    "axes.titlesize": 10.0,
    "axes.grid": True,
    "grid.color": "#D9D9D9",
    "grid.linewidth": 0.6,
    "axes.axisbelow": True,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "legend.frameon": False,
    "legend.fontsize": 8.0,
    "lines.linewidth": 1.1,
    "svg.hashsalt": "trundle",
    "svg.fonttype": "none",
}


@dataclass(frozen=True, kw_only=True)
class Drawing:
    """Hold what can be drawn for a page.

    Attributes
    ----------
    name : str
        File name without suffix.
    title : str
        Heading.
    caption : str
        What is seen, and what it was computed from.
    draw : callable
        Draws it.
    """

    name: str
    title: str
    caption: str
    draw: Callable[[], Figure]

    def save(self, folder: Path) -> None:
        """Draw it, and write ``NAME.png`` and ``NAME.svg`` into a folder."""
        with rc_context(STYLE):
            figure = self.draw()
            figure.savefig(folder / f"{self.name}.png", dpi=130)
            figure.set_layout_engine("none")  # laid out once; the second finds it as it is
            figure.savefig(folder / f"{self.name}.svg", metadata={"Date": None})


def new_figure(
    width: float = 7.2, height: float = 3.6, *, rows: int = 1, columns: int = 1, share: str = ""
) -> tuple[Figure, list[Axes]]:
    """Return a figure [inch] and its axes in reading order; share holds x, y, both or none."""
    figure = Figure(figsize=(width, height), layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.subplots(rows, columns, squeeze=False, sharex="x" in share, sharey="y" in share)
    return figure, list(axes.ravel())


def make_logarithmic(axes: Axes, which: str) -> None:
    """Make the axes named in `which` (x, y or both) logarithmic, with plain numbers on them."""
    for name in which:
        span = axes.dataLim.intervaly if name == "y" else axes.dataLim.intervalx
        if not max(span) > 0.0:
            continue  # nothing above 0 to draw: a logarithm has no place for it
        getattr(axes, f"set_{name}scale")("log")
        axis = axes.xaxis if name == "x" else axes.yaxis
        axis.set_major_formatter(StrMethodFormatter("{x:g}"))
        axis.set_minor_formatter(NullFormatter())


def class_colours(n: int) -> list[str]:
    """Return a colour for each of n classes: grey for not assessed, dark where little may stand."""
    return ["#d9d9d9", *(to_hex(shade) for shade in colormaps["cividis"](np.linspace(0, 1, n - 1)))]

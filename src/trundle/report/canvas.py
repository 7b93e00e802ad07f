"""Make figures of one look: colour-blind-safe, without a screen, saved as PNG and SVG."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from textwrap import fill
from typing import Any

import numpy as np
from matplotlib import rc_context
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import LinearSegmentedColormap, to_hex
from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter, StrMethodFormatter
from PIL import Image

__all__ = [
    "COLOURS",
    "STYLE",
    "Drawing",
    "class_colours",
    "legend_below",
    "line_look",
    "make_logarithmic",
    "new_figure",
]

# Okabe and Ito's palette (2008), told apart by nearly everybody.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000", "#7F7F7F")

_WARM = LinearSegmentedColormap.from_list("people", ["#dd5f0a", "#f7a650", "#fde6c4"])
_COOL = LinearSegmentedColormap.from_list("precision", ["#94bfe9", "#3f86c6", "#0a2f73"])
_PRECISION = 60e-6  # m/s: VC-A, 50 um/s, is the widest for equipment

_DASHES = ("-", "--", ":", "-.")
_DPI = 300  # of pictures as files
_OF_A_PAGE = 0.4  # of these
_LONGEST = 80  # letters of a name in a row of a legend
_LEGEND_ROW = 0.17  # inch

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

    def save(self, folder: Path) -> bytes:
        """Draw it, write ``NAME.png`` (300 dpi) and ``NAME.svg``; return a PNG for a page.

        That of a page has 120 dpi and 128 colours: a fifth of the bytes.
        """
        with rc_context(STYLE):
            figure = self.draw()
            figure.draw_without_rendering()
            figure.set_layout_engine("none")  # laid out once; both find it as it is
            large = _rendered(figure)
            large.save(folder / f"{self.name}.png", compress_level=3, dpi=(_DPI, _DPI))
            figure.set_dpi(100)
            figure.savefig(folder / f"{self.name}.svg", metadata={"Date": None})
        return _for_a_page(large)


def _rendered(figure: Figure) -> Image.Image:
    """Return a figure as its picture in print."""
    figure.set_dpi(_DPI)
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    return Image.fromarray(np.asarray(canvas.buffer_rgba())).convert("RGB")


def _for_a_page(picture: Image.Image) -> bytes:
    size = (round(_OF_A_PAGE * picture.width), round(_OF_A_PAGE * picture.height))
    small = picture.resize(size, Image.Resampling.HAMMING)
    few = small.quantize(128, method=Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE)
    target = BytesIO()
    few.save(target, format="PNG", optimize=True)
    return target.getvalue()


def new_figure(
    width: float = 7.2, height: float = 3.6, *, rows: int = 1, columns: int = 1, share: str = ""
) -> tuple[Figure, list[Axes]]:
    """Return a figure [inch] and its axes in reading order; share holds x, y, both or none."""
    figure = Figure(figsize=(width, height), layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.subplots(rows, columns, squeeze=False, sharex="x" in share, sharey="y" in share)
    return figure, list(axes.ravel())


def line_look(number: int) -> tuple[str, str]:
    """Return colour and style of a line: 32 of them are told apart."""
    return COLOURS[number % len(COLOURS)], _DASHES[number // len(COLOURS) % len(_DASHES)]


def legend_below(
    figure: Figure,
    handles: Sequence[Artist],
    labels: Sequence[str],
    *,
    columns: int,
    title: str = "",
) -> None:
    """Put a legend below a figure, of as many columns as it has room for.

    Names come from outside and may be long: those of a legend that is wider than its figure would
    be cut off at both ends.
    """
    words = [fill(label, _LONGEST) for label in labels]
    for n in range(min(columns, max(len(words), 1)), 0, -1):
        legend = figure.legend(
            handles, words, loc="outside lower center", ncols=n, title=title or None
        )
        if n == 1 or legend.get_window_extent().width <= figure.bbox.width:
            rows = -(-len(words) // n)
            figure.set_figheight(figure.get_figheight() + _LEGEND_ROW * max(0, rows - 3))
            return
        legend.remove()


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


def class_colours(limits: Sequence[float]) -> list[str]:
    """Return a colour for each class of a map: what nobody knows, none, then the criteria.

    Grey for not assessed, nearly black for none, from orange to pale for what people and workshops
    bear, from pale to dark blue for precision equipment: no two of the three are alike, to the
    colour-blind neither.

    Parameters
    ----------
    limits : sequence of float
        Smallest limit of each criterion, from the widest to the strictest [m/s].
    """
    people = sum(limit > _PRECISION for limit in limits)
    warm = _WARM(np.linspace(0.0, 1.0, people))
    cool = _COOL(np.linspace(0.0, 1.0, len(limits) - people))
    return ["#d9d9d9", "#331111", *(to_hex(shade) for shade in (*warm, *cool))]

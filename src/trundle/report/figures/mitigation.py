"""Draw what would help: classes against speed and road, and level against speed."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from itertools import product
from textwrap import fill
from typing import Literal, TypeAlias, get_args

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from trundle.mitigate.outcome import Outcome, Sweep
from trundle.report.canvas import COLOURS, Drawing, legend_below, make_logarithmic, new_figure
from trundle.units import KMH
from trundle.views.mitigation import NONE, PARTLY, UNKNOWN, middle_curve, strictest

__all__ = ["drawings"]

_FEW = 4  # changes, that have a panel each in a matrix and a line each in curves
_CELL = 8  # letters that a cell of a matrix holds
_Dashes: TypeAlias = Literal["-", "--", ":", "-."]
_STYLES: tuple[_Dashes, ...] = get_args(_Dashes)
_MARKERS = ("o", "s", "^", "D", "v", "P", "X", "*")


def drawings(sweep: Sweep) -> Iterator[Drawing]:
    """Give what is met at every point, and the level there against speed.

    Yields
    ------
    Drawing
        One after the other, as they stand on the page.
    """
    curve = middle_curve(sweep)
    for i, point in enumerate(sweep.study.points):
        yield Drawing(
            name=f"matrix_{i + 1}",
            title=f"Strictest criterion met, {point}",
            caption=f"By speed and road class, for every change and case. {PARTLY}.",
            draw=lambda point=point: class_matrix_figure(sweep, point),
        )
        if curve:
            yield Drawing(
                name=f"speed_{i + 1}",
                title=f"Level against speed, {point}",
                caption=f"Level over the limit of {curve}, where it is nearest; above 1 it fails. "
                "Dotted: speeds at which axles pass at the floor's first frequency, a half or a "
                "third of it.",
                draw=lambda point=point: speed_figure(sweep, point, curve),
            )


def class_matrix_figure(sweep: Sweep, point: str) -> Figure:
    """Draw the strictest criterion met at a point.

    Few changes have a panel each, speed against road class; many are rows of a panel of one case
    and road class, against speed.
    """
    cases = [case.name for case in sweep.study.cases]
    found = {(o.change, o.case, o.speed, o.road): strictest(o, point) for o in sweep.outcomes}
    speeds = [f"{v / KMH:.3g}" for v in sweep.speeds]
    names, labels = _names(sweep), _labels(sweep)
    if len(sweep.changes) <= _FEW:
        figure, axes = new_figure(
            1.2 + 1.9 * len(cases),
            1.2 + (0.55 + 0.30 * len(sweep.speeds)) * len(sweep.changes),
            rows=len(sweep.changes), columns=len(cases), share="xy",
        )  # fmt: skip
        for panel, (change, case) in zip(axes, product(sweep.changes, cases), strict=True):
            rows = [[found[change, case, v, road] for road in sweep.roads] for v in sweep.speeds]
            _matrix(panel, rows, (names, labels), (speeds, sweep.roads))
            panel.set_title(case if len(sweep.changes) == 1 else f"{case}\n{change}", fontsize=8)
        _label(axes, len(cases), "road class", "speed [km/h]")
        return figure
    figure, axes = new_figure(
        2.6 + 0.5 * len(sweep.speeds) * len(sweep.roads),
        1.0 + (0.5 + 0.22 * len(sweep.changes)) * len(cases),
        rows=len(cases), columns=len(sweep.roads), share="xy",
    )  # fmt: skip
    for panel, (case, road) in zip(axes, product(cases, sweep.roads), strict=True):
        rows = [[found[change, case, v, road] for v in sweep.speeds] for change in sweep.changes]
        _matrix(panel, rows, (names, labels), (sweep.changes, speeds))
        panel.set_title(f"{case}, class {road}", fontsize=8)
    axes[0].invert_yaxis()  # all panels share it
    figure.supxlabel("speed [km/h]", fontsize=9)  # one for all: panels of few speeds are narrow
    return figure


def _matrix(
    panel: Axes,
    rows: list[list[str]],
    called: tuple[list[str], Mapping[str, str]],
    ticks: tuple[Sequence[str], Sequence[str]],
) -> None:
    """Draw criteria met as colours with their labels; ticks are those of rows and columns."""
    names, labels = called
    colours = ListedColormap(colormaps["cividis"](np.linspace(0.0, 1.0, len(names))))
    norm = BoundaryNorm(np.arange(len(names) + 1) - 0.5, len(names))
    ranks = np.array([[names.index(title) for title in row] for row in rows])
    panel.imshow(ranks, cmap=colours, norm=norm, aspect="auto", origin="lower")
    for (i, j), rank in np.ndenumerate(ranks):
        ink = "white" if rank < 0.5 * len(names) else "black"
        panel.text(j, i, labels[rows[i][j]], ha="center", va="center", fontsize=6.5, color=ink)
    panel.grid(visible=False)
    panel.set_yticks(range(len(ticks[0])), ticks[0])
    panel.set_xticks(range(len(ticks[1])), ticks[1])
    panel.tick_params(labelsize=7)


def _label(axes: list[Axes], columns: int, x: str, y: str) -> None:
    """Name the axes at the figure's left and lower edge alone."""
    for i, panel in enumerate(axes):
        panel.set(xlabel=x if i >= len(axes) - columns else "", ylabel="" if i % columns else y)


def speed_figure(sweep: Sweep, point: str, criterion: str) -> Figure:
    """Draw level over limit against speed; marks where axles pass in resonance.

    A panel a case with a line for every change, or, of many changes, a panel a change with a line
    for every case.
    """
    cases, changes = [case.name for case in sweep.study.cases], sweep.changes
    by_case = len(changes) <= _FEW
    panels, lines = (cases, changes) if by_case else (changes, cases)
    columns = min(2 if by_case else 3, len(panels))
    rows = -(-len(panels) // columns)
    figure, axes = new_figure(8.4, 0.9 + 2.3 * rows, rows=rows, columns=columns, share="xy")
    for panel, name in zip(axes, panels, strict=False):
        marked: set[float] = set()
        for k, line in enumerate(lines):
            change, case = (line, name) if by_case else (name, line)
            dashes, mark = _look(k)
            marked |= set(sweep.resonances[change, case])
            for j, road in enumerate(sweep.roads):
                panel.plot(
                    np.array(sweep.speeds) / KMH,
                    1.0 / sweep.margin(change, case, road, point, criterion),
                    color=COLOURS[j % len(COLOURS)],
                    linestyle=dashes,
                    marker=mark,
                    markersize=3,
                )
        for speed in marked:
            panel.axvline(speed / KMH, color=COLOURS[7], linewidth=0.8, linestyle=":")
        panel.axhline(1.0, color="black", linewidth=1.0)
        make_logarithmic(panel, "y")
        panel.set_title(name if by_case else fill(name, 40), fontsize=9 if by_case else 7)
    for i, panel in enumerate(axes):
        panel.set_visible(i < len(panels))
        panel.set(xlabel="speed [km/h]" if i + columns >= len(panels) else "")
        panel.tick_params(labelbottom=i + columns >= len(panels))
        panel.set(ylabel=f"level / {criterion}" if i % columns == 0 else "")
    _legend(figure, sweep.roads, lines)
    return figure


def _legend(figure: Figure, roads: Sequence[str], lines: Sequence[str]) -> None:
    """Say which colour is which road, and which style and mark which line."""
    handles = [
        Line2D(
            [], [], color=COLOURS[j % len(COLOURS)], marker="o", markersize=3, label=f"class {r}"
        )
        for j, r in enumerate(roads)
    ]
    for k, line in enumerate(lines):
        dashes, mark = _look(k)
        handles.append(
            Line2D([], [], color="black", linestyle=dashes, marker=mark, markersize=3, label=line)
        )
    legend_below(figure, handles, [str(h.get_label()) for h in handles], columns=4)


def _look(number: int) -> tuple[_Dashes, str]:
    """Return style and mark of a line whose colour is that of a road: 32 are told apart."""
    return _STYLES[number % len(_STYLES)], _MARKERS[number // len(_STYLES) % len(_MARKERS)]


def _labels(sweep: Sweep) -> dict[str, str]:
    """Return what a cell holds for each title: itself, a short name, or its beginning.

    Beginnings that several titles share say nothing: those have their names.
    """
    found = {NONE: NONE, UNKNOWN: f"{UNKNOWN[:7].rstrip()}."}
    curves = {v.criterion.title: v.criterion.name for v in sweep.outcomes[0].verdicts}
    for title, name in curves.items():
        short = next((word for word in (title, name) if len(word) <= _CELL), "")
        found[title] = short or f"{title[: _CELL - 1].rstrip()}."
    often = Counter(found.values())
    return {
        title: label if often[label] == 1 else curves.get(title, title)
        for title, label in found.items()
    }


def _names(sweep: Sweep) -> list[str]:
    """Return none, not assessed, then the velocity criteria from the widest on."""
    first: Outcome = sweep.outcomes[0]
    curves = {
        v.criterion.title: float(v.criterion.limits.min())
        for v in first.verdicts
        if v.criterion.quantity == "band_rms_velocity"
    }
    return [NONE, UNKNOWN, *sorted(curves, key=lambda title: -curves[title])]  # widest first

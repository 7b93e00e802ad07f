"""Draw what would help: classes against speed and road, and level against speed."""

from __future__ import annotations

import numpy as np
from matplotlib import colormaps
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from trundle.criteria import Verdict
from trundle.report.canvas import COLOURS, make_logarithmic, new_figure
from trundle.study.mitigation import Outcome, Sweep
from trundle.units import KMH

__all__ = ["class_matrix_figure", "speed_figure", "strictest"]


def strictest(verdicts: tuple[Verdict, ...], point: str) -> str:
    """Return the title of the strictest velocity criterion that is passed at a point, or none."""
    passed = [
        v
        for v in verdicts
        if v.point == point and v.status == "pass" and v.criterion.quantity == "band_rms_velocity"
    ]
    best = min(passed, key=lambda v: float(v.criterion.limits.min()), default=None)
    return "none" if best is None else best.criterion.title


def class_matrix_figure(sweep: Sweep, point: str) -> Figure:
    """Draw the strictest criterion met for every change and case, speed against road class."""
    names = _names(sweep)
    colours = ListedColormap(colormaps["cividis"](np.linspace(0.0, 1.0, len(names))))
    norm = BoundaryNorm(np.arange(len(names) + 1) - 0.5, len(names))
    cases = [case.name for case in sweep.study.cases]
    found = {(o.change, o.case, o.speed, o.road): o for o in sweep.outcomes}
    figure, axes = new_figure(
        1.2 + 1.9 * len(cases),
        1.2 + (0.55 + 0.30 * len(sweep.speeds)) * len(sweep.changes),
        rows=len(sweep.changes),
        columns=len(cases),
        share="xy",
    )
    pairs = [(change, case) for change in sweep.changes for case in cases]
    for number, (panel, (change, case)) in enumerate(zip(axes, pairs, strict=True)):
        titles = [
            [strictest(found[change, case, speed, road].verdicts, point) for road in sweep.roads]
            for speed in sweep.speeds
        ]
        ranks = np.array([[names.index(title) for title in row] for row in titles])
        panel.imshow(ranks, cmap=colours, norm=norm, aspect="auto", origin="lower")
        for i, row in enumerate(titles):
            for j, title in enumerate(row):
                ink = "white" if ranks[i, j] < 0.6 * len(names) else "black"
                panel.text(j, i, _short(title), ha="center", va="center", fontsize=6.5, color=ink)
        panel.grid(visible=False)
        panel.set_xticks(range(len(sweep.roads)), sweep.roads)
        panel.set_yticks(range(len(sweep.speeds)), [f"{v / KMH:.3g}" for v in sweep.speeds])
        title = case if number < len(cases) and len(sweep.changes) == 1 else f"{case}\n{change}"
        panel.set_title(title, fontsize=8)
        panel.set(xlabel="road class" if number >= len(pairs) - len(cases) else "")
        panel.set(ylabel="speed [km/h]" if number % len(cases) == 0 else "")
    return figure


def speed_figure(sweep: Sweep, point: str, criterion: str) -> Figure:
    """Draw level over limit against speed, a panel a case; marks where axles pass in resonance."""
    cases = [case.name for case in sweep.study.cases]
    columns = min(2, len(cases))
    rows = -(-len(cases) // columns)
    figure, axes = new_figure(8.4, 0.9 + 2.5 * rows, rows=rows, columns=columns, share="xy")
    styles = ("-", "--", ":", "-.")
    for panel, case in zip(axes, cases, strict=False):
        for k, change in enumerate(sweep.changes):
            for j, road in enumerate(sweep.roads):
                level = 1.0 / sweep.margin(change, case, road, point, criterion)
                panel.plot(
                    np.array(sweep.speeds) / KMH,
                    level,
                    color=COLOURS[j % len(COLOURS)],
                    linestyle=styles[k % len(styles)],
                    marker="o",
                    markersize=3,
                )
        for speed in sweep.resonances[sweep.changes[0]]:
            panel.axvline(speed / KMH, color=COLOURS[7], linewidth=0.8, linestyle=":")
        panel.axhline(1.0, color="black", linewidth=1.0)
        make_logarithmic(panel, "y")
        panel.set_title(case, fontsize=9)
    for i, panel in enumerate(axes):
        panel.set_visible(i < len(cases))
        panel.set(xlabel="speed [km/h]" if i + columns >= len(cases) else "")
        panel.set(ylabel=f"level / {criterion}" if i % columns == 0 else "")
    handles = [
        Line2D(
            [], [], color=COLOURS[j % len(COLOURS)], marker="o", markersize=3, label=f"class {r}"
        )
        for j, r in enumerate(sweep.roads)
    ]
    handles += [
        Line2D([], [], color="black", linestyle=styles[k % len(styles)], label=change)
        for k, change in enumerate(sweep.changes)
    ]
    figure.legend(handles=handles, loc="outside lower center", ncols=4)
    return figure


def _short(title: str) -> str:
    """Return a title that a cell holds."""
    return title if len(title) <= 8 else f"{title[:7].rstrip()}."


def _names(sweep: Sweep) -> list[str]:
    """Return none, then the velocity criteria from the widest to the strictest."""
    first: Outcome = sweep.outcomes[0]
    curves = {
        v.criterion.title: float(v.criterion.limits.min())
        for v in first.verdicts
        if v.criterion.quantity == "band_rms_velocity"
    }
    return ["none", *sorted(curves, key=lambda title: -curves[title])]  # widest first

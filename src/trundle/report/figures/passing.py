"""Draw when vehicles and other sources are on a floor, and when they pass nearest to a point."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from trundle._typing import Array
from trundle.report.canvas import line_look
from trundle.results.cells import CellKey
from trundle.results.study_result import StudyResult, presence, wheels_at

__all__ = ["draw_passing", "passing_handles"]

_TIMES = 120  # at which it is looked where they are
_TOP, _APART = 0.985, 0.045  # of a panel's height: the first bar, and how far the next is below


def draw_passing(panel: Axes, result: StudyResult, key: CellKey, point: str, end: float) -> None:
    """Draw a bar along the top while each source is on the floor, with a tick where it is nearest.

    Parameters
    ----------
    panel : Axes
        A history, time along x [s].
    result : StudyResult
        A finished study.
    key : CellKey
        Whose first run is drawn.
    point : str
        Where it is read.
    end : float
        End of the record [s].
    """
    times = np.linspace(0.0, end, _TIMES)
    seen = presence(result, key, times.tolist())
    spot = result.study.points[point]
    there = result.study.in_plan(np.array([[spot.x, spot.y]]), spot.on)[0]
    look = panel.get_xaxis_transform()  # x in seconds, y in shares of the height
    for i, stands in enumerate(seen.values()):
        on = np.array([wheels > 0 for _, wheels in stands])
        if not on.any():
            continue
        colour, _ = line_look(i + 1)
        height = _TOP - _APART * i
        bars = np.where(on, height, np.nan)
        panel.plot(times, bars, color=colour, linewidth=3.0, alpha=0.6, transform=look)
        nearest = _nearest([place for place, _ in stands], there)
        if nearest is not None:
            panel.plot([times[nearest]], [height], marker="v", markersize=5, color=colour,
                       markeredgecolor="black", markeredgewidth=0.5, transform=look)  # fmt: skip


def _nearest(places: Sequence[tuple[float, float] | None], there: Array) -> int | None:
    """Return at which of some times a front axle is nearest to a place; None where it never is."""
    far = np.array([np.inf if p is None else np.hypot(*(np.asarray(p) - there)) for p in places])
    return int(far.argmin()) if np.isfinite(far).any() else None


def passing_handles(result: StudyResult, key: CellKey) -> tuple[list[Line2D], list[str]]:
    """Return what a legend says of the bars."""
    names = list(wheels_at(result, key, 0.0))
    handles = [
        Line2D([], [], color=line_look(i + 1)[0], linewidth=3.0, alpha=0.6, marker="v",
               markeredgecolor="black", markeredgewidth=0.5)
        for i in range(len(names))
    ]  # fmt: skip
    return handles, [f"{name} on the floor, front axle nearest" for name in names]

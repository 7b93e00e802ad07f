"""Draw where people walk and machines stand, on any plan."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from matplotlib.axes import Axes

from trundle.report.canvas import COLOURS
from trundle.study.model import Study

__all__ = ["draw_sources"]

_ONE_PLACE = 16  # places of a way up to which they are feet, and no way


def draw_sources(
    axes: Axes, study: Study, names: Iterable[str], *, on: str | None, labels: bool = False
) -> None:
    """Draw sources that are no vehicles: ways dotted, places as squares.

    Parameters
    ----------
    axes : Axes
        A plan [m].
    study : Study
        Has the sources.
    names : iterable of str
        Which are drawn.
    on : str or None
        Surface that the plan is of.
    labels : bool
        Whether their names stand beside them.
    """
    for i, name in enumerate(name for name in names if name in study.sources):
        source, colour = study.sources[name], COLOURS[(i + 2) % 6]
        if not study.is_on(source.on, on):
            continue
        places = np.concatenate([place for place, _ in source.way()])
        xy = study.in_plan(places, source.on)
        if len(xy) > _ONE_PLACE:
            axes.plot(*xy.T, color="white", linewidth=2.4)
            axes.plot(*xy.T, color=colour, linewidth=1.4, linestyle=":")
        else:
            axes.plot(
                *xy.T, marker="s", markersize=6, color=colour, markeredgecolor="white",
                linestyle="none",
            )  # fmt: skip
        if labels:
            axes.annotate(
                name, xy[len(xy) // 8], xytext=(4, -11), textcoords="offset points", color=colour,
                bbox={"facecolor": "white", "edgecolor": "none", "pad": 1.0, "alpha": 0.8},
            )  # fmt: skip

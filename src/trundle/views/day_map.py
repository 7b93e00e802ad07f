"""Say how often and how long a day lies above a limit, over the floor."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from trundle._typing import Array
from trundle.results.cells import DayKey
from trundle.results.maps import MapKey
from trundle.results.study_result import StudyResult
from trundle.study.map_plan import MapGrid

__all__ = ["DayMap", "day_maps"]


@dataclass(frozen=True, kw_only=True, eq=False)
class DayMap:
    """Hold a day over one surface beside the criterion that a study's maps are drawn for.

    Attributes
    ----------
    criterion : str
        Name of the criterion.
    grid : MapGrid
        The places.
    routes : tuple of str
        Names of what passes.
    events : ndarray of float, shape (n_places,)
        Passages a day that exceed it, in the mean; NaN where nothing moves.
    minutes : ndarray of float, shape (n_places,)
        Minutes a day that the running level lies above it, in the mean; NaN where none is known.
    """

    criterion: str
    grid: MapGrid
    routes: tuple[str, ...]
    events: Float[Array, " places"]
    minutes: Float[Array, " places"]


def day_maps(result: StudyResult, key: DayKey) -> list[DayMap]:
    """Return a day over every surface that is mapped; nothing without maps of all its routes.

    Parameters
    ----------
    result : StudyResult
        A finished study.
    key : DayKey
        Schedule and road.
    """
    plan, schedule = result.study.map, result.study.schedules[key.schedule]
    maps = {route: result.maps.get(MapKey(route, key.road)) for route in schedule.routes}
    if plan is None or any(one is None for one in maps.values()):
        return []
    counts = {name: float(hours.sum()) for name, hours in schedule.expected().items()}
    events, seconds = np.zeros(plan.n_places), np.zeros(plan.n_places)
    for route, one in maps.items():
        assert one is not None  # looked at above
        events += counts[route] * one.classes.share_exceeding[one.classes.index(plan.criterion)]
        seconds += counts[route] * one.seconds_above.get(plan.criterion, np.nan)
    return [
        DayMap(
            criterion=plan.criterion,
            grid=grid,
            routes=schedule.routes,
            events=events[part],
            minutes=seconds[part] / 60.0,
        )
        for grid, part in plan.parts()
    ]

"""Map one case over the floor, on every road."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from trundle._progress import Progress
from trundle.criteria import class_map, watched
from trundle.response import CurveLimit, FloorMap, floor_map
from trundle.results.maps import StudyMap
from trundle.results.parts import MapPart
from trundle.simulate import Layout, PlaceResponses, contact_force_histories
from trundle.study.map_plan import MapPlan

__all__ = ["map_part"]


def map_part(
    plan: MapPlan,
    layout: Layout,
    places: PlaceResponses,
    factors: Sequence[float],
    seed: int,
    *,
    days: bool = False,
    progress: Progress | None = None,
) -> MapPart:
    """Map a case on every road, and keep what is drawn of it."""
    forces, mean = contact_force_histories(layout, runs=range(plan.runs), seed=seed)
    every = floor_map(  # all roads beside each other: the floor answers them alike
        places,
        np.concatenate([mean + factor * (forces - mean) for factor in factors], axis=2),
        f_max=layout.f_max,
        averaging=plan.averaging,
        peaks=plan.peaks,
        people=plan.people,
        curves=_watched(plan, layout) if days else (),
        every_step=plan.every_step,
        progress=progress,
    )
    return MapPart(
        maps=tuple(
            _of_road(every.part(slice(i * plan.runs, (i + 1) * plan.runs)), plan, layout)
            for i in range(len(factors))
        )
    )


def _watched(plan: MapPlan, layout: Layout) -> tuple[CurveLimit, ...]:
    """Return the curves of a map, as far as anything is known in their bands."""
    curves, _ = watched(
        plan.criteria,
        f_max=layout.f_max,
        sampling_frequency=1.0 / layout.integration.dt,
        coverage=layout.coverage,
    )
    return curves


def _of_road(found: FloorMap, plan: MapPlan, layout: Layout) -> StudyMap:
    """Hold the map of one road against the criteria, and keep the levels that it is drawn by."""
    return StudyMap(
        classes=class_map(
            found,
            plan.criteria,
            percentile=plan.percentile,
            f_max=layout.f_max,
            coverage=layout.coverage,
            level=plan.level,
        ),
        numbers={
            name: np.percentile(levels, plan.percentile, axis=0)
            for name, levels in found.numbers.items()
        },
        band_levels=np.percentile(found.band_levels, plan.percentile, axis=0),
        seconds_above={name: np.mean(values, axis=0) for name, values in found.above.items()},
    )

"""Map one case over the floor, on every road."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from trundle._progress import Progress
from trundle._typing import Array
from trundle.criteria import class_map
from trundle.response import floor_map
from trundle.results.maps import BY_CRITERION, LEVELS
from trundle.results.pieces import Piece
from trundle.simulate import Layout, PlaceResponses, contact_force_histories
from trundle.study.map_plan import MapPlan

__all__ = ["map_piece"]


def map_piece(
    plan: MapPlan,
    layout: Layout,
    places: PlaceResponses,
    factors: Sequence[float],
    seed: int,
    *,
    progress: Progress | None = None,
) -> Piece:
    """Map a case on every road, and keep what is drawn of it."""
    forces, mean = contact_force_histories(layout, runs=range(plan.runs), seed=seed)
    every = floor_map(  # all roads beside each other: the floor answers them alike
        places,
        np.concatenate([mean + factor * (forces - mean) for factor in factors], axis=2),
        f_max=layout.f_max,
        averaging=plan.averaging,
        peaks=plan.peaks,
        every_step=plan.every_step,
        progress=progress,
    )
    arrays: dict[str, Array] = {}
    for i in range(len(factors)):
        found = every.part(slice(i * plan.runs, (i + 1) * plan.runs))
        held = class_map(
            found,
            plan.criteria,
            percentile=plan.percentile,
            f_max=layout.f_max,
            coverage=layout.coverage,
        )
        arrays |= {f"{i}.{name}": getattr(held, name) for name in BY_CRITERION}
        arrays[f"{i}.complete"] = np.array(held.complete)
        for name in LEVELS:
            level = np.percentile(getattr(found, name), plan.percentile, axis=0)
            arrays[f"{i}.{name}"] = level
    return Piece(role="map", arrays=arrays, notes={})

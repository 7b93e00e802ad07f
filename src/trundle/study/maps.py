"""Map a study's cases over the floor: plan, piece and result."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from trundle._typing import Array
from trundle.criteria import ClassMap, Criterion, class_map
from trundle.response import floor_map
from trundle.signals import Averaging
from trundle.simulate import Layout, PlaceResponses, contact_force_histories
from trundle.study.pieces import Piece

__all__ = ["MapKey", "MapPlan", "StudyMap", "map_of", "map_piece", "map_places"]

_MOST = 300  # places of a map unless a spacing is given: half a minute for 1000 runs
_ARRAYS = ("margin", "governing_band", "share_exceeding")
_LEVELS = ("rms_velocity", "peak_acceleration", "band_levels")


@dataclass(frozen=True, kw_only=True, eq=False)
class MapPlan:
    """Hold what is mapped.

    Attributes
    ----------
    x, y : ndarray of float
        Lines of the grid of places [m].
    runs : int
        Runs of each map, the first of the study's.
    criteria : tuple of Criterion
        Curves that a map can be held against.
    criterion : str
        Name of the one whose margin and exceedance are drawn.
    percentile : float
        Share of runs that levels cover, 0 to 100.
    averaging : {"max_1s", "event"}
        Averaging rule of band levels.
    traffic : bool
        Whether several vehicles at once are mapped too; they take as long as all of them.
    every_step : bool
        Whether the largest 1 s is looked for at every time step, see `floor_map`.
    peaks : bool
        Whether peak accelerations are mapped too; they take half as long again.
    speeds : tuple of float
        Constant speeds of every vehicle that are mapped beside those of the study [m/s].
    """

    x: Float[Array, " columns"]
    y: Float[Array, " rows"]
    runs: int
    criteria: tuple[Criterion, ...]
    criterion: str
    percentile: float
    averaging: Averaging
    traffic: bool
    every_step: bool
    peaks: bool
    speeds: tuple[float, ...]

    @property
    def places(self) -> Float[Array, "places 2"]:
        """Return the places in plan, x running fastest [m]."""
        return np.stack(np.meshgrid(self.x, self.y), axis=-1).reshape(-1, 2)


@dataclass(frozen=True)
class MapKey:
    """Name a map: what drove, on what road, at what speed if not the study's own [m/s]."""

    case: str
    road: str
    speed: float | None = None


@dataclass(frozen=True, kw_only=True, eq=False)
class StudyMap:
    """Hold the map of one cell.

    Attributes
    ----------
    classes : ClassMap
        Margins, exceedance and classes.
    rms_velocity : ndarray of float, shape (n_places,)
        RMS velocity over the record that the share of runs stays below [m/s].
    peak_acceleration : ndarray of float, shape (n_places,)
        The same of the peak [m/s2]; NaN where no criterion asks for it.
    band_levels : ndarray of float, shape (n_places, n_bands)
        The same of band levels [m/s].
    """

    classes: ClassMap
    rms_velocity: Float[Array, " places"]
    peak_acceleration: Float[Array, " places"]
    band_levels: Float[Array, "places bands"]


def map_places(
    extent: tuple[float, float], spacing: float | None, other: tuple[float, float]
) -> Float[Array, " lines"]:
    """Return evenly spaced lines across an extent, half a step inside it [m].

    Parameters
    ----------
    extent : tuple of float
        Where the floor begins and ends [m].
    spacing : float or None
        Distance of lines, at most [m]; so that the whole floor has 300 places unless given.
    other : tuple of float
        Extent in the other direction [m].
    """
    length = extent[1] - extent[0]
    if spacing is None:
        spacing = float(np.sqrt(length * (other[1] - other[0]) / _MOST))
    n = max(2, int(np.ceil(length / spacing - 1e-9)))
    return extent[0] + (np.arange(n) + 0.5) * length / n


def map_piece(
    plan: MapPlan,
    layout: Layout,
    places: PlaceResponses,
    factors: Sequence[float],
    seed: int,
    *,
    progress: Callable[[float], None] | None = None,
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
        arrays |= {f"{i}.{name}": getattr(held, name) for name in _ARRAYS}
        arrays[f"{i}.complete"] = np.array(held.complete)
        for name in _LEVELS:
            level = np.percentile(getattr(found, name), plan.percentile, axis=0)
            arrays[f"{i}.{name}"] = level
    return Piece(arrays=arrays, notes={"mapped": True})


def map_of(plan: MapPlan, piece: Piece, road: int) -> StudyMap:
    """Return the map of one of the roads of a piece."""
    arrays = piece.arrays
    some = tuple(c for c in plan.criteria if c.axis != "horizontal")
    return StudyMap(
        classes=ClassMap(
            places=plan.places,
            criteria=some,
            complete=tuple(bool(flag) for flag in arrays[f"{road}.complete"]),
            percentile=plan.percentile,
            **{name: arrays[f"{road}.{name}"] for name in _ARRAYS},
        ),
        **{name: arrays[f"{road}.{name}"] for name in _LEVELS},
    )

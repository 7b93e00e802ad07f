"""Hold a map of a floor against criteria: class, margin and exceedance at every place."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float, Int

from trundle._checks import within
from trundle._typing import Array
from trundle.criteria.curve import Criterion
from trundle.criteria.verdict import STILL
from trundle.errors import ComputationError, InputError
from trundle.response import FloorMap
from trundle.signals import TOP_FREQUENCY
from trundle.simulate import Coverage

__all__ = ["ClassMap", "class_map", "envelope_of"]

_MAPPED = ("band_rms_velocity", "peak_acceleration", "response_factor")


@dataclass(frozen=True, kw_only=True, eq=False)
class ClassMap:
    """Hold criteria over a floor.

    Attributes
    ----------
    places : ndarray of float, shape (n_places, 2)
        Where [m].
    criteria : tuple of Criterion
        Those that a map can be held against: velocity in bands, peak acceleration.
    margin : ndarray of float, shape (n_criteria, n_places)
        Smallest limit over level in the bands computed and excited; below 1 fails; NaN where none
        was, or where nothing moves, as on an edge that is held.
    governing_band : ndarray of float, shape (n_criteria, n_places)
        Mid-band frequency where it is smallest [Hz]; NaN for peaks.
    share_exceeding : ndarray of float, shape (n_criteria, n_places)
        Share of runs above the limit in any band, 0 to 1; NaN where nothing moves.
    applies : ndarray of bool, shape (n_criteria, n_places)
        Whether each criterion is for the motion that is mapped at a place: level or vertical.
    complete : tuple of bool
        Whether everything that each criterion asks for was computed and excited, and the vehicles
        have left; else it cannot be passed.
    percentile : float
        Share of runs that levels cover, 0 to 100.
    """

    places: Float[Array, "places 2"]
    criteria: tuple[Criterion, ...]
    margin: Float[Array, "criteria places"]
    governing_band: Float[Array, "criteria places"]
    share_exceeding: Float[Array, "criteria places"]
    applies: Bool[Array, "criteria places"]
    complete: tuple[bool, ...]
    percentile: float

    def classes(self) -> Int[Array, " places"]:
        """Return which velocity criterion is the strictest that is passed.

        One criterion is stricter than another whose smallest limit is larger. -1 stands where none
        is met, -2 where none is known to be passed and the widest not known to be failed.
        """
        order = self.order()
        widest = np.full(self.margin.shape[1], np.nan)
        for i in reversed(order):
            widest = np.where(self.applies[i], self.margin[i], widest)
        found = np.where(widest < 1.0, -1, -2)
        for i in order:
            if self.complete[i]:
                found[self.margin[i] >= 1.0] = i
        return found

    def part(self, places: slice) -> ClassMap:
        """Return some of the places."""
        return replace(
            self,
            places=self.places[places],
            margin=self.margin[:, places],
            governing_band=self.governing_band[:, places],
            share_exceeding=self.share_exceeding[:, places],
            applies=self.applies[:, places],
        )

    def order(self) -> list[int]:
        """Return which criteria are of velocity, from the widest to the strictest."""
        velocity = (i for i, c in enumerate(self.criteria) if c.quantity == "band_rms_velocity")
        return sorted(velocity, key=lambda i: -float(self.criteria[i].limits.min()))

    def index(self, name: str) -> int:
        """Return the place of a criterion by its name."""
        names = [criterion.name for criterion in self.criteria]
        if name not in names:
            raise InputError(f"no criterion {name!r} on the map; there are {', '.join(names)}")
        return names.index(name)


def class_map(
    floor: FloorMap,
    criteria: Sequence[Criterion],
    *,
    percentile: float = 95.0,
    f_max: float,
    coverage: Coverage | None = None,
    level: Bool[Array, " places"] | None = None,
) -> ClassMap:
    """Hold a map against criteria.

    Parameters
    ----------
    floor : FloorMap
        Levels of every run at every place.
    criteria : sequence of Criterion
        Curves; those that a map has no quantity for are left out.
    percentile : float
        Share of runs that the compared level must cover, 0 to 100.
    f_max : float
        Highest frequency that modes and step show as it is [Hz].
    coverage : Coverage, optional
        Which bands the road excites, and whether the vehicles have left; without it all do.
    level : ndarray of bool, shape (n_places,), optional
        Where level motion is mapped; vertical motion elsewhere, and everywhere unless given.
    """
    reach = coverage or Coverage()
    within("percentile", percentile, 0.0, 100.0)
    level = np.zeros(len(floor.places), dtype=bool) if level is None else level
    for_motion = {"horizontal": level, "vertical": ~level, "each axis": np.ones_like(level)}
    some = tuple(c for c in criteria if c.quantity in _MAPPED and for_motion[c.axis].any())
    if np.isinf(floor.band_levels).any():
        raise ComputationError("a level on the map is infinite; the motion there has overflowed")
    levels = np.percentile(floor.band_levels, percentile, axis=0)
    found = [
        _by_band(floor, levels, c, reach)
        if c.quantity == "band_rms_velocity"
        else _by_number(floor, c, percentile, min(f_max, reach.excited_to) if reach.left else 0.0)
        for c in some
    ]
    shape = (len(some), len(floor.places))
    applies = np.array([for_motion[c.axis] for c in some], dtype=bool).reshape(shape)
    numbers = np.array([one[:3] for one in found], dtype=float).reshape(len(some), 3, len(level))
    margin, band, share = np.where(applies[:, None], numbers, np.nan).transpose(1, 0, 2)
    return ClassMap(
        places=floor.places,
        criteria=some,
        margin=margin,
        governing_band=band,
        share_exceeding=share,
        applies=applies,
        complete=tuple(one[3] for one in found),
        percentile=percentile,
    )


def envelope_of(maps: Sequence[ClassMap], known: Sequence[bool] | None = None) -> ClassMap:
    """Return the worst of several maps at every place: of roads, vehicles, speeds.

    The share of runs is that of the worst single map.

    Parameters
    ----------
    maps : sequence of ClassMap
        The maps.
    known : sequence of bool, optional
        Which are of forces that are known altogether: that they excite no higher bands keeps
        nobody else from passing, unless all are so.
    """
    first = maps[0]
    free = [not one for one in known] if known is not None else [True] * len(maps)
    asked = [one for one, binds in zip(maps, free, strict=True) if binds] or list(maps)
    margins = np.stack([one.margin for one in maps])
    worst = np.argmin(np.where(np.isnan(margins), np.inf, margins), axis=0)[None]
    bands = np.stack([one.governing_band for one in maps])
    return ClassMap(
        places=first.places,
        criteria=first.criteria,
        margin=np.take_along_axis(margins, worst, axis=0)[0],
        governing_band=np.take_along_axis(bands, worst, axis=0)[0],
        share_exceeding=np.fmax.reduce([one.share_exceeding for one in maps]),
        applies=first.applies,
        complete=tuple(all(flags) for flags in zip(*(one.complete for one in asked), strict=True)),
        percentile=first.percentile,
    )


def _by_band(
    floor: FloorMap, level: Array, criterion: Criterion, coverage: Coverage
) -> tuple[Array, Array, Array, bool]:
    limits = criterion.limit(floor.mid_band)
    asked = np.isfinite(limits)
    excited = asked & floor.resolved & coverage.excites(floor.mid_band)
    # where some of several sources excite, what they give is a lower bound: it can fail
    usable = excited | (asked & floor.resolved & coverage.excites_partly(floor.mid_band))
    n_places = len(floor.places)
    beyond = len(criterion.bands_beyond()) > 0
    complete = bool(excited.any() and not (asked & ~excited).any() and not beyond and coverage.left)
    if not usable.any():
        nothing = np.full(n_places, np.nan)
        return nothing, nothing, nothing, False
    margins = limits[usable] / np.maximum(level[:, usable], np.finfo(float).tiny)
    margins = np.where(excited[usable] | (margins < 1.0), margins, np.inf)
    levels = floor.band_levels[:, :, usable]
    above = (levels > limits[usable]).any(axis=2).mean(axis=0)
    moves = levels.max(axis=(0, 2)) > STILL
    worst = margins.min(axis=1)
    said = moves & np.isfinite(worst)  # not where no band is whole and none fails
    return (
        np.where(said, worst, np.nan),
        np.where(said, floor.mid_band[usable][margins.argmin(axis=1)], np.nan),
        np.where(moves, above, np.nan),
        complete,
    )


def _by_number(
    floor: FloorMap, criterion: Criterion, percentile: float, f_max: float
) -> tuple[Array, Array, Array, bool]:
    limit, numbers = float(criterion.limits[0]), floor.numbers[criterion.quantity]
    if np.isnan(numbers).any():
        nothing = np.full(len(floor.places), np.nan)
        return nothing, nothing, nothing, False
    value = np.percentile(numbers, percentile, axis=0)
    margin = limit / np.maximum(value, np.finfo(float).tiny)
    above = (numbers > limit).mean(axis=0)
    moves = numbers.max(axis=0) > STILL
    reach = min(float(criterion.frequencies[-1]), TOP_FREQUENCY)
    return (
        np.where(moves, margin, np.nan),
        np.full(len(value), np.nan),
        np.where(moves, above, np.nan),
        f_max >= reach * (1 - 1e-6),
    )

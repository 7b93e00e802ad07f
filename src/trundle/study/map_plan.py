"""Say what is mapped over a floor: where, how often, against what."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from jaxtyping import Bool, Float

from trundle._typing import Array
from trundle.criteria import Criterion
from trundle.signals import Averaging
from trundle.structure import Axis, Spots, Surface

__all__ = ["MapGrid", "MapPlan", "grids_over", "map_places"]

_MOST = 300  # places of a map unless a spacing is given: half a minute for 1000 runs


@dataclass(frozen=True, kw_only=True, eq=False)
class MapGrid:
    """Hold the places of a map on one surface.

    Attributes
    ----------
    x, y : ndarray of float
        Lines of the grid in plan [m].
    there : ndarray of bool, shape (n_rows, n_columns)
        Where the surface is: not in an opening, not beyond an edge.
    spots : Spots
        The places that are there, x running fastest.
    """

    x: Float[Array, " columns"]
    y: Float[Array, " rows"]
    there: Bool[Array, "rows columns"]
    spots: Spots

    @classmethod
    def over(
        cls,
        x: Float[Array, " columns"],
        y: Float[Array, " rows"],
        surface: Surface | None,
        on: str | None,
        axis: Axis = "z",
    ) -> MapGrid:
        """Lay a grid over a surface; over a whole rectangle without one."""
        xy = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
        there = np.ones(len(xy), dtype=bool)
        if surface is not None:
            xy = surface.frame.from_plan(xy)
            there = surface.holds(xy)
        shape = (len(y), len(x))
        spots = Spots(xy=xy[there], on=on, axis=axis)
        return cls(x=x, y=y, there=there.reshape(shape), spots=spots)

    @property
    def on(self) -> str | None:
        """Name of the surface; None for the only one."""
        return self.spots.on

    @property
    def axis(self) -> Axis:
        """Which motion is mapped."""
        return self.spots.axis

    @property
    def label(self) -> str:
        """Surface and level axis in words; empty for vertical motion of the only surface."""
        along = None if self.axis == "z" else f"along {self.axis}"
        return ", ".join(part for part in (self.on, along) if part is not None)

    @property
    def xy(self) -> Float[Array, "places 2"]:
        """All places in plan [m]."""
        return np.stack(np.meshgrid(self.x, self.y), axis=-1)[self.there]

    def filled(self, values: Float[Array, " places"]) -> Float[Array, "rows columns"]:
        """Return values of the places on the grid, NaN where there is none."""
        out = np.full(self.there.shape, np.nan)
        out[self.there] = values
        return out


@dataclass(frozen=True, kw_only=True, eq=False)
class MapPlan:
    """Hold what is mapped.

    Attributes
    ----------
    grids : tuple of MapGrid
        Places, surface by surface, axis by axis.
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
    people : bool
        Whether what people feel is mapped too: response factors and doses; as long again.
    speeds : tuple of float
        Constant speeds of every vehicle that are mapped beside those of the study [m/s].
    """

    grids: tuple[MapGrid, ...]
    runs: int
    criteria: tuple[Criterion, ...]
    criterion: str
    percentile: float
    averaging: Averaging
    traffic: bool
    every_step: bool
    peaks: bool
    people: bool
    speeds: tuple[float, ...]

    @property
    def places(self) -> tuple[Spots, ...]:
        """The places on every surface, for every axis."""
        return tuple(grid.spots for grid in self.grids)

    @property
    def n_places(self) -> int:
        """Number of places on all surfaces, for all axes."""
        return sum(map(len, self.places))

    @property
    def level(self) -> Bool[Array, " places"]:
        """Where level motion is mapped, of all places."""
        return np.concatenate([np.full(len(s), s.axis != "z") for s in self.places])

    @property
    def motion(self) -> str:
        """Which motion is mapped, in words."""
        axes = dict.fromkeys(grid.axis for grid in self.grids)
        return ", ".join("vertical" if axis == "z" else f"along {axis}" for axis in axes)

    def parts(self) -> Iterator[tuple[MapGrid, slice]]:
        """Give each grid with where its places stand among all."""
        ends = np.cumsum([0, *map(len, self.places)])
        for grid, (start, end) in zip(self.grids, pairwise(ends.tolist()), strict=True):
            yield grid, slice(start, end)

    def where(self, place: int) -> tuple[float, float, str]:
        """Return where one of all places is in plan [m], and its surface and axis in words."""
        for grid, part in self.parts():
            if place < part.stop:
                x, y = grid.xy[place - part.start]
                return float(x), float(y), grid.label
        raise IndexError(place)


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


def grids_over(surfaces: Mapping[str, Surface], spacing: float | None) -> tuple[MapGrid, ...]:
    """Return places of vertical motion on every surface of a floor.

    Parameters
    ----------
    surfaces : mapping of str to Surface
        All surfaces of the floor.
    spacing : float or None
        Distance of places, at most [m]; so that each surface has 300 unless given.
    """
    grids: list[MapGrid] = []
    for name, surface in surfaces.items():
        low, high = (surface.frame.to_plan(corner[None])[0] for corner in surface.extent)
        x, y = (float(low[0]), float(high[0])), (float(low[1]), float(high[1]))
        lines = map_places(x, spacing, y), map_places(y, spacing, x)
        grids.append(MapGrid.over(*lines, surface, name if len(surfaces) > 1 else None))
    return tuple(grids)

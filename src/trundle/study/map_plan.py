"""Say what is mapped over a floor: where, how often, against what."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from trundle._typing import Array
from trundle.criteria import Criterion
from trundle.signals import Averaging
from trundle.structure import Spots

__all__ = ["MapPlan", "map_places"]

_MOST = 300  # places of a map unless a spacing is given: half a minute for 1000 runs


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
    def places(self) -> Spots:
        """Return the places in plan, x running fastest."""
        return Spots(xy=np.stack(np.meshgrid(self.x, self.y), axis=-1).reshape(-1, 2))


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

"""Parts that are given by their outline in plan and their heights, beside those between planes.

Where an element belongs is asked a little way round its middle, in eight directions of plan and, of
one that lies flat at a height where a part ends, below and above. What lies on an outline, such as
a beam between two units or a column at the corner of four, is so shared by all that meet there:
two halves along an edge, four quarters at a corner. Directions lean by 13 degrees, that no edge
runs along one.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from jaxtyping import Float

from trundle._checks import frozen_array, set_frozen
from trundle._typing import Array
from trundle.errors import InputError
from trundle.structure.elements.protocol import GROUND

__all__ = ["Region", "middles_of", "shares_by_region"]

_ON_EDGE = 1e-3  # m, within which an element lies on an outline
_ROUND = np.radians(13.0) + 0.25 * np.pi * np.arange(8)


@dataclass(frozen=True, kw_only=True, eq=False)
class Region:
    """Hold where a given part lies.

    Attributes
    ----------
    name : str
        Of the part; its copies share it.
    outline : ndarray of float, shape (n, 2)
        Corners in plan, one after the other [m].
    low, high : float
        Heights between which it lies [m]; all, unless given.

    Raises
    ------
    InputError
        An outline of less than three corners, one that crosses itself, heights that do not rise.
    """

    name: str
    outline: Float[Array, "corners 2"]
    low: float = -np.inf
    high: float = np.inf

    def __post_init__(self) -> None:
        """Check that it encloses something."""
        outline = frozen_array("outline", self.outline, shape=(None, 2))
        set_frozen(self, outline=outline)
        if len(outline) < 3 or not shapely.Polygon(outline).is_valid or not self.area:
            raise InputError(
                f"part {self.name!r} needs an outline of three corners or more that does not cross "
                f"itself; got {outline.tolist()}"
            )
        if not self.low < self.high:
            raise InputError(
                f"part {self.name!r} must end above where it begins; got {self.low:g} m to "
                f"{self.high:g} m"
            )

    @property
    def area(self) -> float:
        """The area in plan [m2]."""
        return float(shapely.Polygon(self.outline).area)

    def overlaps(self, other: Region) -> bool:
        """Return whether another one takes more than a strip of a millimetre of it."""
        if min(self.high, other.high) - max(self.low, other.low) <= _ON_EDGE:
            return False
        both = shapely.intersection(shapely.Polygon(self.outline), shapely.Polygon(other.outline))
        return not both.buffer(-_ON_EDGE).is_empty

    def holds(self, points: Float[Array, "points 3"]) -> Array:
        """Return which points lie in it."""
        within = shapely.contains_xy(shapely.Polygon(self.outline), points[:, 0], points[:, 1])
        return within & (points[:, 2] > self.low) & (points[:, 2] < self.high)

    def has_on_its_edge(self, points: Float[Array, "points 3"]) -> Array:
        """Return which points lie on its outline, seen in plan."""
        edge = shapely.LinearRing(self.outline)
        return np.asarray(shapely.distance(edge, shapely.points(points[:, :2])) <= _ON_EDGE)


def middles_of(nodes: Array, connectivity: Array) -> Array:
    """Return the middle of each element's nodes [m], shape (n_elements, 3)."""
    there = (connectivity != GROUND)[..., None]
    return np.where(there, nodes[connectivity], 0.0).sum(axis=1) / there.sum(axis=1)


def shares_by_region(
    nodes: Float[Array, "nodes 3"], connectivity: Array, regions: Sequence[Region]
) -> Float[Array, "elements regions_and_none"]:
    """Return by which share each element of a group belongs to each region, and to none (last).

    Parameters
    ----------
    nodes : ndarray of float, shape (n_nodes, 3)
        Of the structure [m].
    connectivity : ndarray of int, shape (n_elements, n_ends)
        Nodes of each element.
    regions : sequence of Region
        None that overlap.
    """
    there = connectivity != GROUND
    xyz = nodes[connectivity]
    middle = middles_of(nodes, connectivity)
    on_edge, levels = _lying(xyz, there, middle, regions)
    low = np.where(there, xyz[..., 2], np.inf).min(axis=1)
    high = np.where(there, xyz[..., 2], -np.inf).max(axis=1)
    flat = high - low <= 2.0 * _ON_EDGE
    for end in levels:
        flat_here = flat & (np.abs(middle[:, 2] - end) <= _ON_EDGE)
        on_edge[flat_here, 1] = True
    shares = np.zeros((len(connectivity), len(regions) + 1))
    reach = 2.0 * _ON_EDGE
    for turn in _ROUND:
        for side in (-1.0, 1.0):
            step = np.stack(
                [
                    np.where(on_edge[:, 0], np.cos(turn), np.cos(_ROUND[0])),
                    np.where(on_edge[:, 0], np.sin(turn), np.sin(_ROUND[0])),
                    np.where(on_edge[:, 1], side, -1.0),
                ],
                axis=1,
            )
            inside = np.stack([region.holds(middle + reach * step) for region in regions], axis=1)
            where = np.where(inside.any(axis=1), inside.argmax(axis=1), len(regions))
            shares[np.arange(len(where)), where] += 0.5 / len(_ROUND)
    return shares


def _lying(
    xyz: Array, there: Array, middle: Array, regions: Sequence[Region]
) -> tuple[Array, set[float]]:
    """Return which elements lie on an outline in plan, and heights at which regions end."""
    lies = np.zeros((len(middle), 2), dtype=bool)
    for region in regions:
        ends = region.has_on_its_edge(xyz.reshape(-1, 3)).reshape(there.shape)
        lies[:, 0] |= (ends | ~there).all(axis=1) & region.has_on_its_edge(middle)
    levels = {end for region in regions for end in (region.low, region.high) if np.isfinite(end)}
    return lies, levels

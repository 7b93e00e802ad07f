"""Cut a structure into pieces: which piece each element belongs to.

Pieces meet at nodes, never inside an element. An element that lies in a plane of the cut, such as
a beam or a column between two units, belongs to the pieces on both sides by equal shares, so that
equal units stay equal.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import combinations

import numpy as np
from jaxtyping import Float, Int

from trundle._checks import frozen_array, set_frozen
from trundle._typing import Array
from trundle.errors import InputError
from trundle.structure.elements.protocol import GROUND, Elements
from trundle.structure.superelements.regions import Region, middles_of, shares_by_region

__all__ = ["Cuts", "Share", "shares_in_halves", "shares_of"]

_ON_PLANE = 1e-3  # m, within which an element lies in a plane of the cut


@dataclass(frozen=True, kw_only=True, eq=False)
class Cuts:
    """Hold the planes by which a structure is cut, across x, y and z [m], and parts that are given.

    Attributes
    ----------
    x, y, z : ndarray of float
        Where they lie, rising; none, unless given.
    regions : tuple of Region
        Parts that are given by their outlines: no plane cuts them.

    Raises
    ------
    InputError
        Planes that do not rise, or parts that overlap.
    """

    x: Float[Array, " across_x"] = field(default_factory=lambda: np.zeros(0))
    y: Float[Array, " across_y"] = field(default_factory=lambda: np.zeros(0))
    z: Float[Array, " across_z"] = field(default_factory=lambda: np.zeros(0))
    regions: tuple[Region, ...] = ()

    def __post_init__(self) -> None:
        """Check that planes rise and parts lie beside each other."""
        for name in "xyz":
            values = frozen_array(name, getattr(self, name), shape=(None,))
            if np.any(np.diff(values) <= 0.0):
                raise InputError(f"cuts across {name} must rise; got {values.tolist()}")
            set_frozen(self, **{name: values})
        for one, other in combinations(self.regions, 2):
            if one.overlaps(other):
                raise InputError(f"parts {one.name!r} and {other.name!r} overlap")

    def __len__(self) -> int:
        """Return how many there are."""
        return len(self.x) + len(self.y) + len(self.z) + len(self.regions)


@dataclass(frozen=True, kw_only=True, eq=False)
class Share:
    """Hold which elements of one group belong to which piece, and by how much.

    Attributes
    ----------
    element, piece : ndarray of int, shape (n_shares,)
        Numbers of both; an element that two pieces share stands twice.
    weight : ndarray of float, shape (n_shares,)
        The share; those of an element sum to 1.
    """

    element: Int[Array, " shares"]
    piece: Int[Array, " shares"]
    weight: Float[Array, " shares"]


def shares_of(
    groups: Sequence[Elements], nodes: Float[Array, "nodes 3"], cuts: Cuts
) -> tuple[Share, ...]:
    """Return the shares of every group's elements in the pieces between planes, and in given ones.

    Pieces are numbered from 0 without gaps, z changing fastest, given ones last. Planes outside are
    passed over. An element in a plane belongs to no piece in which nothing carries it, if another
    one does.

    Raises
    ------
    InputError
        A given part in which no element lies.
    """
    ends = nodes.min(axis=0) + _ON_PLANE, nodes.max(axis=0) - _ON_PLANE
    planes = [
        at[(at > low) & (at < high)]
        for at, low, high in zip((cuts.x, cuts.y, cuts.z), *ends, strict=True)
    ]
    found = [_in_cells(nodes, group.connectivity, planes) for group in groups]
    if cuts.regions:
        first = int(np.prod([len(at) + 1 for at in planes]))
        ends_of = [group.connectivity for group in groups]
        found = _with_regions(found, nodes, ends_of, cuts.regions, first)
    found = _carried(found, [group.connectivity for group in groups], len(nodes))
    used = np.unique(np.concatenate([share.piece for share in found]))
    return tuple(
        Share(
            element=share.element,
            piece=np.searchsorted(used, share.piece),
            weight=share.weight,
        )
        for share in found
    )


def _in_cells(nodes: Array, connectivity: Array, planes: Sequence[Array]) -> Share:
    """Return the shares of some elements in cells numbered with gaps."""
    element = np.arange(len(connectivity))
    cell = np.zeros(len(connectivity), dtype=np.intp)
    weight = np.ones(len(connectivity))
    there = (connectivity != GROUND)[..., None]
    xyz = nodes[connectivity]
    low = np.where(there, xyz, np.inf).min(axis=1)
    high = np.where(there, xyz, -np.inf).max(axis=1)
    for axis, at in enumerate(planes):
        bottom = np.searchsorted(at, 0.5 * (low + high)[element, axis] - _ON_PLANE)
        within = np.searchsorted(at, high[element, axis] - _ON_PLANE) != np.searchsorted(
            at, low[element, axis] + _ON_PLANE
        )
        flat = (high - low)[element, axis] <= 2.0 * _ON_PLANE
        shared = flat & within
        cell = cell * (len(at) + 1) + bottom
        weight = np.where(shared, 0.5 * weight, weight)
        # the other half lies on the far side of the plane
        element = np.concatenate([element, element[shared]])
        weight = np.concatenate([weight, weight[shared]])
        cell = np.concatenate([cell, cell[shared] + 1])
    return Share(element=element, piece=cell, weight=weight)


def _with_regions(
    shares: list[Share],
    nodes: Array,
    ends: Sequence[Array],
    regions: Sequence[Region],
    first: int,
) -> list[Share]:
    """Return shares with those of given parts in front of what lies between planes."""
    by_region = [shares_by_region(nodes, some, regions) for some in ends]
    held = np.sum([some[:, :-1].sum(axis=0) for some in by_region], axis=0)
    if np.any(held == 0.0):
        name = regions[int(np.argmin(held))].name
        raise InputError(f"in part {name!r} nothing of the structure lies")
    found = []
    for share, some in zip(shares, by_region, strict=True):
        left = share.weight * some[share.element, -1]
        kept = left > 0.0
        element, region = np.nonzero(some[:, :-1])
        found.append(
            Share(
                element=np.concatenate([share.element[kept], element]),
                piece=np.concatenate([share.piece[kept], first + region]),
                weight=np.concatenate([left[kept], some[element, region]]),
            )
        )
    return found


def _carried(shares: list[Share], ends: Sequence[Array], n_nodes: int) -> list[Share]:
    """Return shares without those of elements that would float in a piece.

    A beam where two planes cross has four pieces round it, and may hang on two of them alone, as
    that of a ramp halfway between storeys does.
    """
    parts = [np.flatnonzero(share.weight < 1.0) for share in shares]
    number, piece, node = map(np.concatenate, zip(*_places(shares, ends, parts), strict=True))
    known, node = np.unique(node, return_inverse=True)
    column = np.full(n_nodes, -1)
    column[known] = np.arange(len(known))
    n_pieces = 1 + max(int(share.piece.max(initial=0)) for share in shares)
    touched = np.zeros((n_pieces, len(known)), dtype=bool)
    whole = [np.flatnonzero(share.weight == 1.0) for share in shares]
    for _, where, what in _places(shares, ends, whole):
        there = column[what] >= 0
        touched[where[there], column[what[there]]] = True
    n_parts = sum(map(len, parts))
    while True:  # what touches a carried element is carried
        before = np.count_nonzero(touched)
        hit = touched[piece, node].astype(float)
        carried = np.bincount(number, weights=hit, minlength=n_parts) > 0.0
        on = carried[number]
        touched[piece[on], node[on]] = True
        if np.count_nonzero(touched) == before:
            break
    by_group = np.split(carried, np.cumsum([len(some) for some in parts])[:-1])
    return [
        _without_floating(share, some, yes)
        for share, some, yes in zip(shares, parts, by_group, strict=True)
    ]


def _places(
    shares: Sequence[Share], ends: Sequence[Array], chosen: Sequence[Array]
) -> Iterator[tuple[Array, Array, Array]]:
    """Give, group by group, the number of each end's share among the chosen, its piece and node."""
    first = 0
    for share, nodes, some in zip(shares, ends, chosen, strict=True):
        at = nodes[share.element[some]]
        there = at != GROUND
        number = np.repeat(first + np.arange(len(some)), there.sum(axis=1))
        piece = np.repeat(share.piece[some], there.sum(axis=1))
        yield number, piece, at[there]
        first += len(some)


def _without_floating(share: Share, parts: Array, carried: Array) -> Share:
    """Return a share with only carried parts of the elements that have any."""
    element = share.element[parts]
    n_carried = np.bincount(element[carried], minlength=int(share.element.max(initial=-1)) + 1)
    floats = parts[~carried & (n_carried[element] > 0)]
    if not len(floats):
        return share
    keep = np.ones(len(share.element), dtype=bool)
    keep[floats] = False
    left = share.element[keep]
    weight = np.where(share.weight < 1.0, 1.0 / np.bincount(left)[share.element], 1.0)
    return Share(element=left, piece=share.piece[keep], weight=weight[keep])


def shares_in_halves(
    groups: Sequence[Elements], nodes: Float[Array, "nodes 3"], *, largest: int
) -> tuple[Share, ...]:
    """Return the shares of pieces found by halving what is longest, over and over.

    Parameters
    ----------
    groups : sequence of Elements
        All elements of the structure.
    nodes : ndarray of float, shape (n_nodes, 3)
        Its nodes [m].
    largest : int
        Number of nodes that a piece may have, about.
    """
    middles = [middles_of(nodes, group.connectivity) for group in groups]
    everywhere = np.concatenate(middles)
    label = np.zeros(len(everywhere), dtype=np.intp)
    parts, next_label = [np.arange(len(everywhere))], 1
    allowed = max(1, int(largest * len(everywhere) / max(1, len(nodes))))
    while parts:
        part = parts.pop()
        if len(part) <= allowed:
            continue
        axis = int(np.argmax(np.ptp(everywhere[part], axis=0)))
        along = everywhere[part, axis]
        above = along > np.median(along)
        if not above.any():
            continue
        label[part[above]] = next_label
        next_label += 1
        parts += [part[above], part[~above]]
    ends = np.cumsum([len(one) for one in middles])[:-1]
    return tuple(
        Share(element=np.arange(len(one)), piece=one, weight=np.ones(len(one)))
        for one in np.split(label, ends)
    )

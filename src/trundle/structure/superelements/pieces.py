"""Assemble the pieces of a structure, each by itself, and find which are alike.

A piece is known by the free dofs of the structure that it moves (`Piece.dofs`) and by its own two
matrices over them. Two pieces are alike where one, moved, turned by right angles in plan or
mirrored, has the other's dofs and matrices: they are then reduced once.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int
from scipy import sparse

from trundle._typing import Array, SparseMatrix
from trundle.structure.assembly import ElementBlocks, assembled
from trundle.structure.elements.protocol import GROUND
from trundle.structure.floor import Floor
from trundle.structure.superelements.cuts import Share

__all__ = ["Alike", "Piece", "like", "pieces_of", "places_of"]

_SAME_PLACE = 1e-5  # m, between nodes of pieces that are alike
_SAME = 1e-8  # between entries of their matrices, against the roots of both diagonals
_TURNS = (
    ((1, 0), (0, 1)), ((-1, 0), (0, 1)), ((1, 0), (0, -1)), ((-1, 0), (0, -1)),
    ((0, 1), (1, 0)), ((0, -1), (1, 0)), ((0, 1), (-1, 0)), ((0, -1), (-1, 0)),
)  # fmt: skip


@dataclass(frozen=True, kw_only=True, eq=False)
class Piece:
    """Hold a piece of a structure.

    Attributes
    ----------
    dofs : ndarray of int, shape (n,)
        Free dofs of the structure that it moves, rising.
    places : ndarray of float, shape (n, 3)
        Where the node of each is [m].
    kinds : ndarray of int, shape (n,)
        Which of a node's six dofs each is.
    mass, stiffness : sparse array, shape (n, n)
        Its own [kg], [N/m].
    """

    dofs: Int[Array, " dofs"]
    places: Float[Array, "dofs 3"]
    kinds: Int[Array, " dofs"]
    mass: SparseMatrix
    stiffness: SparseMatrix


@dataclass(frozen=True, kw_only=True, eq=False)
class Alike:
    """Say how a piece is alike another.

    Attributes
    ----------
    order : ndarray of int, shape (n,)
        Its dof that stands for each of the other's.
    sign : ndarray of float, shape (n,)
        1, or -1 where the other's moves the opposite way.
    """

    order: Int[Array, " dofs"]
    sign: Float[Array, " dofs"]


def pieces_of(
    floor: Floor,
    shares: Sequence[Share],
    mass: Sequence[ElementBlocks | None],
    stiffness: Sequence[ElementBlocks | None],
    number: int,
) -> Piece:
    """Assemble one piece.

    Parameters
    ----------
    floor : Floor
        The structure.
    shares : sequence of Share
        Which elements belong to which piece, a group each.
    mass, stiffness : sequence of ElementBlocks or None
        Their matrices, a group each; None of a group that has none of a kind.
    number : int
        Which piece.
    """
    chosen = [np.flatnonzero(share.piece == number) for share in shares]
    ends = [
        group.connectivity[share.element[some]].ravel()
        for group, share, some in zip(floor.elements, shares, chosen, strict=True)
    ]
    nodes = np.unique(np.concatenate(ends))
    nodes = nodes[nodes != GROUND]
    matrices = [_sum_of(blocks, shares, chosen, nodes) for blocks in (mass, stiffness)]
    motion = _motion(floor, nodes)
    dofs = np.unique(motion.indices)
    motion = motion[:, dofs]
    where, kinds = places_of(floor)
    m, k = ((motion.T @ matrix @ motion).tocsc() for matrix in matrices)
    return Piece(dofs=dofs, places=where[dofs], kinds=kinds[dofs], mass=m, stiffness=k)


def _sum_of(
    blocks: Sequence[ElementBlocks | None],
    shares: Sequence[Share],
    chosen: Sequence[Array],
    nodes: Array,
) -> SparseMatrix:
    """Return a matrix of all dofs of some nodes, held or not."""
    some = [
        _shared(one, share, pick, nodes)
        for one, share, pick in zip(blocks, shares, chosen, strict=True)
        if one is not None and len(pick)
    ]
    return assembled(some, np.arange(6 * len(nodes)).reshape(-1, 6), 6 * len(nodes))


def _shared(one: ElementBlocks, share: Share, pick: Array, nodes: Array) -> ElementBlocks:
    """Return the matrices of some elements of a group, times their shares, on other nodes."""
    element = share.element[pick]
    kinds, which = np.unique(
        np.stack([one.which[element], share.weight[pick]]), axis=1, return_inverse=True
    )
    ends = one.connectivity[element]
    return ElementBlocks(
        connectivity=np.where(ends == GROUND, GROUND, np.searchsorted(nodes, ends)),
        distinct=one.distinct[kinds[0].astype(np.intp)] * kinds[1][:, None, None],
        which=which.ravel(),
    )


def _motion(floor: Floor, nodes: Array) -> SparseMatrix:
    """Return the motion of all dofs of some nodes by the free dofs, (6 n_nodes, n_dofs)."""
    if floor.expansion is not None:
        rows = (6 * nodes[:, None] + np.arange(6)).ravel()
        return sparse.csr_array(sparse.csr_array(floor.expansion)[rows])
    columns = floor.dof_index[nodes].ravel()
    rows = np.flatnonzero(columns >= 0)
    entries = (np.ones(len(rows)), (rows, columns[rows]))
    return sparse.csr_array(entries, shape=(len(columns), floor.n_dofs))


def places_of(floor: Floor) -> tuple[Array, Array]:
    """Return the place of each free dof's node [m], and which of its six dofs it is."""
    node, kind = np.nonzero(floor.dof_index >= 0)  # row by row: as the dofs are numbered
    return floor.nodes[node], kind


def like(piece: Piece, other: Piece, *, turned: bool = True) -> Alike | None:
    """Return how a piece is alike another; None where it is not.

    Parameters
    ----------
    piece, other : Piece
        Both.
    turned : bool
        Whether it may be turned or mirrored in plan, beside moved.
    """
    if len(piece.dofs) != len(other.dofs):
        return None
    order, places, kinds = _sorted(other.places, other.kinds)
    for turn in _TURNS if turned else _TURNS[:1]:
        turned_places, turned_kinds, sign = _turned(piece, np.array(turn))
        mine, my_places, my_kinds = _sorted(turned_places, turned_kinds)
        if not np.array_equal(my_kinds, kinds):
            continue
        if np.abs(my_places - places).max(initial=0.0) > _SAME_PLACE:
            continue
        to_other = np.empty_like(mine)
        to_other[order] = mine
        found = Alike(order=to_other, sign=sign[to_other])
        if _same(piece.stiffness, other.stiffness, found) and _same(piece.mass, other.mass, found):
            return found
    return None


def _sorted(places: Array, kinds: Array) -> tuple[Array, Array, Array]:
    """Return the order of dofs by place and kind, and both in it; places from the lowest ones."""
    from_low = places - places.min(axis=0)
    whole = np.round(from_low / (10.0 * _SAME_PLACE)).astype(np.int64)
    order = np.lexsort((kinds, whole[:, 2], whole[:, 1], whole[:, 0]))
    return order, from_low[order], kinds[order]


def _turned(piece: Piece, turn: Array) -> tuple[Array, Array, Array]:
    """Return places and kinds of dofs that are turned or mirrored in plan, and their signs."""
    places = piece.places.copy()
    places[:, :2] = piece.places[:, :2] @ turn.T
    axis = piece.kinds % 3
    swapped = turn[0, 0] == 0
    to = np.where(axis == 2, 2, 1 - axis) if swapped else axis
    along = np.array([turn[:, 0].sum(), turn[:, 1].sum(), 1])[axis]
    # rotations are axial: a mirror turns them the other way about as well
    mirror = np.where(piece.kinds >= 3, round(np.linalg.det(turn)), 1)
    sign = (along * mirror).astype(float)
    return places, to + 3 * (piece.kinds // 3), sign


def _same(mine: SparseMatrix, other: SparseMatrix, alike: Alike) -> bool:
    """Return whether matrices are the same, dof for dof."""
    size = np.sqrt(np.abs(other.diagonal()))
    diagonal = np.abs(mine.diagonal()[alike.order])
    if np.any(np.abs(np.sqrt(diagonal) - size) > _SAME * size):
        return False
    signs = sparse.diags_array(alike.sign)
    moved = signs @ mine[:, alike.order][alike.order] @ signs
    apart = abs(moved - other).tocoo()
    limit = np.maximum(size[apart.row] * size[apart.col], np.finfo(float).tiny)
    return bool(np.all(apart.data <= _SAME * limit))

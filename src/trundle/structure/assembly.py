"""Assemble the matrices of a structure from those of its elements.

Elements of one section have the same matrices wherever they have the same shape: each shape is
formed once. What couples two nodes is added up in a 6 x 6 block of its own, entry by entry, so that
no list of all elements' entries is sorted: only the pairs of nodes are.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int
from scipy import sparse

from trundle._typing import Array, SparseMatrix
from trundle.structure.elements.protocol import GROUND, Elements, Repeating

__all__ = ["ElementBlocks", "Form", "assembled", "blocks_of", "without_noughts"]

_SAME = 1e-9  # m, by which corners of elements of one shape may lie apart
_ROUND_OFF = 1e-15  # against the roots of both diagonals; a coupling that counts is far above
_MANY = 64  # elements from which on it is worth looking for equal shapes

Form = Callable[[Elements, Float[Array, "some nodes 3"]], Float[Array, "some dofs dofs"] | None]
"""What forms one kind of matrices of some elements at the places of their nodes."""


@dataclass(frozen=True, kw_only=True, eq=False)
class ElementBlocks:
    """Hold elements' matrices: each distinct one once.

    Attributes
    ----------
    connectivity : ndarray of int, shape (n_elements, n_nodes)
        Node numbers of each element, `GROUND` for rigid ground.
    distinct : ndarray of float, shape (n_distinct, 6 n_nodes, 6 n_nodes)
        The matrices.
    which : ndarray of int, shape (n_elements,)
        Which of them each element has.
    """

    connectivity: Int[Array, "elements nodes"]
    distinct: Float[Array, "distinct dofs dofs"]
    which: Int[Array, " elements"]


def blocks_of(
    groups: Iterable[Elements], nodes: Float[Array, "nodes 3"], form: Form
) -> list[ElementBlocks]:
    """Return the matrices of all groups that have some of a kind."""
    found = []
    for group in groups:
        xyz = nodes[group.connectivity]
        first, which = _shapes(group, xyz)
        matrices = form(group, xyz[first])
        if matrices is not None:
            blocks = ElementBlocks(connectivity=group.connectivity, distinct=matrices, which=which)
            found.append(blocks)
    return found


def _shapes(group: Elements, xyz: Array) -> tuple[Array, Array]:
    """Return one element of each shape, and which shape each has."""
    n = len(xyz)
    if n < _MANY or not isinstance(group, Repeating):
        return np.arange(n), np.arange(n)
    from_first = np.round((xyz - xyz[:, :1]) / _SAME).astype(np.int64).reshape(n, -1)
    rows = np.ascontiguousarray(from_first).view([("", np.int64)] * from_first.shape[1]).ravel()
    _, first, which = np.unique(rows, return_index=True, return_inverse=True)
    return first, which.ravel()


def assembled(
    blocks: Sequence[ElementBlocks],
    numbers: Int[Array, "nodes 6"],
    n_dofs: int,
) -> SparseMatrix:
    """Add up elements' matrices.

    Parameters
    ----------
    blocks : sequence of ElementBlocks
        The elements.
    numbers : ndarray of int, shape (n_nodes, 6)
        Row of each dof of each node, rising along the nodes; -1 where there is none.
    n_dofs : int
        How many rows there are.

    Returns
    -------
    sparse array, shape (n_dofs, n_dofs)
        Symmetric as the elements' are, without entries that are nought but for round-off.
    """
    n_nodes = len(numbers)
    pairs = [_pairs(one.connectivity, n_nodes) for one in blocks]
    keys = np.concatenate([*pairs, np.zeros(0, dtype=np.int64)])
    on = np.flatnonzero(keys >= 0)
    known, at = np.unique(keys[on], return_inverse=True)
    summed = _summed(blocks, on, at.ravel(), len(known))
    row, column = np.divmod(known, n_nodes)
    starts = np.searchsorted(row, np.arange(n_nodes + 1))
    shape = (6 * n_nodes, 6 * n_nodes)
    matrix = sparse.bsr_array((summed, column, starts), shape=shape).tocsr()
    free = np.flatnonzero(numbers.ravel() >= 0)
    if len(free) != n_dofs or np.any(numbers.ravel()[free] != np.arange(n_dofs)):
        raise ValueError("rows of dofs must rise along the nodes")
    if len(free) < shape[0]:
        matrix.eliminate_zeros()
        matrix = matrix[free][:, free]
    return without_noughts(matrix)


def _pairs(connectivity: Array, n_nodes: int) -> Array:
    """Return a number for each pair of nodes of each element, -1 with rigid ground."""
    row, column = connectivity[:, :, None], connectivity[:, None, :]
    pairs = row.astype(np.int64) * n_nodes + column
    return np.where((row == GROUND) | (column == GROUND), -1, pairs).ravel()


def _summed(blocks: Sequence[ElementBlocks], on: Array, at: Array, n_pairs: int) -> Array:
    """Return the 6 x 6 block of each pair of nodes, (n_pairs, 6, 6)."""
    couplings, numbers, first = [], [], 0
    for one in blocks:
        k = one.connectivity.shape[1]
        # (shape, row node, row dof, column node, column dof) -> (shape and pair, dof, dof)
        couplings.append(one.distinct.reshape(-1, k, 6, k, 6).swapaxes(2, 3).reshape(-1, 36))
        numbers.append((first + one.which[:, None] * k * k + np.arange(k * k)).ravel())
        first += len(one.distinct) * k * k
    if not numbers:
        return np.zeros((0, 6, 6))
    chosen = np.concatenate(numbers)[on]
    adds = sparse.coo_array((np.ones(len(at)), (at, chosen)), shape=(n_pairs, first)).tocsr()
    return (adds @ np.concatenate(couplings)).reshape(-1, 6, 6)


def without_noughts(matrix: SparseMatrix) -> SparseMatrix:
    """Return a symmetric matrix without entries that are nought but for round-off of their sums.

    On a level slab these are more than half of what elements store, and a factor fills with them.
    """
    size = np.sqrt(np.abs(matrix.diagonal()))
    counts = np.diff(matrix.indptr)
    along = np.repeat(np.arange(len(counts), dtype=matrix.indices.dtype), counts)
    across = matrix.indices
    keep = np.abs(matrix.data) > _ROUND_OFF * size[along] * size[across]
    keep |= along == across  # solvers look for the whole diagonal
    ends = np.concatenate([[0], np.cumsum(keep, dtype=matrix.indptr.dtype)])[matrix.indptr]
    # of a symmetric matrix rows are columns
    kept = sparse.csc_array((matrix.data[keep], across[keep], ends), shape=matrix.shape)
    kept.sort_indices()
    return kept

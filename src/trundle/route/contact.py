"""Form the contact operator H: from a structure's dofs to its height under a wheel.

One operator serves the loading of the structure (its transpose), the motion that a coupled
wheel feels, and the reading of a response at a point.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from jaxtyping import Float, Int
from scipy import sparse

from trundle._typing import Array, SparseMatrix
from trundle.structure import ContactShape, Hat, Structure, Surface

__all__ = ["ContactRows", "contact_rows", "level_rows"]

_ON_PLANE = 1e-6  # m, and sine of the angle to a mirror plane


@dataclass(frozen=True, kw_only=True, eq=False)
class ContactRows:
    """Hold rows of the contact operator, each over the few dofs of one element.

    Attributes
    ----------
    dofs : ndarray of int, shape (n_rows, width)
        Row numbers in the floor's matrices; 0 with no weight where a dof is held.
    value : ndarray of float, shape (n_rows, width)
        Weights that give the deflection, along the surface's normal [m].
    slope : ndarray of float, shape (n_rows, width)
        Weights that give its derivative along the direction of travel [m/m].
    load_share : ndarray of float, shape (n_rows,)
        Share of a wheel's force that the modelled part of the floor carries: one half for
        a wheel that drives along a mirror plane, one elsewhere.
    n_dofs : int
        Number of dofs of the floor.
    """

    dofs: Int[Array, "rows width"]
    value: Float[Array, "rows width"]
    slope: Float[Array, "rows width"]
    load_share: Float[Array, " rows"]
    n_dofs: int

    def used_dofs(self) -> Int[Array, " dofs"]:
        """Return the dofs on which any row has a weight, rising."""
        return np.unique(self.dofs[(self.value != 0.0) | (self.slope != 0.0)])

    def among(self, dofs: Int[Array, " dofs"]) -> Int[Array, "rows width"]:
        """Return where its dofs stand among some, rising; those without a weight stand anywhere."""
        return np.minimum(np.searchsorted(dofs, self.dofs), max(0, len(dofs) - 1))

    def part(self, rows: slice) -> ContactRows:
        """Return some of the rows."""
        return ContactRows(
            dofs=self.dofs[rows],
            value=self.value[rows],
            slope=self.slope[rows],
            load_share=self.load_share[rows],
            n_dofs=self.n_dofs,
        )

    def matrix(
        self, weights: Float[Array, "rows width"], dofs: Int[Array, " some"] | None = None
    ) -> sparse.csr_array:
        """Return weights as a sparse matrix by all dofs, or by some, rising: (n_rows, n_dofs)."""
        n, width = self.dofs.shape
        at, columns = (self.dofs, self.n_dofs) if dofs is None else (self.among(dofs), len(dofs))
        starts = np.arange(0, n * width + 1, width)
        entries = (weights.ravel(), at.ravel(), starts)
        # a copy: who drops or sorts entries must not change the rows
        return sparse.csr_array(entries, shape=(n, columns), copy=True)

    def scaled(
        self, share: Float[Array, " rows"], share_slope: Float[Array, " rows"]
    ) -> ContactRows:
        """Return rows for wheels that the floor carries only in part.

        The share g varies along the route, so ``d(g H)/ds = g' H + g dH/ds``.
        """
        return ContactRows(
            dofs=self.dofs,
            value=share[:, None] * self.value,
            slope=share_slope[:, None] * self.value + share[:, None] * self.slope,
            load_share=self.load_share,
            n_dofs=self.n_dofs,
        )


def contact_rows(
    floor: Structure,
    places: Float[Array, "n 2"],
    directions: Float[Array, "n 2"],
    *,
    shape: ContactShape,
    on: str | None = None,
) -> ContactRows:
    """Form one row of the contact operator, and of its slope, for each place.

    Parameters
    ----------
    floor : Structure
        The structure.
    places : ndarray of float, shape (n, 2)
        Places on the surface [m].
    directions : ndarray of float, shape (n, 2)
        Unit vectors in it along which the slope is taken.
    shape : ContactShape
        Interpolation between nodes.
    on : str, optional
        Name of the surface; the only one unless given.

    Returns
    -------
    ContactRows
        One row a place.

    Raises
    ------
    InputError
        A place off the surface.
    """
    surface = floor.surface(on)
    motion = surface.frame.motion
    moving = np.flatnonzero(motion.any(axis=0))
    turn = motion[:, moving]
    width = len(moving) * max(group.connectivity.shape[1] for group in surface.groups)
    dofs = np.full((len(places), width), -1, dtype=np.intp)
    numbers = _numbers(floor)
    value, slope = np.zeros((len(places), width)), np.zeros((len(places), width))
    for part, rows, elements, local in surface.find(places):
        weights, gradient = part.group.weights(local, part.corners[elements], shape)
        along = np.einsum("njk,nj->nk", gradient, directions[rows])
        at = numbers[part.elements[elements]][:, :, moving].reshape(len(rows), -1)
        dofs[rows, : at.shape[1]] = at
        value[rows, : at.shape[1]] = _turned(weights, turn)
        slope[rows, : at.shape[1]] = _turned(along, turn)
    if floor.expansion is not None:
        dofs, value, slope = _by_free_dofs(dofs, value, slope, floor.expansion)
    free = dofs >= 0
    return ContactRows(
        dofs=np.where(free, dofs, 0),
        value=np.where(free, value, 0.0),
        slope=np.where(free, slope, 0.0),
        load_share=_load_share(floor, surface, places, directions),
        n_dofs=floor.n_dofs,
    )


def level_rows(
    floor: Structure, places: Float[Array, "n 2"], axis: Literal["x", "y"], *, on: str | None = None
) -> SparseMatrix:
    """Form rows that read the motion along a level axis of the plan at places, (n, n_dofs).

    Between nodes it runs straight, as the motion of elements in their plane does.

    Parameters
    ----------
    floor : Structure
        The structure.
    places : ndarray of float, shape (n, 2)
        Places on the surface [m].
    axis : {"x", "y"}
        Which axis.
    on : str, optional
        Name of the surface; the only one unless given.

    Raises
    ------
    InputError
        A place off the surface.
    """
    surface, dof = floor.surface(on), "xy".index(axis)
    rows, columns, values = [], [], []
    for part, found, elements, local in surface.find(places):
        weights, _ = part.group.weights(local, part.corners[elements], Hat())
        # of deflections and two rotations a node, the first alone has a weight
        value = weights.reshape(len(found), -1, 3)[:, :, 0]
        at = _numbers(floor)[part.elements[elements]][:, :, dof]
        free = at >= 0
        rows.append(np.broadcast_to(found[:, None], at.shape)[free])
        columns.append(at[free])
        values.append(value[free])
    n = floor.n_dofs if floor.expansion is None else floor.expansion.shape[0]
    entries = (np.concatenate(values), (np.concatenate(rows), np.concatenate(columns)))
    found = sparse.coo_array(entries, shape=(len(places), n)).tocsr()
    return found if floor.expansion is None else (found @ floor.expansion).tocsr()


def _numbers(floor: Structure) -> Int[Array, "nodes 6"]:
    """Return rows of the free dofs of nodes, or of all their dofs where some follow others."""
    if floor.expansion is None:
        return floor.dof_index
    return np.arange(floor.expansion.shape[0]).reshape(-1, 6)


def _by_free_dofs(
    dofs: Array, value: Array, slope: Array, expansion: SparseMatrix
) -> tuple[Array, Array, Array]:
    """Turn weights on dofs of nodes into those on the free dofs that move them."""
    n_rows, width = dofs.shape
    starts = np.arange(0, n_rows * width + 1, width)
    shape = (n_rows, expansion.shape[0])
    at = np.maximum(dofs, 0).ravel()

    def by_free(weights: Array) -> sparse.csr_array:
        return sparse.csr_array((weights.ravel(), at, starts), shape=shape) @ expansion

    there = sparse.csr_array(((dofs >= 0).astype(float).ravel(), at, starts), shape=shape)
    used = there @ abs(expansion)
    used.sort_indices()
    pattern = sparse.csr_array((np.ones(used.nnz), used.indices, used.indptr), shape=used.shape)
    row = np.repeat(np.arange(n_rows), np.diff(pattern.indptr))
    place = np.arange(pattern.nnz) - np.repeat(pattern.indptr[:-1], np.diff(pattern.indptr))
    found = np.full((n_rows, int(np.diff(pattern.indptr).max(initial=1))), -1, dtype=np.intp)
    found[row, place] = pattern.indices
    laid = []
    for weights in (value, slope):
        out = np.zeros(found.shape)
        out[row, place] = np.asarray(by_free(weights)[row, pattern.indices]).ravel()
        laid.append(out)
    return found, laid[0], laid[1]


def _turned(weights: Array, turn: Array) -> Array:
    """Return weights on the dofs in space of nodes, given those in a surface's frame."""
    by_node = weights.reshape(len(weights), -1, 3)
    if turn.shape == (3, 3) and np.array_equal(turn, np.eye(3)):
        return weights  # a level surface with the axes of the plan
    return (by_node @ turn).reshape(len(weights), -1)


def _load_share(floor: Structure, surface: Surface, places: Array, directions: Array) -> Array:
    share = np.ones(len(places))
    for mirror in floor.mirrors:
        away = mirror.away(surface.frame.in_space(places))
        # A wheel that only crosses the plane is on it for no time at all.
        towards = directions @ np.array([surface.frame.x_axis, surface.frame.y_axis])
        along = np.abs(towards[:, :2] @ mirror.normal) < _ON_PLANE
        share[(np.abs(away) < _ON_PLANE) & along] *= 0.5
    return share

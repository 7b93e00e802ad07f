"""Reduce a part of a structure to its own modes and to how it follows its boundary.

A part that is held at its boundary has modes of its own, Phi; moved slowly there, it follows by its
static shapes Psi. Motion of the part is written by both (Craig and Bampton),

    u_interior = Phi q + Psi u_boundary,

which is exact as the number of modes grows, and statically exact with none. With modes of unit
modal mass the reduced matrices are

    K = [ omega^2   0  ]      M = [   1       P   ]
        [    0     K_b ]          [  P^T     M_b  ]

so that modes are coupled to the boundary by mass alone, and not to each other at all: a shift of
the whole structure eliminates them by a division each (`structure.superelements`).

References
----------
R. R. Craig and M. C. C. Bampton, AIAA J. 6 (1968) 1313-1319.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from jaxtyping import Float, Int
from scipy import sparse

from trundle._progress import Progress
from trundle._typing import Array, SparseMatrix
from trundle.dynamics.eigen import natural_modes
from trundle.dynamics.sparse_solver import Factor, factorise

__all__ = ["RestingPart", "Superelement", "reduce_part"]

_AT_ONCE = 96  # static shapes that are solved for together
_MODES_SHARE, _STATIC_SHARE = 0.6, 0.2  # of the work, for progress


@dataclass(frozen=True, kw_only=True, eq=False)
class Superelement:
    """Hold a part of a structure, reduced to its boundary and its own modes.

    How the inside follows the boundary at rest is not held: it would take more memory than all
    else, and few rows of it are ever asked for (`RestingPart`).

    Attributes
    ----------
    boundary, interior : ndarray of int, shapes (n_boundary,), (n_interior,)
        Rows of the part's matrices, rising.
    omega : ndarray of float, shape (n_modes,)
        Natural circular frequencies of the part held at its boundary, rising [rad/s].
    shapes : ndarray of float, shape (n_interior, n_modes)
        Its modes there, of unit modal mass [1/sqrt(kg)].
    coupling : ndarray of float, shape (n_modes, n_boundary)
        P: what modes and static shapes share of the mass [sqrt(kg)].
    stiffness, mass : ndarray of float, shape (n_boundary, n_boundary)
        K_b [N/m] and M_b [kg].
    f_max : float
        All modes below are kept [Hz].
    """

    boundary: Int[Array, " boundary"]
    interior: Int[Array, " interior"]
    omega: Float[Array, " modes"]
    shapes: Float[Array, "interior modes"]
    coupling: Float[Array, "modes boundary"]
    stiffness: Float[Array, "boundary boundary"]
    mass: Float[Array, "boundary boundary"]
    f_max: float

    @property
    def n_dofs(self) -> int:
        """Number of dofs of the part before its reduction."""
        return len(self.boundary) + len(self.interior)

    def below(self, f: float) -> Superelement:
        """Return the same with its own modes below a frequency alone [Hz]."""
        n = int(np.searchsorted(self.omega, 2.0 * np.pi * f))
        return replace(
            self,
            omega=self.omega[:n],
            shapes=self.shapes[:, :n],
            coupling=self.coupling[:n],
            f_max=min(f, self.f_max),
        )


@dataclass(frozen=True, kw_only=True, eq=False)
class RestingPart:
    """Answer how the inside of a part rests: under loads, and where its boundary is moved.

    Attributes
    ----------
    reduced : Superelement
        The part.
    stiffness : sparse array, shape (n_dofs, n_dofs)
        That of the part alone [N/m].
    """

    reduced: Superelement
    stiffness: SparseMatrix

    @cached_property
    def _halves(self) -> tuple[Factor, SparseMatrix]:
        """The inside's factor, and what holds it to the boundary."""
        inside, across, _ = _split(self.stiffness, self.reduced.interior, self.reduced.boundary)
        return factorise(inside), across

    def under(self, load: Float[Array, "interior loads"]) -> Float[Array, "interior loads"]:
        """Return how the inside deflects under loads, its boundary held."""
        return self._halves[0].solve(load)

    def following(
        self, moved: Float[Array, "boundary columns"]
    ) -> Float[Array, "interior columns"]:
        """Return how the inside follows a motion of the boundary."""
        factor, across = self._halves
        out = np.empty((len(self.reduced.interior), moved.shape[1]))
        for start in range(0, moved.shape[1], _AT_ONCE):
            part = slice(start, start + _AT_ONCE)
            out[:, part] = factor.solve(-(across @ moved[:, part]))
        return out

    def at_boundary(self, load: Float[Array, "interior loads"]) -> Float[Array, "boundary loads"]:
        """Return what the boundary bears of loads on the inside while it is held."""
        factor, across = self._halves
        return np.asarray(-(across.T @ factor.solve(load)))

    def expanded(
        self, q: Float[Array, "modes columns"], moved: Float[Array, "boundary columns"]
    ) -> Float[Array, "dofs columns"]:
        """Return the motion of all dofs of the part."""
        part = self.reduced
        out = np.empty((part.n_dofs, q.shape[1]))
        out[part.boundary] = moved
        out[part.interior] = part.shapes @ q + self.following(moved)
        return out

    def seen(
        self, reader: SparseMatrix
    ) -> tuple[Float[Array, "rows modes"], Float[Array, "rows boundary"]]:
        """Return modes and static shapes as rows of weights (n_rows, n_dofs) see them."""
        part = self.reduced
        inner, outer = reader[:, part.interior], reader[:, part.boundary]
        followed = np.asarray(outer.toarray(), dtype=float)
        if inner.nnz:
            for start in range(0, len(followed), _AT_ONCE):
                rows = slice(start, start + _AT_ONCE)
                followed[rows] += self.at_boundary(np.asfortranarray(inner[rows].toarray().T)).T
        return np.asarray(inner @ part.shapes), followed


def reduce_part(
    mass: SparseMatrix,
    stiffness: SparseMatrix,
    boundary: Int[Array, " boundary"],
    *,
    f_max: float,
    progress: Progress | None = None,
) -> Superelement:
    """Reduce a part of a structure to its boundary.

    Parameters
    ----------
    mass, stiffness : sparse array, shape (n_dofs, n_dofs)
        Of the part alone, free at its boundary [kg], [N/m].
    boundary : ndarray of int, shape (n_boundary,)
        Rows by which it meets others, rising. Held there, it must be at rest.
    f_max : float
        Its own modes below this frequency are kept [Hz].
    progress : callable, optional
        Told about how much of the work is done, 0 to 1.

    Raises
    ------
    UnrestrainedModeError
        Held at its boundary the part can still move without strain.
    """
    tell = progress or _nobody
    inside = np.ones(mass.shape[0], dtype=bool)
    inside[boundary] = False
    interior = np.flatnonzero(inside)
    m_ii, m_ib, m_bb = _split(mass, interior, boundary)
    k_ii, k_ib, k_bb = _split(stiffness, interior, boundary)
    modes = natural_modes(
        m_ii, k_ii, f_max=f_max, progress=lambda share: tell(_MODES_SHARE * share)
    )
    static = _static(factorise(k_ii), k_ib, lambda s: tell(_MODES_SHARE + s * _STATIC_SHARE))
    coupling, coupled = _shared(m_ii, m_ib, static, modes.shapes)
    return Superelement(
        boundary=boundary,
        interior=interior,
        omega=modes.omega,
        shapes=modes.shapes,
        coupling=coupling,
        stiffness=_symmetric(k_bb.toarray() + np.asarray(k_ib.T @ static)),
        mass=_symmetric(m_bb.toarray() + np.asarray(m_ib.T @ static) + coupled),
        f_max=f_max,
    )


def _shared(
    m_ii: SparseMatrix, m_ib: SparseMatrix, static: Array, shapes: Array
) -> tuple[Array, Array]:
    """Return ``Phi^T (M_ii Psi + M_ib)`` and ``Psi^T (M_ii Psi + M_ib)``.

    The second but for ``Psi^T M_ib`` is symmetric: of that only a triangle is formed.
    """
    n = static.shape[1]
    coupling, moved = np.empty((shapes.shape[1], n)), np.zeros((n, n))
    for start in range(0, n, _AT_ONCE):
        part = slice(start, min(start + _AT_ONCE, n))
        carried = np.asarray(m_ii @ static[:, part])
        coupling[:, part] = shapes.T @ (carried + m_ib[:, part].toarray())
        moved[: part.stop, part] = static[:, : part.stop].T @ carried
    whole = np.triu(moved) + np.triu(moved, 1).T
    return coupling, whole + np.asarray(m_ib.T @ static).T


def _split(
    matrix: SparseMatrix, interior: Array, boundary: Array
) -> tuple[SparseMatrix, SparseMatrix, SparseMatrix]:
    """Return the parts of a matrix: inside, between inside and boundary, and at the boundary."""
    by_column = sparse.csc_array(matrix)
    inner, outer = by_column[:, interior], by_column[:, boundary]
    return inner[interior].tocsc(), outer[interior].tocsc(), outer[boundary].tocsc()


def _static(factor: Factor, coupling: SparseMatrix, tell: Progress) -> Array:
    """Return ``-K_ii^-1 K_ib``."""
    out = np.empty(coupling.shape)
    for start in range(0, out.shape[1], _AT_ONCE):
        part = slice(start, start + _AT_ONCE)
        out[:, part] = factor.solve(-coupling[:, part].toarray())
        tell(start / out.shape[1])
    return out


def _nobody(share: float) -> None:
    """Tell nobody."""
    del share


def _symmetric(matrix: Array) -> Array:
    return 0.5 * (matrix + matrix.T)

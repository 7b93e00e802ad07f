"""Hold the reduced matrices of a whole structure by their pieces, and factorise them at shifts.

Coordinates are the own modes of every piece, piece by piece, then those of all seams. A piece's
modes meet the seams of that piece alone, and by mass alone (`dynamics.superelement`). At a shift
``s = omega^2`` they are eliminated by a division each,

    S(s) = K_seams - s M_seams - sum over pieces of  P^T diag(s^2 / (omega_i^2 - s)) P,

and only S, one dense block a piece, is factorised as a sparse matrix. Its negative eigenvalues and
the modes of pieces below s are together those of the structure below s (Sylvester, Haynsworth).
Equal pieces share P and what it gives.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Float, Int
from scipy import sparse

from trundle._typing import Array, SparseMatrix
from trundle.dynamics import Factor, HalfSolve, Solver, factorise, factorise_damped
from trundle.errors import UnrestrainedModeError

__all__ = ["PieceCoordinates", "ReducedPencil", "ReducedPiece"]


@dataclass(frozen=True, kw_only=True, eq=False)
class ReducedPiece:
    """Hold the matrices of pieces that are equal, with equal seams.

    Attributes
    ----------
    omega : ndarray of float, shape (n_modes,)
        Circular frequencies of its own modes [rad/s].
    coupling : ndarray of float, shape (n_modes, n_seams)
        P.
    stiffness, mass : ndarray of float, shape (n_seams, n_seams)
        By the coordinates of its seams.
    """

    omega: Float[Array, " modes"]
    coupling: Float[Array, "modes seams"]
    stiffness: Float[Array, "seams seams"]
    mass: Float[Array, "seams seams"]


@dataclass(frozen=True, kw_only=True, eq=False)
class PieceCoordinates:
    """Say which coordinates of the structure are a piece's.

    Attributes
    ----------
    kind : int
        Which of the distinct pieces it is.
    first : int
        Coordinate of its first own mode.
    seams : ndarray of int, shape (n_seams,)
        Coordinates of its seams, counted from the first of all seams.
    """

    kind: int
    first: int
    seams: Int[Array, " seams"]


@dataclass(frozen=True, kw_only=True, eq=False)
class _Group:
    """Pieces of one kind, whose products are formed at once.

    `own` (n_pieces, n_modes) and `seams` (n_pieces, n_seams) say which coordinates are theirs.
    """

    kind: int
    own: Int[Array, "pieces modes"]
    seams: Int[Array, "pieces seams"]


@dataclass(frozen=True, kw_only=True, eq=False)
class _Product:
    """A reduced matrix that can be multiplied with, ``diag`` of modes and all that is at seams."""

    pencil: ReducedPencil
    of_mass: bool

    @property
    def shape(self) -> tuple[int, int]:
        """Number of rows and of columns."""
        return self.pencil.n_coordinates, self.pencil.n_coordinates

    def __matmul__(self, block: Array) -> Array:
        """Return the product with a vector or a block of them."""
        pencil = self.pencil
        n, rows = pencil.n_modes, _rows(block)
        out = np.zeros_like(rows)
        out[:, :n] = rows[:, :n] if self.of_mass else rows[:, :n] * pencil.omega**2
        for group in pencil.groups:
            # dense, all equal pieces at once: many times as fast as one sparse matrix of all seams
            kind = pencil.kinds[group.kind]
            moved = _taken(rows, n + group.seams)
            if not self.of_mass:
                _add(out, n + group.seams, _times(moved, kind.stiffness))
                continue
            own = _times(_taken(rows, group.own), kind.coupling)
            _add(out, group.own, _times(moved, kind.coupling.T))
            _add(out, n + group.seams, _times(moved, kind.mass) + own)
        return out.T.reshape(block.shape)


@dataclass(frozen=True, kw_only=True, eq=False)
class ReducedPencil:
    """Hold stiffness and mass of a whole structure by its reduced pieces.

    Attributes
    ----------
    kinds : tuple of ReducedPiece
        The distinct ones.
    pieces : tuple of PieceCoordinates
        All pieces.
    n_seams : int
        Number of coordinates of all seams.
    """

    kinds: tuple[ReducedPiece, ...]
    pieces: tuple[PieceCoordinates, ...]
    n_seams: int

    @cached_property
    def n_modes(self) -> int:
        """Number of own modes of all pieces."""
        return sum(len(self.kinds[one.kind].omega) for one in self.pieces)

    def n_own(self, number: int) -> int:
        """Return how many own modes of a piece are kept."""
        return len(self.kinds[self.pieces[number].kind].omega)

    @property
    def n_coordinates(self) -> int:
        """Number of all coordinates."""
        return self.n_modes + self.n_seams

    @cached_property
    def omega(self) -> Float[Array, " modes"]:
        """Circular frequencies of all pieces' own modes, piece by piece [rad/s]."""
        return np.concatenate([self.kinds[one.kind].omega for one in self.pieces])

    @cached_property
    def groups(self) -> tuple[_Group, ...]:
        """The pieces, those of one kind together."""
        found = []
        for kind, reduced in enumerate(self.kinds):
            mine = [one for one in self.pieces if one.kind == kind]
            first = np.array([one.first for one in mine], dtype=np.intp)
            own = first[:, None] + np.arange(len(reduced.omega))
            found.append(_Group(kind=kind, own=own, seams=np.array([one.seams for one in mine])))
        return tuple(found)

    @property
    def mass(self) -> _Product:
        """What multiplies with the reduced mass."""
        return _Product(pencil=self, of_mass=True)

    @property
    def stiffness(self) -> _Product:
        """What multiplies with the reduced stiffness."""
        return _Product(pencil=self, of_mass=False)

    @cached_property
    def _pattern(self) -> SparseMatrix:
        """Where seams couple: a number for each stored entry."""
        couples = [
            sparse.coo_array(
                (
                    np.ones(len(one.seams) ** 2, dtype=np.int8),
                    (
                        np.repeat(one.seams, len(one.seams)),
                        np.tile(one.seams, len(one.seams)),
                    ),
                ),
                shape=(self.n_seams, self.n_seams),
            ).tocsc()
            for one in self.pieces
        ]
        pattern = couples[0]
        for other in couples[1:]:
            pattern = pattern + other
        pattern = sparse.csc_array(pattern)
        pattern.sort_indices()
        numbers = np.arange(pattern.nnz, dtype=np.int32)
        return sparse.csc_array((numbers, pattern.indices, pattern.indptr), shape=pattern.shape)

    @cached_property
    def _places(self) -> tuple[Int[Array, "seams seams"], ...]:
        """Where the entries of each piece's dense block are stored."""
        pattern = self._pattern
        shown = sparse.csc_array((pattern.data + 1, pattern.indices, pattern.indptr), pattern.shape)
        return tuple(shown[:, one.seams][one.seams].toarray() - 1 for one in self.pieces)

    def _at_seams(self, blocks: Sequence[Array]) -> SparseMatrix:
        """Add up a dense block a distinct piece over all pieces."""
        pattern = self._pattern
        data = np.zeros(pattern.nnz, dtype=blocks[0].dtype)
        for one, places in zip(self.pieces, self._places, strict=True):
            data[places] += blocks[one.kind]
        return sparse.csc_array((data, pattern.indices, pattern.indptr), shape=pattern.shape)

    @cached_property
    def seam_stiffness(self) -> SparseMatrix:
        """Stiffness between seams."""
        return self._at_seams([kind.stiffness for kind in self.kinds])

    def factorise(self, shift: float) -> Factor:
        """Factorise ``K - shift M``.

        Raises
        ------
        UnrestrainedModeError
            The shift is a natural frequency of the structure, or of one of its pieces.
        """
        below = self.omega**2 - shift
        if np.any(np.abs(below) <= _CLOSE * np.maximum(self.omega**2, abs(shift))):
            raise UnrestrainedModeError("the shift is a natural frequency of a piece")
        blocks = []
        for kind in self.kinds:
            weight = shift**2 / (kind.omega**2 - shift)
            full = kind.stiffness - shift * kind.mass
            full -= kind.coupling.T @ (weight[:, None] * kind.coupling)
            blocks.append(full)
        seams = factorise(self._at_seams(blocks))
        return _ShiftedFactor(pencil=self, shift=shift, seams=seams)

    def factorise_damped(self, shift: complex) -> Solver:
        """Factorise ``K - shift M`` at a shift off the real axis."""
        blocks = []
        for kind in self.kinds:
            share = shift**2 / (kind.omega**2 - shift)
            # real products, half the work of complex ones
            there = kind.coupling.T @ (share.real[:, None] * kind.coupling)
            across = kind.coupling.T @ (share.imag[:, None] * kind.coupling)
            blocks.append(kind.stiffness - shift * kind.mass - (there + 1j * across))
        seams = factorise_damped(self._at_seams(blocks))
        return _Shifted(pencil=self, shift=shift, seams=seams)


@dataclass(frozen=True, kw_only=True, eq=False)
class _Shifted:
    """A factorised ``K - shift M``, of any shift."""

    pencil: ReducedPencil
    shift: complex
    seams: Solver

    def solve(self, right_hand_side: Array) -> Array:
        """Return ``(K - shift M)^-1 b``."""
        pencil, n = self.pencil, self.pencil.n_modes
        gap = pencil.omega**2 - self.shift
        rows = _rows(right_hand_side)
        out = rows.astype(gap.dtype)
        out[:, :n] /= gap
        for group in pencil.groups:
            coupling = pencil.kinds[group.kind].coupling
            moved = _times(_taken(out, group.own), coupling)
            _add(out, n + group.seams, self.shift * moved)
        out[:, n:] = self.seams.solve(out[:, n:].T).T
        for group in pencil.groups:
            coupling = pencil.kinds[group.kind].coupling
            moved = _times(_taken(out, n + group.seams), coupling.T)
            _add(out, group.own, self.shift * moved / np.tile(gap[group.own], (len(rows), 1)))
        return out.T.reshape(right_hand_side.shape)


@dataclass(frozen=True, kw_only=True, eq=False)
class _ShiftedFactor(_Shifted):
    """A factorised ``K - shift M`` at a real shift, which counts what lies below."""

    shift: float
    seams: Factor

    @property
    def n_negative(self) -> int:
        """Number of eigenvalues below the shift."""
        own = np.count_nonzero(self.pencil.omega**2 < self.shift)
        return int(own) + self.seams.n_negative

    def halves(self) -> tuple[HalfSolve, HalfSolve] | None:
        """Return nothing: there is no factor of the whole."""
        return None


def _rows(block: Array) -> Array:
    """Return a vector, or the columns of a block, as rows: so those of a piece lie together."""
    return np.ascontiguousarray(np.atleast_2d(block.T))


def _taken(rows: Array, which: Int[Array, "pieces some"]) -> Array:
    """Return some coordinates of each row, piece by piece: (n_rows * n_pieces, n_some)."""
    shape = (len(rows) * len(which), which.shape[1])
    return rows.take(which.ravel(), axis=1).reshape(shape)


def _add(rows: Array, which: Int[Array, "pieces some"], more: Array) -> None:
    """Add to some coordinates of each row, piece by piece, for pieces share seams."""
    by_piece = more.reshape(len(rows), *which.shape)
    for number, mine in enumerate(which):
        rows[:, mine] += by_piece[:, number]


def _times(rows: Array, matrix: Array) -> Array:
    """Return rows, real or complex, times a real matrix, by a real product."""
    if np.isrealobj(rows):
        return rows @ matrix
    found = np.concatenate([np.real(rows), np.imag(rows)]) @ matrix
    return found[: len(rows)] + 1j * found[len(rows) :]


_CLOSE = 1e-9  # relative distance of a shift from a piece's own eigenvalue that is too near

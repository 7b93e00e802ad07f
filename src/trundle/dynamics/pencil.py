"""Say what a search for natural modes asks of a pair of matrices."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol, TypeAlias, runtime_checkable

import numpy as np
from scipy import sparse

from trundle._typing import Array, Matrix, SparseMatrix
from trundle.dynamics.sparse_solver import Factor, Solver, factorise, factorise_damped
from trundle.errors import ConvergenceError, UnrestrainedModeError

__all__ = [
    "DampedPencil",
    "Multiplies",
    "Pencil",
    "Product",
    "Shift",
    "SparsePencil",
    "shift_near",
]

_NUDGES = 6  # shifts tried beside each other if one meets an eigenvalue


@runtime_checkable
class Multiplies(Protocol):
    """A symmetric matrix that can be multiplied with, however it is stored."""

    @property
    def shape(self) -> tuple[int, ...]:
        """Number of rows and of columns."""
        ...

    def __matmul__(self, block: Array) -> Array:
        """Return the product with a vector or a block of them."""
        ...


Product: TypeAlias = Matrix | Multiplies
"""A symmetric matrix, or what multiplies as one."""


@runtime_checkable
class Pencil(Protocol):
    """Stiffness and mass of a structure, which can be factorised at any shift."""

    @property
    def mass(self) -> Product:
        """The mass M."""
        ...

    @property
    def stiffness(self) -> Product:
        """The stiffness K."""
        ...

    def factorise(self, shift: float) -> Factor:
        """Factorise ``K - shift M``; refused where the shift is an eigenvalue."""
        ...


@runtime_checkable
class DampedPencil(Pencil, Protocol):
    """Stiffness and mass that can be factorised off the real axis too."""

    def factorise_damped(self, shift: complex) -> Solver:
        """Factorise ``K - shift M`` at a shift off the real axis."""
        ...


@dataclass(frozen=True, kw_only=True, eq=False)
class SparsePencil:
    """Hold two sparse matrices.

    Attributes
    ----------
    mass, stiffness : sparse array, shape (n_dofs, n_dofs)
        Symmetric M [kg] and K [N/m].
    backend : str, optional
        Sparse solver.
    """

    mass: SparseMatrix
    stiffness: SparseMatrix
    backend: str | None = None

    def factorise(self, shift: float) -> Factor:
        """Factorise ``K - shift M``."""
        matrix = sparse.csc_array(self.stiffness - shift * self.mass)
        return factorise(matrix, backend=self.backend)

    def factorise_damped(self, shift: complex) -> Solver:
        """Factorise ``K - shift M`` at a shift off the real axis."""
        matrix = sparse.csc_array(self.stiffness - shift * self.mass)
        return factorise_damped(matrix, backend=self.backend)


@dataclass(frozen=True, kw_only=True, eq=False)
class Shift:
    """A shift, its factorisation, and how many eigenvalues lie below it."""

    value: float
    factor: Factor

    @property
    def below(self) -> int:
        """How many eigenvalues lie below it, by inertia."""
        return self.factor.n_negative


def shift_near(pencil: Pencil, omega: float) -> Shift:
    """Factorise at a circular frequency [rad/s], or just beside it if it is a natural one.

    Raises
    ------
    ConvergenceError
        It cannot be factorised beside it either.
    """
    for nudge in range(_NUDGES):
        value = float((omega * (1.0 + 1e-6 * nudge)) ** 2)
        try:
            return Shift(value=value, factor=pencil.factorise(value))
        except UnrestrainedModeError:
            continue
    raise ConvergenceError(
        f"K - omega^2 M cannot be factorised at {omega / (2.0 * np.pi):.6g} Hz",
        residual=float("nan"),
    )

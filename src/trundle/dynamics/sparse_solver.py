"""Factorise a sparse symmetric matrix once and solve with it many times.

PARDISO is used when the ``fast`` extra is installed, SuperLU in symmetric mode otherwise.
The COLAMD ordering that scipy would choose by itself is about four times slower on a floor.
"""

from __future__ import annotations

import importlib
import importlib.util
import os
import weakref
from collections.abc import Callable
from functools import cache, partial
from typing import Any, Protocol, TypeAlias, runtime_checkable

import numpy as np
from scipy import sparse
from scipy.sparse import linalg as sparse_linalg

from trundle._typing import Array, SparseMatrix
from trundle.errors import InputError, UnrestrainedModeError

__all__ = [
    "BACKENDS",
    "Factor",
    "HalfSolve",
    "Solver",
    "available_backends",
    "factorise",
    "factorise_damped",
]

HalfSolve: TypeAlias = Callable[[Array], Array]
"""One half of a solution with a triangular factor, in the solver's own order of rows."""

BACKENDS = ("pardiso", "superlu")
"""Names of the sparse solvers, in the order of preference."""


@runtime_checkable
class Solver(Protocol):
    """What a factorised matrix A can do."""

    def solve(self, right_hand_side: Array) -> Array:
        """Return ``A^-1 b`` for b of shape (n,) or (n, k)."""
        ...


@runtime_checkable
class Factor(Solver, Protocol):
    """What a factorised real symmetric matrix A can do."""

    @property
    def n_negative(self) -> int:
        """Number of negative eigenvalues of A (Sylvester's law of inertia)."""
        ...

    def halves(self) -> tuple[HalfSolve, HalfSolve] | None:
        """Return ``L^-1 b`` and ``L^-T y`` of ``A = L L^T``, where the solver offers them."""
        ...


@cache
def available_backends() -> tuple[str, ...]:
    """Return the solvers that work in this environment, best first."""
    if importlib.util.find_spec("pypardiso") is None:
        return ("superlu",)
    try:
        importlib.import_module("pypardiso")
    except (ImportError, OSError):
        return ("superlu",)
    return BACKENDS


def factorise(matrix: SparseMatrix, *, backend: str | None = None) -> Factor:
    """Factorise a sparse symmetric matrix, definite or not.

    Parameters
    ----------
    matrix : sparse array, shape (n, n)
        Symmetric matrix; both triangles stored.
    backend : {"pardiso", "superlu"}, optional
        Solver; the best one available unless named.

    Returns
    -------
    Factor
        Something that solves, and knows its count of negative eigenvalues.

    Raises
    ------
    InputError
        Unknown or missing backend.
    UnrestrainedModeError
        The matrix is singular: the structure is a mechanism.
    """
    if _known(backend) == "pardiso":
        return _PardisoFactor(matrix)
    return _SuperLUFactor(matrix)


def factorise_damped(matrix: SparseMatrix, *, backend: str | None = None) -> Solver:
    """Factorise a complex symmetric matrix, such as ``K - z M`` of a damped structure.

    Parameters
    ----------
    matrix : sparse array of complex, shape (n, n)
        Equal to its transpose, not to its conjugate; both triangles stored.
    backend : {"pardiso", "superlu"}, optional
        Solver; the best one available unless named.

    Raises
    ------
    InputError
        Unknown or missing backend.
    UnrestrainedModeError
        The matrix is singular.
    """
    if _known(backend) == "pardiso":
        return _PardisoFactor(matrix)
    return _SuperLUFactor(matrix)


def _known(backend: str | None) -> str:
    """Return the backend asked for, the best one available unless named."""
    name = backend or available_backends()[0]
    if name not in available_backends():
        known = ", ".join(available_backends())
        raise InputError(f"sparse backend must be one of {known}; got {name!r}")
    return name


class _SuperLUFactor:
    """Symmetric-mode SuperLU with minimum degree on A + A^T and pivots on the diagonal."""

    def __init__(self, matrix: SparseMatrix) -> None:
        options: dict[str, Any] = {"SymmetricMode": True}
        try:
            self._lu = sparse_linalg.splu(
                sparse.csc_matrix(matrix),
                permc_spec="MMD_AT_PLUS_A",
                diag_pivot_thresh=0.0,
                options=options,
            )
        except RuntimeError as error:
            raise UnrestrainedModeError(_SINGULAR) from error
        pivots = self._lu.U.diagonal()
        if not _well_conditioned(pivots):
            raise UnrestrainedModeError(_SINGULAR)
        self._dtype = pivots.dtype
        self._refined: SparseMatrix | None = None
        self.n_negative = 0
        if np.iscomplexobj(pivots):
            return  # damping keeps pivots from growing
        self.n_negative = int(np.count_nonzero(pivots < 0.0))
        if self.n_negative and self._error(matrix) > _PRECISE:
            self._refined = matrix

    def halves(self) -> tuple[HalfSolve, HalfSolve] | None:
        return None

    def solve(self, right_hand_side: Array) -> Array:
        b = np.ascontiguousarray(right_hand_side, dtype=self._dtype)
        x = self._lu.solve(b)
        return x if self._refined is None else x + self._lu.solve(b - self._refined @ x)

    def _error(self, matrix: SparseMatrix) -> float:
        """Return the relative residual of one solution: pivots on an indefinite diagonal grow."""
        b = np.random.default_rng(0).standard_normal(matrix.shape[0])
        return float(np.linalg.norm(b - matrix @ self._lu.solve(b)) / np.linalg.norm(b))


class _PardisoFactor:
    """MKL PARDISO, Cholesky where a real matrix is definite, LDL^T where it is not."""

    def __init__(self, matrix: SparseMatrix) -> None:
        wrapper = importlib.import_module("pypardiso.pardiso_wrapper")
        self._upper = upper = _upper(matrix)
        self._solver: Any = None
        self.n_negative = 0
        damped = np.iscomplexobj(upper)
        if not damped and np.all(upper.diagonal() > 0.0) and self._try_type(wrapper, _DEFINITE):
            return
        if not self._try_type(wrapper, _DAMPED if damped else _INDEFINITE):
            raise UnrestrainedModeError(_SINGULAR)
        self.n_negative = 0 if damped else int(self._solver.iparm[22])
        if int(self._solver.iparm[13]) > 0:  # perturbed pivots: singular to round-off
            raise UnrestrainedModeError(_SINGULAR)

    def _try_type(self, wrapper: Any, matrix_type: int) -> bool:
        solver = wrapper.PyPardisoSolver(mtype=matrix_type)
        # Every solver would search the environment for the library again.
        os.environ.setdefault("PYPARDISO_MKL_RT", str(solver.libmkl._name))
        # MKL holds the factor outside Python's memory; give it back with this object.
        weakref.finalize(self, solver.free_memory, everything=True)
        solver.set_phase(12)
        try:
            nothing = np.zeros((self._upper.shape[0], 1), dtype=self._upper.dtype)
            solver._call_pardiso(self._upper, nothing)
        except wrapper.PyPardisoError:
            return False
        # The factorisation call resets this entry, so refinement is switched off after it.
        solver.iparm[7] = 0
        solver.set_phase(_BOTH)
        self._solver = solver
        return True

    def solve(self, right_hand_side: Array) -> Array:
        b = np.asfortranarray(right_hand_side, dtype=self._upper.dtype)
        return self._solver._call_pardiso(self._upper, b)

    def halves(self) -> tuple[HalfSolve, HalfSolve] | None:
        if self._solver.mtype != _DEFINITE:
            return None
        return partial(self._phase, _FORWARD), partial(self._phase, _BACKWARD)

    def _phase(self, phase: int, right_hand_side: Array) -> Array:
        self._solver.set_phase(phase)
        try:
            return self.solve(right_hand_side)
        finally:
            self._solver.set_phase(_BOTH)


def _upper(matrix: SparseMatrix) -> Any:
    """Return the upper triangle of a symmetric matrix by rows, each in its order."""
    if matrix.format != "csc":
        upper = sparse.csr_matrix(sparse.triu(sparse.csr_array(matrix), format="csr"))
        upper.sort_indices()
        return upper
    # its columns are its rows: one is made at every frequency, and turning it took a tenth of all
    columns = np.repeat(np.arange(matrix.shape[1]), np.diff(matrix.indptr))
    kept = matrix.indices >= columns
    starts = np.concatenate([[0], np.cumsum(kept)])[matrix.indptr]
    lower = (matrix.data[kept], matrix.indices[kept], starts)
    found = sparse.csr_matrix(lower, shape=matrix.shape)
    found.sort_indices()
    return found


_PRECISE = 2e-11  # residual of a solution above which every solution is refined once
_BOTH, _FORWARD, _BACKWARD = 33, 331, 333  # PARDISO's phases of a solution
_DEFINITE, _INDEFINITE = 2, -2  # PARDISO's matrix types for real symmetric matrices
_DAMPED = 6  # and for complex symmetric ones


def _well_conditioned(pivots: Array) -> bool:
    sizes = np.abs(pivots)
    return bool(np.all(np.isfinite(sizes)) and sizes.min() > 1e-14 * np.median(sizes))


_SINGULAR = (
    "the stiffness matrix is singular: part of the structure can move without strain; "
    "add supports, or connect the loose part"
)

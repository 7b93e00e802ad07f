"""Find all natural modes below a frequency, and prove by inertia that none is missing.

Large sparse systems use a block Lanczos iteration on ``(K + s M)^-1 M`` with full
reorthogonalisation in the mass inner product: nearly all the work is solves with many
right-hand sides and dense matrix products, which run near the machine's speed.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy import linalg, sparse

from trundle._checks import positive
from trundle._typing import Array, Matrix, SparseMatrix
from trundle.dynamics.sparse_solver import factorise
from trundle.errors import ConvergenceError, UnrestrainedModeError

__all__ = ["Modes", "count_modes_below", "natural_modes"]

_BLOCK = 24
_DENSE_LIMIT = 600
_DENSE_FALLBACK = 6000
_SHIFT = 1.0  # rad2/s2: keeps K + s M definite for a free body, far below any floor mode
_USUAL_SUBSPACE = 2.3  # columns a mode takes to converge, for the progress bar
_RIGID = 1e-4  # rad2/s2: an eigenvalue below this is a motion without strain


@dataclass(frozen=True, kw_only=True, eq=False)
class Modes:
    """Hold the natural modes of an undamped system, scaled to unit modal mass.

    Attributes
    ----------
    omega : ndarray of float, shape (n_modes,)
        Natural circular frequencies, rising [rad/s].
    shapes : ndarray of float, shape (n_dofs, n_modes)
        Mode shapes with ``shapes.T @ M @ shapes = I`` [1/sqrt(kg)].
    residuals : ndarray of float, shape (n_modes,)
        ``|K phi - lambda M phi| / |K phi|`` of each mode.
    f_max : float
        Every mode below this frequency is here [Hz].
    """

    omega: Float[Array, " modes"]
    shapes: Float[Array, "dofs modes"]
    residuals: Float[Array, " modes"]
    f_max: float

    @property
    def frequencies(self) -> Float[Array, " modes"]:
        """Natural frequencies [Hz]."""
        return self.omega / (2.0 * np.pi)

    @property
    def n_modes(self) -> int:
        """Number of modes."""
        return len(self.omega)


def count_modes_below(
    mass: SparseMatrix, stiffness: SparseMatrix, f: float, *, backend: str | None = None
) -> int:
    """Count the natural frequencies below f [Hz] by Sylvester's law of inertia."""
    shifted = sparse.csc_array(stiffness - (2.0 * np.pi * f) ** 2 * mass)
    return factorise(shifted, backend=backend).n_negative


def natural_modes(
    mass: Matrix,
    stiffness: Matrix,
    *,
    f_max: float,
    backend: str | None = None,
    allow_rigid: bool = False,
    progress: Callable[[float], None] | None = None,
) -> Modes:
    """Find every natural mode below a frequency.

    Parameters
    ----------
    mass, stiffness : ndarray or sparse array, shape (n_dofs, n_dofs)
        Symmetric M [kg] and K [N/m]; M may be singular, K may not unless `allow_rigid`.
    f_max : float
        All modes below this frequency are returned [Hz].
    backend : str, optional
        Sparse solver, see `trundle.dynamics.factorise`.
    allow_rigid : bool
        Accept motions without strain, as a free body has them.
    progress : callable, optional
        Told about how much of the work is done, 0 to 1.

    Returns
    -------
    Modes
        All modes below `f_max`, rising.

    Raises
    ------
    UnrestrainedModeError
        The system has a motion without strain.
    ConvergenceError
        The count found differs from the count by inertia.

    References
    ----------
    R. G. Grimes, J. G. Lewis and H. D. Simon, SIAM J. Matrix Anal. Appl. 15 (1994) 228-272.
    """
    positive("f_max", f_max)
    n_dofs = int(mass.shape[0])
    if n_dofs <= _DENSE_LIMIT or isinstance(mass, np.ndarray) or isinstance(stiffness, np.ndarray):
        eigenvalues, shapes = _dense(mass, stiffness, f_max)
    else:
        eigenvalues, shapes = _block_lanczos(mass, stiffness, f_max, backend, progress)
    if not allow_rigid and len(eigenvalues) and eigenvalues[0] < _RIGID:
        raise UnrestrainedModeError(
            f"{np.count_nonzero(eigenvalues < _RIGID)} motions without strain: part of the "
            "structure is loose or unsupported; add supports, or connect the loose part"
        )
    return Modes(
        omega=np.sqrt(np.maximum(eigenvalues, 0.0)),
        shapes=_fix_signs(shapes),
        residuals=_residuals(mass, stiffness, eigenvalues, shapes),
        f_max=float(f_max),
    )


def _dense(mass: Matrix, stiffness: Matrix, f_max: float) -> tuple[Array, Array]:
    m = mass.toarray() if sparse.issparse(mass) else np.asarray(mass)
    k = stiffness.toarray() if sparse.issparse(stiffness) else np.asarray(stiffness)
    # The inverse problem M v = nu (K + s M) v allows a singular M.
    try:
        nu, vectors = linalg.eigh(m, k + _SHIFT * m)
    except linalg.LinAlgError as error:
        raise UnrestrainedModeError("the stiffness matrix is singular or indefinite") from error
    limit = (2.0 * np.pi * f_max) ** 2
    keep = nu > 1.0 / (limit + _SHIFT)
    nu, vectors = nu[keep][::-1], vectors[:, keep][:, ::-1]
    return 1.0 / nu - _SHIFT, vectors / np.sqrt(nu)


def _block_lanczos(
    mass: SparseMatrix,
    stiffness: SparseMatrix,
    f_max: float,
    backend: str | None,
    progress: Callable[[float], None] | None,
) -> tuple[Array, Array]:
    wanted = count_modes_below(mass, stiffness, f_max, backend=backend)
    n_dofs = mass.shape[0]
    if wanted > n_dofs // 6 and n_dofs <= _DENSE_FALLBACK:
        return _dense(mass, stiffness, f_max)  # most of a small spectrum: cheaper whole
    factor = factorise(sparse.csc_array(stiffness + _SHIFT * mass), backend=backend)
    capacity = min(n_dofs - 1, 4 * wanted + 12 * _BLOCK)
    basis = np.zeros((n_dofs, capacity + _BLOCK), order="F")
    projected = np.zeros((capacity + _BLOCK, capacity + _BLOCK))
    start = np.random.default_rng(0).standard_normal((n_dofs, _BLOCK))
    block, _, _ = _orthonormalise(mass, basis[:, :0], factor.solve(mass @ start))
    basis[:, :_BLOCK] = block
    size, next_look = _BLOCK, int(1.5 * wanted) + 3 * _BLOCK
    while size + _BLOCK <= capacity + _BLOCK:
        block = factor.solve(mass @ basis[:, size - _BLOCK : size])
        block, overlap, last = _orthonormalise(mass, basis[:, :size], block)
        projected[:size, size - _BLOCK : size] = overlap
        projected[size - _BLOCK : size, :size] = overlap.T
        if size >= next_look:
            nu, ritz = linalg.eigh(projected[:size, :size])
            nu, ritz = nu[::-1], ritz[:, ::-1]
            errors = np.linalg.norm(last @ ritz[-_BLOCK:], axis=0)
            good = errors[: wanted + 1] <= 1e-11 * np.abs(nu[: wanted + 1])
            n_good = int(np.argmin(good)) if not good.all() else wanted + 1
            if n_good >= wanted:
                return _pick(nu, basis[:, :size], ritz, wanted, f_max)
            next_look = int(1.12 * size)
        basis[:, size : size + _BLOCK] = block
        size += _BLOCK
        if progress is not None:
            progress(min(0.95, size / (_USUAL_SUBSPACE * wanted + 3 * _BLOCK)))
    raise ConvergenceError(
        f"{wanted} modes below {f_max:g} Hz wanted by inertia, but the iteration stopped "
        f"short with a subspace of {size}",
        residual=float("nan"),
    )


def _orthonormalise(mass: SparseMatrix, basis: Array, block: Array) -> tuple[Array, Array, Array]:
    """Make a block M-orthonormal and M-orthogonal to a basis; return it, overlap and R."""
    overlap = np.zeros((basis.shape[1], block.shape[1]))
    triangle = np.eye(block.shape[1])
    for _ in range(2):
        step = basis.T @ (mass @ block)
        block = block - basis @ step
        overlap += step @ triangle  # back on the scale of the original block
        lower = linalg.cholesky(block.T @ (mass @ block), lower=True)
        block = linalg.solve_triangular(lower, block.T, lower=True).T
        triangle = lower.T @ triangle
    return block, overlap, triangle


def _pick(nu: Array, basis: Array, ritz: Array, wanted: int, f_max: float) -> tuple[Array, Array]:
    eigenvalues = 1.0 / nu[:wanted] - _SHIFT
    found = int(np.count_nonzero(eigenvalues < (2.0 * np.pi * f_max) ** 2))
    if found != wanted:
        raise ConvergenceError(
            f"{found} modes found below {f_max:g} Hz, {wanted} counted by inertia",
            residual=float("nan"),
        )
    return eigenvalues, basis @ ritz[:, :wanted]


def _residuals(mass: Matrix, stiffness: Matrix, eigenvalues: Array, shapes: Array) -> Array:
    elastic = stiffness @ shapes
    error = np.linalg.norm(elastic - (mass @ shapes) * eigenvalues, axis=0)
    return error / np.maximum(np.linalg.norm(elastic, axis=0), np.finfo(float).tiny)


def _fix_signs(shapes: Array) -> Array:
    peak = np.abs(shapes).argmax(axis=0)
    signs = np.sign(shapes[peak, np.arange(shapes.shape[1])])
    return np.ascontiguousarray(shapes * signs)

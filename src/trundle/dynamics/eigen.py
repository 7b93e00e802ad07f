"""Find all natural modes below a frequency, and prove by inertia that none is missing.

Large sparse systems are taken slice by slice (`dynamics.lanczos`), small ones whole.
"""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor

import numpy as np
from scipy import linalg, sparse
from threadpoolctl import threadpool_limits

from trundle._checks import positive
from trundle._progress import Progress
from trundle._typing import Array, Matrix, SparseMatrix
from trundle.dynamics.lanczos import EigenSlice, Interval, march, march_within
from trundle.dynamics.modes import Modes
from trundle.dynamics.pencil import Pencil, Product, SparsePencil, shift_near
from trundle.dynamics.sparse_solver import factorise
from trundle.errors import UnrestrainedModeError

__all__ = [
    "count_modes_below",
    "dense_is_better",
    "intervals_below",
    "modes_by_shifts",
    "modes_within",
    "natural_modes",
    "together",
]

_DENSE_LIMIT = 600
_DENSE_FALLBACK = 6000
_SHIFT = 1.0  # rad2/s2: keeps K + s M definite for a free body, far below any floor mode
_OF_PARTS = 500  # modes looked for at one shift of a structure by its parts: products are cheap
_RIGID = 1e-4  # rad2/s2: an eigenvalue below this is a motion without strain


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
    progress: Progress | None = None,
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
        eigenvalues, shapes, residuals = _whole(mass, stiffness, f_max)
    else:
        eigenvalues, shapes, residuals = _sparse(mass, stiffness, f_max, backend, progress)
    if not allow_rigid and len(eigenvalues) and eigenvalues[0] < _RIGID:
        raise UnrestrainedModeError(
            f"{np.count_nonzero(eigenvalues < _RIGID)} motions without strain: part of the "
            "structure is loose or unsupported; add supports, or connect the loose part"
        )
    return _as_modes(eigenvalues, shapes, residuals, f_max)


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


def _sparse(
    mass: SparseMatrix,
    stiffness: SparseMatrix,
    f_max: float,
    backend: str | None,
    progress: Progress | None,
) -> tuple[Array, Array, Array]:
    """Return eigenvalues, shapes and residuals."""
    wanted = count_modes_below(mass, stiffness, f_max, backend=backend)
    n_dofs = mass.shape[0]
    if wanted > n_dofs // 6 and n_dofs <= _DENSE_FALLBACK:
        return _whole(mass, stiffness, f_max)  # most of a small spectrum: cheaper whole
    pencil = SparsePencil(mass=mass, stiffness=stiffness, backend=backend)
    try:
        return _by_shifts(pencil, wanted, (2.0 * np.pi * f_max) ** 2, progress)
    except linalg.LinAlgError:  # fewer masses than a block has columns
        if n_dofs > _DENSE_FALLBACK:
            raise
        return _whole(mass, stiffness, f_max)


def modes_by_shifts(pencil: Pencil, *, f_max: float, progress: Progress | None = None) -> Modes:
    """Find every natural mode below a frequency, of matrices that are known by their products.

    Parameters
    ----------
    pencil : Pencil
        Stiffness and mass, which can be factorised at any shift; shapes are by its coordinates.
    f_max : float
        All modes below this frequency are returned [Hz].
    progress : callable, optional
        Told about how much of the work is done, 0 to 1.

    Raises
    ------
    ConvergenceError
        The count found differs from the count by inertia.
    """
    n = int(pencil.mass.shape[0])
    if dense_is_better(n, _count(pencil, f_max)):
        mass, stiffness = (np.asarray(one @ np.eye(n)) for one in (pencil.mass, pencil.stiffness))
        return _as_modes(*_whole(mass, stiffness, f_max), f_max)
    parts = intervals_below(pencil, f_max)
    done = np.zeros(len(parts))

    def search(number: int) -> Modes:
        """Find the modes of one part."""

        def tell(share: float) -> None:
            """Tell of all parts."""
            done[number] = share
            if progress is not None:
                progress(0.98 * float(done.mean()))

        return modes_within(pencil, parts[number], progress=tell)

    with ThreadPoolExecutor(2) as pool:
        return together(list(pool.map(search, range(len(parts)))), n_coordinates=n, f_max=f_max)


def dense_is_better(n: int, wanted: int) -> bool:
    """Return whether so many modes of a matrix of n rows are found sooner by dense algebra."""
    return n <= _DENSE_LIMIT or (n <= _DENSE_FALLBACK and wanted > n // 6)


def _count(pencil: Pencil, f: float) -> int:
    """Return how many modes lie below a frequency [Hz]."""
    return shift_near(pencil, 2.0 * np.pi * positive("f_max", f)).below


def intervals_below(pencil: Pencil, f_max: float, *, most: int = 900) -> tuple[Interval, ...]:
    """Part the spectrum below a frequency, so that each part can be searched by itself, anywhere.

    Parameters
    ----------
    pencil : Pencil
        Stiffness and mass, which can be factorised at any shift.
    f_max : float
        End of the last part [Hz].
    most : int
        How many modes a part is to hold, about: plates have as many in every band of one width,
        storeys on each other more and more.

    Notes
    -----
    Every edge is factorised once and its inertia counted; the parts depend on nothing else, so
    that modes have the same bits however many search them.
    """
    positive("f_max", f_max)
    end = shift_near(pencil, 2.0 * np.pi * f_max)
    n = max(1, -(-end.below // most))
    found: list[Interval] = []
    first, edge = 0, 0.0
    for share in np.sqrt(np.arange(1, n) / n):
        cut = shift_near(pencil, 2.0 * np.pi * f_max * float(share))
        found.append(Interval(first=first, edge=edge, end=cut.below, limit=cut.value))
        first, edge = cut.below, cut.value
    return (*found, Interval(first=first, edge=edge, end=end.below, limit=end.value))


def modes_within(pencil: Pencil, interval: Interval, *, progress: Progress | None = None) -> Modes:
    """Find all modes of one part of a spectrum.

    Parameters
    ----------
    pencil : Pencil
        Stiffness and mass, which can be factorised at any shift; shapes are by its coordinates.
    interval : Interval
        The part.
    progress : callable, optional
        Told about how much of the work is done, 0 to 1.

    Raises
    ------
    ConvergenceError
        The count found differs from the count by inertia.
    """
    found: list[Modes] = []
    count = interval.end - interval.first
    f_max = float(np.sqrt(interval.limit)) / (2.0 * np.pi)

    def keep(below: int, part: EigenSlice) -> None:
        """Keep a slice."""
        # a march that goes back replaces what it found
        while found and sum(one.n_modes for one in found) > below - interval.first:
            found.pop()
        residuals = _residuals(pencil.mass, pencil.stiffness, part.eigenvalues, part.shapes)
        signed = part.shapes * _signs(part.shapes)
        found.append(_as_modes(part.eigenvalues, signed, residuals, f_max))
        if progress is not None:
            progress(min(1.0, sum(one.n_modes for one in found) / count))

    if count:
        with threadpool_limits(limits=1):
            march_within(pencil, interval, keep=keep, most=_OF_PARTS)
    return together(found, n_coordinates=int(pencil.mass.shape[0]), f_max=f_max)


def together(parts: Sequence[Modes], *, n_coordinates: int, f_max: float) -> Modes:
    """Return modes of parts of a spectrum that follow each other, as one."""
    return Modes(
        omega=np.concatenate([np.zeros(0), *(part.omega for part in parts)]),
        shapes=np.hstack([np.zeros((n_coordinates, 0)), *(part.shapes for part in parts)]),
        residuals=np.concatenate([np.zeros(0), *(part.residuals for part in parts)]),
        f_max=float(f_max),
    )


def _as_modes(eigenvalues: Array, shapes: Array, residuals: Array, f_max: float) -> Modes:
    return Modes(
        omega=np.sqrt(np.maximum(eigenvalues, 0.0)),
        shapes=shapes,
        residuals=residuals,
        f_max=float(f_max),
    )


def _by_shifts(
    pencil: Pencil, wanted: int, limit: float, progress: Progress | None
) -> tuple[Array, Array, Array]:
    """Return eigenvalues below a limit, so many by inertia, with shapes and residuals."""
    eigenvalues, residuals = np.zeros(wanted), np.zeros(wanted)
    shapes = np.empty((pencil.mass.shape[0], wanted))

    def keep(found: int, part: EigenSlice) -> None:
        here = slice(found, found + len(part.eigenvalues))
        eigenvalues[here] = part.eigenvalues
        shapes[:, here] = part.shapes * _signs(part.shapes)
        residuals[here] = _residuals(pencil.mass, pencil.stiffness, part.eigenvalues, part.shapes)
        if progress is not None:
            progress(0.98 * np.count_nonzero(eigenvalues) / wanted)

    if wanted:
        # Tall thin products are held up by memory; threads of one would only take turns.
        with threadpool_limits(limits=1):
            march(pencil, wanted, limit, keep=keep)
    return eigenvalues, shapes, residuals


def _whole(mass: Matrix, stiffness: Matrix, f_max: float) -> tuple[Array, Array, Array]:
    eigenvalues, shapes = _dense(mass, stiffness, f_max)
    shapes = np.ascontiguousarray(shapes * _signs(shapes))
    return eigenvalues, shapes, _residuals(mass, stiffness, eigenvalues, shapes)


def _residuals(mass: Product, stiffness: Product, eigenvalues: Array, shapes: Array) -> Array:
    elastic = stiffness @ shapes
    error = np.linalg.norm(elastic - (mass @ shapes) * eigenvalues, axis=0)
    return error / np.maximum(np.linalg.norm(elastic, axis=0), np.finfo(float).tiny)


def _signs(shapes: Array) -> Array:
    """Return factors that make each shape's largest part positive."""
    peak = np.maximum(shapes.max(axis=0, initial=0.0), 0.0)
    return np.where(peak >= -shapes.min(axis=0, initial=0.0), 1.0, -1.0)

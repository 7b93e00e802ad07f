"""March through a spectrum shift by shift, with a block Lanczos iteration at each.

At a shift sigma the iteration runs on ``(K - sigma M)^-1 M`` with full reorthogonalisation in the
mass inner product: the eigenvalues nearest the shift come first, on both of its sides. Some three
hundred modes a shift keep the subspace in cache, where one subspace for a thousand modes would be
read from memory at every step. Each factorisation counts the eigenvalues below its shift
(Sylvester's law of inertia), so that none is missed between two shifts.

References
----------
R. G. Grimes, J. G. Lewis and H. D. Simon, SIAM J. Matrix Anal. Appl. 15 (1994) 228-272.
"""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy import sparse

from trundle._typing import Array, SparseMatrix
from trundle.dynamics.krylov import BLOCK, Krylov
from trundle.dynamics.sparse_solver import Factor, factorise
from trundle.errors import ConvergenceError, UnrestrainedModeError

__all__ = ["EigenSlice", "march"]

_SLICE = 320  # modes looked for at one shift
_SHIFT = 1.0  # rad2/s2: keeps K + s M definite for a free body, far below any floor mode
_USUAL_SUBSPACE = 2.3  # columns a mode takes to converge; looking earlier costs time
_ACCURATE = 1e-11  # relative error of an inverse eigenvalue that counts as converged
_EDGES = 16  # last modes of a slice among which the widest gap is its end
_MIDDLE = 0.62  # of the highest frequency: as many modes above as below, with what each costs
_NUDGES = 4  # shifts tried beside each other if one meets an eigenvalue


@dataclass(frozen=True, kw_only=True, eq=False)
class EigenSlice:
    """Hold the eigenpairs of one part of a spectrum.

    Attributes
    ----------
    eigenvalues : ndarray of float, shape (n_found,)
        Rising [rad2/s2].
    shapes : ndarray of float, shape (n_dofs, n_found)
        Eigenvectors, M-orthonormal.
    """

    eigenvalues: Float[Array, " modes"]
    shapes: Float[Array, "dofs modes"]


@dataclass(frozen=True, kw_only=True, eq=False)
class _Shift:
    """A shift, its factorisation, and how many eigenvalues lie below it."""

    value: float
    factor: Factor
    below: int


def march(
    mass: SparseMatrix,
    stiffness: SparseMatrix,
    wanted: int,
    limit: float,
    *,
    backend: str | None,
    keep: Callable[[int, EigenSlice], None],
) -> None:
    """Find the lowest eigenpairs of ``K x = lambda M x``, a slice at a time.

    Parameters
    ----------
    mass, stiffness : sparse array, shape (n_dofs, n_dofs)
        Symmetric M [kg] and K [N/m].
    wanted : int
        How many eigenvalues lie below `limit`, by inertia.
    limit : float
        End of the part of the spectrum that is looked for [rad2/s2].
    backend : str, optional
        Sparse solver.
    keep : callable
        Given the number of eigenvalues below the next slice, and the slice; called from two
        threads where the spectrum is long.

    Raises
    ------
    ConvergenceError
        A slice holds more or fewer eigenvalues than inertia counts.
    """
    pencil = _Pencil(mass=mass, stiffness=stiffness, backend=backend)
    lowest = pencil.at(-_SHIFT)
    if wanted <= 2 * _SLICE:
        _march(pencil, _Interval(first=0, edge=0.0, end=wanted, limit=limit), lowest, keep)
        return
    # Floors have about twice as many modes in an octave as in the one below; this halves the work.
    middle = pencil.near(_MIDDLE * np.sqrt(limit))
    lower = _Interval(first=0, edge=0.0, end=middle.below, limit=middle.value)
    upper = _Interval(first=middle.below, edge=middle.value, end=wanted, limit=limit)
    del middle
    with ThreadPoolExecutor(2) as pool:
        above = pool.submit(_march, pencil, upper, None, keep)
        _march(pencil, lower, lowest, keep)
        above.result()


@dataclass(frozen=True, kw_only=True, eq=False)
class _Interval:
    """A part of a spectrum: from `edge`, with `first` eigenvalues below, to `limit`, with `end`."""

    first: int
    edge: float
    end: int
    limit: float


@dataclass(frozen=True, kw_only=True, eq=False)
class _Pencil:
    """A pair of matrices, factorised at any shift."""

    mass: SparseMatrix
    stiffness: SparseMatrix
    backend: str | None

    def at(self, value: float) -> _Shift:
        """Factorise K - value M."""
        matrix = sparse.csc_array(self.stiffness - value * self.mass)
        factor = factorise(matrix, backend=self.backend)
        return _Shift(value=value, factor=factor, below=factor.n_negative)

    def near(self, omega: float) -> _Shift:
        """Factorise at a circular frequency, or just beside it if it is a natural one."""
        for nudge in range(_NUDGES):
            try:
                return self.at((omega * (1.0 + 1e-6 * nudge)) ** 2)
            except UnrestrainedModeError:
                continue
        raise ConvergenceError(
            f"K - omega^2 M cannot be factorised at {omega / (2.0 * np.pi):.6g} Hz",
            residual=float("nan"),
        )


def _march(
    pencil: _Pencil,
    interval: _Interval,
    shift: _Shift | None,
    keep: Callable[[int, EigenSlice], None],
) -> None:
    found, wanted, edge = interval.first, interval.end, interval.edge
    last = np.array([edge])
    while found < wanted:
        if shift is None:
            shift = _next_shift(pencil, interval, found, last, edge)
        left = shift.below - found
        right = min(wanted - shift.below, max(BLOCK, _share(wanted - found) - left))
        part = _near(pencil.mass, shift, left, right)
        edge = interval.limit
        if shift.below + right < wanted:
            part, edge = _up_to_a_gap(part)
        _check(part, last[-1], edge)
        keep(found, part)
        found += len(part.eigenvalues)
        last = part.eigenvalues
        shift = None  # its factor goes before the next is made


def _share(remaining: int) -> int:
    """Return how many of the remaining modes one shift is to find."""
    return -(-remaining // max(1, -(-remaining // _SLICE)))


def _check(part: EigenSlice, before: float, edge: float) -> None:
    """Hold a slice against what lies before it and behind it."""
    values = part.eigenvalues
    if values[0] < before or values[-1] >= edge:
        place = np.sqrt(max(before if values[0] < before else edge, 0.0)) / (2.0 * np.pi)
        raise ConvergenceError(
            f"near {place:.6g} Hz inertia counts other modes than were found",
            residual=float("nan"),
        )


def _up_to_a_gap(part: EigenSlice) -> tuple[EigenSlice, float]:
    """Cut a slice in the widest gap near its end, so that equal modes stay together."""
    last = part.eigenvalues[-_EDGES:]
    cut = len(part.eigenvalues) - len(last) + 1 + int(np.argmax(np.diff(last) / last[1:]))
    edge = 0.5 * (part.eigenvalues[cut - 1] + part.eigenvalues[cut])
    return EigenSlice(eigenvalues=part.eigenvalues[:cut], shapes=part.shapes[:, :cut]), float(edge)


def _next_shift(
    pencil: _Pencil, interval: _Interval, found: int, last: Array, edge: float
) -> _Shift:
    """Place a shift in the middle of the modes that it is to find."""
    ahead = 0.5 * _share(interval.end - found)
    start, end = np.sqrt(edge), np.sqrt(interval.limit)
    # Frequencies of a floor are about evenly spaced over a short way.
    omega = np.sqrt(np.maximum(last[-64:], 0.0))
    if len(omega) > 1 and omega[-1] > omega[0]:
        spacing = (omega[-1] - omega[0]) / (len(omega) - 1)
    else:
        spacing = (end - start) / (interval.end - found)
    distance = min(ahead * spacing, 0.5 * (end - start))
    for _ in range(40):
        shift = pencil.near(float(start + distance))
        if shift.below - found <= 1.5 * ahead + BLOCK:
            return shift
        distance *= max(0.25, ahead / (shift.below - found))
    raise ConvergenceError(
        f"no shift above {start / (2.0 * np.pi):.6g} Hz parts the modes that lie close together",
        residual=float("nan"),
    )


def _near(mass: SparseMatrix, shift: _Shift, left: int, right: int) -> EigenSlice:
    """Return so many eigenpairs on the left of a shift and on its right."""
    wanted = left + right
    capacity = min(mass.shape[0] - 1, 5 * wanted + 32 * BLOCK)
    krylov = Krylov(mass, shift.factor, capacity)
    next_look = int(_USUAL_SUBSPACE * wanted) + 6 * BLOCK
    while krylov.extend():
        if krylov.size >= next_look:
            nu, ritz, errors = krylov.ritz_pairs()
            good = errors <= _ACCURATE * np.abs(nu)
            # nearest the shift are the largest on either side: first and last of the list
            if good[:left].all() and good[len(nu) - right :].all():
                pick = np.r_[:left, len(nu) - right : len(nu)]
                eigenvalues = shift.value + 1.0 / nu[pick]
                order = np.argsort(eigenvalues)
                shapes = krylov.vectors(ritz[:, pick[order]])
                return EigenSlice(eigenvalues=eigenvalues[order], shapes=shapes)
            next_look = int(1.08 * krylov.size)
    raise ConvergenceError(
        f"{wanted} modes wanted near {np.sqrt(max(shift.value, 0.0)) / (2.0 * np.pi):.6g} Hz by "
        f"inertia, but the iteration stopped short with a subspace of {krylov.size}",
        residual=float("nan"),
    )

"""Find the eigenpairs nearest a shift by block Lanczos iteration, copies of equal ones too.

The iteration runs on ``(K - sigma M)^-1 M`` with full reorthogonalisation in the mass inner product
(`dynamics.krylov`). A block of b vectors shows b copies of an eigenvalue; further ones, as equal
columns and bays have them, are searched for beside what was found.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from trundle._typing import Array
from trundle.dynamics.krylov import BLOCK, Krylov
from trundle.dynamics.pencil import Product, Shift
from trundle.errors import ConvergenceError

__all__ = ["EigenSlice", "hunted", "near"]

_USUAL_SUBSPACE = 2.3  # columns a mode takes to converge; looking earlier costs time
_ACCURATE = 1e-11  # relative error of an inverse eigenvalue that counts as converged
_ANEW = 60  # searches beside what is found, each of which shows another block of copies


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


def near(
    mass: Product, shift: Shift, left: int, right: int, bounds: tuple[float, float]
) -> EigenSlice:
    """Return so many eigenpairs on the left of a shift and on its right, all within bounds."""
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
                inside = (eigenvalues >= bounds[0]) & (eigenvalues < bounds[1])
                pick, eigenvalues = pick[inside], eigenvalues[inside]
                order = np.argsort(eigenvalues)
                shapes = krylov.vectors(ritz[:, pick[order]])
                part = EigenSlice(eigenvalues=eigenvalues[order], shapes=shapes)
                # what lies beyond the bounds converged in the place of copies that do not appear
                return part if inside.all() else hunted(mass, shift, part, bounds, wanted)
            next_look = int(1.08 * krylov.size)
    whole = bool(np.isfinite(bounds[1]))
    nu, ritz, errors = krylov.ritz_pairs()
    good, values = errors <= _ACCURATE * np.abs(nu), shift.value + 1.0 / nu
    # on the right, all that lie nearest; those on the left are not taken twice
    fewer = min(right, int(np.argmin(np.r_[good[::-1], False])))
    pick = np.r_[:left, len(nu) - fewer : len(nu)]
    if not whole and fewer > BLOCK and good[:left].all() and values[pick].min() >= bounds[0]:
        pick = pick[np.argsort(values[pick])]  # the rest by later shifts
        return EigenSlice(eigenvalues=values[pick], shapes=krylov.vectors(ritz[:, pick]))
    # Where copies are missing, others in their place may be too far to converge.
    if whole or left:
        bounds = bounds if whole else (bounds[0], shift.value)
        pick = np.flatnonzero((values >= bounds[0]) & (values < bounds[1]) & good)
        part = EigenSlice(eigenvalues=values[pick], shapes=krylov.vectors(ritz[:, pick]))
        return hunted(mass, shift, part, bounds, wanted if whole else left)
    raise ConvergenceError(
        f"{wanted} modes wanted near {np.sqrt(max(shift.value, 0.0)) / (2.0 * np.pi):.6g} Hz by "
        f"inertia, but the iteration stopped short with a subspace of {krylov.size}",
        residual=float("nan"),
    )


def hunted(
    mass: Product, shift: Shift, part: EigenSlice, bounds: tuple[float, float], wanted: int
) -> EigenSlice:
    """Search anew beside what is found until so many eigenpairs lie within bounds.

    Raises
    ------
    ConvergenceError
        No further one appears, or more were found than inertia counts.
    """
    values, shapes = part.eigenvalues, part.shapes
    for start in range(1, _ANEW):
        missing = wanted - len(values)
        if missing <= 0:
            break
        more = _beside(mass, shift, shapes, bounds, missing=missing, start=start)
        values = np.concatenate([values, more.eigenvalues])
        shapes = np.hstack([shapes, more.shapes])
    if len(values) != wanted:
        raise ConvergenceError(
            f"between {np.sqrt(max(bounds[0], 0.0)) / (2.0 * np.pi):.6g} Hz and the next gap "
            f"inertia counts {wanted} modes, and {len(values)} were found",
            residual=float("nan"),
        )
    order = np.argsort(values)
    return EigenSlice(eigenvalues=values[order], shapes=shapes[:, order])


def _beside(
    mass: Product,
    shift: Shift,
    shapes: Array,
    bounds: tuple[float, float],
    *,
    missing: int,
    start: int,
) -> EigenSlice:
    """Return some of the missing eigenpairs, found M-orthogonal to others."""
    capacity = min(mass.shape[0] - 1, 5 * missing + 40 * BLOCK)
    krylov = Krylov(mass, shift.factor, capacity, beside=shapes, start=start)
    while krylov.extend():
        if krylov.size % (4 * BLOCK):
            continue
        nu, ritz, errors = krylov.ritz_pairs()
        values = shift.value + 1.0 / nu
        within = (values >= bounds[0]) & (values < bounds[1])
        good = within & (errors <= _ACCURATE * np.abs(nu))
        if good.any() and (good.sum() >= min(missing, BLOCK) or (within == good).all()):
            pick = np.flatnonzero(good)[:missing]
            return EigenSlice(eigenvalues=values[pick], shapes=krylov.vectors(ritz[:, pick]))
    return EigenSlice(eigenvalues=np.zeros(0), shapes=np.zeros((mass.shape[0], 0)))

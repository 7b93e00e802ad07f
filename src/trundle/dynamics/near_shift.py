"""Find the eigenpairs nearest a shift by block Lanczos iteration, copies of equal ones too.

The iteration runs on ``(K - sigma M)^-1 M`` with full reorthogonalisation in the mass inner product
(`dynamics.krylov`). A block of b vectors shows b copies of an eigenvalue; further ones, as equal
columns and bays have them, are searched for beside what was found.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Float

from trundle._typing import Array
from trundle.dynamics.krylov import BLOCK, Krylov
from trundle.dynamics.pencil import Product, Shift
from trundle.errors import ConvergenceError

__all__ = ["EQUAL", "EigenSlice", "hunted", "near"]

_USUAL_SUBSPACE = 2.3  # columns a mode takes to converge; looking earlier costs time
_LOOKS = 1.08  # size of the subspace at a look against the one before
_SHIFT_COST = 240  # columns that could be formed while a shift is factorised and looked at
_WORTH_A_SHIFT = 0.4  # of those to find: where fewer are left, they are found by this shift
EQUAL = 1e-5  # relative distance of eigenvalues that may be copies of one
_ACCURATE = 1e-11  # relative error of an inverse eigenvalue that counts as converged
_NEARLY = 0.03  # and of one that tells how many lie further on
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
    beyond : ndarray of float, shape (n_beyond,)
        About where further eigenvalues lie above these, rising; they have not converged.
    """

    eigenvalues: Float[Array, " modes"]
    shapes: Float[Array, "dofs modes"]
    beyond: Float[Array, " beyond"] = field(default_factory=lambda: np.zeros(0))


def near(
    mass: Product,
    shift: Shift,
    left: int,
    right: int,
    bounds: tuple[float, float],
    *,
    aim: int,
) -> EigenSlice:
    """Return all eigenpairs left of a shift, and of those on its right the nearest.

    Parameters
    ----------
    mass : sparse array or product, shape (n_dofs, n_dofs)
        M [kg].
    shift : Shift
        The shift.
    left, right : int
        How many lie within bounds on either side, by inertia.
    bounds : tuple of float
        Where the part of the spectrum begins and ends [rad2/s2].
    aim : int
        How many to find, about: where the right side is slow to come, another shift costs less.

    Raises
    ------
    ConvergenceError
        The iteration stops short.
    """
    whole = left + right <= aim
    aim = min(left + right, max(aim, left + 2 * BLOCK))
    krylov = Krylov(mass, shift.factor, min(mass.shape[0] - 1, 5 * aim + 32 * BLOCK))
    next_look, before = int(_USUAL_SUBSPACE * aim) + 6 * BLOCK, (0, -np.inf)
    while krylov.extend():
        if krylov.size < next_look:
            continue
        found = _Found.of(krylov, shift, left, right)
        count, size = left + found.n_right, krylov.size
        if found.left_is_done and count:
            slow = (count - before[1]) * (size + _SHIFT_COST) < count * (size - before[0])
            worth_another = left + right - count > _WORTH_A_SHIFT * aim
            ends = found.n_right == right or found.goes_beyond(bounds[1])
            if ends or (count > BLOCK and worth_another and (slow or count >= aim)):
                return _of_both_sides(mass, shift, krylov, found, bounds, whole=whole)
            before = (size, count)
        next_look = int(_LOOKS * krylov.size)
    found = _Found.of(krylov, shift, left, right)
    some = left + right if whole else left
    return _as_far_as_it_came(mass, shift, krylov, found, bounds, hunted_for=some)


@dataclass(frozen=True, kw_only=True, eq=False)
class _Found:
    """What a Krylov space knows of the eigenvalues nearest its shift.

    `values`, by rising inverse: those on the left first, farthest last; `good` says which have
    converged; `n_right` of `right` are the nearest that have without a gap.
    """

    left: int
    right: int
    n_right: int
    values: Array
    vectors: Array
    good: Array
    nearly: Array

    @classmethod
    def of(cls, krylov: Krylov, shift: Shift, left: int, right: int) -> _Found:
        """Look at a space."""
        nu, vectors, errors = krylov.ritz_pairs()
        good = errors <= _ACCURATE * np.abs(nu)
        values = shift.value + 1.0 / nu
        return cls(
            left=left,
            right=right,
            n_right=min(right, _ready(values[nu > 0.0][::-1], good[nu > 0.0][::-1])),
            values=values,
            vectors=vectors,
            good=good,
            nearly=errors <= _NEARLY * np.abs(nu),
        )

    @property
    def left_is_done(self) -> bool:
        """Whether all on the left have converged."""
        return len(self.good) >= self.left and bool(self.good[: self.left].all())

    @property
    def nearest(self) -> Array:
        """Where those on the left, and on the right as far as they have converged, stand."""
        n = len(self.values)
        return np.r_[: self.left, n - self.n_right : n]

    def goes_beyond(self, limit: float) -> bool:
        """Return whether what has converged on the right reaches a limit: copies are missing."""
        return bool(np.any(self.values[self.nearest] >= limit))

    def beyond(self, value: float) -> Array:
        """Return about where others lie above one, as far as that can be trusted."""
        sure = self.values[::-1][: int(np.argmin(np.r_[self.nearly[::-1], False]))]
        return sure[sure > value]

    def slice_of(self, pick: Array, krylov: Krylov) -> EigenSlice:
        """Return some of the eigenpairs, rising."""
        order = pick[np.argsort(self.values[pick])]
        values = self.values[order]
        beyond = self.beyond(values[-1]) if len(values) else np.zeros(0)
        shapes = krylov.vectors(self.vectors[:, order])
        return EigenSlice(eigenvalues=values, shapes=shapes, beyond=beyond)


def _ready(values: Array, good: Array) -> int:
    """Return how many of rising values come before the first that is not good, or its copies."""
    ready = int(np.argmin(np.r_[good, False]))
    if ready == len(values):
        return ready
    apart = np.diff(values[: ready + 1], prepend=-np.inf) > EQUAL * np.abs(values[: ready + 1])
    return int(np.flatnonzero(apart)[-1])


def _of_both_sides(
    mass: Product,
    shift: Shift,
    krylov: Krylov,
    found: _Found,
    bounds: tuple[float, float],
    *,
    whole: bool,
) -> EigenSlice:
    """Return the nearest, with copies searched for where those do not all lie within bounds.

    `whole` says that all within bounds are to be found by this shift.
    """
    pick = found.nearest
    values = found.values[pick]
    inside = (values >= bounds[0]) & (values < bounds[1])
    part = found.slice_of(pick[inside], krylov)
    # what lies beyond the bounds converged in the place of copies that do not appear
    if not inside.all() and (whole or found.n_right == found.right):
        return hunted(mass, shift, part, bounds, found.left + found.right)
    if np.any(values < bounds[0]):
        part = found.slice_of(pick[inside & (values < shift.value)], krylov)
        return hunted(mass, shift, part, (bounds[0], shift.value), found.left)
    return part


def _as_far_as_it_came(
    mass: Product,
    shift: Shift,
    krylov: Krylov,
    found: _Found,
    bounds: tuple[float, float],
    *,
    hunted_for: int,
) -> EigenSlice:
    """Return what a space without further room knows, as far as no copy can be missing.

    `hunted_for` of the rest are searched for beside what it knows: all, or those on the left.

    Raises
    ------
    ConvergenceError
        That is nothing.
    """
    pick, values = found.nearest, found.values
    inside = (values >= bounds[0]) & (values < bounds[1])
    some = found.n_right > BLOCK and found.n_right < found.right
    if some and found.left_is_done and inside[pick].all():
        return found.slice_of(pick, krylov)  # the rest by later shifts
    # Where copies are missing, others in their place may be too far to converge.
    if hunted_for:
        if hunted_for < found.left + found.right:
            bounds = (bounds[0], shift.value)
        inside = (values >= bounds[0]) & (values < bounds[1]) & found.good
        part = found.slice_of(np.flatnonzero(inside), krylov)
        return hunted(mass, shift, part, bounds, hunted_for)
    place = np.sqrt(max(shift.value, 0.0)) / (2.0 * np.pi)
    raise ConvergenceError(
        f"{found.left + found.right} modes wanted near {place:.6g} Hz by "
        f"inertia, but the iteration stopped short with a subspace of {len(values)}",
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

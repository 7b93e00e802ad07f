"""Give reduced parts as arrays to be kept, and see whether kept ones can be believed."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from trundle._typing import Array, SparseMatrix
from trundle.dynamics.eigen import count_modes_below
from trundle.dynamics.superelement import RestingPart, Superelement

__all__ = ["is_reduction_of", "part_as_arrays", "part_from_arrays"]

_SUMS = 3  # random sums of columns by which a kept part is tried
_OFF = 1e-6  # relative, that such a sum may be off
_NAMES = ("boundary", "interior", "omega", "shapes", "coupling", "stiffness", "mass")


def part_as_arrays(part: Superelement) -> dict[str, Array]:
    """Return all that a reduced part holds."""
    return {name: getattr(part, name) for name in _NAMES} | {"f_max": np.array(part.f_max)}


def part_from_arrays(arrays: Mapping[str, Array]) -> Superelement:
    """Return a part that was kept.

    Raises
    ------
    KeyError
        Something is missing.
    """
    return Superelement(**{name: arrays[name] for name in _NAMES}, f_max=float(arrays["f_max"]))


def is_reduction_of(
    part: Superelement, mass: SparseMatrix, stiffness: SparseMatrix, boundary: Array
) -> bool:
    """Return whether a part is the reduction of two matrices to a boundary.

    Notes
    -----
    Random sums of its columns must satisfy what defines them: of its modes ``K Phi s / lambda =
    M Phi s`` and unit modal mass, of the boundary that its stiffness, mass and coupling are those
    of the motion in which the inside rests. One spoiled number breaks one of these. Modes may be
    right, and one of them missing: inertia counts them.
    """
    n, b = len(part.omega), len(boundary)
    shapes_fit = (
        np.array_equal(part.boundary, boundary)
        and part.n_dofs == mass.shape[0]
        and part.shapes.shape == (len(part.interior), n)
        and part.coupling.shape == (n, b)
        and part.stiffness.shape == part.mass.shape == (b, b)
    )
    if not shapes_fit or not np.array_equal(
        part.interior, np.setdiff1d(np.arange(part.n_dofs), boundary)
    ):
        return False
    numbers = (part.omega, part.shapes, part.coupling, part.stiffness, part.mass)
    if not all(np.isfinite(values).all() for values in numbers):
        return False
    if n and not (part.omega[0] > 0.0 and np.all(np.diff(part.omega) >= 0.0)):
        return False
    inside = mass[part.interior][:, part.interior], stiffness[part.interior][:, part.interior]
    return (
        _moves_as_modes(part, *inside)
        and _rests(part, mass, stiffness)
        and count_modes_below(*inside, part.f_max) == n
    )


def _signs(rows: int) -> Array:
    return np.random.default_rng(rows).choice([-1.0, 1.0], size=(rows, _SUMS))


def _moves_as_modes(part: Superelement, mass: SparseMatrix, stiffness: SparseMatrix) -> bool:
    n = len(part.omega)
    if not n:
        return True
    both = part.shapes @ _signs(n)
    held = stiffness @ (part.shapes @ (_signs(n) / part.omega[:, None] ** 2))
    unlike = np.abs(np.sum(both * (mass @ both), axis=0) / n - 1.0)
    return _close(held, mass @ both) and bool(np.all(unlike < _OFF))


def _rests(part: Superelement, mass: SparseMatrix, stiffness: SparseMatrix) -> bool:
    """Return whether what the part says of its boundary is what the whole matrices say."""
    moved = _signs(len(part.boundary))
    resting = RestingPart(reduced=part, stiffness=stiffness)
    whole = resting.expanded(np.zeros((len(part.omega), _SUMS)), moved)
    carried = mass @ whole
    at_boundary = carried[part.boundary] - resting.at_boundary(-carried[part.interior])
    return (
        _close(part.stiffness @ moved, (stiffness @ whole)[part.boundary])
        and _close(part.coupling @ moved, part.shapes.T @ carried[part.interior])
        and _close(part.mass @ moved, at_boundary)
    )


def _close(found: Array, expected: Array) -> bool:
    """Return whether sums are those expected, against the largest of each."""
    size = np.abs(expected).max(axis=0, initial=0.0)
    return bool(np.all(np.abs(found - expected).max(axis=0, initial=0.0) <= _OFF * size + 1e-300))

"""Give modes as arrays to be kept, and see whether kept ones can be believed."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping

import numpy as np

from trundle._typing import Array
from trundle.dynamics.modes import Modes
from trundle.dynamics.pencil import Pencil, shift_near

__all__ = ["are_modes_of", "modes_as_arrays", "modes_from_arrays"]

_SUMS = 3  # sums of all modes by which kept ones are tried
_OFF = 1e-6  # relative, that such a sum may be off


def modes_as_arrays(modes: Modes) -> dict[str, Array]:
    """Return all that modes hold, with a digest of it."""
    return {
        "omega": modes.omega,
        "shapes": modes.shapes,
        "residuals": modes.residuals,
        "f_max": np.array(modes.f_max),
        "digest": np.frombuffer(_digest(modes), dtype=np.uint8),
    }


def modes_from_arrays(arrays: Mapping[str, Array]) -> Modes:
    """Return modes that were kept.

    Raises
    ------
    ValueError
        They are not what their digest says.
    """
    modes = Modes(
        omega=arrays["omega"],
        shapes=arrays["shapes"],
        residuals=arrays["residuals"],
        f_max=float(arrays["f_max"]),
    )
    if arrays["digest"].tobytes() != _digest(modes):
        raise ValueError("damaged")
    return modes


def are_modes_of(modes: Modes, pencil: Pencil) -> bool:
    """Return whether modes are all those of a system below their limit.

    Notes
    -----
    With random signs s, ``K Phi s / lambda = M Phi s``, and ``|Phi s|^2`` by the mass is the number
    of modes; one spoiled number anywhere breaks either, and each costs a product with the shapes.
    Modes may be right, and one of them missing: inertia counts them.
    """
    n, mass, stiffness = modes.n_modes, pencil.mass, pencil.stiffness
    if modes.shapes.shape != (mass.shape[0], n) or modes.residuals.shape != (n,) or n == 0:
        return False
    sound = all(np.isfinite(v).all() for v in (modes.shapes, modes.omega, modes.residuals))
    rising = modes.omega[0] > 0.0 and bool(np.all(np.diff(modes.omega) >= 0.0))
    if not sound or not rising or modes.frequencies[-1] >= modes.f_max:
        return False
    signs = np.random.default_rng(n).choice([-1.0, 1.0], size=(n, _SUMS))
    held = stiffness @ (modes.shapes @ (signs / modes.omega[:, None] ** 2))
    both = modes.shapes @ signs
    moved = mass @ both
    off = np.linalg.norm(held - moved, axis=0) / np.linalg.norm(moved, axis=0)
    unlike = np.abs(np.sum(both * moved, axis=0) / n - 1.0)
    if not (np.all(off < _OFF) and np.all(unlike < _OFF)):
        return False
    return shift_near(pencil, 2.0 * np.pi * modes.f_max).below == n


def _digest(modes: Modes) -> bytes:
    """Return a sum of all that is kept of modes."""
    found = hashlib.sha256(f"{modes.f_max!r} {modes.shapes.shape}".encode())
    for values in (modes.omega, modes.residuals, modes.shapes):
        found.update(np.ascontiguousarray(values).tobytes())
    return found.digest()

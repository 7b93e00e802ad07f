"""Find slopes at measured points, and say in words what is wrong with their stations."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float
from scipy.interpolate import CubicSpline

from trundle._checks import frozen_array
from trundle._typing import Array, ArrayLike
from trundle.errors import InputError

__all__ = ["check_order", "limited_slopes", "measured_points"]

_LIMIT = 3.0  # Fritsch and Carlson (1980): a cubic with no steeper ends than this is monotone


def measured_points(
    station: ArrayLike, elevation: ArrayLike, *, at_least: int
) -> tuple[Float[Array, " points"], Float[Array, " points"]]:
    """Check measured points whose stations must rise, and return them as arrays."""
    s, z = (
        frozen_array(name, np.atleast_1d(np.asarray(values, float)), shape=(None,))
        for name, values in (("station", station), ("elevation", elevation))
    )
    if s.shape != z.shape or len(s) < at_least:
        raise InputError(
            f"a measured profile needs at least {at_least} points with one elevation each; "
            f"got {len(s)} stations and {len(z)} elevations"
        )
    check_order(s, z)
    if np.any(repeated := np.diff(s) == 0.0):
        at = int(np.argmax(repeated))
        raise InputError(
            f"station must rise from point to point; points {at} and {at + 1} (counted from 0) "
            f"both stand at {s[at]:g} m with elevation {z[at]:g} m: drop one of them"
        )
    return s, z


def check_order(station: Float[Array, " points"], elevation: Float[Array, " points"]) -> None:
    """Refuse stations that fall, and vertical steps."""
    step, rise = np.diff(station), np.diff(elevation)
    if np.any(step < 0.0):
        bad = int(np.argmin(step))
        raise InputError(
            f"station must not fall; it goes from {station[bad]:g} to {station[bad + 1]:g} m "
            f"at point {bad + 1} (counted from 0): sort the file by station"
        )
    if np.any(vertical := (step == 0.0) & (rise != 0.0)):
        at = int(np.argmax(vertical))
        raise InputError(
            f"the profile has a vertical step: points {at} and {at + 1} (counted from 0) both "
            f"stand at {station[at]:g} m, with elevations {elevation[at]:g} and "
            f"{elevation[at + 1]:g} m; no wheel can climb it: draw their stations apart by the "
            "length of the step's chamfer, or by the tyre's contact patch, some 0.1 m"
        )


def limited_slopes(
    station: Float[Array, " points"], elevation: Float[Array, " points"]
) -> Float[Array, " points"]:
    """Return the slopes of a cubic spline, held to what the points beside each allow.

    Notes
    -----
    A spline through a step swings on both sides of it, and the more so the closer two points
    stand. Each slope is therefore held to three times the lesser of the two chords that meet
    at its point, and to their sign where they agree (Hyman's filter). Through points that show
    the waves they are taken from nothing is held, and the curve is the spline itself.

    References
    ----------
    J. M. Hyman, Accurate monotonicity preserving cubic interpolation, SIAM J. Sci. Stat.
    Comput. 4 (1983) 645-654, equation 2.6.
    """
    slope = CubicSpline(station, elevation)(station, 1)
    chord = np.diff(elevation) / np.diff(station)
    before, after = np.concatenate([chord[:1], chord]), np.concatenate([chord, chord[-1:]])
    most = _LIMIT * np.minimum(np.abs(before), np.abs(after))
    agree = before * after > 0.0
    low = np.where(agree & (before > 0.0), 0.0, -most)
    high = np.where(agree & (before < 0.0), 0.0, most)
    return np.clip(slope, low, high)

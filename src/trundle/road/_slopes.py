"""Find slopes at measured points, and say in words what is wrong with their stations."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float
from scipy.interpolate import CubicSpline

from trundle._checks import frozen_array
from trundle._typing import Array, ArrayLike
from trundle.errors import InputError

__all__ = ["check_order", "limited_slopes", "measured_points"]

_CHORDS = 3.0  # a cubic with ends no steeper than this many chords is monotone
_PARABOLAS = 1.5
_UNEVEN = 3.0  # times the narrowest of four intervals


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
    stand. Each slope is therefore held between 0 and the larger of three times the lesser of
    the chords that meet at its point, and 1.5 times the lesser of the slopes there of the
    parabolas through it and the two points on either side; 0 where their signs differ. Through
    points that show the waves they are taken from nothing is held, and the curve is the spline.
    Where points are uneven a parabola swings too, and the chords alone count.

    References
    ----------
    H. T. Huynh, Accurate monotone cubic interpolation, SIAM J. Numer. Anal. 30 (1993) 57-100,
    equations 3.21 to 3.26.
    """
    slope = CubicSpline(station, elevation)(station, 1)
    width, chord = (_continued(v) for v in (np.diff(station), np.diff(elevation)))
    chord = chord / width
    # of each point: the second interval before it, the first, the first and second behind it
    h, d = (np.stack([v[i : len(v) - 3 + i] for i in range(4)]) for v in (width, chord))
    before = d[1] + h[1] * (d[1] - d[0]) / (h[0] + h[1])
    behind = d[2] - h[2] * (d[3] - d[2]) / (h[2] + h[3])
    even = h.max(axis=0) < _UNEVEN * h.min(axis=0)
    limit = _CHORDS * _lesser(d[1], d[2])
    by_parabolas = np.where(even, _PARABOLAS * _lesser(before, behind), 0.0)
    limit = np.where(np.abs(by_parabolas) > np.abs(limit), by_parabolas, limit)
    return np.clip(slope, np.minimum(limit, 0.0), np.maximum(limit, 0.0))


def _continued(values: Array) -> Array:
    """Repeat the values of the first and last intervals twice beyond the ends."""
    return np.pad(values, 2, mode="edge")


def _lesser(a: Array, b: Array) -> Array:
    """Return the value nearer to 0 of two of one sign, 0 for two of different signs."""
    return np.where(a * b > 0.0, np.sign(a) * np.minimum(np.abs(a), np.abs(b)), 0.0)

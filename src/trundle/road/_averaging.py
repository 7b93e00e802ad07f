"""Average a profile over the length of road that a tyre stands on."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.interpolate import PPoly

from trundle._typing import Array

__all__ = ["Points", "moving_average"]

_SAME = 1e-9  # m; break points closer than this are one


@dataclass(frozen=True, kw_only=True, eq=False)
class Points:
    """Hold stations [m], elevations [m] and slopes [m/m], shape (n_points,) each."""

    station: Float[Array, " points"]
    elevation: Float[Array, " points"]
    slope: Float[Array, " points"]


def moving_average(points: Points, length: float) -> Points:
    """Return the centred moving average, from half a length inside either end.

    Parameters
    ----------
    points : Points
        Piecewise cubic road; longer than `length`.
    length : float
        Length averaged over [m].

    Notes
    -----
    With I the integral of the elevation, ``z_a(s) = (I(s + a/2) - I(s - a/2)) / a`` and
    ``z_a'(s) = (z(s + a/2) - z(s - a/2)) / a``: both exact at every point where one of the
    window's ends meets a point of the road. Straight lines become parabolas between those
    points, which the cubic through value and slope at both ends is; a cubic becomes a quartic,
    of which it leaves out ``h^4 z_a'''' / 384``.
    """
    road = _cubics(points)
    whole = road.antiderivative()
    half, s = 0.5 * length, points.station
    first, last = s[0] + half, s[-1] - half
    breaks = np.sort(np.concatenate([[first, last], s + half, s - half]))
    breaks = breaks[(breaks >= first) & (breaks <= last)]
    station = breaks[np.concatenate([[True], np.diff(breaks) > _SAME])]
    fore, aft = np.minimum(station + half, s[-1]), np.maximum(station - half, s[0])
    return Points(
        station=station,
        elevation=points.elevation[0] + (whole(fore) - whole(aft)) / length,
        slope=(road(fore) - road(aft)) / length,
    )


def _cubics(points: Points) -> PPoly:
    """Return the road above its first point, without the intervals of no length."""
    width = np.diff(points.station)
    some = width > 0.0
    h, z = width[some], points.elevation[:-1][some] - points.elevation[0]
    g0, g1 = points.slope[:-1][some], points.slope[1:][some]
    chord = np.diff(points.elevation)[some] / h
    cubic, square = (g0 + g1 - 2.0 * chord) / h**2, (3.0 * chord - 2.0 * g0 - g1) / h
    ends = np.concatenate([points.station[:-1][some], points.station[-1:]])
    return PPoly(np.array([cubic, square, g0, z]), ends)

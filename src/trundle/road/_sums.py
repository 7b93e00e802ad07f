"""Add profiles exactly: each is piecewise cubic, and so is their sum."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from trundle._typing import Array
from trundle.road.profile import Profile

__all__ = ["added"]

_SAME = 1e-12  # m, and m/m: what two sides of a point may differ by rounding
_CLOSE = 1e-9  # m between break points that are one


def added(below: Profile, on_top: Profile) -> Profile:
    """Return the sum of two profiles, over the stations of the first or of both if that is level.

    Parameters
    ----------
    below : Profile
        Says what the road beyond the stations is.
    on_top : Profile
        Known at all of them: level beyond its own.
    """
    first, last = float(below.station[0]), float(below.station[-1])
    if below.beyond == "level":
        first = min(first, float(on_top.station[0]))
        last = max(last, float(on_top.station[-1]))
        below = _lengthened(below, first, last)
    inside = on_top.station[(on_top.station > first) & (on_top.station < last)]
    breaks = np.unique(np.concatenate([below.station, inside]))
    breaks = breaks[np.concatenate([[True], np.diff(breaks) > _CLOSE])]
    one, other = (_ends(p, breaks) for p in (below, on_top))
    return _joined(breaks, one + other, below)


def _lengthened(profile: Profile, first: float, last: float) -> Profile:
    """Return a profile that is level beyond its ends, with level road to other ends."""
    s, z, g = profile.station, profile.elevation, profile.slope
    if first < s[0]:
        s, z, g = _put_before(first, s[0], s), _put_before(z[0], z[0], z), _put_before(0.0, 0.0, g)
    if last > s[-1]:
        s, z, g = (_put_before(*pair, v[::-1])[::-1] for *pair, v in (
            (last, s[-1], s), (z[-1], z[-1], z), (0.0, 0.0, g)
        ))  # fmt: skip
    return Profile(station=s, elevation=z, slope=g, beyond="level")


def _put_before(one: float, other: float, values: Array) -> Array:
    return np.concatenate([[one, other], values])


def _ends(profile: Profile, breaks: Float[Array, " breaks"]) -> Float[Array, "2 intervals 2"]:
    """Return height and slope at both ends of every interval, from within it."""
    width = np.diff(breaks)
    # Height and slope at two points inside an interval tell its cubic, kinks at the ends or not.
    x = np.array([0.25, 0.75])
    z, g = profile.at(breaks[:-1, None] + width[:, None] * x)
    rise = np.diff(z, axis=1)[:, 0]
    h = 0.5 * width  # between the two readings
    second = (3.0 * rise / h - 2.0 * g[:, 0] - g[:, 1]) / h
    third = (g[:, 0] + g[:, 1] - 2.0 * rise / h) / h**2

    def at(t: Array) -> tuple[Array, Array]:
        height = z[:, 0] + t * (g[:, 0] + t * (second + t * third))
        return height, g[:, 0] + t * (2.0 * second + 3.0 * t * third)

    (z0, g0), (z1, g1) = at(-0.25 * width), at(0.75 * width)
    return np.array([np.stack([z0, z1], axis=1), np.stack([g0, g1], axis=1)])


def _joined(breaks: Array, ends: Float[Array, "2 intervals 2"], like: Profile) -> Profile:
    """Return the profile of intervals; a point whose two sides have one slope stands once."""
    z, g = ends
    station = np.repeat(breaks, 2)[1:-1]
    height, slope = z.ravel(), g.ravel()
    twin = np.zeros(len(station), dtype=bool)
    scale = np.maximum(1.0, np.abs(slope[1:-1:2]))
    # between readings rounding grows with the height over an interval's width
    loose = _SAME * (scale + np.abs(height[1:-1:2]) / np.minimum(*_sides(breaks)))
    twin[2::2] = np.abs(slope[2::2] - slope[1:-1:2]) <= 16.0 * loose
    keep = ~twin
    return Profile(
        station=station[keep], elevation=_one_height(height)[keep], slope=slope[keep],
        beyond=like.beyond,
    )  # fmt: skip


def _sides(breaks: Array) -> tuple[Array, Array]:
    width = np.diff(breaks)
    return width[:-1], width[1:]


def _one_height(height: Array) -> Array:
    """Give both sides of a point one height: a profile has no jump."""
    out = height.copy()
    out[2::2] = out[1:-1:2]
    return out

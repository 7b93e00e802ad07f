"""Roll a disc over a profile: the path of its lowest point."""

from __future__ import annotations

import numpy as np
from scipy import ndimage

from trundle._typing import Array
from trundle.road.profile import Profile

__all__ = ["rolled"]

_FINE = 200  # samples to a radius: a disc drops r / 80,000 between two of them
_FLAT = 1e-12  # m: what is as level as this is level


def rolled(profile: Profile, radius: float) -> Profile:
    """Return the path of a disc's lowest point over a profile that is level beyond its ends.

    Parameters
    ----------
    profile : Profile
        The road.
    radius : float
        Of the disc [m].

    Notes
    -----
    The disc's centre is as high as the highest of ``z(s + x) + sqrt(R^2 - x^2)``, -R <= x <= R: a
    grey dilation by the disc. It is taken at samples a two-hundredth of the radius apart, and at
    every point of the road; straight lines join them.
    """
    step = radius / _FINE
    first, last = float(profile.station[0]), float(profile.station[-1])
    station = first + step * np.arange(int(np.ceil((last - first) / step)) + 1)
    lying = profile.at(station)[0]
    own = profile.station  # corners lie between samples: each lifts its nearest one
    nearest = np.clip(np.round((own - first) / step).astype(int), 0, len(station) - 1)
    np.maximum.at(lying, nearest, profile.elevation)
    across = step * np.arange(-_FINE, _FINE + 1)
    disc = np.sqrt(np.maximum(radius**2 - across**2, 0.0)) - radius
    every = np.ones(len(disc), dtype=bool)
    path = np.asarray(
        ndimage.grey_dilation(lying, footprint=every, structure=disc, mode="nearest")  # pyright: ignore[reportCallIssue, reportArgumentType] - scipy's stubs know whole numbers alone
    )
    return Profile.piecewise_linear(*_thinned(station, path), beyond="level")


def _thinned(station: Array, path: Array) -> tuple[Array, Array]:
    """Leave out points on level stretches."""
    level = np.abs(np.diff(path)) <= _FLAT
    inner = np.concatenate([[False], level[1:] & level[:-1], [False]])
    return station[~inner], path[~inner]

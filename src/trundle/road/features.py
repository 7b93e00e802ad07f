"""Lay joints, potholes, patches, humps and the like on a road, as a tyre's tread meets them.

A point on a step would be thrown up in no time. A tyre stands on a patch of some length, and its
tread is a row of springs there (the fixed-footprint model): each presses only where it reaches the
ground, so that a gap counts as no deeper than the tyre is compressed by its static load, and what
the axle feels is the mean over the patch. The first is done here, to each gap; the second by who
drives, to the whole road (`Profile.averaged`). A hard wheel does not sink into a gap narrower than
itself: of one with a radius the path of its lowest point is taken, which is the road rolled over by
a disc.

References: D. J. Captain, A. B. Boghani, D. N. Wormley, Analytical tire models for dynamic vehicle
simulation, Vehicle System Dynamics 8 (1979) 1-32 (fixed footprint, rigid tread band).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np

from trundle._checks import finite, non_negative, set_frozen
from trundle._typing import Array
from trundle.errors import InputError
from trundle.road._rolling import rolled
from trundle.road._sums import added
from trundle.road.profile import Profile

__all__ = ["Feature", "Shape", "Tread", "laid"]

_STEEPEST = 1.4  # rad: a line across a road at 80 degrees to its square is one along it
_LEVEL_BEYOND = 1.0  # m of level road before the first and behind the last feature
_BOTTOM = 1.0  # m: what a gap without a bottom is deep for a wheel that does not sink


@dataclass(frozen=True, kw_only=True)
class Tread:
    """Hold how a tyre meets what is shorter than itself.

    Attributes
    ----------
    sinking : float
        How far its static load compresses it [m]: no gap counts as deeper.
    radius : float
        Radius of a wheel that rolls over gaps as a disc does [m]; 0 for a soft tyre.
    """

    sinking: float = np.inf
    radius: float = 0.0

    def __post_init__(self) -> None:
        """Check that neither is negative."""
        if not self.sinking >= 0.0:
            raise InputError(f"sinking must be 0 or more; got {self.sinking} m")
        set_frozen(self, radius=non_negative("radius", self.radius))


@runtime_checkable
class Shape(Protocol):
    """What one feature looks like along the road."""

    def outline(self, sinking: float) -> Profile:
        """Return its height from its own start on, level beyond its ends.

        Parameters
        ----------
        sinking : float
            What a gap without a bottom is deep [m].
        """
        ...


@dataclass(frozen=True, kw_only=True, eq=False)
class Feature:
    """Hold a feature and where it lies.

    Attributes
    ----------
    shape : Shape
        What it looks like.
    station : float
        Where it begins, on the centre line [m]: from the route's start, or in the chainage of a
        measured road.
    skew : float
        Angle of a line across the road to its square [rad]; positive where the left wheel meets
        it later.
    across : tuple of float
        Where it lies across the road, from right to left, positive to the left of the centre
        line [m].
    route : str or None
        Name of the only route that meets it; None for all.
    """

    shape: Shape
    station: float
    skew: float = 0.0
    across: tuple[float, float] = (-np.inf, np.inf)
    route: str | None = None

    def __post_init__(self) -> None:
        """Check the angle, and that it lies somewhere."""
        set_frozen(self, station=finite("station of a feature", self.station))
        if abs(finite("skew", self.skew)) > _STEEPEST:
            raise InputError(
                f"skew must be within 80 degrees; got {np.rad2deg(self.skew):g} degrees: 0 is "
                "square to the road"
            )
        low, high = self.across
        if not low < high:
            raise InputError(f"across must rise, from right to left; got {low:g} to {high:g} m")

    def reaches(self, lateral: float) -> bool:
        """Return whether it lies under a track [m to the left of the centre line]."""
        return self.across[0] <= lateral <= self.across[1]

    def begins(self, lateral: float) -> float:
        """Return the station at which a track meets it [m]."""
        return self.station + lateral * float(np.tan(self.skew))


def laid(features: Sequence[Feature], lateral: float, tread: Tread) -> Profile:
    """Return the heights of features under one track; where two overlap they add.

    Parameters
    ----------
    features : sequence of Feature
        One or more.
    lateral : float
        The track's distance to the left of the centre line [m].
    tread : Tread
        What meets them.

    Returns
    -------
    Profile
        Level beyond the first and the last of them.
    """
    depth = tread.sinking if np.isfinite(tread.sinking) else _BOTTOM
    shapes = [one.shape.outline(depth).moved(one.begins(lateral)) for one in features]
    margin = _LEVEL_BEYOND + tread.radius
    ends = np.array([-margin, margin])
    ends += [min(p.station[0] for p in shapes), max(p.station[-1] for p in shapes)]
    whole = Profile(station=ends, elevation=np.zeros(2), slope=np.zeros(2), beyond="level")
    for chain in _chains(shapes):
        whole = added(whole, chain)
    return whole if tread.radius == 0.0 else rolled(whole, tread.radius)


def _chains(shapes: Sequence[Profile]) -> list[Profile]:
    """Join outlines that end where they began and do not meet, so that few are left to add."""
    chains: list[list[Profile]] = []
    for shape in sorted(shapes, key=lambda one: float(one.station[0])):
        room = (c for c in chains if _returns(c[-1]) and c[-1].station[-1] < shape.station[0])
        if _returns(shape) and (chain := next(room, None)) is not None:
            chain.append(shape)
        else:
            chains.append([shape])
    return [_joined(chain) for chain in chains]


def _returns(shape: Profile) -> bool:
    """Return whether an outline begins and ends at no height."""
    return bool(shape.elevation[0] == 0.0 and shape.elevation[-1] == 0.0)


def _joined(chain: Sequence[Profile]) -> Profile:
    """Return outlines behind each other, level between them and beyond."""
    pieces: list[Array] = []
    for one in chain:
        body = np.array([one.station, one.elevation, one.slope])
        ends = body[:, [0, -1]] * [[1.0], [1.0], [0.0]]
        pieces += [ends[:, :1], body, ends[:, 1:]]
    station, elevation, slope = np.concatenate(pieces, axis=1)
    return Profile(station=station, elevation=elevation, slope=slope, beyond="level")

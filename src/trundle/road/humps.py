"""What bumps, humps and ramps look like along a road: curves.

Lengths are along the road [m], heights up positive [m].
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from trundle._checks import non_negative, positive, set_frozen
from trundle.errors import InputError
from trundle.road._outlines import height_of, lines
from trundle.road.profile import Profile

__all__ = ["Bump", "CosineHump", "RampKink"]

_STEEPEST = 0.5  # m/m, of a ramp
_CURVE = 33  # points to half a wave; the cubic between them is within 1e-7 of it


@dataclass(frozen=True, kw_only=True)
class Bump:
    """Hold a bump of half a sine: ``h sin(pi x / l)``.

    Attributes
    ----------
    length : float
        From foot to foot [m].
    height : float
        At its middle [m].
    """

    length: float
    height: float

    def __post_init__(self) -> None:
        """Check both."""
        set_frozen(
            self, length=positive("length", self.length), height=height_of("height", self.height)
        )

    def outline(self, sinking: float) -> Profile:
        """Return its height [m]."""
        del sinking
        x = np.linspace(0.0, 1.0, _CURVE)
        z = self.height * np.sin(np.pi * x)
        slope = self.height * np.pi / self.length * np.cos(np.pi * x)
        z[[0, -1]] = 0.0
        return Profile(station=self.length * x, elevation=z, slope=slope, beyond="level")


@dataclass(frozen=True, kw_only=True)
class CosineHump:
    """Hold a hump that begins and ends level: ``h (1 - cos(2 pi x / l)) / 2``.

    Attributes
    ----------
    length : float
        From foot to foot [m].
    height : float
        At its middle [m].
    """

    length: float
    height: float

    def __post_init__(self) -> None:
        """Check both."""
        set_frozen(
            self, length=positive("length", self.length), height=height_of("height", self.height)
        )

    def outline(self, sinking: float) -> Profile:
        """Return its height [m]."""
        del sinking
        x = np.linspace(0.0, 1.0, 2 * _CURVE - 1)
        z = 0.5 * self.height * (1.0 - np.cos(2.0 * np.pi * x))
        slope = self.height * np.pi / self.length * np.sin(2.0 * np.pi * x)
        z[[0, -1]] = 0.0
        return Profile(station=self.length * x, elevation=z, slope=slope, beyond="level")


@dataclass(frozen=True, kw_only=True)
class RampKink:
    """Hold a change of grade, rounded over a length, and the way until the road is level again.

    Attributes
    ----------
    grade : float
        Rise over run behind the kink [m/m], relative to the road before it.
    length : float
        From the kink until the road turns back into its former grade [m].
    rounding : float
        Length of the vertical curve at either end, half of it on each side of the kink [m].
    """

    grade: float
    length: float
    rounding: float = 0.0

    def __post_init__(self) -> None:
        """Check that both curves fit."""
        set_frozen(
            self,
            grade=height_of("grade", self.grade),
            length=positive("length", self.length),
            rounding=non_negative("rounding", self.rounding),
        )
        if abs(self.grade) > _STEEPEST:
            raise InputError(
                f"grade must be within {_STEEPEST:g} m/m; got {self.grade:g}: 5 % is 0.05"
            )
        if self.rounding > self.length:
            raise InputError(
                f"rounding must be at most the ramp's length, {self.length:g} m; got "
                f"{self.rounding:g} m"
            )

    def outline(self, sinking: float) -> Profile:
        """Return its height [m]; rounded by parabolas, it begins half a rounding early."""
        del sinking
        half, top = 0.5 * self.rounding, self.grade * self.length
        if half == 0.0:
            return lines([(0.0, 0.0), (self.length, top)])
        s = np.array([-half, half, self.length - half, self.length + half])
        z = np.array([0.0, self.grade * half, top - self.grade * half, top])
        slope = np.array([0.0, self.grade, self.grade, 0.0])
        return Profile(station=s, elevation=z, slope=slope, beyond="level")

"""What discontinuities look like along a road: one class a kind.

Lengths are along the road [m], heights up positive [m]; walls are drawn over a chamfer of 2 mm.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from trundle._checks import finite, non_negative, positive, set_frozen
from trundle.errors import InputError
from trundle.road.profile import Profile

__all__ = [
    "Bump",
    "CableProtector",
    "CosineHump",
    "ExpansionJoint",
    "Patch",
    "Pothole",
    "RailCrossing",
    "RampKink",
]

_WALL = 2e-3  # m: a wall is drawn over so much
_WIDEST = 0.5  # m, of a gap
_STEEPEST = 0.5  # m/m, of a ramp
_CURVE = 33  # points to half a wave; the cubic between them is within 1e-7 of it
RAIL_GAUGE = 1.435
"""Between the heads of rails of standard gauge [m]."""


@dataclass(frozen=True, kw_only=True)
class ExpansionJoint:
    """Hold a joint between two slabs: a gap, a step, or both.

    Attributes
    ----------
    gap : float
        Width of the gap [m].
    depth : float or None
        Its depth [m]; None is deeper than any tyre reaches.
    step : float
        Height of the far edge above the near one [m]; negative drops.
    runout : float or None
        Length over which the far slab returns to the level before the joint [m]; None stays.
    """

    gap: float = 0.0
    depth: float | None = None
    step: float = 0.0
    runout: float | None = None

    def __post_init__(self) -> None:
        """Check that there is a joint."""
        set_frozen(self, gap=non_negative("gap", self.gap), step=finite("step", self.step))
        if self.depth is not None:
            set_frozen(self, depth=positive("depth", self.depth))
        if self.runout is not None:
            set_frozen(self, runout=positive("runout", self.runout))
        if self.gap == 0.0 and self.step == 0.0:
            raise InputError("a joint has a gap or a step: give one")
        if self.gap and not 2.0 * _WALL <= self.gap <= _WIDEST:
            raise InputError(
                f"gap must be {2e3 * _WALL:g} mm to {_WIDEST:g} m; got {self.gap:g} m: a wider one "
                "is a pothole"
            )

    def outline(self, sinking: float) -> Profile:
        """Return its height [m]; of a gap no more depth than a tyre sinks in."""
        corners = [(0.0, 0.0)]
        if self.gap:
            low = -min(sinking, self.depth or sinking)
            corners += [(_WALL, low), (self.gap - _WALL, low), (self.gap, self.step)]
        else:
            corners += [(_WALL, self.step)]
        if self.runout is not None and self.step:
            corners += [(corners[-1][0] + self.runout, 0.0)]
        return _lines(corners)


@dataclass(frozen=True, kw_only=True)
class Patch:
    """Hold a plate or a patch: level at some height, between two ramps.

    Attributes
    ----------
    length : float
        From foot to foot [m].
    height : float
        Its height [m]; negative lies lower.
    ramp : float
        Length of the ramp at either end [m]; a wall unless given.
    """

    length: float
    height: float
    ramp: float = _WALL

    def __post_init__(self) -> None:
        """Check that both ramps fit."""
        set_frozen(
            self,
            length=positive("length", self.length),
            height=_some("height", self.height),
            ramp=max(positive("ramp", self.ramp), _WALL),
        )
        _check_ramps(self.length, self.ramp)

    def outline(self, sinking: float) -> Profile:
        """Return its height [m]."""
        del sinking
        return _plateau(self.length, self.height, self.ramp)


@dataclass(frozen=True, kw_only=True)
class Pothole:
    """Hold a hole with a level bottom; all of its depth counts, however short it is.

    Attributes
    ----------
    length : float
        From rim to rim [m].
    depth : float
        Its depth [m].
    edge : float
        Length of each side [m]; a wall unless given.
    """

    length: float
    depth: float
    edge: float = _WALL

    def __post_init__(self) -> None:
        """Check that both sides fit."""
        set_frozen(
            self,
            length=positive("length", self.length),
            depth=positive("depth", self.depth),
            edge=max(positive("edge", self.edge), _WALL),
        )
        _check_ramps(self.length, self.edge)

    def outline(self, sinking: float) -> Profile:
        """Return its height [m]."""
        del sinking
        return _plateau(self.length, -self.depth, self.edge)


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
            self, length=positive("length", self.length), height=_some("height", self.height)
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
            self, length=positive("length", self.length), height=_some("height", self.height)
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
            grade=_some("grade", self.grade),
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
            return _lines([(0.0, 0.0), (self.length, top)])
        s = np.array([-half, half, self.length - half, self.length + half])
        z = np.array([0.0, self.grade * half, top - self.grade * half, top])
        slope = np.array([0.0, self.grade, self.grade, 0.0])
        return Profile(station=s, elevation=z, slope=slope, beyond="level")


@dataclass(frozen=True, kw_only=True)
class RailCrossing:
    """Hold a level crossing of two rails: a rail head and a flangeway each.

    Attributes
    ----------
    flangeway : float
        Width of the groove beside each rail [m].
    depth : float
        Its depth [m].
    head : float
        Width of a rail's head [m].
    proud : float
        How far heads stand above the road [m]; negative lies lower.
    gauge : float
        Between the inner sides of the heads [m].
    """

    flangeway: float = 0.065
    depth: float = 0.04
    head: float = 0.07
    proud: float = 0.0
    gauge: float = RAIL_GAUGE

    def __post_init__(self) -> None:
        """Check that there is room for all."""
        for name in ("flangeway", "depth", "head", "gauge"):
            set_frozen(self, **{name: positive(name, getattr(self, name))})
        set_frozen(self, proud=finite("proud", self.proud))
        if self.gauge <= 2.0 * self.flangeway or min(self.flangeway, self.head) < 3.0 * _WALL:
            raise InputError(
                f"a crossing of gauge {self.gauge:g} m has no room for heads of {self.head:g} m "
                f"and grooves of {self.flangeway:g} m"
            )

    def outline(self, sinking: float) -> Profile:
        """Return its height [m]: head, groove, groove, head."""
        low, up, w = -min(sinking, self.depth), self.proud, _WALL
        a, b = self.head, self.head + self.flangeway
        near = [(0.0, 0.0), (w, up), (a - w, up), (a, low), (b - w, low), (b, 0.0)]
        whole = 2.0 * self.head + self.gauge
        return _lines([*near, *((whole - s, z) for s, z in reversed(near))])


@dataclass(frozen=True, kw_only=True)
class CableProtector:
    """Hold a trapezoid that lies on the road: a cable protector, a threshold, a hose bridge.

    Attributes
    ----------
    length : float
        From foot to foot [m].
    height : float
        Of its top [m].
    top : float
        Length of its top [m].
    """

    length: float
    height: float
    top: float

    def __post_init__(self) -> None:
        """Check that it is wider below."""
        set_frozen(
            self,
            length=positive("length", self.length),
            height=positive("height", self.height),
            top=positive("top", self.top),
        )
        if self.top >= self.length:
            raise InputError(f"top must be below length, {self.length:g} m; got {self.top:g} m")
        _check_ramps(self.length, 0.5 * (self.length - self.top))

    def outline(self, sinking: float) -> Profile:
        """Return its height [m]."""
        del sinking
        return _plateau(self.length, self.height, 0.5 * (self.length - self.top))


def _plateau(length: float, height: float, ramp: float) -> Profile:
    return _lines([(0.0, 0.0), (ramp, height), (length - ramp, height), (length, 0.0)])


def _lines(corners: Sequence[tuple[float, float]]) -> Profile:
    return Profile.piecewise_linear(*np.array(corners).T, beyond="level")


def _some(name: str, value: float) -> float:
    if finite(name, value) == 0.0:
        raise InputError(f"{name} must not be 0: there would be nothing")
    return float(value)


def _check_ramps(length: float, ramp: float) -> None:
    if not _WALL <= ramp < 0.5 * length:
        raise InputError(
            f"its two sides of {ramp:g} m each do not fit into its length of {length:g} m"
        )

"""What joints, holes, plates and rails look like along a road: straight lines.

Lengths are along the road [m], heights up positive [m]; walls are drawn over a chamfer of 2 mm.
"""

from __future__ import annotations

from dataclasses import dataclass

from trundle._checks import finite, non_negative, positive, set_frozen
from trundle.errors import InputError
from trundle.road._outlines import WALL, check_ramps, height_of, lines, plateau
from trundle.road.profile import Profile

__all__ = ["CableProtector", "ExpansionJoint", "Patch", "Pothole", "RailCrossing"]

_WIDEST = 0.5  # m, of a gap
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
        if self.gap and not 2.0 * WALL <= self.gap <= _WIDEST:
            raise InputError(
                f"gap must be {2e3 * WALL:g} mm to {_WIDEST:g} m; got {self.gap:g} m: a wider one "
                "is a pothole"
            )

    def outline(self, sinking: float) -> Profile:
        """Return its height [m]; of a gap no more depth than a tyre sinks in."""
        corners = [(0.0, 0.0)]
        if self.gap:
            low = -min(sinking, self.depth or sinking)
            # one corner and not two where the walls of the narrowest gap meet
            below = dict.fromkeys([(WALL, low), (self.gap - WALL, low)])
            corners += [*below, (self.gap, self.step)]
        else:
            corners += [(WALL, self.step)]
        if self.runout is not None and self.step:
            corners += [(corners[-1][0] + self.runout, 0.0)]
        return lines(corners)


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
    ramp: float = WALL

    def __post_init__(self) -> None:
        """Check that both ramps fit."""
        set_frozen(
            self,
            length=positive("length", self.length),
            height=height_of("height", self.height),
            ramp=max(positive("ramp", self.ramp), WALL),
        )
        check_ramps(self.length, self.ramp)

    def outline(self, sinking: float) -> Profile:
        """Return its height [m]."""
        del sinking
        return plateau(self.length, self.height, self.ramp)


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
    edge: float = WALL

    def __post_init__(self) -> None:
        """Check that both sides fit."""
        set_frozen(
            self,
            length=positive("length", self.length),
            depth=positive("depth", self.depth),
            edge=max(positive("edge", self.edge), WALL),
        )
        check_ramps(self.length, self.edge)

    def outline(self, sinking: float) -> Profile:
        """Return its height [m]."""
        del sinking
        return plateau(self.length, -self.depth, self.edge)


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
        if self.gauge <= 2.0 * self.flangeway or min(self.flangeway, self.head) < 3.0 * WALL:
            raise InputError(
                f"a crossing of gauge {self.gauge:g} m has no room for heads of {self.head:g} m "
                f"and grooves of {self.flangeway:g} m"
            )

    def outline(self, sinking: float) -> Profile:
        """Return its height [m]: head, groove, groove, head."""
        low, up, w = -min(sinking, self.depth), self.proud, WALL
        a, b = self.head, self.head + self.flangeway
        near = [(0.0, 0.0), (w, up), (a - w, up), (a, low), (b - w, low), (b, 0.0)]
        whole = 2.0 * self.head + self.gauge
        return lines([*near, *((whole - s, z) for s, z in reversed(near))])


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
        check_ramps(self.length, 0.5 * (self.length - self.top))

    def outline(self, sinking: float) -> Profile:
        """Return its height [m]."""
        del sinking
        return plateau(self.length, self.height, 0.5 * (self.length - self.top))

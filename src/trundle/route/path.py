"""Describe where a vehicle goes and how fast."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float

from trundle._checks import finite, frozen_array, positive, set_frozen
from trundle._kinds import kinds_checked
from trundle._typing import Array, ArrayLike
from trundle.errors import InputError

__all__ = ["ConstantSpeed", "Route", "SpeedLaw", "SteadyAcceleration"]


@runtime_checkable
class SpeedLaw(Protocol):
    """Give distance travelled and speed as functions of time."""

    def distance(self, time: ArrayLike) -> Float[Array, ...]:
        """Return the distance travelled since time 0 [m]; negative before it."""
        ...

    def speed(self, time: ArrayLike) -> Float[Array, ...]:
        """Return the speed [m/s]."""
        ...

    def time_to(self, distance: float) -> float:
        """Return the time at which a distance has been travelled [s]."""
        ...


@dataclass(frozen=True)
class ConstantSpeed:
    """Hold one speed for ever.

    Attributes
    ----------
    value : float
        Speed V [m/s].
    """

    value: float

    def __post_init__(self) -> None:
        """Check the speed."""
        set_frozen(self, value=positive("speed", self.value))

    def distance(self, time: ArrayLike) -> Float[Array, ...]:
        """Return V t [m]."""
        return np.asarray(self.value * np.asarray(time, float))

    def speed(self, time: ArrayLike) -> Float[Array, ...]:
        """Return V at every time [m/s]."""
        return np.full_like(np.asarray(time, float), self.value)

    def time_to(self, distance: float) -> float:
        """Return s / V [s]."""
        return distance / self.value


@dataclass(frozen=True, kw_only=True)
class SteadyAcceleration:
    """Start at a speed and change it at a steady rate; before time 0 the speed is steady.

    Attributes
    ----------
    initial : float
        Speed at time 0 [m/s].
    acceleration : float
        Rate of change [m/s2]; negative brakes until the vehicle stands still.
    """

    initial: float
    acceleration: float

    def __post_init__(self) -> None:
        """Check both numbers."""
        set_frozen(
            self,
            initial=positive("initial speed", self.initial),
            acceleration=finite("acceleration", self.acceleration),
        )

    def _moving_time(self, time: ArrayLike) -> Array:
        t = np.asarray(time, float)
        if self.acceleration < 0.0:
            t = np.asarray(np.minimum(t, -self.initial / self.acceleration))
        return t

    def distance(self, time: ArrayLike) -> Float[Array, ...]:
        """Return ``v0 t + a t^2 / 2`` [m]."""
        t = self._moving_time(time)
        return np.asarray(self.initial * t + 0.5 * self.acceleration * np.maximum(t, 0.0) ** 2)

    def speed(self, time: ArrayLike) -> Float[Array, ...]:
        """Return ``v0 + a t`` [m/s]."""
        moving = np.maximum(self._moving_time(time), 0.0)
        return np.asarray(self.initial + self.acceleration * moving)

    def time_to(self, distance: float) -> float:
        """Return the time at which a distance is reached, infinity if it never is [s]."""
        if distance <= 0.0 or self.acceleration == 0.0:
            return distance / self.initial
        square = self.initial**2 + 2.0 * self.acceleration * distance
        if square < 0.0:
            return float("inf")
        return 2.0 * distance / (self.initial + float(np.sqrt(square)))


@kinds_checked
@dataclass(frozen=True, kw_only=True, eq=False)
class Route:
    """Hold a polyline on the floor and the speed along it.

    Attributes
    ----------
    points : ndarray of float, shape (n_points, 2)
        Corners of the centre line in plan [m], in driving order.
    law : SpeedLaw
        Speed of the front axle; time 0 is when it stands at the crossing's start.
    name : str
        Name for tables.
    on : str or None
        Name of the surface that the line lies on; None where a structure has only one.
    """

    points: Float[Array, "points 2"]
    law: SpeedLaw
    name: str = "route"
    on: str | None = None

    def __post_init__(self) -> None:
        """Check that the line has a length everywhere."""
        points = frozen_array("route points", self.points, shape=(None, 2))
        if len(points) < 2:
            raise InputError(f"route {self.name!r} needs at least 2 points; got {len(points)}")
        if np.any(np.linalg.norm(np.diff(points, axis=0), axis=1) <= 0.0):
            raise InputError(f"route {self.name!r} gives the same point twice in a row")
        set_frozen(self, points=points)

    @classmethod
    def straight(
        cls, start: ArrayLike, end: ArrayLike, *, speed: float, name: str = "route"
    ) -> Route:
        """Drive from one point to another [m] at constant speed [m/s]."""
        ends = np.array([start, end], dtype=float)
        return cls(points=ends, law=ConstantSpeed(speed), name=name)

    @property
    def corner_stations(self) -> Float[Array, " points"]:
        """Distance of each corner from the start [m]."""
        steps = np.linalg.norm(np.diff(self.points, axis=0), axis=1)
        return np.concatenate([[0.0], np.cumsum(steps)])

    @property
    def length(self) -> float:
        """Length of the line [m]."""
        return float(self.corner_stations[-1])

    def reversed(self) -> Route:
        """Return the same line driven the other way."""
        return replace(self, points=self.points[::-1])

    def locate(
        self, station: ArrayLike, lateral: ArrayLike = 0.0
    ) -> tuple[Float[Array, "n 2"], Float[Array, "n 2"]]:
        """Return places in plan [m] and unit directions of travel.

        Parameters
        ----------
        station : array_like of float, shape (n,)
            Distance along the line [m]; clipped to its ends.
        lateral : array_like of float
            Distance to the left of the line [m].
        """
        corners = self.corner_stations
        s = np.clip(np.asarray(station, float), 0.0, corners[-1])
        leg = np.clip(np.searchsorted(corners, s, "right") - 1, 0, len(corners) - 2)
        along = np.diff(self.points, axis=0) / np.diff(corners)[:, None]
        direction = along[leg]
        left = np.stack([-direction[:, 1], direction[:, 0]], axis=1)
        place = self.points[leg] + (s - corners[leg])[:, None] * direction
        return place + np.broadcast_to(lateral, s.shape)[:, None] * left, direction

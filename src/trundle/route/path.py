"""Describe where a vehicle goes."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Literal, TypeAlias, get_args

import numpy as np
from jaxtyping import Float, Int

from trundle._checks import finite, frozen_array, non_negative, one_of, set_frozen
from trundle._kinds import kinds_checked
from trundle._typing import Array, ArrayLike
from trundle.errors import InputError
from trundle.route.legs import Legs, legs_of
from trundle.route.speed import ConstantSpeed, SpeedLaw

__all__ = ["Route", "Steering"]

_THERE = 1e-6  # m
_DRAWN = 25  # places on an arc, where it is drawn

Steering: TypeAlias = Literal["path", "tractrix"]
"""Where wheels behind the first go: each along the route, or pulled by what is before them."""


@kinds_checked
@dataclass(frozen=True, kw_only=True, eq=False)
class Route:
    """Hold a way of lines and arcs on the floor and the speed along it.

    Attributes
    ----------
    points : ndarray of float, shape (n_points, 2)
        Start, corners and end of the way in plan [m], in driving order.
    law : SpeedLaw
        Speed of the front axle; time 0 is when it stands at the crossing's start.
    name : str
        Name for tables.
    on : str or None
        Name of the surface that the way lies on; None where a structure has only one.
    surfaces : tuple of str
        Name of the surface of every leg between two points, of a way through several: over a ramp
        from one storey to another. Its points, stations and speeds are then those in plan.
    radius : float
        By which corners are rounded [m]; 0 leaves them sharp, for wheels on the line alone.
    lane : float
        Distance of the line that is driven to the left of the way [m].
    steering : {"path", "tractrix"}
        Every wheel goes along the way; or the front axle does, and what follows is pulled, so that
        it cuts corners.
    reverse : bool
        Whether the vehicle drives backwards, its last axle first.
    """

    points: Float[Array, "points 2"]
    law: SpeedLaw
    name: str = "route"
    on: str | None = None
    surfaces: tuple[str, ...] = ()
    radius: float = 0.0
    lane: float = 0.0
    steering: Steering = "path"
    reverse: bool = False

    def __post_init__(self) -> None:
        """Check that the line has a length everywhere."""
        points = frozen_array("route points", self.points, shape=(None, 2))
        if len(points) < 2:
            raise InputError(f"route {self.name!r} needs at least 2 points; got {len(points)}")
        if np.any(np.linalg.norm(np.diff(points, axis=0), axis=1) <= 0.0):
            raise InputError(f"route {self.name!r} gives the same point twice in a row")
        one_of("steering", self.steering, get_args(Steering))
        set_frozen(
            self,
            points=points,
            radius=non_negative("radius", self.radius),
            lane=finite("lane", self.lane),
        )
        self._check_surfaces()
        bends = self.legs.curvature
        if np.any(1.0 - bends * self.lane <= 0.0):
            raise InputError(
                f"route {self.name!r}: a lane {self.lane:g} m aside has no way round a corner of "
                f"{self.radius:g} m: give a larger radius"
            )

    def _check_surfaces(self) -> None:
        """Refuse surfaces that are not one a leg, or that meet in a rounded corner."""
        if not self.surfaces:
            return
        if self.on is not None or len(self.surfaces) != len(self.points) - 1:
            raise InputError(
                f"route {self.name!r} has {len(self.points) - 1} legs: name the surface of each, "
                f"or one for all; got {len(self.surfaces)}"
            )
        _ = self.breaks

    @classmethod
    def straight(
        cls, start: ArrayLike, end: ArrayLike, *, speed: float, name: str = "route"
    ) -> Route:
        """Drive from one point to another [m] at constant speed [m/s]."""
        ends = np.array([start, end], dtype=float)
        return cls(points=ends, law=ConstantSpeed(speed), name=name)

    @cached_property
    def legs(self) -> Legs:
        """The way as lines and arcs."""
        return legs_of(self.points, self.radius, self.name)

    @cached_property
    def breaks(self) -> Float[Array, " changes"]:
        """Where it comes onto another surface, as stations [m].

        Raises
        ------
        InputError
            One that lies in a rounded corner.
        """
        at = [i for i in range(1, len(self.surfaces)) if self.surfaces[i] != self.surfaces[i - 1]]
        ends = self.legs.station
        places = self.legs.at(ends)[0]
        found: list[float] = []
        for i in at:
            away = np.linalg.norm(places - self.points[i], axis=1)
            if away.min() > _THERE:
                x, y = self.points[i]
                raise InputError(
                    f"route {self.name!r} comes onto {self.surfaces[i]!r} at ({x:g}, {y:g}) m, in "
                    "a corner that is rounded: let it come there straight"
                )
            found.append(float(ends[int(away.argmin())]))
        return np.array(found)

    @property
    def visited(self) -> tuple[str | None, ...]:
        """Which surfaces it comes onto, in that order."""
        if not self.surfaces:
            return (self.on,)
        pairs = zip(self.surfaces, ("", *self.surfaces), strict=False)
        return tuple(one for one, before in pairs if one != before)

    def leg_of(self, station: ArrayLike) -> Int[Array, ...]:
        """Return which of the surfaces visited stations lie on, from 0."""
        return np.searchsorted(self.breaks, np.asarray(station, float), "right")

    @property
    def length(self) -> float:
        """Length of the way [m]."""
        return self.legs.length

    @property
    def has_sharp_corners(self) -> bool:
        """Whether the way turns anywhere without an arc."""
        turns = np.abs(np.diff(self.legs.direction, axis=0)).max(initial=0.0)
        return self.radius == 0.0 and bool(turns > 1e-9)

    @property
    def line(self) -> Float[Array, "places 2"]:
        """The way as places, close enough to draw it [m]."""
        if self.radius == 0.0 and self.lane == 0.0:
            return self.points
        ends = np.concatenate([self.legs.station, self.breaks])
        bent = np.flatnonzero(self.legs.curvature)
        legs = self.legs.station
        arcs = [np.linspace(legs[i], legs[i + 1], _DRAWN) for i in bent]
        return self.locate(np.unique(np.concatenate([ends, *arcs])))[0]

    def line_on(self, name: str | None) -> Float[Array, "places 2"]:
        """Return what of the line lies on a surface; nothing if none of it does.

        In the surface's own axes, or in plan if the way leads through several.
        """
        if not self.surfaces:
            return self.line if name in (self.on, None) or self.on is None else self.line[:0]
        edges = np.concatenate([[0.0], self.breaks, [self.length]])
        parts = [
            np.linspace(low, high, _DRAWN)
            for low, high, there in zip(edges[:-1], edges[1:], self.visited, strict=True)
            if there == name or name is None
        ]
        return self.locate(np.concatenate(parts))[0] if parts else self.line[:0]

    def reversed(self) -> Route:
        """Return the same line driven the other way."""
        return replace(self, points=self.points[::-1], lane=-self.lane)

    def locate(
        self, station: ArrayLike, lateral: ArrayLike = 0.0
    ) -> tuple[Float[Array, "n 2"], Float[Array, "n 2"]]:
        """Return places in plan [m] and unit directions of travel.

        Parameters
        ----------
        station : array_like of float, shape (n,)
            Distance along the way [m]; clipped to its ends.
        lateral : array_like of float
            Distance to the left of the line that is driven [m].
        """
        s = np.clip(np.asarray(station, float), 0.0, self.length)
        place, direction, _ = self.legs.at(s)
        left = np.stack([-direction[:, 1], direction[:, 0]], axis=1)
        aside = np.broadcast_to(np.asarray(lateral, float) + self.lane, s.shape)
        return place + aside[:, None] * left, direction

    def stretch(self, station: ArrayLike, lateral: ArrayLike = 0.0) -> Float[Array, " n"]:
        """Return how much faster than along the way something beside it goes: ``1 - k y``."""
        s = np.clip(np.asarray(station, float), 0.0, self.length)
        bend = self.legs.at(s)[2]
        return np.asarray(1.0 - bend * (np.asarray(lateral, float) + self.lane))

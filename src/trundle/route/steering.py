"""Say where every wheel goes: each along the way, or pulled along by what is before it.

A unit (a tractor, a trailer) is led at one place and rolls without sliding aside at another, its
pivot, a length l behind. With u its direction and h' how its lead moves per metre of the way, its
angle changes by ``psi' = (u x h') / l``: the tractrix, if the lead goes straight. Its coupling
moves by ``h' - d psi' n``, n to its left and d the distance behind the lead, and leads the next
unit. One system of ordinary equations over the way's length gives all angles, and places follow.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float
from scipy import integrate

from trundle._typing import Array
from trundle.route.path import Route

__all__ = ["Footprint", "Led", "WheelPlaces", "wheel_places"]

_TOLERANCE = 1e-9  # rad
_NEAR_END = 3.0  # m from an end of the way, within which wheels may stand beyond it
_LONGEST = 0.5  # m between two evaluations, so that no arc is stepped over


@runtime_checkable
class Led(Protocol):
    """A part of a vehicle that turns as one: see `trundle.vehicle.Unit`."""

    @property
    def lead(self) -> float:
        """Where it is led [m]."""
        ...

    @property
    def pivot(self) -> float:
        """Where it rolls without sliding aside [m]."""
        ...

    @property
    def contacts(self) -> tuple[int, ...]:
        """Which wheels are on it, by number."""
        ...


@dataclass(frozen=True, kw_only=True, eq=False)
class Footprint:
    """Hold where a vehicle's wheels are on it.

    Attributes
    ----------
    setback, lateral : ndarray of float, shape (n_contacts,)
        Behind its front axle, and to the left of its centre line [m].
    units : tuple
        What turns as one, from the front; nothing where all goes along the way.
    """

    setback: Float[Array, " contacts"]
    lateral: Float[Array, " contacts"]
    units: tuple[Led, ...] = ()


@dataclass(frozen=True, kw_only=True, eq=False)
class WheelPlaces:
    """Hold where wheels are, shape (n_steps, n_contacts, ...).

    Attributes
    ----------
    place, direction : ndarray of float, shape (n_steps, n_contacts, 2)
        Places [m], and unit directions in which they move.
    stretch : ndarray of float, shape (n_steps, n_contacts)
        How far each moves over how far the front axle has come along the way.
    """

    place: Float[Array, "steps contacts 2"]
    direction: Float[Array, "steps contacts 2"]
    stretch: Float[Array, "steps contacts"]


def wheel_places(route: Route, footprint: Footprint, front: Float[Array, " steps"]) -> WheelPlaces:
    """Return where all wheels are when the front axle is at some stations.

    Parameters
    ----------
    route : Route
        The way, and how wheels follow it.
    footprint : Footprint
        Where they are on the vehicle.
    front : ndarray of float, shape (n_steps,)
        Stations of the front axle [m]; wheels that are not on the way yet, or no longer, are put
        at its ends.
    """
    made = _along(route, footprint, front)
    if route.steering == "path" or not footprint.units:
        return made
    station = front[:, None] - footprint.setback
    inside = (station >= 0.0) & (station <= route.length)
    pulled = _between_ends(route, _pulled(route, footprint, front), station)
    for ours, theirs in (
        (made.place, pulled.place),
        (made.direction, pulled.direction),
        (made.stretch, pulled.stretch),
    ):
        some = inside & np.isfinite(pulled.stretch)
        ours[some] = theirs[some]
    return made


def _between_ends(route: Route, wheels: WheelPlaces, station: Array) -> WheelPlaces:
    """Draw back wheels that are still askew at the way's end, and stand a trace beyond it."""
    place = wheels.place.copy()
    ends, ways, _ = route.legs.at(np.array([0.0, route.length]))
    for end, way, sign in zip(ends, ways, (-1.0, 1.0), strict=True):
        beyond = np.maximum(sign * ((place - end) @ way), 0.0)
        near = (station if sign < 0.0 else route.length - station) < _NEAR_END
        place -= sign * np.where(near, beyond, 0.0)[:, :, None] * way
    return WheelPlaces(place=place, direction=wheels.direction, stretch=wheels.stretch)


def _along(route: Route, footprint: Footprint, front: Array) -> WheelPlaces:
    shape = (len(front), len(footprint.setback))
    place, direction, stretch = np.empty((*shape, 2)), np.empty((*shape, 2)), np.empty(shape)
    for i, (behind, aside) in enumerate(zip(footprint.setback, footprint.lateral, strict=True)):
        place[:, i], direction[:, i] = route.locate(front - behind, aside)
        stretch[:, i] = route.stretch(front - behind, aside)
    return WheelPlaces(place=place, direction=direction, stretch=stretch)


def _pulled(route: Route, footprint: Footprint, front: Array) -> WheelPlaces:
    """Return places of pulled wheels; not-a-number for wheels of no unit."""
    shape = (len(front), len(footprint.setback))
    place, moves = np.full((*shape, 2), np.nan), np.full((*shape, 2), np.nan)
    angles = _angles(route, footprint, front)
    lead, motion = _lead(route, front)
    before = footprint.units[0].lead
    turning = np.zeros(len(front))
    u = np.zeros((len(front), 2))
    for unit, angle in zip(footprint.units, angles, strict=True):
        # its lead is a place on what pulls it
        behind = unit.lead - before
        if behind:
            lead, motion = lead - behind * u, motion - behind * turning[:, None] * _left(u)
        u = np.stack([np.cos(angle), np.sin(angle)], axis=1)
        turning = _cross(u, motion) / (unit.pivot - unit.lead)
        before = unit.lead
        for i in unit.contacts:
            back, aside = footprint.setback[i] - unit.lead, footprint.lateral[i]
            place[:, i] = lead - back * u + aside * _left(u)
            moves[:, i] = motion - turning[:, None] * (back * _left(u) + aside * u)
    stretch = np.linalg.norm(moves, axis=2)
    safe = np.where(stretch > 1e-9, stretch, 1.0)
    return WheelPlaces(place=place, direction=moves / safe[:, :, None], stretch=stretch)


def _angles(route: Route, footprint: Footprint, front: Array) -> Float[Array, "units steps"]:
    """Return the direction of every unit [rad]; straight behind the way's start at first."""
    start = route.legs.at(np.zeros(1))[1][0]
    first = np.full(len(footprint.units), np.arctan2(start[1], start[0]))
    last = float(front.max(initial=0.0))
    if last <= 0.0:
        return np.tile(first[:, None], len(front))

    def rate(s: float, psi: Array) -> Array:
        _, motion = _lead(route, np.array([s]))
        way, before, out = motion[0], footprint.units[0].lead, np.empty(len(psi))
        turning, u = 0.0, np.zeros(2)
        for k, unit in enumerate(footprint.units):
            way = way - (unit.lead - before) * turning * np.array([-u[1], u[0]])
            u = np.array([np.cos(psi[k]), np.sin(psi[k])])
            turning = (u[0] * way[1] - u[1] * way[0]) / (unit.pivot - unit.lead)
            before, out[k] = unit.lead, turning
        return out

    found = integrate.solve_ivp(
        rate, (0.0, last), first, dense_output=True, max_step=_LONGEST, rtol=1e-9,
        atol=_TOLERANCE,
    )  # fmt: skip
    assert found.sol is not None  # asked for
    return np.asarray(found.sol(np.maximum(front, 0.0)))


def _lead(route: Route, front: Array) -> tuple[Array, Array]:
    """Return where the front axle is [m], and how it moves per metre of the way."""
    place, direction, bend = route.legs.at(front)
    return place + route.lane * _left(direction), (1.0 - bend * route.lane)[:, None] * direction


def _left(vector: Array) -> Array:
    return np.stack([-vector[:, 1], vector[:, 0]], axis=1)


def _cross(one: Array, other: Array) -> Array:
    return one[:, 0] * other[:, 1] - one[:, 1] * other[:, 0]

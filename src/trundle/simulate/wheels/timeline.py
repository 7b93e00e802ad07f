"""Lay out in time where every wheel is, and what carries it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from trundle._typing import Array
from trundle.errors import InputError
from trundle.route import ContactRows, contact_rows
from trundle.simulate.crossing import Crossing
from trundle.structure import ContactShape, Hermite, Structure

__all__ = [
    "Timeline",
    "columns_of",
    "contact_springs",
    "operator_rows",
    "route_dofs",
    "starts_standing",
    "timeline_of",
]


@dataclass(frozen=True, kw_only=True, eq=False)
class Timeline:
    """Hold the wheels' stations and speeds over the run-in and the record.

    Attributes
    ----------
    time : ndarray of float, shape (n_all,)
        Times [s]; negative during the run-in, 0 at the record's start.
    n_run_in : int
        Number of steps before time 0.
    station : ndarray of float, shape (n_all, n_contacts)
        Station of each wheel along its route [m].
    speed : ndarray of float, shape (n_all, n_contacts)
        Speed of each wheel [m/s].
    begin : tuple of int
        Step at which each vehicle begins to move.
    """

    time: Float[Array, " steps"]
    n_run_in: int
    station: Float[Array, "steps contacts"]
    speed: Float[Array, "steps contacts"]
    begin: tuple[int, ...]


def timeline_of(crossings: tuple[Crossing, ...], dt: float, duration: float) -> Timeline:
    """Return the timeline of all crossings, run-in first."""
    starts_standing(crossings)
    starts = [_own_start(crossing, dt) for crossing in crossings]
    n_run_in = max(0, *(int(np.ceil(-start / dt - 1e-9)) for start in starts))
    n_steps = round(duration / dt)
    if n_steps < 2:
        raise InputError(f"duration must hold at least 2 steps of {dt:g} s; got {duration:g} s")
    time = dt * np.arange(-n_run_in, n_steps + 1)
    stations, speeds = [], []
    for crossing, start in zip(crossings, starts, strict=True):
        law, clock = crossing.route.law, time - crossing.depart
        # Before its own start a vehicle stands still, so that it drives the same way whether
        # others have a longer run-in or not.
        moving = time > start + 0.5 * dt
        clock = np.maximum(clock, start - crossing.depart)
        front = crossing.lead + law.distance(clock)
        stations.append(front[:, None] - crossing.vehicle.setback)
        speeds.append(np.broadcast_to((law.speed(clock) * moving)[:, None], stations[-1].shape))
    return Timeline(
        time=time,
        n_run_in=n_run_in,
        station=np.hstack(stations),
        speed=np.hstack(speeds),
        begin=tuple(n_run_in + round(start / dt) for start in starts),
    )


def starts_standing(crossings: tuple[Crossing, ...]) -> bool:
    """Return whether all start in static equilibrium with the floor; refuse if only some do."""
    standing = [crossing.entry.standing for crossing in crossings]
    if any(standing) and not all(standing):
        raise InputError("either every crossing starts in static equilibrium or none does")
    return all(standing)


def _own_start(crossing: Crossing, dt: float) -> float:
    """Return the time at which a vehicle begins to move, a whole number of steps [s]."""
    if crossing.entry.standing:
        return 0.0
    return -float(np.ceil((crossing.run_in_time - crossing.depart) / dt - 1e-9)) * dt


def columns_of(crossings: tuple[Crossing, ...]) -> Iterator[tuple[Crossing, slice]]:
    """Give each crossing with its contacts among all."""
    at = 0
    for crossing in crossings:
        yield crossing, slice(at, at + crossing.vehicle.n_contacts)
        at += crossing.vehicle.n_contacts


def contact_springs(crossings: tuple[Crossing, ...]) -> tuple[Array, Array]:
    """Return stiffness [N/m] and damping [N s/m] of all contacts."""
    vehicles = [crossing.vehicle for crossing in crossings]
    return (
        np.concatenate([vehicle.contact_stiffness for vehicle in vehicles]),
        np.concatenate([vehicle.contact_damping for vehicle in vehicles]),
    )


def route_dofs(floor: Structure, crossings: tuple[Crossing, ...]) -> Int[Array, " dofs"]:
    """Return the dofs that wheels load on their way over a floor, rising."""
    found = []
    for crossing in crossings:
        station = np.linspace(0.0, crossing.route.length, 50 * int(crossing.route.length) + 2)
        for lateral in np.unique(crossing.vehicle.lateral):
            places, directions = crossing.route.locate(station, lateral)
            rows = contact_rows(floor, places, directions, shape=Hermite())
            found.append(rows.used_dofs())
    return np.unique(np.concatenate(found))


def operator_rows(
    floor: Structure, crossings: tuple[Crossing, ...], timeline: Timeline, shape: ContactShape
) -> ContactRows:
    """Form the contact operator of every wheel at every time of the record.

    Returns
    -------
    ContactRows
        ``n_steps + 1`` times ``n_contacts`` rows, contact running fastest.
    """
    station = timeline.station[timeline.n_run_in :]
    places = np.empty((*station.shape, 2))
    directions = np.empty((*station.shape, 2))
    share, share_slope = np.empty(station.shape), np.empty(station.shape)
    at = 0
    for crossing in crossings:
        for lateral in crossing.vehicle.lateral:
            route = crossing.route
            places[:, at], directions[:, at] = route.locate(station[:, at], lateral)
            share[:, at], share_slope[:, at] = crossing.entry.share(station[:, at], route.length)
            at += 1
    rows = contact_rows(floor, places.reshape(-1, 2), directions.reshape(-1, 2), shape=shape)
    return rows.scaled(share.ravel(), share_slope.ravel())

"""Lay out in time where every wheel is, what carries it, and the road under it."""

from __future__ import annotations

import zlib
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from trundle._typing import Array
from trundle.errors import InputError
from trundle.road import Profile, ProfileReader, synthesise_tracks
from trundle.route import ContactRows, ContactShape, StaticStart, contact_rows, deck_of
from trundle.simulate.crossing import Crossing
from trundle.structure import Floor

__all__ = [
    "RoadUnderWheels",
    "Timeline",
    "columns_of",
    "contact_springs",
    "drawn_roads",
    "operator_rows",
    "roads_under_wheels",
    "timeline_of",
]

_TOGETHER = 64  # roads laid beside each other at once, for the runs are the last axis
_MARGIN = 10.0  # m of road beyond the wheels, so that none runs off its profile


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
    """

    time: Float[Array, " steps"]
    n_run_in: int
    station: Float[Array, "steps contacts"]
    speed: Float[Array, "steps contacts"]


@dataclass(frozen=True, kw_only=True, eq=False)
class RoadUnderWheels:
    """Hold what the road does to every wheel of every run.

    Attributes
    ----------
    push : ndarray of float, shape (n_all, n_contacts, n_runs)
        What the road adds to a contact force if vehicle and floor stand still [N]:
        ``k r + c V dr/ds`` of its elevation r under the moving wheel.
    start : ndarray of float, shape (n_contacts, n_runs)
        Elevation under the wheels at the first time [m].
    """

    push: Float[Array, "steps contacts runs"]
    start: Float[Array, "contacts runs"]

    @property
    def n_runs(self) -> int:
        """Number of runs."""
        return self.push.shape[2]


def timeline_of(crossings: tuple[Crossing, ...], dt: float, duration: float) -> Timeline:
    """Return the timeline of all crossings, run-in first."""
    static = [isinstance(crossing.entry, StaticStart) for crossing in crossings]
    if any(static) and not all(static):
        raise InputError("either every crossing starts in static equilibrium or none does")
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
        time=time, n_run_in=n_run_in, station=np.hstack(stations), speed=np.hstack(speeds)
    )


def _own_start(crossing: Crossing, dt: float) -> float:
    """Return the time at which a vehicle begins to move, a whole number of steps [s]."""
    if isinstance(crossing.entry, StaticStart):
        return 0.0
    return -float(np.ceil((crossing.run_in_time - crossing.depart) / dt - 1e-9)) * dt


def roads_under_wheels(
    crossings: tuple[Crossing, ...], timeline: Timeline, runs: range, seed: int, *, smooth: int = 0
) -> RoadUnderWheels:
    """Draw or read the road under every wheel; behind all runs, so many without random roads.

    A crossing's road depends on the seed, its route's name and the run's number alone; so
    the truck of one route meets the same road whether it drives alone or with others.
    """
    shape = (*timeline.station.shape, len(runs) + smooth)
    push, first = np.empty(shape), np.empty(shape[1:])
    push[..., len(runs) :] = 0.0
    first[:, len(runs) :] = 0.0
    stiffness, damping = contact_springs(crossings)
    rolling = damping * timeline.speed
    for columns, here, elevation, slope in drawn_roads(crossings, timeline, runs, seed):
        felt = stiffness[columns] * elevation + rolling[:, columns] * slope
        push[:, columns, here] = np.moveaxis(felt, 0, -1)
        first[columns, here] = elevation[:, 0].T
    for crossing, columns in columns_of(crossings):
        if smooth and isinstance(crossing.road, Profile):
            z, slope = crossing.road.at(timeline.station[:, columns])
            felt = stiffness[columns] * z + rolling[:, columns] * slope
            push[:, columns, len(runs) :] = felt[:, :, None]
            first[columns, len(runs) :] = z[0][:, None]
    return RoadUnderWheels(push=push, start=first)


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


def drawn_roads(
    crossings: tuple[Crossing, ...], timeline: Timeline, runs: range, seed: int
) -> Iterator[tuple[slice, slice, Array, Array]]:
    """Draw or read roads, some runs of one crossing at a time.

    Yields
    ------
    contacts, runs : slice
        Whose roads these are.
    elevation, slope : ndarray of float, shape (n_runs, n_all, n_contacts)
        Elevation under each wheel [m] and its slope along the way [m/m].
    """
    for crossing, columns in columns_of(crossings):
        station, speed = timeline.station[:, columns], timeline.speed[:, columns]
        tracks, which = np.unique(crossing.vehicle.lateral, return_inverse=True)
        readers: list[ProfileReader] = []
        under = [np.flatnonzero(which == i) for i in range(len(tracks))]
        for start in range(0, len(runs), _TOGETHER):
            some = runs[start : start + _TOGETHER]
            drawn = np.empty((2, len(some), *station.shape))
            for place, run in enumerate(some):
                rng = run_generator(seed, crossing.route.name, run)
                profiles = _profiles_of(crossing, tracks, float(speed.max()), timeline, rng)
                # every run's profile has the same stations
                readers = readers or _readers(profiles, station, under)
                for profile, reader, wheels in zip(profiles, readers, under, strict=True):
                    z, slope = reader.read(profile.elevation, profile.slope)
                    drawn[0, place][:, wheels] = z
                    drawn[1, place][:, wheels] = slope
            yield columns, slice(start, start + len(some)), drawn[0], drawn[1]


def _readers(
    profiles: tuple[Profile, ...], station: Array, under: list[Array]
) -> list[ProfileReader]:
    return [
        ProfileReader(profile.station, station[:, wheels])
        for profile, wheels in zip(profiles, under, strict=True)
    ]


def _profiles_of(
    crossing: Crossing, tracks: Array, speed: float, timeline: Timeline, rng: np.random.Generator
) -> tuple[Profile, ...]:
    """Return the profile of every wheel track; one given profile lies under all of them."""
    if isinstance(crossing.road, Profile):
        return (crossing.road,) * len(tracks)
    dt = float(timeline.time[1] - timeline.time[0])
    limit = 0.5 / (speed * dt)
    if crossing.band.n_max > limit * (1 + 1e-9):
        raise InputError(
            f"route {crossing.route.name!r}: roughness up to {crossing.band.n_max:g} cycle/m at "
            f"{speed:.3g} m/s needs a time step of at most "
            f"{0.5 / (crossing.band.n_max * speed):.3g} s; got {dt:g} s: shorten dt or "
            f"lower n_max to {limit:.3g} cycle/m"
        )
    low, high = _road_extent(crossing, float(timeline.time[-1]))
    return synthesise_tracks(
        crossing.road,
        tracks,
        length=high - low,
        rng=rng,
        band=crossing.band,
        start=low,
    )


def _road_extent(crossing: Crossing, duration: float) -> tuple[float, float]:
    """Return the stations that a random road covers [m].

    They do not depend on the time step or on other vehicles, so that every method drives
    over the same road.
    """
    reach = crossing.vehicle.length + _MARGIN
    law = crossing.route.law
    before = float(law.speed(0.0)) * crossing.run_in_time - min(0.0, crossing.lead + _MARGIN)
    after = max(crossing.route.length, float(law.distance(max(0.0, duration - crossing.depart))))
    return -float(np.ceil(before + reach)), float(np.ceil(after + reach))


def run_generator(seed: int, route_name: str, run: int) -> np.random.Generator:
    """Return the random generator of one run on one route."""
    key = (zlib.crc32(route_name.encode()), run)
    return np.random.default_rng(np.random.SeedSequence(seed, spawn_key=key))


def operator_rows(
    floor: Floor, crossings: tuple[Crossing, ...], timeline: Timeline, shape: ContactShape
) -> ContactRows:
    """Form the contact operator of every wheel at every time of the record.

    Returns
    -------
    ContactRows
        ``n_steps + 1`` times ``n_contacts`` rows, contact running fastest.
    """
    deck = deck_of(floor)
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
    rows = contact_rows(
        floor, places.reshape(-1, 2), directions.reshape(-1, 2), shape=shape, deck=deck
    )
    return rows.scaled(share.ravel(), share_slope.ravel())

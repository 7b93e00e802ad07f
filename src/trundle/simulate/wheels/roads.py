"""Draw the road under every wheel of every run."""

from __future__ import annotations

import zlib
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from trundle._threads import n_threads
from trundle._typing import Array
from trundle.errors import InputError
from trundle.road import Profile, ProfileReader, RoadClass, synthesise_tracks
from trundle.simulate.crossing import Crossing
from trundle.simulate.wheels.given_road import given_road
from trundle.simulate.wheels.timeline import Timeline, columns_of, contact_springs

__all__ = ["RoadUnderWheels", "drawn_roads", "roads_under_wheels", "run_generator"]

_TOGETHER = 64  # roads laid beside each other at once, for the runs are the last axis
_MARGIN = 10.0  # m of road beyond the wheels, so that none runs off its profile


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
            given = given_road(crossing, timeline, columns)
            felt = stiffness[columns] * given.elevation + rolling[:, columns] * given.slope
            push[:, columns, len(runs) :] = felt[:, :, None]
            first[columns, len(runs) :] = given.elevation[0][:, None]
    for crossing, columns in columns_of(crossings):
        if crossing.start == "level":
            first[columns] = 0.0
    return RoadUnderWheels(push=push, start=first)


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
    with ThreadPoolExecutor(n_threads()) as pool:
        for crossing, columns in columns_of(crossings):
            draw = _drawing(crossing, columns, timeline, seed)
            for start in range(0, len(runs), _TOGETHER):
                some = runs[start : start + _TOGETHER]
                drawn = np.array(list(pool.map(draw, some)))
                yield columns, slice(start, start + len(some)), drawn[:, 0], drawn[:, 1]


def _drawing(
    crossing: Crossing, columns: slice, timeline: Timeline, seed: int
) -> Callable[[int], Float[Array, "2 steps contacts"]]:
    """Return what gives elevation and slope under one crossing's wheels by the run's number."""
    if not isinstance(crossing.road, Profile):
        return _Source(crossing, columns, timeline, seed).draw
    given = given_road(crossing, timeline, columns)
    road = np.array([given.elevation, given.slope])
    return lambda _: road


class _Source:
    """Draws the random road under the wheels of one crossing, run by run."""

    def __init__(self, crossing: Crossing, columns: slice, timeline: Timeline, seed: int) -> None:
        assert isinstance(crossing.road, RoadClass)  # the caller has looked
        self._crossing, self._road, self._seed = crossing, crossing.road, seed
        self._station = timeline.station[:, columns]
        self._tracks, which = np.unique(crossing.vehicle.lateral, return_inverse=True)
        self._under = [np.flatnonzero(which == i) for i in range(len(self._tracks))]
        self._extent = _road_extent(crossing, float(timeline.time[-1]))
        dt = float(timeline.time[1] - timeline.time[0])
        _check_step(crossing, float(timeline.speed[:, columns].max()), dt)
        # every run's profile has the same stations
        self._readers = [
            ProfileReader(profile.station, self._station[:, wheels])
            for profile, wheels in zip(self._profiles(0), self._under, strict=True)
        ]

    def draw(self, run: int) -> Float[Array, "2 steps contacts"]:
        """Return elevation and slope under the wheels in one run."""
        out = np.empty((2, *self._station.shape))
        together = zip(self._profiles(run), self._readers, self._under, strict=True)
        for profile, reader, wheels in together:
            out[0][:, wheels], out[1][:, wheels] = reader.read(profile.elevation, profile.slope)
        return out

    def _profiles(self, run: int) -> tuple[Profile, ...]:
        """Return the profile of every wheel track."""
        crossing = self._crossing
        low, high = self._extent
        return synthesise_tracks(
            self._road,
            self._tracks,
            length=high - low,
            rng=run_generator(self._seed, crossing.route.name, run),
            band=crossing.band,
            start=low,
        )


def _check_step(crossing: Crossing, speed: float, dt: float) -> None:
    limit = 0.5 / (speed * dt)
    if crossing.band.n_max > limit * (1 + 1e-9):
        raise InputError(
            f"route {crossing.route.name!r}: roughness up to {crossing.band.n_max:g} cycle/m at "
            f"{speed:.3g} m/s needs a time step of at most "
            f"{0.5 / (crossing.band.n_max * speed):.3g} s; got {dt:g} s: shorten dt or "
            f"lower n_max to {limit:.3g} cycle/m"
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

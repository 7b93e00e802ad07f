"""Draw the random road under the wheels of one crossing, run by run."""

from __future__ import annotations

import zlib

import numpy as np
from jaxtyping import Float

from trundle._typing import Array
from trundle.errors import InputError
from trundle.road import Profile, ProfileReader, Spectrum, synthesise_tracks
from trundle.route import Along
from trundle.simulate.sources.crossing import TAIL, Crossing

__all__ = ["RandomRoad", "run_generator"]

_MARGIN = 10.0  # m of road beyond the wheels, so that none runs off its profile
_TURNS = 5.0  # m before its end, where a road turns back


class RandomRoad:
    """Draws the random road under the wheels of one crossing.

    It depends on the seed, the route's name and the run's number alone; so the truck of one route
    meets the same road whether it drives alone or with others.
    """

    def __init__(self, crossing: Crossing, road: Spectrum, along: Along, seed: int) -> None:
        self._crossing, self._road, self._seed = crossing, road, seed
        self._along = along
        self._tracks, which = np.unique(crossing.driven.lateral, return_inverse=True)
        self._under = [np.flatnonzero(which == i) for i in range(len(self._tracks))]
        self._extent = _road_extent(crossing)
        station, self._way = _turned_back(along.station, self._extent[1] - _TURNS)
        _check_step(crossing, float(along.speed.max()), float(along.time[1] - along.time[0]))
        # every run's profile has the same stations
        self._readers = [
            ProfileReader(profile.station, station[:, wheels])
            for profile, wheels in zip(self._profiles(0), self._under, strict=True)
        ]

    def draw(self, run: int) -> Float[Array, "2 times contacts"]:
        """Return elevation [m] and slope under the wheels in one run."""
        out = np.empty((2, *self._along.station.shape))
        together = zip(self._profiles(run), self._readers, self._under, strict=True)
        for profile, reader, wheels in together:
            out[0][:, wheels], out[1][:, wheels] = reader.read(profile.elevation, profile.slope)
        out[1] *= self._way
        return out

    def still(self) -> Float[Array, "2 times contacts"]:
        """Return a road of no height."""
        return np.zeros((2, *self._along.station.shape))

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


def _road_extent(crossing: Crossing) -> tuple[float, float]:
    """Return the stations that a random road covers [m].

    They do not depend on the time step, on the length of the record or on other vehicles, so that
    every method drives over the same road, and a vehicle over the same one alone and with others.
    """
    reach = crossing.driven.length + _MARGIN
    law = crossing.route.law
    before = float(law.speed(0.0)) * crossing.run_in_time - min(0.0, crossing.lead + _MARGIN)
    driven = crossing.exit_time - crossing.depart + TAIL
    after = max(crossing.route.length, float(law.distance(np.ceil(driven))))
    return -float(np.ceil(before + reach)), float(np.ceil(after + reach))


def _turned_back(
    station: Float[Array, "times contacts"], end: float
) -> tuple[Float[Array, "times contacts"], Float[Array, "times contacts"]]:
    """Return where on a road wheels are that drive on behind its end, and which way it then runs.

    In a record that goes on long after a vehicle has left the floor, the road turns back there.
    """
    length = max(end - float(station.min()), 1.0)
    beyond = np.abs((station - end + length) % (2.0 * length) - length)
    behind = station > end
    folded = np.where(behind, end - beyond, station)
    # rising on the way out, falling on the way back
    way = np.where(behind & ((station - end) % (2.0 * length) < length), -1.0, 1.0)
    return folded, way


def run_generator(seed: int, route_name: str, run: int) -> np.random.Generator:
    """Return the random generator of one run on one route."""
    key = (zlib.crc32(route_name.encode()), run)
    return np.random.default_rng(np.random.SeedSequence(seed, spawn_key=key))

"""Say who departs when on a day: a timetable, headways, a random stream of a mix."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float, Int

from trundle._checks import frozen_array, non_negative, positive, set_frozen
from trundle._typing import Array
from trundle.errors import InputError

__all__ = ["DAY", "Departures", "Poisson", "Schedule", "Stream", "Times", "evenly"]

DAY = 86400.0
"""Seconds of a day."""

_HOUR = 3600.0
_MOST = 200_000  # passages of a day


@dataclass(frozen=True, kw_only=True, eq=False)
class Departures:
    """Hold who departs when, in the order of time.

    Attributes
    ----------
    time : ndarray of float, shape (n,)
        Time of the day [s].
    route : tuple of str
        Names of the routes.
    which : ndarray of int, shape (n,)
        Which of these each drives.
    """

    time: Float[Array, " n"]
    route: tuple[str, ...]
    which: Int[Array, " n"]

    def __len__(self) -> int:
        """Return how many there are."""
        return len(self.time)

    @property
    def numbers(self) -> Int[Array, " n"]:
        """How many passages on the same route came before each."""
        out = np.zeros(len(self.which), dtype=np.intp)
        for i in range(len(self.route)):
            mine = self.which == i
            out[mine] = np.arange(np.count_nonzero(mine))
        return out

    def counts(self) -> dict[str, int]:
        """Return how many passages each route has."""
        return {name: int(np.sum(self.which == i)) for i, name in enumerate(self.route)}


@runtime_checkable
class Stream(Protocol):
    """Part of a schedule."""

    @property
    def routes(self) -> tuple[str, ...]:
        """List the routes that it has passages on."""
        ...

    def expected(self) -> Mapping[str, Float[Array, " hours"]]:
        """Return how many passages each route has in each hour of the day, in the mean."""
        ...

    def draw(self, rng: np.random.Generator) -> tuple[Array, list[str]]:
        """Return times of departure [s], in any order, with the routes."""
        ...


@dataclass(frozen=True, kw_only=True, eq=False)
class Times:
    """Passages whose times are known.

    Attributes
    ----------
    route : str
        Name of the route.
    times : ndarray of float, shape (n,)
        Times of departure [s], within a day.
    """

    route: str
    times: Float[Array, " n"]

    def __post_init__(self) -> None:
        """Check and sort the times."""
        times = np.sort(frozen_array("times", self.times, shape=(None,)))
        if len(times) and not (times[0] >= 0.0 and times[-1] < DAY):
            raise InputError(
                "times of departure must lie within a day, from 0:00 to 24:00; got "
                f"{times[0]:g} s to {times[-1]:g} s"
            )
        times.setflags(write=False)
        set_frozen(self, times=times)

    @property
    def routes(self) -> tuple[str, ...]:
        """Name of its route, alone."""
        return (self.route,)

    def expected(self) -> Mapping[str, Float[Array, " hours"]]:
        """Return how many depart in each hour."""
        counts, _ = np.histogram(self.times, bins=24, range=(0.0, DAY))
        return {self.route: counts.astype(float)}

    def draw(self, rng: np.random.Generator) -> tuple[Array, list[str]]:
        """Return the times as they are."""
        del rng
        return np.asarray(self.times), [self.route] * len(self.times)


def evenly(route: str, *, first: float, last: float, headway: float) -> Times:
    """Return passages at even headways.

    Parameters
    ----------
    route : str
        Name of the route.
    first, last : float
        Times of the first departure, and at which none departs any more [s].
    headway : float
        Time between departures [s].
    """
    positive("headway", headway)
    if not last > first:
        raise InputError(f"the last departure must come after the first; got {first:g}, {last:g} s")
    n = int(np.floor((last - first) / headway * (1.0 - 1e-12))) + 1
    if n > _MOST:
        raise InputError(f"{n} passages a day; {_MOST} at most: lengthen the headway")
    return Times(route=route, times=non_negative("first", first) + headway * np.arange(n))


@dataclass(frozen=True, kw_only=True, eq=False)
class Poisson:
    """A stream of vehicles that know nothing of each other.

    Attributes
    ----------
    edges : ndarray of float, shape (n_intervals + 1,)
        Times of the day between which the rate is even, rising [s].
    means : ndarray of float, shape (n_intervals,)
        Passages in each interval, in the mean.
    mix : mapping of str to float
        Share of each route; they need not add up to 1.
    """

    edges: Float[Array, " edges"]
    means: Float[Array, " intervals"]
    mix: Mapping[str, float]

    def __post_init__(self) -> None:
        """Check times, means and shares."""
        edges = frozen_array("times", self.edges, shape=(None,))
        if len(edges) < 2 or np.any(np.diff(edges) <= 0.0) or edges[0] < 0.0 or edges[-1] > DAY:
            raise InputError("times of a stream must rise within a day, from 0:00 to 24:00")
        means = frozen_array("passages", self.means, shape=(len(edges) - 1,))
        if np.any(means < 0.0):
            raise InputError("passages of a stream must be 0 or more in every hour")
        if means.sum() > _MOST:
            raise InputError(f"{means.sum():g} passages a day; {_MOST} at most")
        if not self.mix:
            raise InputError("a stream needs at least one route")
        for name, share in self.mix.items():
            positive(f"share of {name}", share)
        set_frozen(self, edges=edges, means=means)

    @classmethod
    def by_hour(cls, counts: ArrayLike, mix: Mapping[str, float]) -> Poisson:
        """Return a stream by its passages in each of 24 hours."""
        hours = frozen_array("passages by hour", counts, shape=(24,))
        return cls(edges=_HOUR * np.arange(25), means=hours, mix=mix)

    @classmethod
    def through(cls, *, start: float, end: float, rate: float, mix: Mapping[str, float]) -> Poisson:
        """Return a stream of an even rate between two times of the day.

        Parameters
        ----------
        start, end : float
            When it begins and ends [s].
        rate : float
            Passages an hour.
        mix : mapping of str to float
            Share of each route.
        """
        mean = positive("rate", rate) * (end - start) / _HOUR
        return cls(edges=np.array([start, end]), means=np.array([max(mean, 0.0)]), mix=mix)

    @property
    def routes(self) -> tuple[str, ...]:
        """The routes of the mix."""
        return tuple(self.mix)

    def _shares(self) -> Float[Array, " routes"]:
        shares = np.array(list(self.mix.values()), dtype=float)
        return shares / shares.sum()

    def expected(self) -> Mapping[str, Float[Array, " hours"]]:
        """Return the means."""
        so_far = np.concatenate([[0.0], np.cumsum(self.means)])
        by_hour = np.diff(np.interp(_HOUR * np.arange(25), self.edges, so_far))
        return {n: share * by_hour for n, share in zip(self.mix, self._shares(), strict=True)}

    def draw(self, rng: np.random.Generator) -> tuple[Array, list[str]]:
        """Return how many come in each interval, evenly spread in it, each on a random route.

        The times of a Poisson process of even rate, whose number is known, are independent and
        uniform.
        """
        counts = rng.poisson(self.means)
        starts, widths = np.repeat(self.edges[:-1], counts), np.repeat(np.diff(self.edges), counts)
        times = starts + widths * rng.random(len(starts))
        chosen = rng.choice(len(self.mix), size=len(starts), p=self._shares())
        names = self.routes
        return times, [names[i] for i in chosen]


@dataclass(frozen=True, kw_only=True, eq=False)
class Schedule:
    """Who drives on a day.

    Attributes
    ----------
    name : str
        Name.
    streams : tuple of Stream
        Its parts.
    """

    name: str
    streams: tuple[Stream, ...]

    def __post_init__(self) -> None:
        """Refuse one in which nobody drives."""
        if not self.streams or self.per_day <= 0.0:
            raise InputError(f"schedule {self.name!r}: nobody drives")

    @property
    def routes(self) -> tuple[str, ...]:
        """List all routes, each once."""
        return tuple(dict.fromkeys(name for one in self.streams for name in one.routes))

    def expected(self) -> dict[str, Float[Array, " hours"]]:
        """Return how many passages each route has in each hour of the day, in the mean."""
        out = {name: np.zeros(24) for name in self.routes}
        for stream in self.streams:
            for name, counts in stream.expected().items():
                out[name] += counts
        return out

    @property
    def per_day(self) -> float:
        """Mean number of passages a day."""
        return float(sum(counts.sum() for counts in self.expected().values()))

    @property
    def is_random(self) -> bool:
        """Whether no two days are alike."""
        return any(isinstance(stream, Poisson) for stream in self.streams)

    def draw(self, rng: np.random.Generator) -> Departures:
        """Return the departures of one day."""
        drawn = [stream.draw(rng) for stream in self.streams]
        times = np.concatenate([one for one, _ in drawn])
        names = [name for _, some in drawn for name in some]
        order = np.argsort(times, kind="stable")
        place = {name: i for i, name in enumerate(self.routes)}
        which = np.array([place[names[i]] for i in order], dtype=np.intp)
        return Departures(time=times[order], route=self.routes, which=which)

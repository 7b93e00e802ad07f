"""Say how fast a vehicle goes: laws of distance and speed over time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float

from trundle._checks import finite, frozen_array, non_negative, positive, set_frozen
from trundle._typing import Array, ArrayLike
from trundle.errors import InputError

__all__ = ["ConstantSpeed", "SpeedLaw", "SpeedOverTime", "SteadyAcceleration"]


_HARDEST = 15.0  # m/s2


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
        """Return the time at which a distance has been travelled [s]; infinity if never."""
        ...

    def change(self, time: ArrayLike) -> Float[Array, ...]:
        """Return the acceleration along the way [m/s2]."""
        ...

    @property
    def fastest(self) -> float:
        """Largest speed [m/s]; infinity if there is none."""
        ...

    @property
    def rests_from(self) -> float:
        """Time from which it stands for ever [s]; infinity if it never does."""
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

    def change(self, time: ArrayLike) -> Float[Array, ...]:
        """Return 0 at every time [m/s2]."""
        return np.zeros_like(np.asarray(time, float))

    @property
    def fastest(self) -> float:
        """V [m/s]."""
        return self.value

    @property
    def rests_from(self) -> float:
        """Infinity: it never stands [s]."""
        return float("inf")


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

    def change(self, time: ArrayLike) -> Float[Array, ...]:
        """Return a while it moves, from time 0 on [m/s2]."""
        t = np.asarray(time, float)
        moves = (t >= 0.0) & (self._moving_time(t) == t)
        return np.where(moves, self.acceleration, 0.0)

    @property
    def fastest(self) -> float:
        """Initial speed [m/s]; infinity where it accelerates, which it does for ever."""
        return float("inf") if self.acceleration > 0.0 else self.initial

    @property
    def rests_from(self) -> float:
        """When it has braked to rest [s]."""
        return float("inf") if self.acceleration >= 0.0 else -self.initial / self.acceleration


@dataclass(frozen=True, kw_only=True, eq=False)
class SpeedOverTime:
    """Hold speeds at times, joined by straight lines: steady accelerations.

    Before the first time the speed is that at it, and behind the last that at it. A standing start
    has speed 0 at first; a stop is two times with speed 0; stop and go is several of them.

    Attributes
    ----------
    time : ndarray of float, shape (n_times,)
        Times [s], rising from 0.
    value : ndarray of float, shape (n_times,)
        Speeds there [m/s], 0 or more.
    """

    time: Float[Array, " times"]
    value: Float[Array, " times"]

    def __post_init__(self) -> None:
        """Check times and speeds."""
        time = frozen_array("time", self.time, shape=(None,))
        value = frozen_array("speed", self.value, shape=time.shape)
        if len(time) < 2 or time[0] != 0.0 or np.any(np.diff(time) <= 0.0):
            raise InputError(f"times must rise from 0; got {time[:6].tolist()} s")
        if np.any(value < 0.0) or not np.any(value > 0.0):
            raise InputError(
                f"speeds must be 0 or more, and one above it; got {value[:6].tolist()} m/s"
            )
        hardest = float(np.abs(np.diff(value) / np.diff(time)).max())
        if hardest > _HARDEST:
            raise InputError(
                f"between two speeds the acceleration is {hardest:.3g} m/s2; no wheel holds more "
                f"than {_HARDEST:g} m/s2: draw them further apart"
            )
        set_frozen(self, time=time, value=value)

    @classmethod
    def over_stations(
        cls, station: ArrayLike, value: ArrayLike, *, waits: Sequence[float] = ()
    ) -> SpeedOverTime:
        """Give speeds at stations; between two of them the acceleration is steady.

        Parameters
        ----------
        station : array_like of float, shape (n_stations,)
            Distance travelled since time 0 [m], rising from 0.
        value : array_like of float, shape (n_stations,)
            Speeds there [m/s]; 0 is a stop.
        waits : sequence of float, optional
            How long it stands at each station where its speed is 0 [s], in their order; not at all
            unless given.

        Raises
        ------
        InputError
            Stations that do not rise, two stops behind each other, a wait below 0, or a number of
            waits that is not that of the stops.

        Notes
        -----
        At a steady acceleration the mean of two speeds covers the way between them: it takes
        ``2 (s2 - s1) / (v1 + v2)``.
        """
        s = frozen_array("station", station, shape=(None,))
        v = frozen_array("speed", value, shape=s.shape)
        if len(s) < 2 or s[0] != 0.0 or np.any(np.diff(s) <= 0.0):
            raise InputError(f"stations must rise from 0; got {s[:6].tolist()} m")
        both = v[1:] + v[:-1]
        if np.any(both <= 0.0):
            at = s[int(np.argmax(both <= 0.0))]
            raise InputError(
                f"from station {at:g} m on the speed is 0 until the next: nothing would get there; "
                "give a speed between two stops"
            )
        stops = np.flatnonzero(v == 0.0)
        lasting = tuple(non_negative("wait", one) for one in waits) or (0.0,) * len(stops)
        if len(lasting) != len(stops):
            raise InputError(
                f"waits gives {len(lasting)} times for {len(stops)} stations with speed 0"
            )
        took = dict(zip(stops.tolist(), lasting, strict=True))
        times, speeds, now = [0.0], [float(v[0])], 0.0
        if took.get(0, 0.0) > 0.0:
            now = float(took[0])
            times, speeds = [0.0, now], [0.0, 0.0]
        for i, step in enumerate(2.0 * np.diff(s) / both, start=1):
            now += float(step)
            times.append(now)
            speeds.append(float(v[i]))
            if took.get(i, 0.0) > 0.0:
                now += float(took[i])
                times.append(now)
                speeds.append(0.0)
        return cls(time=np.array(times), value=np.array(speeds))

    @property
    def _reached(self) -> Array:
        """Distance travelled at each time [m]."""
        steps = 0.5 * (self.value[1:] + self.value[:-1]) * np.diff(self.time)
        return np.concatenate([[0.0], np.cumsum(steps)])

    def distance(self, time: ArrayLike) -> Float[Array, ...]:
        """Return the distance travelled since time 0 [m]."""
        t = np.asarray(time, float)
        i = np.clip(np.searchsorted(self.time, t, "right") - 1, 0, len(self.time) - 1)
        past = t - self.time[i]
        rate = np.append(np.diff(self.value) / np.diff(self.time), 0.0)[i]
        rate = np.where(past < 0.0, 0.0, rate)
        return np.asarray(self._reached[i] + past * (self.value[i] + 0.5 * rate * past))

    def speed(self, time: ArrayLike) -> Float[Array, ...]:
        """Return the speed [m/s]."""
        return np.interp(np.asarray(time, float), self.time, self.value)

    def change(self, time: ArrayLike) -> Float[Array, ...]:
        """Return the acceleration, that behind a time where it jumps [m/s2]."""
        t = np.asarray(time, float)
        rate = np.concatenate([[0.0], np.diff(self.value) / np.diff(self.time), [0.0]])
        return rate[np.searchsorted(self.time, t, "right")]

    def time_to(self, distance: float) -> float:
        """Return the first time at which a distance is reached, infinity if it never is [s]."""
        reached = self._reached
        if distance <= 0.0:
            first = float(self.value[0])
            return distance / first if first > 0.0 else (0.0 if distance == 0.0 else -np.inf)
        if distance > reached[-1]:
            last = float(self.value[-1])
            more = distance - float(reached[-1])
            return float(self.time[-1]) + more / last if last > 0.0 else float("inf")
        i = int(np.searchsorted(reached, distance, "left")) - 1
        v, more = float(self.value[i]), distance - float(reached[i])
        rate = float((self.value[i + 1] - v) / (self.time[i + 1] - self.time[i]))
        root = float(np.sqrt(max(v * v + 2.0 * rate * more, 0.0)))
        return float(self.time[i]) + 2.0 * more / (v + root)

    @property
    def fastest(self) -> float:
        """Largest speed [m/s]."""
        return float(self.value.max())

    @property
    def rests_from(self) -> float:
        """Time from which it stands for ever [s]; infinity if it does not."""
        if self.value[-1] > 0.0:
            return float("inf")
        moving = np.flatnonzero(self.value > 0.0)[-1]
        return float(self.time[moving + 1])

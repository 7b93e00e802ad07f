"""Count what lies above limits on a day, and keep who was there when levels were largest."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from trundle._typing import Array
from trundle.errors import ComputationError
from trundle.response.meter import CurveLimit, Reading

__all__ = ["Present", "Tally"]

_HOUR = 3600.0
_APART = 5.0  # s between times above a limit that are events of their own
_DAY = (7, 23)  # hours of BS 6472-1's day


@dataclass(frozen=True, kw_only=True, eq=False)
class Present:
    """Hold the motion of a part of a day, and who makes it.

    Attributes
    ----------
    start : int
        First step, from midnight.
    motion : mapping of str to ndarray of float, shape (n_points, n_steps)
        What the points do: displacement, velocity, acceleration, and what is felt of it.
    who : tuple
        Route, time of departure [s], first step and velocity (n_points, steps) of each passage.
    """

    start: int
    motion: Mapping[str, Float[Array, "points steps"]]
    who: tuple[tuple[str, float, int, Float[Array, "points own"]], ...]


@dataclass(kw_only=True)
class Peak:
    """Hold the largest level so far: its square over the limit's, band, step, and who was there."""

    square: float = 0.0
    band: int = 0
    step: int = 0
    who: tuple[tuple[str, float, float], ...] = ()


class Tally:
    """What a day gave so far."""

    def __init__(
        self, curves: Sequence[CurveLimit], point_names: Sequence[str], sampling_frequency: float
    ) -> None:
        self.curves, self.point_names = tuple(curves), tuple(point_names)
        self.fs = sampling_frequency
        shape = (24, len(self.curves), len(self.point_names))
        self.seconds_above = np.zeros(shape)
        self.events = np.zeros(shape, dtype=int)
        self.peaks = [[Peak() for _ in self.point_names] for _ in self.curves]
        self.dose = np.zeros((2, len(self.point_names)))  # sums of fourth powers, day and night
        self.busy, self.at_once = 0.0, 0
        self._last_above = np.full(shape[1:], -np.inf)  # step at which each lay above last

    def take(self, start: int, reading: Reading, there: Present) -> None:
        """Count a part of the day."""
        n_steps = reading.square.shape[-1]
        step = start + np.arange(n_steps)
        hour = ((step / self.fs // _HOUR) % 24).astype(int)
        self._check(there, start)
        above = reading.square > 1.0
        self._count(above, step, hour)
        self._keep_peaks(reading, there, start)
        for here in np.unique(hour):
            which = 0 if _DAY[0] <= here < _DAY[1] else 1
            felt = there.motion["felt"][:, hour == here]
            self.dose[which] += np.sum(felt**4, axis=-1) / self.fs
        self.busy += n_steps / self.fs
        self.at_once = max(self.at_once, _most_at_once(there, start, n_steps))

    def _check(self, there: Present, start: int) -> None:
        for name, values in there.motion.items():
            if not np.isfinite(values).all():
                raise ComputationError(
                    f"the {name} is not a finite number {start / self.fs:.0f} s after midnight"
                )

    def _count(self, above: Bool[Array, "curves points steps"], step: Array, hour: Array) -> None:
        for here in np.unique(hour):
            self.seconds_above[here] += above[..., hour == here].sum(axis=-1) / self.fs
        curves, points = np.nonzero(above.any(axis=-1))
        for c, p in zip(curves, points, strict=True):
            at = step[above[c, p]]
            before = np.concatenate([[self._last_above[c, p]], at[:-1]])
            begun = at[at - before > _APART * self.fs]
            np.add.at(self.events[:, c, p], (begun / self.fs // _HOUR % 24).astype(int), 1)
            self._last_above[c, p] = at[-1]

    def _keep_peaks(self, reading: Reading, there: Present, start: int) -> None:
        at = reading.square.argmax(axis=-1)
        largest = np.take_along_axis(reading.square, at[..., None], axis=-1)[..., 0]
        for c, row in enumerate(self.peaks):
            for p, peak in enumerate(row):
                if largest[c, p] > peak.square:
                    peak.square = float(largest[c, p])
                    peak.band = int(reading.band[c, p, at[c, p]])
                    peak.step = start + int(at[c, p])
                    peak.who = self._shares(there, peak.step, p)

    def _shares(
        self, there: Present, step: int, point: int
    ) -> tuple[tuple[str, float, float], ...]:
        """Return route, departure and RMS velocity over the last second of each that was there."""
        found = []
        for route, departs, first, velocity in there.who:
            stop = step + 1 - first
            part = velocity[point, max(0, stop - round(self.fs)) : max(0, stop)]
            if len(part):
                found.append((route, departs, float(np.sqrt(np.mean(part**2)))))
        return tuple(sorted(found, key=lambda one: -one[2]))

    def end(self) -> None:
        """Mark criteria that have no running level."""
        unread = [i for i, curve in enumerate(self.curves) if not curve.is_read]
        self.seconds_above[:, unread] = np.nan


def _most_at_once(there: Present, start: int, n_steps: int) -> int:
    """Return how many passages' records overlap at most within a part."""
    if not there.who:
        return 0
    begin = np.array([max(first, start) for _, _, first, _ in there.who])
    end = np.array([min(first + v.shape[-1], start + n_steps) for _, _, first, v in there.who])
    return int(max(np.sum((begin <= t) & (end > t)) for t in begin))

"""Lay out in time when sources begin to move, and what is recorded."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from trundle._typing import Array
from trundle.errors import InputError
from trundle.simulate.sources.source import Source

__all__ = ["Timeline", "columns_of", "starts_standing", "timeline_of"]


@dataclass(frozen=True, kw_only=True, eq=False)
class Timeline:
    """Hold the times of run-in and record.

    Attributes
    ----------
    time : ndarray of float, shape (n_all,)
        Times [s]; negative during the run-in, 0 at the record's start.
    n_run_in : int
        Number of steps before time 0.
    begins : tuple of float
        When each source begins to move [s].
    """

    time: Float[Array, " steps"]
    n_run_in: int
    begins: tuple[float, ...]

    @property
    def dt(self) -> float:
        """Time step [s]."""
        return float(self.time[1] - self.time[0])

    @property
    def record(self) -> Float[Array, " steps"]:
        """Time of the record [s]."""
        return self.time[self.n_run_in :]

    @property
    def begin(self) -> tuple[int, ...]:
        """Step at which each source begins to move."""
        return tuple(self.n_run_in + round(start / self.dt) for start in self.begins)


def timeline_of(sources: tuple[Source, ...], dt: float, duration: float) -> Timeline:
    """Return the timeline of all sources, run-in first."""
    starts_standing(sources)
    begins = tuple(source.begins(dt) for source in sources)
    n_run_in = max(0, *(int(np.ceil(-start / dt - 1e-9)) for start in begins))
    n_steps = round(duration / dt)
    if n_steps < 2:
        raise InputError(f"duration must hold at least 2 steps of {dt:g} s; got {duration:g} s")
    return Timeline(time=dt * np.arange(-n_run_in, n_steps + 1), n_run_in=n_run_in, begins=begins)


def starts_standing(sources: tuple[Source, ...]) -> bool:
    """Return whether all start in static equilibrium with the floor; refuse if only some do."""
    standing = [source.standing for source in sources]
    if any(standing) and not all(standing):
        raise InputError("either every crossing starts in static equilibrium or none does")
    return all(standing)


def columns_of(
    sources: tuple[Source, ...], timeline: Timeline
) -> Iterator[tuple[Source, float, slice]]:
    """Give each source with when it begins [s] and its contacts among all."""
    at = 0
    for source, begins in zip(sources, timeline.begins, strict=True):
        n_contacts = len(source.contact_names)
        yield source, begins, slice(at, at + n_contacts)
        at += n_contacts

"""Lay what sources put in beside each other: every contact of every run."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from trundle._threads import n_threads
from trundle._typing import Array
from trundle.simulate.sources.source import Source
from trundle.simulate.wheels.timeline import Timeline, columns_of

__all__ = ["RoadUnderWheels", "roads_under_wheels"]

_TOGETHER = 64  # runs laid beside each other at once, for they are the last axis


@dataclass(frozen=True, kw_only=True, eq=False)
class RoadUnderWheels:
    """Hold what is put in at every contact of every run.

    Attributes
    ----------
    push : ndarray of float, shape (n_all, n_contacts, n_runs)
        What is added to a contact force if vehicle and floor stand still [N]: of a road
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
    sources: tuple[Source, ...], timeline: Timeline, runs: range, seed: int, *, smooth: int = 0
) -> RoadUnderWheels:
    """Draw what every source puts in; behind all runs, so many without anything random.

    What a source puts in depends on the seed, its name and the run's number alone.
    """
    n_contacts = sum(len(source.contact_names) for source in sources)
    shape = (len(timeline.time), n_contacts, len(runs) + smooth)
    push, first = np.empty(shape), np.empty(shape[1:])
    with ThreadPoolExecutor(n_threads()) as pool:
        for source, begins, columns in columns_of(sources, timeline):
            inputs = source.inputs(timeline.time, begins, seed)
            for at in range(0, len(runs), _TOGETHER):
                some = runs[at : at + _TOGETHER]
                here = slice(at, at + len(some))
                drawn = list(pool.map(inputs.draw, some))
                push[:, columns, here] = np.moveaxis(np.array([one[0] for one in drawn]), 0, -1)
                first[columns, here] = np.array([one[1] for one in drawn]).T
            if smooth:
                still, height = inputs.still()
                push[:, columns, len(runs) :] = still[:, :, None]
                first[columns, len(runs) :] = height[:, None]
    return RoadUnderWheels(push=push, start=first)

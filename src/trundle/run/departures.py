"""Draw who departs when on a study's days."""

from __future__ import annotations

import zlib
from collections.abc import Sequence

import numpy as np

from trundle.simulate import Source
from trundle.simulate.sources.passage import Passage
from trundle.traffic import Departures, Schedule

__all__ = ["departures_of"]

_FOLLOWS = 2.0  # s, that drivers keep from the one ahead at least


def departures_of(schedule: Schedule, sources: Sequence[Source], seed: int) -> Departures:
    """Return who departs when: of a random stream, as a study's seed has it.

    Parameters
    ----------
    schedule : Schedule
        The day.
    sources : sequence of Source
        One passage on each of its routes.
    seed : int
        Seed of the study; the day depends on it and on the schedule's name.
    """
    key = (zlib.crc32(f"schedule {schedule.name}".encode()),)
    rng = np.random.default_rng(np.random.SeedSequence(seed, spawn_key=key))
    return schedule.draw(rng, {source.name: _behind(source) for source in sources})


def _behind(source: Source) -> float:
    """Return how long behind a vehicle the next one follows at least [s]: its length, and 2 s."""
    if not isinstance(source, Passage):
        return 0.0
    law = source.crossing.route.law
    return float(law.time_to(source.crossing.driven.length)) + _FOLLOWS

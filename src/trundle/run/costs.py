"""Say about how long the parts of a job take on two cores.

Each part's time is proportional to counts that are known beforehand; the factors were fitted to
whole parts of sixteen studies on two cores (`benchmarks/estimate.py`), to within a factor of two.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from trundle.run.jobs import Job
from trundle.simulate.ensembles import runs_at_once

__all__ = ["Size", "day_seconds", "exact_seconds", "map_seconds", "run_in_steps", "runs_seconds"]

_PASS = 7e-5  # s for each step of a batch, however few its runs
_DIRECT = 1e-8  # s for each run, step and degree of freedom to the power 1.2


@dataclass(frozen=True, kw_only=True)
class Size:
    """Hold how large a floor is, for what is computed on it.

    Attributes
    ----------
    n_dofs : int
        Degrees of freedom.
    n_modes : float
        About how many modes are kept, 0 for direct integration.
    """

    n_dofs: int
    n_modes: float


def run_in_steps(job: Job) -> float:
    """Return how many steps the vehicles of a job take before they reach the floor."""
    dt = job.method.interaction.integration.dt
    return max(0.0, *(-source.begins(dt) for source in job.sources)) / dt


def _steps(job: Job) -> float:
    return job.duration / job.method.interaction.integration.dt + run_in_steps(job)


def _contacts(job: Job) -> int:
    return sum(len(source.contact_names) for source in job.sources)


def runs_seconds(job: Job, part: range, size: Size) -> float:
    """Return about how long some runs of a job take [s]."""
    if not job.modal:
        return _DIRECT * _steps(job) * (len(part) + 2) * size.n_dofs**1.2
    n_modes = size.n_modes
    contacts, points, roads = _contacts(job), len(job.points), len(job.factors)
    a_run = 1.5e-7 * contacts + (0.8e-7 + 1.8e-7 * roads) * points
    a_run += 1.5e-11 * n_modes * (points + contacts)
    return _steps(job) * (_PASS + 2.6e-7 * n_modes + len(part) * a_run)


def exact_seconds(job: Job, size: Size) -> float:
    """Return about how long the exact statistics of a job take [s]."""
    dt, points = job.method.interaction.integration.dt, len(job.points)
    a_wave = 8.3e-10 * size.n_modes + 6e-8 * _contacts(job) + 2.2e-7 * points
    at_once = max(1, runs_at_once(job.sources, dt, job.duration, points) // 2)
    waves = job.n_waves * sum(source.random for source in job.sources)
    passes = float(np.ceil(waves / at_once))
    return _steps(job) * (passes * _PASS + 2.0 * waves * a_wave)


def day_seconds(job: Job, size: Size) -> float:
    """Return about how long a day takes, on all its roads [s]: its passages, and their bands."""
    if job.schedule is None:
        return 0.0
    passages, routes = job.schedule.per_day, max(1, len(job.sources))
    alone = replace(job, factors=dict.fromkeys(list(job.factors)[:1], 1.0))
    runs = runs_seconds(alone, range(int(np.ceil(passages / routes))), size)
    read = 4e-7 * _steps(job) * passages * len(job.points)
    return len(job.factors) * (runs + read)


def map_seconds(job: Job) -> float:
    """Return about how long the map of a job takes, on all its roads [s]."""
    if job.map is None:
        return 0.0
    columns = 67.0 + job.map.runs * len(job.factors) * (1.5 if job.map.peaks else 1.0)
    return 2e-8 * _steps(job) * job.map.n_places * columns

"""Estimate how long a study will take and how much memory, before anything is computed.

Each part's time is proportional to counts that are known beforehand; the factors were fitted to
whole parts of sixteen studies on two cores (`benchmarks/estimate.py`), to within a factor of two.
The number of modes is Weyl's for a plate: ``A f sqrt(m / D) / 2``, beams left out.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from trundle.dynamics import Modal
from trundle.run.jobs import Job, plan_jobs
from trundle.run.mode_cache import has_modes
from trundle.simulate.ensembles import runs_at_once
from trundle.structure import FloorPlan
from trundle.study.model import Study

__all__ = [
    "START",
    "Estimate",
    "estimate_of",
    "job_seconds",
    "memory_there_is",
    "mode_seconds",
    "n_modes_of",
    "part_seconds",
    "peak_memory",
    "shares_of",
]

_MODES = 8e-7  # s for each degree of freedom and mode
_PASS = 7e-5  # s for each step of a batch, however few its runs
_LAY_OUT = 5e-5  # s for each degree of freedom, for each job
_DIRECT = 1e-8  # s for each run, step and degree of freedom to the power 1.2
_FIGURES = 0.6  # s for each cell's figures and tables

START = 8.0
"""Time of imports, writing and the report's page [s]."""

_BARE = 0.35e9  # bytes: the process and its libraries
_EXACT = 0.4e9  # of answers to waves
_BATCH = 0.4e9  # of the histories of a batch, at most
_AT_ONCE = 2  # batches in work
_FACTOR = 8.0 * 60.0  # bytes of a factor for each degree of freedom and doubling of them
_MAP = 2.2e9  # of spectra and responses of a map, at most


@dataclass(frozen=True, kw_only=True)
class Estimate:
    """Hold what a study will take.

    Attributes
    ----------
    seconds : float
        Time on two cores [s].
    memory : float
        Memory at its peak [bytes].
    slowest : str
        Which part takes longest.
    """

    seconds: float
    memory: float
    slowest: str

    def __str__(self) -> str:
        """Render it as a line of a message."""
        return f"about {_time(self.seconds)} on two cores and {self.memory / 1e9:.2g} GB of memory"


def estimate_of(study: Study) -> Estimate:
    """Return about what a study will take.

    Parameters
    ----------
    study : Study
        A checked study.
    """
    jobs = plan_jobs(study)
    n_dofs = study.floor.n_dofs
    n_modes = {job.name: n_modes_of(study.plan, job) for job in jobs}
    most = max(n_modes.values())
    spent = {"modes of the floor": _seconds_of_modes(study, jobs, most)}
    for job in jobs:
        seconds = job_seconds(job, n_modes[job.name], n_dofs)
        spent[f"{job.case.name}, {job.method.name}"] = (
            spent.get(f"{job.case.name}, {job.method.name}", 0.0) + seconds
        )
    cells = len(study.cases) * len(study.roads) * len(study.methods)
    return Estimate(
        seconds=START + _FIGURES * cells + sum(spent.values()),
        memory=peak_memory(jobs, n_dofs, most),
        slowest=max(spent, key=lambda name: spent[name]),
    )


def part_seconds(job: Job, n_modes: float, n_dofs: int) -> tuple[float, ...]:
    """Return about how long each part of a job takes on two cores [s].

    Parameters
    ----------
    job : Job
        The job.
    n_modes : float
        Modes of its floor, 0 for direct integration.
    n_dofs : int
        Degrees of freedom of the floor.
    """
    dt = job.method.interaction.integration.dt
    steps = job.duration / dt + _run_in_steps(job, dt)
    contacts = sum(crossing.vehicle.n_contacts for crossing in job.crossings)
    points, roads = len(job.points), len(job.factors)
    if not job.modal:
        return tuple(_DIRECT * steps * (len(p) + 2) * n_dofs**1.2 for p in job.parts)
    a_run = 1.5e-7 * contacts + (0.8e-7 + 1.8e-7 * roads) * points
    a_run += 1.5e-11 * n_modes * (points + contacts)
    found = [steps * (_PASS + 2.6e-7 * n_modes + len(part) * a_run) for part in job.parts]
    if job.n_waves:
        a_wave = 8.3e-10 * n_modes + 6e-8 * contacts + 2.2e-7 * points
        at_once = max(1, runs_at_once(job.crossings, dt, job.duration, points) // 2)
        passes = float(np.ceil(job.n_waves * len(job.crossings) / at_once))
        found.append(steps * (passes * _PASS + 2.0 * job.n_waves * len(job.crossings) * a_wave))
    if job.map is not None:
        columns = 67.0 + job.map.runs * roads * (1.5 if job.map.peaks else 1.0)
        found.append(2e-8 * steps * len(job.map.places) * columns)
    return tuple(found)


def job_seconds(job: Job, n_modes: float, n_dofs: int) -> float:
    """Return about how long a job takes with its layout [s], see `part_seconds`."""
    return sum(part_seconds(job, n_modes, n_dofs)) + _LAY_OUT * n_dofs


def mode_seconds(n_dofs: int, n_modes: float) -> float:
    """Return about how long so many modes of a floor take [s]."""
    return _MODES * n_dofs * n_modes


def shares_of(study: Study, jobs: Sequence[Job]) -> tuple[float, dict[str, float]]:
    """Return what share of a study's time its modes take, and what each piece costs [s].

    Parameters
    ----------
    study : Study
        The study.
    jobs : sequence of Job
        Its jobs.
    """
    n_dofs, n_modes = study.floor.n_dofs, [n_modes_of(study.plan, job) for job in jobs]
    costs: dict[str, float] = {}
    for job, n in zip(jobs, n_modes, strict=True):
        costs |= dict(zip(job.pieces, part_seconds(job, n, n_dofs), strict=True))
    of_modes = _seconds_of_modes(study, jobs, max(n_modes))
    return of_modes / (of_modes + sum(costs.values())), costs


def memory_there_is() -> float:
    """Return how much memory a new process may take [bytes], a container's limit counted."""
    import psutil  # noqa: PLC0415 - only where somebody asks

    there = float(psutil.virtual_memory().available)
    for limit, used in (
        ("/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory.current"),
        (
            "/sys/fs/cgroup/memory/memory.limit_in_bytes",
            "/sys/fs/cgroup/memory/memory.usage_in_bytes",
        ),
    ):
        try:
            there = min(there, float(Path(limit).read_text()) - float(Path(used).read_text()))
        except (OSError, ValueError):  # no such file, or "max"
            continue
    return max(there, 0.0)


def n_modes_of(plan: FloorPlan, job: Job) -> float:
    """Return about how many modes a job's method keeps."""
    integration = job.method.interaction.integration
    if not isinstance(integration, Modal):
        return 0.0
    slab, material = plan.slab, plan.slab.material
    area = float(np.ptp(plan.x_extent) * np.ptp(plan.y_extent))
    stiffness = material.elastic_modulus * slab.thickness**3 / 12.0
    mass = material.density * slab.thickness + slab.superimposed_mass
    return 1.0 + 0.5 * area * integration.f_max * float(np.sqrt(mass / stiffness))


def _seconds_of_modes(study: Study, jobs: Sequence[Job], n_modes: float) -> float:
    """Return how long the modes take, nothing where they are kept from before."""
    integrations = (job.method.interaction.integration for job in jobs)
    f_max = max((i.f_max for i in integrations if isinstance(i, Modal)), default=0.0)
    if f_max == 0.0 or has_modes(study.floor, f_max):
        return 0.0
    return mode_seconds(study.floor.n_dofs, n_modes)


def _run_in_steps(job: Job, dt: float) -> float:
    """Return how many steps the vehicles take before they reach the floor."""
    return max(0.0, *(c.run_in_time - c.depart for c in job.crossings)) / dt


def peak_memory(jobs: Sequence[Job], n_dofs: int, n_modes: float) -> float:
    """Return about how much memory is held at the peak [bytes]."""
    floor = 2.5 * 8.0 * n_dofs * n_modes + _FACTOR * n_dofs * np.log2(n_dofs)
    return _BARE + floor + max((_memory_of(job) for job in jobs), default=0.0)


def _memory_of(job: Job) -> float:
    dt = job.method.interaction.integration.dt
    before, record = _run_in_steps(job, dt), job.duration / dt
    contacts = sum(crossing.vehicle.n_contacts for crossing in job.crossings)
    points, roads = len(job.points), len(job.factors)
    columns = 1 + max((len(part) for part in job.parts), default=job.n_waves)
    a_run = 8.0 * ((before + record) * contacts + record * (3 * points + contacts))
    held = _AT_ONCE * max(min(_BATCH, columns * a_run), 17 * a_run)
    rows = 8.0 * record * contacts * 24 * 4  # the contact operator of every step
    mapped = 0.0
    if job.map is not None:
        forces = 8.0 * record * contacts * job.map.runs * roads
        kept = 8.0 * 22 * len(job.map.places) * job.map.runs * roads
        mapped = 2.0 * forces + kept + min(_MAP, 8.0 * record * len(job.map.places) * 60)
    return held + rows + mapped + (_EXACT if job.n_waves else 0.0)


def _time(seconds: float) -> str:
    """Return a time as people say it."""
    for size, name, above in ((86400.0, "days", 2.0), (3600.0, "h", 2.0), (60.0, "min", 2.0)):
        if seconds >= above * size:
            return f"{seconds / size:.2g} {name}"
    return f"{seconds:.0f} s"

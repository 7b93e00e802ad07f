"""Estimate how long a study will take and how much memory, before anything is computed.

The number of modes is Weyl's for a plate: ``A f sqrt(m / D) / 2``, beams left out.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from trundle.dynamics import spacing_at_first
from trundle.run.costs import Size, run_in_steps
from trundle.run.jobs import Job, plan_jobs
from trundle.run.mode_cache import has_modes
from trundle.run.tasks import tasks_of
from trundle.structure import PlateSection, bending_wave
from trundle.study.model import Study

__all__ = [
    "START",
    "Estimate",
    "estimate_of",
    "job_seconds",
    "memory_there_is",
    "mode_seconds",
    "n_modes_of",
    "peak_memory",
    "seconds_of_modes",
    "size_of",
]

_MODES = 8e-7  # s for each degree of freedom and mode
_PARTED_MODES = 2e-7  # s for each degree of freedom and mode that is found by parts
_REDUCED = 1e-4  # s for each degree of freedom of parts that are reduced
_COORDINATES = 1.8  # of parts and seams, for each mode below the frequency to which parts are kept
_AN_ANSWER = 1.3e-6  # s for each of them to the power 1.5, at one frequency
_LOOKED_AT = 3.6  # frequencies, for each at which is looked at first
_ANSWERING = 1200.0  # combinations that stand for many modes, about: 696 to 2342 were seen
_LAY_OUT = 5e-5  # s for each degree of freedom, for each job
_FIGURES = 0.6  # s for each cell's figures and tables

START = 8.0
"""Time of imports, writing and the report's page [s]."""

_BARE = 0.35e9  # bytes: the process and its libraries
_EXACT = 0.4e9  # of answers to waves
_BATCH = 0.4e9  # of the histories of a batch, at most
_USUAL_MODES = 600.0  # below 100 Hz, of a model whose slab is not known
_AT_ONCE = 2  # batches in work
_FACTOR = 8.0 * 60.0  # bytes of a factor for each degree of freedom and doubling of them
_PARTED = 7e3  # bytes for each degree of freedom of a structure by parts
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
    most = max(n_modes_of(study, job) for job in jobs)
    spent = {"modes of the floor": seconds_of_modes(study, jobs)}
    for job in jobs:
        name = f"{job.case.name}, {job.method.name}"
        spent[name] = spent.get(name, 0.0) + job_seconds(job, size_of(study, job))
    cells = len(study.cases) * len(study.roads) * len(study.methods)
    return Estimate(
        seconds=START + _FIGURES * cells + sum(spent.values()),
        memory=peak_memory(jobs, n_dofs, most, parted=study.parting is not None),
        slowest=max(spent, key=lambda name: spent[name]),
    )


def size_of(study: Study, job: Job) -> Size:
    """Return how large a study's floor is for one of its jobs."""
    n_modes = n_modes_of(study, job)
    if _answers(study):
        n_modes = min(n_modes, _ANSWERING)
    return Size(n_dofs=study.floor.n_dofs, n_modes=n_modes)


def job_seconds(job: Job, size: Size) -> float:
    """Return about how long a job takes with its layout [s]."""
    return sum(task.seconds(size) for task in tasks_of(job)) + _LAY_OUT * size.n_dofs


def mode_seconds(n_dofs: int, n_modes: float, *, parted: bool = False) -> float:
    """Return about how long so many modes of a floor take, all at once or by its parts [s]."""
    return (_PARTED_MODES if parted else _MODES) * n_dofs * n_modes


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


def n_modes_of(study: Study, job: Job) -> float:
    """Return about how many modes a job's method keeps.

    A plate has ``A f / 2 sqrt(m / D)`` modes below f (Weyl).
    """
    integration = job.method.interaction.integration
    if integration.f_max is None:
        return 0.0
    plates = list(_plates(study))
    if not plates:
        return _USUAL_MODES * integration.f_max / 100.0
    return 1.0 + sum(
        np.pi * area * integration.f_max / bending_wave(section) for area, section in plates
    )


def _plates(study: Study) -> Iterator[tuple[float, PlateSection]]:
    """Give the area and the section of every slab [m2]."""
    if study.plan is not None:
        yield float(np.ptp(study.plan.x_extent) * np.ptp(study.plan.y_extent)), study.plan.slab
    if study.building is not None:
        for slab in (*study.building.slabs, *study.building.ramps):
            yield slab.area, slab.section


def seconds_of_modes(study: Study, jobs: Sequence[Job]) -> float:
    """Return how long the modes of jobs take, nothing where they are kept from before [s]."""
    integrations = (job.method.interaction.integration for job in jobs)
    f_max = max((i.f_max or 0.0 for i in integrations), default=0.0)
    if f_max == 0.0 or has_modes(study.floor, f_max):
        return 0.0
    n_modes = max(n_modes_of(study, job) for job in jobs)
    if _answers(study):
        return max(_answer_seconds(study, job, n_modes, f_max) for job in jobs)
    return mode_seconds(study.floor.n_dofs, n_modes, parted=study.parting is not None)


def _answers(study: Study) -> bool:
    """Return whether what answers stands for modes."""
    return study.parting is not None and study.parting.response_tolerance > 0.0


def _answer_seconds(study: Study, job: Job, n_modes: float, f_max: float) -> float:
    """Return about how long it takes to find what answers, parts reduced [s]."""
    assert study.parting is not None
    ratio = float(job.method.interaction.damping.ratios(np.array([2.0 * np.pi * f_max]))[0])
    first = 1.0 + np.log(max(f_max, np.e)) / spacing_at_first(ratio)
    coordinates = _COORDINATES * n_modes * study.parting.f_parts / f_max
    solved = _LOOKED_AT * first * _AN_ANSWER * coordinates**1.5
    return _REDUCED * study.floor.n_dofs + solved


def peak_memory(jobs: Sequence[Job], n_dofs: int, n_modes: float, *, parted: bool = False) -> float:
    """Return about how much memory is held at the peak [bytes]."""
    factor = _FACTOR * n_dofs * np.log2(n_dofs)
    floor = 2.5 * 8.0 * n_dofs * n_modes + factor
    if parted:  # what is stepped directly is not reduced
        floor = _PARTED * n_dofs + (0.0 if all(job.modal for job in jobs) else factor)
    return _BARE + floor + max((_memory_of(job) for job in jobs), default=0.0)


def _memory_of(job: Job) -> float:
    dt = job.method.interaction.integration.dt
    before, record = run_in_steps(job), job.duration / dt
    contacts = sum(len(source.contact_names) for source in job.sources)
    points, roads = len(job.points), len(job.factors)
    at_once = 64 * len(job.sources) if job.schedule is not None else job.n_waves
    columns = 1 + max((len(part) for part in job.parts), default=at_once)
    a_run = 8.0 * ((before + record) * contacts + record * (3 * points + contacts))
    held = _AT_ONCE * max(min(_BATCH, columns * a_run), 17 * a_run)
    rows = 8.0 * record * contacts * 24 * 4  # the contact operator of every step
    mapped = 0.0
    if job.map is not None:
        forces = 8.0 * record * contacts * job.map.runs * roads
        kept = 8.0 * 22 * job.map.n_places * job.map.runs * roads
        mapped = 2.0 * forces + kept + min(_MAP, 8.0 * record * job.map.n_places * 60)
    return held + rows + mapped + (_EXACT if job.n_waves else 0.0)


def _time(seconds: float) -> str:
    """Return a time as people say it."""
    for size, name, above in ((86400.0, "days", 2.0), (3600.0, "h", 2.0), (60.0, "min", 2.0)):
        if seconds >= above * size:
            return f"{seconds / size:.2g} {name}"
    return f"{seconds:.0f} s"

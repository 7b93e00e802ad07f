"""The parts of a job as values: each has a name, a cost, and can be computed anywhere, any time.

A new kind of part is a class here, or in the room that needs it: whoever computes parts, keeps them
or tells how much is done knows of them no more than `Task` says.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol, runtime_checkable

from trundle._progress import Progress
from trundle.criteria import watched
from trundle.response import behind_isolators, exact_statistics, reduce_on_scaled_roads
from trundle.results.parts import Part, exact_part, runs_part
from trundle.run.costs import Size, day_seconds, exact_seconds, map_seconds, runs_seconds
from trundle.run.days import day_part
from trundle.run.jobs import Job, PreparedJob
from trundle.run.mapping import map_part
from trundle.simulate import harmonics, runs_with_mean, truncation_change

__all__ = ["DayTask", "ExactTask", "MapTask", "RunsTask", "Task", "tasks_of"]


@runtime_checkable
class Task(Protocol):
    """A part of a job."""

    @property
    def job(self) -> Job:
        """Whose part it is."""
        ...

    @property
    def name(self) -> str:
        """Name of what it leaves, unique in the study and fit for a file."""
        ...

    @property
    def alone(self) -> bool:
        """Whether none may be computed beside it in one process."""
        ...

    def seconds(self, size: Size) -> float:
        """Return about how long it takes on two cores, on a floor of some size [s]."""
        ...

    def compute(self, laid_out: PreparedJob, progress: Progress | None = None) -> Part:
        """Compute it: the same bits wherever and whenever."""
        ...


@dataclass(frozen=True, kw_only=True, eq=False)
class RunsTask:
    """Run some roads, and keep what is reported of them.

    Attributes
    ----------
    job : Job
        Whose part it is.
    number : int
        Which of the job's parts; the first keeps histories and what modes left out change.
    """

    job: Job
    number: int

    @property
    def name(self) -> str:
        """Name of what it leaves."""
        return f"{self.job.name}-runs{self.number:04d}"

    @property
    def alone(self) -> bool:
        """Whether none may be computed beside it: a sparse solver answers one at a time."""
        return not self.job.modal

    def seconds(self, size: Size) -> float:
        """Return about how long it takes."""
        return runs_seconds(self.job, self.job.parts[self.number], size)

    def compute(self, laid_out: PreparedJob, progress: Progress | None = None) -> Part:
        """Run the roads on the first class, and scale the others from them."""
        job, layout = self.job, laid_out.layout
        factors = list(job.factors.values())
        runs, mean = runs_with_mean(
            layout, runs=job.parts[self.number], seed=job.seed, progress=_most(progress)
        )
        first = self.number == 0
        change = truncation_change(layout, runs, job.parts[0]) if first and job.modal else None
        runs = behind_isolators(runs, job.isolations)
        mean = behind_isolators(mean, job.isolations)
        curves, _ = watched(
            job.watched,
            f_max=runs.f_max,
            sampling_frequency=runs.sampling_frequency,
            coverage=runs.coverage,
        )
        reduced = reduce_on_scaled_roads(
            runs,
            mean,
            factors,
            averaging=job.averaging,
            quantities=job.quantities,
            horizontal=job.sideways,
            curves=curves,
        )
        one = runs.part(slice(0, 1))
        histories = [one.on_scaled_road(mean, factor) for factor in factors] if first else []
        return runs_part(runs, reduced, histories, truncation=change)


def _most(progress: Progress | None) -> Progress | None:
    """Return what is told four fifths of a progress: what is made of the runs takes the rest."""
    return None if progress is None else lambda share: progress(0.8 * share)


@dataclass(frozen=True, kw_only=True, eq=False)
class ExactTask:
    """Sum the answers to all waves of the road: statistics without sampling."""

    job: Job

    @property
    def name(self) -> str:
        """Name of what it leaves."""
        return f"{self.job.name}-exact"

    @property
    def alone(self) -> bool:
        """Whether none may be computed beside it: a sparse solver answers one at a time."""
        return not self.job.modal

    def seconds(self, size: Size) -> float:
        """Return about how long it takes."""
        return exact_seconds(self.job, size)

    def compute(self, laid_out: PreparedJob, progress: Progress | None = None) -> Part:
        """Answer every wave, and add up the squares."""
        job, layout = self.job, laid_out.layout
        answers = harmonics(layout, n_waves=job.n_waves, progress=progress)
        answers = (behind_isolators(answer, job.isolations) for answer in answers)
        exact = exact_statistics(answers, f_max=layout.f_max)
        return exact_part(exact, list(job.factors.values()))


@dataclass(frozen=True, kw_only=True, eq=False)
class MapTask:
    """Map a job's case over the floor."""

    job: Job

    @property
    def name(self) -> str:
        """Name of what it leaves."""
        return f"{self.job.name}-map"

    @property
    def alone(self) -> bool:
        """Whether none may be computed beside it: a sparse solver answers one at a time."""
        return not self.job.modal

    def seconds(self, size: Size) -> float:
        """Return about how long it takes."""
        del size
        return map_seconds(self.job)

    def compute(self, laid_out: PreparedJob, progress: Progress | None = None) -> Part:
        """Carry the contact forces of all runs to every place."""
        job, plan, places = self.job, self.job.map, laid_out.places
        assert plan is not None  # else it is no task of the job
        assert places is not None  # laid out with the map
        factors = list(job.factors.values())
        return map_part(
            plan,
            laid_out.layout,
            places,
            factors,
            job.seed,
            days=bool(job.watched),
            progress=progress,
        )


@dataclass(frozen=True, kw_only=True, eq=False)
class DayTask:
    """Run one day of a schedule, on every road of a job."""

    job: Job

    @property
    def name(self) -> str:
        """Name of what it leaves."""
        return f"{self.job.name}-day"

    @property
    def alone(self) -> bool:
        """Whether none may be computed beside it: a sparse solver answers one at a time."""
        return not self.job.modal

    def seconds(self, size: Size) -> float:
        """Return about how long it takes."""
        return day_seconds(self.job, size)

    def compute(self, laid_out: PreparedJob, progress: Progress | None = None) -> Part:
        """Run all passages, and add them up in time."""
        return day_part(self.job, laid_out, progress=progress)


def tasks_of(job: Job) -> tuple[Task, ...]:
    """Return the parts of a job, its runs first."""
    if job.schedule is not None:
        return (DayTask(job=job),)
    tasks: list[Task] = [RunsTask(job=job, number=i) for i in range(len(job.parts))]
    if job.n_waves:
        tasks.append(ExactTask(job=job))
    if job.map is not None:
        tasks.append(MapTask(job=job))
    return tuple(tasks)

"""Run one combination of changes, and keep what its runs leave behind each kind of isolator."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from trundle._progress import Progress
from trundle.response import behind_isolators, reduce_on_scaled_roads
from trundle.results.parts import ChangesPart, runs_part
from trundle.run.costs import Size, runs_seconds
from trundle.run.jobs import Job, PreparedJob
from trundle.signals import Isolation
from trundle.simulate import runs_with_mean

__all__ = ["ChangesTask"]


@dataclass(frozen=True, kw_only=True, eq=False)
class ChangesTask:
    """Run some roads once, for changes that differ by their isolators alone.

    Attributes
    ----------
    job : Job
        Whose part it is; its own isolators are not used.
    number : int
        Which of the job's parts.
    variants : tuple of mapping of str to Isolation
        What stands between floor and tool, by point, for each change.
    """

    job: Job
    number: int
    variants: tuple[Mapping[str, Isolation], ...]

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

    def compute(self, laid_out: PreparedJob, progress: Progress | None = None) -> ChangesPart:
        """Run the roads on the first class, and scale the others from them, for each change."""
        job = self.job
        runs, mean = runs_with_mean(
            laid_out.layout, runs=job.parts[self.number], seed=job.seed, progress=progress
        )
        return ChangesPart(
            variants=tuple(
                runs_part(
                    behind_isolators(runs, isolations),
                    reduce_on_scaled_roads(
                        behind_isolators(runs, isolations),
                        behind_isolators(mean, isolations),
                        list(job.factors.values()),
                        averaging=job.averaging,
                        quantities=job.quantities,
                    ),
                    [],
                    truncation=None,
                )
                for isolations in self.variants
            )
        )

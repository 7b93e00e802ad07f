"""Estimate how long trying changes will take, and how much memory, before anything is computed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from trundle.mitigate.changes import Change
from trundle.mitigate.mitigation import sharing_runs
from trundle.run.estimate import (
    START,
    Estimate,
    job_seconds,
    mode_seconds,
    n_modes_of,
    part_seconds,
    peak_memory,
)
from trundle.run.jobs import plan_jobs
from trundle.study.model import Study

__all__ = ["estimate_of_changes"]


def estimate_of_changes(
    study: Study, changes: Sequence[Change], speeds: Sequence[float], runs: int
) -> Estimate:
    """Return about what trying changes at several speeds will take.

    Parameters
    ----------
    study : Study
        A study with criteria.
    changes : sequence of Change
        What is tried.
    speeds : sequence of float
        Speeds of every vehicle [m/s].
    runs : int
        Runs of each combination.
    """
    method = study.assessment.method if study.assessment else study.methods[0].name
    methods = tuple(m for m in study.methods if m.name == method)
    once = replace(study, runs=runs, map=None, methods=methods)
    jobs = [job for speed in speeds for job in plan_jobs(once.at_speed(speed))]
    jobs = [replace(job, n_waves=0, duration=study.long_enough(job.crossings)) for job in jobs]
    alone = max(jobs, key=lambda job: sum(part_seconds(job, 0.0, 1)))
    n_dofs, n_modes = study.floor.n_dofs, n_modes_of(study.plan, alone)
    of_runs = sum(job_seconds(job, n_modes, n_dofs) for job in jobs)
    n_slabs = len({change.slab_thickness for change in changes})
    of_modes = n_slabs * mode_seconds(n_dofs, n_modes)
    of_runs *= len(sharing_runs(changes))
    return Estimate(
        seconds=START + of_modes + of_runs,
        memory=peak_memory(jobs, n_dofs, n_modes),
        slowest="modes of the floors" if of_modes > of_runs else "their runs",
    )

"""Estimate how long trying changes will take, and how much memory, before anything is computed."""

from __future__ import annotations

from collections.abc import Sequence

from trundle.mitigate.changes import Change
from trundle.mitigate.plan import plan_changes
from trundle.run.estimate import START, Estimate, job_seconds, mode_seconds, peak_memory, size_of
from trundle.study.model import Study

__all__ = ["estimate_of_changes"]


def estimate_of_changes(
    study: Study,
    changes: Sequence[Change],
    speeds: Sequence[float],
    runs: int,
    roads: Sequence[str] = ("A", "B"),
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
    roads : sequence of str
        Road classes.
    """
    planned = plan_changes(study, changes=changes, speeds=speeds, roads=roads, runs=runs)
    size = max((size_of(study, one.job) for one in planned), key=lambda size: size.n_modes)
    of_runs = sum(job_seconds(one.job, size) for one in planned)
    n_slabs = len({change.slab_thickness for change in changes})
    parted = study.parting is not None
    of_modes = n_slabs * mode_seconds(size.n_dofs, size.n_modes, parted=parted)
    return Estimate(
        seconds=START + of_modes + of_runs,
        memory=peak_memory([one.job for one in planned], size.n_dofs, size.n_modes, parted=parted),
        slowest="modes of the floors" if of_modes > of_runs else "their runs",
    )

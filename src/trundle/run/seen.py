"""Say which dofs the jobs of a study load, and what they read."""

from __future__ import annotations

from collections.abc import Sequence

from scipy import sparse

from trundle._typing import Array, SparseMatrix
from trundle.run.jobs import Job
from trundle.simulate.laying_out import point_rows, spot_rows
from trundle.simulate.wheels.standing import route_dofs
from trundle.structure import Structure

__all__ = ["map_rows", "seen_by_jobs"]


def seen_by_jobs(structure: Structure, jobs: Sequence[Job]) -> tuple[Array, SparseMatrix]:
    """Return the dofs that wheels of jobs load, rising, and rows of all that jobs read.

    Parameters
    ----------
    structure : Structure
        What they drive on.
    jobs : sequence of Job
        What is computed on it.
    """
    sources = {source.name: source for job in jobs for source in job.sources}
    points = {name: spot for job in jobs for name, spot in job.points.items()}
    return route_dofs(structure, tuple(sources.values())), point_rows(structure, points)


def map_rows(structure: Structure, jobs: Sequence[Job]) -> SparseMatrix:
    """Return rows of weights of all places that jobs map."""
    plans = {id(job.map): job.map for job in jobs if job.map is not None}
    rows = [spot_rows(structure, spots) for plan in plans.values() for spots in plan.places]
    if not rows:
        return sparse.csr_array((0, structure.n_dofs))
    return sparse.vstack(rows, format="csr")

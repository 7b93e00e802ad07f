"""Look whether a study's results have settled: the same few runs on a mesh twice as coarse."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from trundle._progress import Tell
from trundle.dynamics import Modes
from trundle.errors import TrundleError
from trundle.results.cells import Cell, CellKey
from trundle.results.mesh_change import MeshChange
from trundle.results.study_result import StudyResult
from trundle.run.settling import compared, few_runs
from trundle.study.model import Study

__all__ = ["mesh_change"]


def mesh_change(
    study: Study,
    cells: Mapping[CellKey, Cell],
    modes: Modes | None,
    run: Callable[[Study, Tell], StudyResult],
    tell: Tell,
) -> MeshChange | None:
    """Return what a mesh twice as coarse changes.

    None for a floor that came as a mesh or a plan, for studies that assess nothing, and where no
    model can be made or run with elements twice as large.

    Parameters
    ----------
    study : Study
        A study of a building, run.
    cells : mapping of CellKey to Cell
        Its results.
    modes : Modes or None
        Its modes, where methods use them.
    run : callable
        Runs a study.
    tell : callable
        Told what is being done, and the share done.
    """
    if study.building is None or study.assessment is None:
        return None
    try:
        coarse = few_runs(study.meshed(2.0), study.assessment.method)
        found = run(coarse, lambda what, done: tell(f"mesh twice as coarse: {what}", done))
    except TrundleError:  # what is computed stands, with the doubt that nobody has looked
        return None
    change = compared(coarse, (found.cells, cells), (found.modes, modes))
    return MeshChange(
        sizes=(coarse.mesh_size, study.mesh_size),
        frequencies=change.frequencies,
        cases=change.cases,
        points=change.points,
        bands=change.bands,
        levels=change.levels,
    )

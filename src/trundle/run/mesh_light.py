"""Look whether a study's results have settled: the same few runs on a mesh twice as coarse."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np

from trundle._progress import Tell
from trundle.dynamics import Modes
from trundle.errors import TrundleError
from trundle.results.cells import Cell, CellKey
from trundle.results.mesh_change import MeshChange
from trundle.results.study_result import StudyResult
from trundle.study.model import Study

__all__ = ["mesh_change"]

_RUNS = 4  # the roads are the same on both meshes, which scatter together
_MODES = 8


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
        coarse = _coarse(study, study.assessment.method)
        found = run(coarse, lambda what, done: tell(f"mesh twice as coarse: {what}", done))
    except TrundleError:  # what is computed stands, with the doubt that nobody has looked
        return None
    (road,), (method,) = coarse.roads, coarse.methods
    keys = [CellKey(case.name, road, method.name) for case in coarse.cases]
    both = [[one[key] for key in keys] for one in (found.cells, cells)]
    frequencies = [
        np.zeros(0) if one is None else one.frequencies[:_MODES] for one in (found.modes, modes)
    ]
    n = min(map(len, frequencies))
    return MeshChange(
        sizes=(coarse.mesh_size, study.mesh_size),
        frequencies=np.stack([some[:n] for some in frequencies]),
        cases=tuple(case.name for case in coarse.cases),
        points=tuple(study.points),
        bands=both[1][0].spectra.mid_band,
        levels=np.array([[_levels(cell, coarse.runs) for cell in some] for some in both]),
    )


def _coarse(study: Study, method: str) -> Study:
    """Return a study on a mesh twice as coarse: the assessed method, one road, a few runs."""
    road = next(iter(study.roads))
    alone = tuple(case for case in study.cases if len(case.routes) == 1)
    return replace(
        study.meshed(2.0),
        building=None,  # or it would be looked at in its turn
        runs=min(_RUNS, study.runs),
        cases=alone or study.cases[:1],
        roads={road: study.roads[road]},
        methods=tuple(m for m in study.methods if m.name == method),
        map=None,
        schedules={},
        printed=(),
        printed_bounds=(),
    )


def _levels(cell: Cell, runs: int) -> np.ndarray:
    """Return the energy mean over the first runs, where a road excites and a result resolves."""
    spectra = cell.spectra
    levels = np.sqrt(np.mean(np.square(spectra.values[:runs]), axis=0))
    there = spectra.resolved & cell.coverage.excites(spectra.mid_band)
    return np.where(there, levels, np.nan)

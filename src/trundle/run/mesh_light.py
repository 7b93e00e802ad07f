"""Look whether a study's results have settled: the same few runs on a mesh twice as coarse."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np

from trundle._progress import Tell
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
    frequencies: np.ndarray,
    run: Callable[[Study, Tell], StudyResult],
    tell: Tell,
) -> MeshChange | None:
    """Return what a mesh twice as coarse changes; None for a floor that came as a mesh, or a plan.

    Parameters
    ----------
    study : Study
        A study of a building, run.
    cells : mapping of CellKey to Cell
        Its results.
    frequencies : ndarray of float
        Its natural frequencies [Hz].
    run : callable
        Runs a study.
    tell : callable
        Told what is being done, and the share done.
    """
    if study.building is None or study.assessment is None:
        return None
    method, road = study.assessment.method, next(iter(study.roads))
    cases = tuple(case for case in study.cases if len(case.routes) == 1)
    runs = min(_RUNS, study.runs)
    coarse = replace(
        study.meshed(2.0),
        building=None,  # or it would be looked at in its turn
        runs=runs,
        cases=cases,
        roads={road: study.roads[road]},
        methods=tuple(m for m in study.methods if m.name == method),
        map=None,
        printed=(),
        printed_bounds=(),
    )
    found = run(coarse, lambda what, done: tell(f"mesh twice as coarse: {what}", done))
    keys = [CellKey(case.name, road, method) for case in cases]
    both = [[one[key] for key in keys] for one in (found.cells, cells)]
    n = min(_MODES, len(frequencies), 0 if found.modes is None else found.modes.n_modes)
    coarse_f = np.zeros(0) if found.modes is None else found.modes.frequencies
    return MeshChange(
        sizes=(coarse.mesh_size, study.mesh_size),
        frequencies=np.stack([coarse_f[:n], np.asarray(frequencies)[:n]]),
        cases=tuple(case.name for case in cases),
        points=tuple(study.points),
        bands=both[1][0].spectra.mid_band,
        levels=np.array([[_levels(cell, runs) for cell in some] for some in both]),
    )


def _levels(cell: Cell, runs: int) -> np.ndarray:
    """Return the energy mean over the first runs, where a road excites and a result resolves."""
    spectra = cell.spectra
    levels = np.sqrt(np.mean(np.square(spectra.values[:runs]), axis=0))
    there = spectra.resolved & cell.coverage.excites(spectra.mid_band)
    return np.where(there, levels, np.nan)

"""Run a study by few runs on another model, and hold its levels against the study's own."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from trundle.dynamics import Modes
from trundle.results.cells import Cell, CellKey
from trundle.results.level_change import LevelChange
from trundle.results.modes import FirstModes
from trundle.study.model import Study

__all__ = ["compared", "few_runs"]

_RUNS = 4  # the roads are the same by both models, which scatter together
_MODES = 8


def few_runs(study: Study, method: str) -> Study:
    """Return a study with few runs of each case, by one method on one road."""
    road = next(iter(study.roads))
    alone = tuple(case for case in study.cases if len(case.routes) == 1)
    return replace(
        study,
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


def compared(
    few: Study,
    cells: tuple[Mapping[CellKey, Cell], Mapping[CellKey, Cell]],
    modes: tuple[FirstModes | None, Modes | FirstModes | None],
) -> LevelChange:
    """Return levels by another model and by a study's own.

    Parameters
    ----------
    few : Study
        The study by few runs.
    cells : tuple of mapping
        Its results by the other model, and those of the whole study.
    modes : tuple of FirstModes, Modes or None
        Modes of both, where methods use them.
    """
    (road,), (method,) = few.roads, few.methods
    keys = [CellKey(case.name, road, method.name) for case in few.cases]
    both = [[one[key] for key in keys] for one in cells]
    frequencies = [np.zeros(0) if one is None else one.frequencies[:_MODES] for one in modes]
    n = min(map(len, frequencies))
    return LevelChange(
        frequencies=np.stack([some[:n] for some in frequencies]),
        cases=tuple(case.name for case in few.cases),
        points=tuple(few.points),
        bands=both[1][0].spectra.mid_band,
        levels=np.array([[_levels(cell, few.runs) for cell in some] for some in both]),
    )


def _levels(cell: Cell, runs: int) -> np.ndarray:
    """Return the energy mean over the first runs, where a road excites and a result resolves."""
    spectra = cell.spectra
    levels = np.sqrt(np.mean(np.square(spectra.values[:runs]), axis=0))
    there = spectra.resolved & cell.coverage.excites(spectra.mid_band)
    return np.where(there, levels, np.nan)

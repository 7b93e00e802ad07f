"""Run every cell of a study, and hold what came out."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from trundle.criteria import Verdict, assess_spectra
from trundle.dynamics import Modal, Modes
from trundle.errors import FitnessWarning
from trundle.simulate import PreparedFloor, StaticFlexibility, prepare
from trundle.study.cells import Cell, CellKey, run_cells
from trundle.study.mode_cache import modes_of
from trundle.study.model import Case, MethodPlan, Study

__all__ = ["StudyResult", "run_study"]

Report = Callable[[str, float], None]
"""Told what is being done, and the share of the whole study that is done (0 to 1)."""

_MODES_SHARE = 0.45  # of a study's time, as a first guess for the bar


@dataclass(frozen=True, kw_only=True, eq=False)
class StudyResult:
    """Hold the results of a study.

    Attributes
    ----------
    study : Study
        What was run.
    cells : mapping of CellKey to Cell
        Every cell.
    verdicts : mapping of CellKey to tuple of Verdict
        Verdicts of the cells of the assessed method.
    modes : Modes or None
        Natural modes of the floor, where a method used them.
    """

    study: Study
    cells: Mapping[CellKey, Cell]
    verdicts: Mapping[CellKey, tuple[Verdict, ...]]
    modes: Modes | None

    def warnings(self) -> dict[str, tuple[FitnessWarning, ...]]:
        """Return the doubts of each method, each once."""
        by_method: dict[str, dict[FitnessWarning, None]] = {}
        for key, cell in self.cells.items():
            by_method.setdefault(key.method, {}).update(dict.fromkeys(cell.warnings))
        return {method: tuple(found) for method, found in by_method.items()}


def run_study(study: Study, *, report: Report | None = None) -> StudyResult:
    """Run every case on every road by every method.

    Parameters
    ----------
    study : Study
        A checked study.
    report : callable, optional
        Told what is being done and the share done.

    Returns
    -------
    StudyResult
        Reduced results; the same study gives the same bits.
    """
    tell = report or (lambda _what, _share: None)
    modes = _all_modes(study, tell)
    base = _MODES_SHARE if modes is not None else 0.0
    jobs = [(case, method) for method in study.methods for case in study.cases]
    costs = np.array([_cost(study, case, method) for case, method in jobs])
    done, total = 0.0, float(costs.sum())
    found: dict[CellKey, Cell] = {}
    prepared: dict[str, PreparedFloor] = {}
    flexibility = StaticFlexibility(study.floor)
    for (case, method), cost in zip(jobs, costs, strict=True):
        bar = _part_of_bar(
            tell,
            f"{case.name}, {method.name}",
            base + (1.0 - base) * done / total,
            (1.0 - base) * float(cost) / total,
        )
        bar(0.0)
        if method.name not in prepared:
            interaction = method.interaction
            prepared[method.name] = prepare(
                study.floor,
                interaction.integration,
                interaction.damping,
                modes=modes,
                flexibility=flexibility,
            )
        found.update(run_cells(study, case, method, prepared[method.name], bar))
        done += float(cost)
    tell("done", 1.0)
    cells = {key: found[key] for key in _keys(study)}
    verdicts = {
        key: _assess(study, cell)
        for key, cell in cells.items()
        if study.assessment is not None and key.method == study.assessment.method
    }
    return StudyResult(study=study, cells=cells, verdicts=verdicts, modes=modes)


def _keys(study: Study) -> Iterator[CellKey]:
    for method in study.methods:
        for case in study.cases:
            for road in study.roads:
                yield CellKey(case.name, road, method.name)


def _part_of_bar(tell: Report, label: str, start: float, length: float) -> Callable[[float], None]:
    return lambda share: tell(label, start + share * length)


def _cost(study: Study, case: Case, method: MethodPlan) -> float:
    """Return a figure proportional to the time that a case takes."""
    integration = method.interaction.integration
    size = 2.0 * integration.f_max**1.5 if isinstance(integration, Modal) else study.floor.n_dofs
    return (0.5 + len(case.routes)) * size * study.duration / integration.dt


def _all_modes(study: Study, tell: Report) -> Modes | None:
    """Find the modes once, as far as the most demanding method needs them."""
    f_max = max(
        (
            method.interaction.integration.f_max
            for method in study.methods
            if isinstance(method.interaction.integration, Modal)
        ),
        default=0.0,
    )
    if f_max == 0.0:
        return None
    label = f"modes of the floor below {f_max:g} Hz"
    tell(label, 0.0)
    return modes_of(
        study.floor, f_max=f_max, progress=lambda share: tell(label, _MODES_SHARE * share)
    )


def _assess(study: Study, cell: Cell) -> tuple[Verdict, ...]:
    assert study.assessment is not None  # the caller has looked
    return assess_spectra(
        cell.spectra,
        cell.peak_acceleration,
        study.assessment.criteria,
        percentile=study.assessment.percentile,
        top=cell.top,
    )

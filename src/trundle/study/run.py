"""Run every cell of a study and reduce it to what is kept."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from trundle._typing import Array
from trundle.criteria import Verdict, assess_spectra
from trundle.dynamics import Modal, Modes, natural_modes
from trundle.errors import FitnessWarning
from trundle.response import BandSpectra, velocity_spectra
from trundle.simulate import PreparedFloor, Runs, StaticFlexibility, ensemble, prepare
from trundle.study.model import Case, MethodPlan, Study

__all__ = ["Cell", "CellKey", "History", "StudyResult", "run_study"]

Report = Callable[[str, float], None]
"""Told what is being done, and the share of the whole study that is done (0 to 1)."""

_MODES_SHARE = 0.45  # of a study's time, as a first guess for the bar


@dataclass(frozen=True)
class CellKey:
    """Name a cell: what drove, on what road, by which method."""

    case: str
    road: str
    method: str


@dataclass(frozen=True, kw_only=True, eq=False)
class History:
    """Hold the time histories of one run (the first) at every point.

    Attributes
    ----------
    time : ndarray of float, shape (n_steps,)
        Time [s].
    displacement, velocity, acceleration : ndarray of float, shape (n_steps, n_points)
        Response, up positive [m], [m/s], [m/s2].
    contact_forces : ndarray of float, shape (n_steps, n_contacts)
        Forces on the floor, positive when pressing [N].
    """

    time: Float[Array, " steps"]
    displacement: Float[Array, "steps points"]
    velocity: Float[Array, "steps points"]
    acceleration: Float[Array, "steps points"]
    contact_forces: Float[Array, "steps contacts"]


@dataclass(frozen=True, kw_only=True, eq=False)
class Cell:
    """Hold what is kept of one cell's ensemble.

    Attributes
    ----------
    key : CellKey
        Which cell.
    peak_acceleration : ndarray of float, shape (n_runs, n_points)
        Largest absolute acceleration [m/s2].
    rms_velocity : ndarray of float, shape (n_runs, n_points)
        RMS velocity over the record [m/s].
    spectra : BandSpectra
        One-third-octave velocity levels [m/s].
    peak_contact_force : ndarray of float, shape (n_runs, n_contacts)
        Largest contact force, static load included [N].
    contact_names : tuple of str
        Names of the contacts.
    history : History
        The first run in time.
    top : float
        Highest frequency that its levels can be trusted to [Hz].
    warnings : tuple of FitnessWarning
        Doubts about the cell.
    """

    key: CellKey
    peak_acceleration: Float[Array, "runs points"]
    rms_velocity: Float[Array, "runs points"]
    spectra: BandSpectra
    peak_contact_force: Float[Array, "runs contacts"]
    contact_names: tuple[str, ...]
    history: History
    top: float
    warnings: tuple[FitnessWarning, ...]


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
    jobs = list(_jobs(study))
    costs = np.array([_cost(study, method) for _, _, method in jobs])
    done, total = 0.0, float(costs.sum())
    cells: dict[CellKey, Cell] = {}
    verdicts: dict[CellKey, tuple[Verdict, ...]] = {}
    prepared: dict[str, PreparedFloor] = {}
    flexibility = StaticFlexibility(study.floor)
    for (case, road, method), cost in zip(jobs, costs, strict=True):
        key = CellKey(case.name, road, method.name)
        bar = _part_of_bar(
            tell,
            f"{case.name}, class {road}, {method.name}",
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
        cells[key] = _run_cell(study, key, (case, method), prepared[method.name], bar)
        if study.assessment is not None and method.name == study.assessment.method:
            verdicts[key] = _assess(study, cells[key])
        done += float(cost)
    tell("done", 1.0)
    return StudyResult(study=study, cells=cells, verdicts=verdicts, modes=modes)


def _part_of_bar(tell: Report, label: str, start: float, length: float) -> Callable[[float], None]:
    return lambda share: tell(label, start + share * length)


def _jobs(study: Study) -> Iterator[tuple[Case, str, MethodPlan]]:
    for method in study.methods:
        for case in study.cases:
            for road in study.roads:
                yield case, road, method


def _cost(study: Study, method: MethodPlan) -> float:
    """Return a figure proportional to the time that a cell takes."""
    integration = method.interaction.integration
    size = 2.0 * integration.f_max**1.5 if isinstance(integration, Modal) else study.floor.n_dofs
    return size * study.duration / integration.dt


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
    return natural_modes(
        study.floor.mass,
        study.floor.stiffness,
        f_max=f_max,
        progress=lambda share: tell(label, _MODES_SHARE * share),
    )


def _run_cell(
    study: Study,
    key: CellKey,
    job: tuple[Case, MethodPlan],
    floor: PreparedFloor,
    progress: Callable[[float], None],
) -> Cell:
    case, method = job
    runs = ensemble(
        floor,
        study.crossings(case, key.road, method),
        method=method.interaction,
        points=study.points,
        n_runs=study.runs,
        seed=study.seed,
        duration=study.duration,
        progress=progress,
    )
    averaging = study.assessment.averaging if study.assessment else "max_1s"
    spectra = velocity_spectra(runs, averaging=averaging)
    return Cell(
        key=key,
        peak_acceleration=runs.peak_acceleration(),
        rms_velocity=runs.record_rms_velocity(),
        spectra=spectra,
        peak_contact_force=runs.contact_forces.max(axis=1),
        contact_names=runs.contact_names,
        history=_first_run(runs),
        top=min(runs.f_max, runs.sampling_frequency / 2.5),
        warnings=runs.warnings,
    )


def _first_run(runs: Runs) -> History:
    return History(
        time=runs.time,
        displacement=runs.displacement[0].copy(),
        velocity=runs.velocity[0].copy(),
        acceleration=runs.acceleration[0].copy(),
        contact_forces=runs.contact_forces[0].copy(),
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

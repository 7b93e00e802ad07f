"""Run the cells of one case and method: all roads together, batch by batch."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from trundle._typing import Array
from trundle.dynamics import Modal
from trundle.errors import FitnessWarning
from trundle.response import (
    BandSpectra,
    ExactStatistics,
    Reduced,
    exact_statistics,
    join,
    reduce_runs,
)
from trundle.signals import Averaging
from trundle.simulate import PreparedFloor, Runs, batches, harmonics, lay_out, mean_response
from trundle.simulate.fitness import LOST_CONTACT, contact_warnings
from trundle.study.model import Case, MethodPlan, Study

__all__ = ["Cell", "CellKey", "History", "run_cells"]

Progress = Callable[[float], None]

_WAVES = 200  # shared among the roads of a case: 400 runs' worth
_SAMPLED_SHARE = 0.65  # of a case's time, against exact statistics


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
    tension_share : ndarray of float, shape (n_contacts,)
        Share of runs in which a contact would have had to pull.
    exact : ExactStatistics or None
        Exact statistics over all roads of the class; only modes have them.
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
    tension_share: Float[Array, " contacts"]
    exact: ExactStatistics | None
    history: History
    top: float
    warnings: tuple[FitnessWarning, ...]


def run_cells(
    study: Study, case: Case, method: MethodPlan, floor: PreparedFloor, progress: Progress
) -> dict[CellKey, Cell]:
    """Run one case by one method on every road.

    Roads of one waviness differ by a factor alone, and the system is linear; so they share one
    ensemble, whose response without roughness is subtracted, scaled about, and added again.
    """
    cells: dict[CellKey, Cell] = {}
    groups: dict[float, list[str]] = {}
    for name, road in study.roads.items():
        groups.setdefault(road.waviness, []).append(name)
    for number, names in enumerate(groups.values()):
        share = (number / len(groups), 1.0 / len(groups))
        for name, cell in _run_group(study, (case, method), names, floor, _part(progress, *share)):
            cells[CellKey(case.name, name, method.name)] = cell
    return cells


def _run_group(
    study: Study,
    job: tuple[Case, MethodPlan],
    roads: list[str],
    floor: PreparedFloor,
    progress: Progress,
) -> Iterator[tuple[str, Cell]]:
    case, method = job
    crossings = study.crossings(case, roads[0], method)
    layout = lay_out(
        floor,
        crossings,
        method=method.interaction,
        points=study.points,
        duration=study.duration,
    )
    mean = mean_response(layout)
    first = study.roads[roads[0]].roughness
    factors = {name: float(np.sqrt(study.roads[name].roughness / first)) for name in roads}
    averaging = study.assessment.averaging if study.assessment else "max_1s"
    modal = isinstance(method.interaction.integration, Modal)
    collected: dict[str, _Collected] = {name: _Collected(averaging) for name in roads}
    sampled = _part(progress, 0.0, _SAMPLED_SHARE if modal else 1.0)
    for runs in batches(layout, runs=range(study.runs), seed=study.seed, progress=sampled):
        for name, factor in factors.items():
            collected[name].add(runs.rougher(mean, factor))
    exact = None
    if modal:
        answers = harmonics(
            layout,
            n_waves=max(2, _WAVES // len(crossings)),
            progress=_part(progress, _SAMPLED_SHARE, 1.0 - _SAMPLED_SHARE),
        )
        exact = exact_statistics(mean, answers, f_max=collected[roads[0]].f_max)
    for name, factor in factors.items():
        key = CellKey(case.name, name, method.name)
        yield name, collected[name].cell(key, None if exact is None else exact.rougher(factor))


class _Collected:
    """What batches of runs on one road have left."""

    def __init__(self, averaging: Averaging) -> None:
        self._averaging: Averaging = averaging
        self._parts: list[Reduced] = []
        self._first: Runs | None = None
        self.f_max = 0.0

    def add(self, runs: Runs) -> None:
        self._parts.append(reduce_runs(runs, averaging=self._averaging))
        if self._first is None:
            self._first = _one_run(runs)
            self.f_max = runs.f_max

    def cell(self, key: CellKey, exact: ExactStatistics | None) -> Cell:
        first = self._first
        assert first is not None  # a study has at least one run
        all_runs = join(self._parts)
        share = all_runs.tension.mean(axis=0)
        return Cell(
            key=key,
            peak_acceleration=all_runs.peak_acceleration,
            rms_velocity=all_runs.rms_velocity,
            spectra=all_runs.spectra,
            peak_contact_force=all_runs.peak_contact_force,
            contact_names=first.contact_names,
            tension_share=share,
            exact=exact,
            history=History(
                time=first.time,
                displacement=first.displacement[0],
                velocity=first.velocity[0],
                acceleration=first.acceleration[0],
                contact_forces=first.contact_forces[0],
            ),
            top=min(first.f_max, first.sampling_frequency / 2.5),
            warnings=(
                *contact_warnings(float(all_runs.tension.any(axis=1).mean())),
                *(w for w in first.warnings if w.subject != LOST_CONTACT),
            ),
        )


def _one_run(runs: Runs) -> Runs:
    """Return the first run, without holding on to the others' histories."""
    return runs.only(1)


def _part(progress: Progress, start: float, length: float) -> Progress:
    return lambda share: progress(start + length * share)

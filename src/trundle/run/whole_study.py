"""Run every cell of a study."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from trundle._kinds import kinds_checked
from trundle._progress import Tell, silent
from trundle.criteria import Verdict, assess_reduced
from trundle.dynamics import Modal, Modes, repeatable
from trundle.errors import InputError
from trundle.results.cells import Cell, CellKey
from trundle.results.maps import MapKey, StudyMap, map_of
from trundle.results.pieces import Piece, cell_of
from trundle.results.study_result import StudyResult
from trundle.run.estimate import shares_of
from trundle.run.in_threads import compute_here
from trundle.run.jobs import Job, lay_out_job, plan_jobs
from trundle.run.mode_cache import modes_of
from trundle.run.progress import Bar
from trundle.run.scale_out import Cluster
from trundle.run.unfinished import InMemory, PieceStore
from trundle.simulate import Coupled, PreparedFloor, StaticFlexibility, prepare
from trundle.structure import Floor
from trundle.study.model import Study

__all__ = ["run_study"]


@kinds_checked
def run_study(
    study: Study,
    *,
    report: Tell | None = None,
    store: PieceStore | None = None,
    cluster: Cluster | None = None,
) -> StudyResult:
    """Run every case on every road by every method.

    Parameters
    ----------
    study : Study
        A checked study.
    report : callable, optional
        Told what is being done and the share done.
    store : PieceStore, optional
        Where finished pieces are kept; those found there are not computed again.
    cluster : Cluster, optional
        Where pieces are computed; in this process unless given.

    Returns
    -------
    StudyResult
        Reduced results; the same study gives the same bits, whatever computes it.
    """
    tell = report or silent
    store = store if store is not None else InMemory()
    jobs = plan_jobs(study)
    share, costs = shares_of(study, jobs)
    modes = _all_modes(study, lambda what, done: tell(what, share * done))
    bar = Bar(tell, share, costs)
    floors = _Floors(study.floor, modes, jobs)
    missing = {job: [i for i, name in enumerate(job.pieces) if not store.has(name)] for job in jobs}
    bar.finished(
        job.pieces[i] for job in jobs for i in range(len(job.pieces)) if i not in missing[job]
    )

    def keep(name: str, piece: Piece) -> None:
        """Keep a finished piece, and tell of it."""
        store.save(name, piece)
        bar.finished([name])

    if cluster is None:
        compute_here(
            missing,
            lambda job: lay_out_job(job, floors.of(job)),
            begin=bar.begin,
            progress=bar.part,
            done=keep,
        )
    else:
        with repeatable():
            for job, parts in missing.items():
                if parts:
                    bar.begin(job)
                    carrier = lay_out_job(job, floors.of(job)) if job.modal else study.floor
                    cluster.submit(job, parts, carrier)
                    cluster.collect(keep, wait=False)
            cluster.collect(keep, wait=True)
    tell("done", 1.0)
    return _result(study, jobs, store, modes)


def _result(
    study: Study, jobs: tuple[Job, ...], store: PieceStore, modes: Modes | None
) -> StudyResult:
    found: dict[CellKey, Cell] = {}
    maps: dict[MapKey, StudyMap] = {}
    for job in jobs:
        pieces = [store.load(name) for name in job.pieces]
        for i, (road, factor) in enumerate(job.factors.items()):
            key = CellKey(job.case.name, road, job.method.name)
            if job.speed is None:
                found[key] = cell_of(key, i, factor, pieces)
            if job.map is not None:
                map_key = MapKey(job.case.name, road, job.speed)
                maps[map_key] = map_of(job.map, pieces[-1], i)
    cells = {key: found[key] for key in _keys(study)}
    verdicts = {
        key: _assess(study, cell)
        for key, cell in cells.items()
        if study.assessment is not None and key.method == study.assessment.method
    }
    return StudyResult(
        study=study,
        cells=cells,
        verdicts=verdicts,
        maps=_in_order(study, maps),
        modes=modes,
    )


def _in_order(study: Study, maps: Mapping[MapKey, StudyMap]) -> dict[MapKey, StudyMap]:
    """Return maps by speed, the study's own first, then by case and road."""
    speeds = () if study.map is None else study.map.speeds
    keys = (
        MapKey(case.name, road, speed)
        for speed in (None, *speeds)
        for case in study.cases
        for road in study.roads
    )
    return {key: maps[key] for key in keys if key in maps}


class _Floors:
    """Prepare the floor for each method once, and hold one of them at a time."""

    def __init__(self, floor: Floor, modes: Modes | None, jobs: tuple[Job, ...]) -> None:
        self._floor, self._modes = floor, modes
        self._flexibility = StaticFlexibility(floor)
        # All routes, whatever is missing: a resumed run must solve for the same things together.
        coupled = [job for job in jobs if job.modal and isinstance(job.method.interaction, Coupled)]
        self._routes = {crossing.route: crossing for job in coupled for crossing in job.crossings}
        self._held: tuple[str, PreparedFloor] | None = None

    def of(self, job: Job) -> PreparedFloor:
        """Return the floor as a job's method needs it."""
        name, interaction = job.method.name, job.method.interaction
        if self._routes:
            self._flexibility.cover(tuple(self._routes.values()))
            self._routes = {}
        if self._held is None or self._held[0] != name:
            self._held = None  # lets go of the last one's factor first
            prepared = prepare(
                self._floor,
                interaction.integration,
                interaction.damping,
                modes=self._modes,
                flexibility=self._flexibility,
            )
            self._held = (name, prepared)
        return self._held[1]


def _keys(study: Study) -> Iterator[CellKey]:
    for method in study.methods:
        for case in study.cases:
            for road in study.roads:
                yield CellKey(case.name, road, method.name)


def _all_modes(study: Study, tell: Tell) -> Modes | None:
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
    with repeatable():
        modes = modes_of(study.floor, f_max=f_max, progress=lambda share: tell(label, share))
    _check_first_mode(study, modes)
    return modes


def _check_first_mode(study: Study, modes: Modes) -> None:
    """Refuse a method that keeps no mode below half its frequency: nothing would tell its error."""
    first = float(modes.frequencies[0])
    for method in study.methods:
        f_max = getattr(method.interaction.integration, "f_max", np.inf)
        if first >= 0.5 * f_max:
            raise InputError(
                f"{study.source}: method {method.name!r} keeps modes to f_max = {f_max:g} Hz, and "
                f"the floor's first is at {first:.3g} Hz: raise f_max above {2.0 * first:.3g} Hz, "
                "better to 112 Hz, which shows all bands to 80 Hz"
            )


def _assess(study: Study, cell: Cell) -> tuple[Verdict, ...]:
    assert study.assessment is not None  # the caller has looked
    return assess_reduced(
        cell.reduced,
        study.assessment.criteria,
        percentile=study.assessment.percentile,
        top=cell.top,
        coverage=cell.coverage,
        events=study.assessment.events,
    )

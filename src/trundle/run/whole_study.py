"""Run every cell of a study."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import nullcontext
from dataclasses import replace

from trundle._kinds import kinds_checked
from trundle._progress import Tell, silent
from trundle._words import in_kmh
from trundle.criteria import Verdict, assess_reduced
from trundle.dynamics import Modes, repeatable
from trundle.errors import InputError
from trundle.results.cells import Cell, CellKey, DayKey
from trundle.results.maps import MapKey, StudyMap
from trundle.results.modes import first_modes
from trundle.results.parts import DayPart, MapPart, cell_of
from trundle.results.provenance import provenance_of
from trundle.results.study_result import StudyResult
from trundle.run.answering import answers_to_jobs, asks_for_answers
from trundle.run.checkpoint import InMemory, PieceStore
from trundle.run.estimate import seconds_of_modes, size_of
from trundle.run.executor import Batch, Executor, carry_out
from trundle.run.floors import Floors
from trundle.run.jobs import Job, plan_jobs, prepare_job
from trundle.run.memory import give_back
from trundle.run.mesh_light import mesh_change
from trundle.run.mode_cache import modes_of
from trundle.run.parts import near_to_jobs, with_kept_parts
from trundle.run.parts_light import parts_change
from trundle.run.progress import Bar
from trundle.run.tasks import tasks_of
from trundle.run.threads import Threads
from trundle.structure import Structure
from trundle.study.model import Study
from trundle.traffic import Day

__all__ = ["run_study"]


@kinds_checked
def run_study(
    study: Study,
    *,
    tell: Tell | None = None,
    store: PieceStore | None = None,
    executor: Executor | None = None,
) -> StudyResult:
    """Run every case on every road by every method.

    Parameters
    ----------
    study : Study
        A checked study.
    tell : callable, optional
        Told what is being done and the share done.
    store : PieceStore, optional
        Where finished pieces are kept; those found there are not computed again.
    executor : Executor, optional
        Who computes; threads of this process unless given.

    Returns
    -------
    StudyResult
        The results; the same study gives the same bits, whoever computes it.
    """
    tell = tell or silent
    store = store if store is not None else InMemory()
    result, modes, floor = _computed(study, plan_jobs(study), tell, store, executor)
    result = replace(
        result,
        mesh=mesh_change(study, result.cells, modes, _run, tell),
        parts=parts_change(study, floor, result.cells, modes, run=_run, tell=tell),
    )
    tell("done", 1.0)
    return result


def _computed(
    study: Study, jobs: tuple[Job, ...], tell: Tell, store: PieceStore, executor: Executor | None
) -> tuple[StudyResult, Modes | None, Structure]:
    """Return what jobs of a study give, its modes, and its structure with its parts reduced."""
    give_back()
    of_modes = seconds_of_modes(study, jobs)
    costs = {t.name: t.seconds(size_of(study, job)) for job in jobs for t in tasks_of(job)}
    share = of_modes / (of_modes + sum(costs.values()))
    with nullcontext(executor) if executor is not None else Threads() as who:
        floor = near_to_jobs(with_kept_parts(study.floor, who), jobs)
        modes = _all_modes(study, floor, jobs, who, lambda what, done: tell(what, share * done))
        floors = Floors(floor, modes, jobs)
        batches = [
            Batch(
                label=_label(job),
                job=job,
                tasks=tasks_of(job),
                floor=study.floor,
                lay_out=lambda job=job: prepare_job(job, floors.of(job)),
            )
            for job in jobs
        ]
        carry_out(batches, who, store, Bar(tell, share, costs))
    return _result(study, jobs, store, modes), modes, floor


def _run(study: Study, tell: Tell) -> StudyResult:
    """Run a study for its levels alone: nobody looks at its exact statistics."""
    jobs = tuple(replace(job, n_waves=0) for job in plan_jobs(study))
    return _computed(study, jobs, tell, InMemory(), None)[0]


def _label(job: Job) -> str:
    at = "" if job.speed is None else f" at {in_kmh(job.speed)}"
    return f"{job.case.name}{at}, {job.method.name}"


def _result(
    study: Study, jobs: tuple[Job, ...], store: PieceStore, modes: Modes | None
) -> StudyResult:
    found: dict[CellKey, Cell] = {}
    maps: dict[MapKey, StudyMap] = {}
    days: dict[DayKey, Day] = {}
    for job in jobs:
        parts = [store.load(task.name) for task in tasks_of(job)]
        for part in parts:
            if isinstance(part, DayPart):
                keys = (DayKey(job.case.name, road) for road in job.factors)
                days |= dict(zip(keys, part.days, strict=True))
        if job.schedule is not None:
            continue
        mapped = [part for part in parts if isinstance(part, MapPart)]
        for i, (road, factor) in enumerate(job.factors.items()):
            key = CellKey(job.case.name, road, job.method.name)
            if job.speed is None:
                found[key] = cell_of(key, i, factor, parts)
            for part in mapped:
                maps[MapKey(job.case.name, road, job.speed)] = part.maps[i]
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
        days={key: days[key] for key in _day_keys(study) if key in days},
        modes=None if modes is None or modes.answering else first_modes(modes, study.floor),
        mesh=None,
        provenance=provenance_of(study),
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


def _day_keys(study: Study) -> Iterator[DayKey]:
    for name in study.schedules:
        for road in study.roads:
            yield DayKey(name, road)


def _keys(study: Study) -> Iterator[CellKey]:
    for method in study.methods:
        for case in study.cases:
            for road in study.roads:
                yield CellKey(case.name, road, method.name)


def _all_modes(
    study: Study, floor: Structure, jobs: Sequence[Job], who: Executor, tell: Tell
) -> Modes | None:
    """Find the modes once, as far as the most demanding method needs them, or what answers."""
    f_max = max(
        (method.interaction.integration.f_max or 0.0 for method in study.methods), default=0.0
    )
    if f_max == 0.0:
        return None
    what = "answers" if asks_for_answers(floor) else "modes"
    label = f"{what} of the floor below {f_max:g} Hz"

    def progress(share: float) -> None:
        """Tell it by its label."""
        tell(label, share)

    progress(0.0)
    if asks_for_answers(floor):
        modal = [job for job in jobs if job.modal]
        modes = answers_to_jobs(floor, modal, f_max=f_max, progress=progress, executor=who)
    else:
        with repeatable():
            modes = modes_of(floor, f_max=f_max, progress=progress, executor=who)
    _check_first_mode(study, modes)
    return modes


def _check_first_mode(study: Study, modes: Modes) -> None:
    """Refuse a method that keeps no mode below half its frequency: nothing would tell its error."""
    if not modes.n_modes:
        raise InputError(
            f"{study.source}: the floor has no mode below {modes.f_max:g} Hz, the highest f_max of "
            "the methods: raise f_max, better to 112 Hz, which shows all bands to 80 Hz"
        )
    first = float(modes.frequencies[0])
    for method in study.methods:
        f_max = method.interaction.integration.f_max
        if f_max is not None and first >= 0.5 * f_max:
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
        f_resolved=cell.f_resolved,
        coverage=cell.coverage,
        events=study.assessment.events,
        axes=study.point_ways,
    )

"""Try what would help: other speeds, roads, vehicles, slabs, damping, isolators."""

from __future__ import annotations

import itertools
from collections import Counter
from collections.abc import Sequence
from contextlib import nullcontext

import numpy as np

from trundle._kinds import kinds_checked
from trundle._progress import Tell, silent
from trundle._words import in_kmh
from trundle.criteria import assess_reduced
from trundle.dynamics import Modes, repeatable
from trundle.errors import InputError
from trundle.mitigate.changes import Change, changed_study
from trundle.mitigate.outcome import Outcome, Sweep
from trundle.mitigate.plan import Combination, assessed, plan_changes
from trundle.response import few_runs_warnings, level_warnings
from trundle.results.parts import ChangesPart, RunsPart, joined
from trundle.run.answering import answers_to_jobs, asks_for_answers
from trundle.run.checkpoint import InMemory, PieceStore
from trundle.run.estimate import mode_seconds, size_of
from trundle.run.executor import Batch, Executor, carry_out
from trundle.run.floors import Floors
from trundle.run.jobs import Job, prepare_job
from trundle.run.mode_cache import modes_of
from trundle.run.parts import near_to_jobs, with_kept_parts
from trundle.run.progress import Bar
from trundle.run.threads import Threads
from trundle.structure import Structure
from trundle.study.model import Study, directions
from trundle.vehicle import Vehicle

__all__ = ["check_changes", "check_speeds", "resonance_speeds", "try_changes"]

_LEAST_STEPS, _MOST_STEPS = 20, 100_000  # of a crossing
_ORDERS = (1, 2, 3)  # multiples of the axle passing frequency that are marked


@kinds_checked
def try_changes(
    study: Study,
    *,
    changes: Sequence[Change],
    speeds: Sequence[float],
    roads: Sequence[str],
    runs: int,
    tell: Tell | None = None,
    store: PieceStore | None = None,
    executor: Executor | None = None,
) -> Sweep:
    """Run every combination of changes, speeds and road classes, and hold it against the criteria.

    Parameters
    ----------
    study : Study
        A study with criteria; its assessed method is used.
    changes : sequence of Change
        Other vehicles, slabs, dampings, isolators, see `each_change` and `every_combination`.
        Those that differ by their isolators alone share their runs.
    speeds : sequence of float
        Speeds of every vehicle [m/s].
    roads : sequence of str
        Road classes, A to H, at the geometric mean.
    runs : int
        Runs of each combination.
    tell : callable, optional
        Told what is being done, and the share done.
    store : PieceStore, optional
        Where finished pieces are kept; those found there are not computed again.
    executor : Executor, optional
        Who computes; threads of this process unless given.
    """
    check_changes(study, changes)
    check_speeds(study, speeds)
    if not roads or runs < 1:
        raise InputError(f"give at least one road class and one run; got {roads!r} and {runs}")
    tell = tell or silent
    store = store if store is not None else InMemory()
    planned = plan_changes(study, changes=changes, speeds=speeds, roads=roads, runs=runs)
    bar = _bar(study, planned, tell)
    resonances: dict[tuple[str, str], tuple[float, ...]] = {}
    with nullcontext(executor) if executor is not None else Threads() as who:
        for thickness, group in itertools.groupby(planned, key=lambda one: one.slab_thickness):
            of_slab = list(group)
            slab = changed_study(study, Change(slab_thickness=thickness))
            bar.begin(f"{of_slab[0].changes[0].label}: modes of the floor")
            jobs = [one.job for one in of_slab]
            floor = near_to_jobs(with_kept_parts(slab.floor, who), jobs)
            modes = _modes(slab, floor, jobs, who)
            bar.finished([_name(thickness)])
            carry_out(_batches(slab, floor, of_slab, modes), who, store, bar)
            resonances |= _resonances(study, of_slab, modes, speeds)
    tell("done", 1.0)
    found: dict[tuple[str, float, str], list[Outcome]] = {}
    for one in planned:  # roads may be run apart
        for outcomes in _outcomes(study, one, store):
            key = (outcomes[0].change, one.speed, one.case.name)
            found.setdefault(key, []).extend(outcomes)
    labels, names = [change.label for change in changes], [case.name for case in study.cases]
    ordered = (found[key] for key in itertools.product(labels, speeds, names))
    return Sweep(
        study=study,
        changes=tuple(labels),
        speeds=tuple(speeds),
        roads=tuple(roads),
        runs=runs,
        outcomes=tuple(itertools.chain.from_iterable(ordered)),
        resonances=resonances,
    )


def check_changes(study: Study, changes: Sequence[Change]) -> None:
    """Refuse a study without criteria, no change, and changes of one name."""
    if not changes:
        raise InputError("give at least one change; Change() is the study as it is")
    if study.assessment is None:
        raise InputError(f"{study.source}: has no [criteria] to hold changes against; add them")
    for label, times in Counter(change.label for change in changes).items():
        if times > 1:
            raise InputError(f"{times} changes are called {label!r}; give each a name of its own")


def check_speeds(study: Study, speeds: Sequence[float]) -> None:
    """Refuse speeds at which a crossing takes next to no steps, or endlessly many [m/s]."""
    if not speeds:
        raise InputError("give at least one speed [m/s]")
    dt = min(method.interaction.integration.dt for method in study.methods)
    if not study.drives:
        raise InputError("nobody drives in this study: changes are compared under vehicles")
    longest = max(drive.route.length + drive.vehicle.length for drive in study.drives.values())
    for speed in speeds:
        steps = longest / speed / dt if speed > 0.0 else np.inf
        if not _LEAST_STEPS < steps < _MOST_STEPS:
            raise InputError(
                f"a speed of {in_kmh(speed, 6)} crosses the longest route in {steps:.3g} steps "
                f"of {1e3 * dt:g} ms; {_LEAST_STEPS} to {_MOST_STEPS} are computed"
            )


def resonance_speeds(vehicle: Vehicle, f1: float, speeds: Sequence[float]) -> tuple[float, ...]:
    """Return speeds within a range at which axles pass a place in step with a floor's first mode.

    ``V = f1 d / k`` for the distances d between axles that follow each other, k = 1, 2, 3.

    Parameters
    ----------
    vehicle : Vehicle
        What drives.
    f1 : float
        First natural frequency of the floor [Hz].
    speeds : sequence of float
        The range [m/s].
    """
    distances = np.unique(np.round(np.diff(np.unique(vehicle.setback)), 6))
    found = (f1 * d / k for d in distances for k in _ORDERS)
    return tuple(sorted({float(v) for v in found if min(speeds) <= v <= max(speeds)}))


def _name(thickness: float | None) -> str:
    """Name the modes of a slab among what takes time."""
    return f"modes of slab {thickness}"


def _bar(study: Study, planned: Sequence[Combination], tell: Tell) -> Bar:
    """Return what tells the share done, by what modes and tasks cost."""
    costs: dict[str, float] = {}
    for one in planned:
        size = size_of(study, one.job)
        of_modes = mode_seconds(size.n_dofs, size.n_modes, parted=study.parting is not None)
        costs[_name(one.slab_thickness)] = of_modes + 1e-3
        costs |= {task.name: task.seconds(size) for task in one.tasks(study)}
    return Bar(tell, 0.0, costs)


def _modes(slab: Study, floor: Structure, jobs: Sequence[Job], who: Executor) -> Modes | None:
    """Find the modes of a slab as far as the assessed method keeps them, or what answers."""
    f_max = assessed(slab)[1].interaction.integration.f_max
    if f_max is None:
        return None
    if asks_for_answers(floor):
        return answers_to_jobs(floor, jobs, f_max=f_max, executor=who)
    with repeatable():
        return modes_of(floor, f_max=f_max, executor=who)


def _batches(
    slab: Study, floor: Structure, combinations: Sequence[Combination], modes: Modes | None
) -> list[Batch]:
    """Return the tasks of the combinations of one slab, ready to be laid out."""
    floors = Floors(floor, modes, [one.job for one in combinations])
    return [
        Batch(
            label=one.label,
            job=one.job,
            tasks=one.tasks(slab),
            floor=slab.floor,
            lay_out=lambda job=one.job: prepare_job(job, floors.of(job)),
        )
        for one in combinations
    ]


def _resonances(
    study: Study, combinations: Sequence[Combination], modes: Modes | None, speeds: Sequence[float]
) -> dict[tuple[str, str], tuple[float, ...]]:
    """Return by change and case the speeds at which axles pass in step with the first mode."""
    known = None if modes is None or modes.answering else modes  # combinations are no modes
    found: dict[tuple[str, str], tuple[float, ...]] = {}
    for one in combinations:
        for change in one.changes:
            drives = changed_study(study, Change(vehicle=change.vehicle)).drives
            vehicles = [drives[n].vehicle for n in one.case.routes if n in drives] if known else []
            f1 = float(known.frequencies[0]) if known else np.nan
            marked = {v for vehicle in vehicles for v in resonance_speeds(vehicle, f1, speeds)}
            found[change.label, one.case.name] = tuple(sorted(marked))
    return found


def _outcomes(study: Study, one: Combination, store: PieceStore) -> list[list[Outcome]]:
    """Hold the runs of a combination against the criteria, by change and road."""
    parts = [store.load(task.name) for task in one.tasks(study)]
    by_part = [part.variants for part in parts if isinstance(part, ChangesPart)]
    by_change = [joined(variants) for variants in zip(*by_part, strict=True)]
    return [
        _of_change(study, one, change.label, runs)
        for change, runs in zip(one.changes, by_change, strict=True)
    ]


def _of_change(study: Study, one: Combination, label: str, runs: RunsPart) -> list[Outcome]:
    """Hold the runs of one change against the criteria, on every road."""
    assessment, _ = assessed(study)
    first = runs.reduced[0]
    doubts = (
        *level_warnings(assessment.averaging, runs.ends, levels=first.spectra),
        *few_runs_warnings(len(first.rms_velocity), assessment.percentile),
    )
    return [
        Outcome(
            change=label,
            case=one.case.name,
            speed=one.speed,
            road=road,
            verdicts=assess_reduced(
                runs.reduced[i],
                assessment.criteria,
                percentile=assessment.percentile,
                f_resolved=runs.f_resolved,
                coverage=runs.coverage,
                events=assessment.events,
                axes=directions(one.job.points),
            ),
            excited_to=runs.coverage.excited_to,
            warnings=(*runs.doubts(i), *doubts),
        )
        for i, road in enumerate(one.job.factors)
    ]

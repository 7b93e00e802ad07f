"""Try what would help: other speeds, roads, vehicles, slabs, damping, isolators."""

from __future__ import annotations

import itertools
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from trundle._progress import Tell, silent
from trundle.criteria import assess_reduced, spectra_asked_for
from trundle.dynamics import Modes, repeatable
from trundle.errors import InputError
from trundle.mitigate.changes import Change, changed_study
from trundle.mitigate.sweep import Outcome, Sweep
from trundle.response import (
    behind_isolators,
    few_runs_warnings,
    level_warnings,
    reduce_rougher,
)
from trundle.road import RoadClass
from trundle.run.mode_cache import modes_of
from trundle.simulate import (
    MeanResponse,
    PreparedFloor,
    Runs,
    StaticFlexibility,
    lay_out,
    prepare,
    runs_with_mean,
)
from trundle.simulate.fitness import LOST_CONTACT, contact_warnings
from trundle.study.model import Assessment, Case, MethodPlan, Study
from trundle.vehicle import Vehicle

__all__ = ["check_speeds", "resonance_speeds", "sharing_runs", "try_changes"]

_LEAST_STEPS, _MOST_STEPS = 20, 100_000  # of a crossing
_ORDERS = (1, 2, 3)  # multiples of the axle passing frequency that are marked


def try_changes(
    study: Study,
    *,
    changes: Sequence[Change],
    speeds: Sequence[float],
    roads: Sequence[str],
    runs: int,
    report: Tell | None = None,
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
    report : callable, optional
        Told what is being done, and the share done.
    """
    if study.assessment is None:
        raise InputError(f"{study.source}: has no [criteria] to hold changes against; add them")
    for label, times in Counter(change.label for change in changes).items():
        if times > 1:
            raise InputError(f"{times} changes are called {label!r}; give each a name of its own")
    check_speeds(study, speeds)
    tell = report or silent
    alike = sharing_runs(changes)
    total, done = len(alike) * len(speeds) * len(study.cases), 0
    found: dict[tuple[str, float, str], list[Outcome]] = {}
    resonances: dict[tuple[str, str], tuple[float, ...]] = {}
    slab: _Slab | None = None
    with repeatable():
        for together in alike:
            first = together[0]
            tell(f"{first.label}: modes of the floor", done / total)
            if slab is None or slab.thickness != first.slab_thickness:
                slab = _slab(study, first.slab_thickness)
            tried = _tried(slab, first, roads)
            for case in study.cases:
                marked = _resonances(tried, case, speeds)
                resonances |= {(change.label, case.name): marked for change in together}
            for speed, case in itertools.product(speeds, study.cases):
                tell(f"{first.label}: {case.name} at {3.6 * speed:.3g} km/h", done / total)
                passages = _passages(tried, case, speed, runs)
                for change in together:
                    outcomes = _outcomes(tried, passages, change, case, speed)
                    found[change.label, speed, case.name] = outcomes
                done += 1
    tell("done", 1.0)
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


def check_speeds(study: Study, speeds: Sequence[float]) -> None:
    """Refuse speeds at which a crossing takes next to no steps, or endlessly many [m/s]."""
    dt = min(method.interaction.integration.dt for method in study.methods)
    longest = max(drive.route.length + drive.vehicle.length for drive in study.drives.values())
    for speed in speeds:
        steps = longest / speed / dt if speed > 0.0 else np.inf
        if not _LEAST_STEPS < steps < _MOST_STEPS:
            raise InputError(
                f"a speed of {3.6 * speed:g} km/h crosses the longest route in {steps:.3g} steps "
                f"of {1e3 * dt:g} ms; {_LEAST_STEPS} to {_MOST_STEPS} are computed"
            )


def sharing_runs(changes: Sequence[Change]) -> list[list[Change]]:
    """Return changes that differ by their isolators alone together, those of one slab in a row."""
    groups: dict[tuple[float, float, int], list[Change]] = {}
    for change in changes:
        key = (change.slab_thickness or 0.0, change.damping_ratio or 0.0, id(change.vehicle))
        groups.setdefault(key, []).append(change)
    return sorted(groups.values(), key=lambda group: group[0].slab_thickness or 0.0)


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


@dataclass(frozen=True, kw_only=True, eq=False)
class _Slab:
    """The study with a slab of some thickness, and what is known of its floor."""

    thickness: float | None
    study: Study
    modes: Modes | None
    flexibility: StaticFlexibility


@dataclass(frozen=True, kw_only=True, eq=False)
class _Tried:
    """The study as changed, but for isolators, on the first of the roads."""

    study: Study
    method: MethodPlan
    assessment: Assessment
    prepared: PreparedFloor
    classes: tuple[RoadClass, ...]


@dataclass(frozen=True, kw_only=True, eq=False)
class _Passages:
    """The runs of one case at one speed on the first road, and their mean."""

    runs: Runs
    mean: MeanResponse


def _slab(study: Study, thickness: float | None) -> _Slab:
    changed = changed_study(study, Change(slab_thickness=thickness))
    method = _assessed(changed)[1]
    f_max = getattr(method.interaction.integration, "f_max", None)
    modes = None if f_max is None else modes_of(changed.floor, f_max=f_max)
    flexibility = StaticFlexibility(changed.floor)
    return _Slab(thickness=thickness, study=changed, modes=modes, flexibility=flexibility)


def _tried(slab: _Slab, change: Change, roads: Sequence[str]) -> _Tried:
    classes = tuple(RoadClass(name) for name in roads)  # pyright: ignore[reportArgumentType] - checked
    rest = replace(change, slab_thickness=None, isolation=None)
    study = replace(changed_study(slab.study, rest), roads={"first": classes[0]})
    assessment, method = _assessed(study)
    interaction = method.interaction
    return _Tried(
        study=study,
        method=method,
        assessment=assessment,
        prepared=prepare(
            study.floor,
            interaction.integration,
            interaction.damping,
            modes=slab.modes,
            flexibility=slab.flexibility,
        ),
        classes=classes,
    )


def _assessed(study: Study) -> tuple[Assessment, MethodPlan]:
    assessment = study.assessment
    assert assessment is not None  # looked for at the start
    return assessment, next(m for m in study.methods if m.name == assessment.method)


def _resonances(tried: _Tried, case: Case, speeds: Sequence[float]) -> tuple[float, ...]:
    modes = tried.prepared.modes
    if modes is None:
        return ()
    f1 = float(modes.frequencies[0])
    vehicles = [tried.study.drives[name].vehicle for name in case.routes]
    return tuple(sorted({v for one in vehicles for v in resonance_speeds(one, f1, speeds)}))


def _passages(tried: _Tried, case: Case, speed: float, runs: int) -> _Passages:
    """Run one case at one speed; the other roads differ by a factor alone."""
    study = tried.study.at_speed(speed)
    crossings = study.crossings(case, "first", tried.method)
    layout = lay_out(
        tried.prepared,
        crossings,
        method=tried.method.interaction,
        points=study.points,
        duration=study.long_enough(crossings),
    )
    found, mean = runs_with_mean(layout, runs=range(runs), seed=study.seed)
    return _Passages(runs=found, mean=mean)


def _outcomes(
    tried: _Tried, passages: _Passages, change: Change, case: Case, speed: float
) -> list[Outcome]:
    """Hold passages behind the isolators of a change against the criteria, on every road."""
    study = changed_study(tried.study, Change(isolation=change.isolation))
    assessment, runs = tried.assessment, passages.runs
    factors = [float(np.sqrt(c.roughness / tried.classes[0].roughness)) for c in tried.classes]
    reduced = reduce_rougher(
        behind_isolators(runs, study.isolations),
        behind_isolators(passages.mean, study.isolations),
        factors,
        averaging=assessment.averaging,
        quantities=spectra_asked_for(assessment.criteria),
    )
    doubts = (
        *(w for w in runs.warnings if w.subject != LOST_CONTACT),
        *level_warnings(assessment.averaging, float(runs.time[-1]), levels=reduced[0].spectra),
        *few_runs_warnings(len(runs.acceleration), assessment.percentile),
    )
    return [
        Outcome(
            change=change.label,
            case=case.name,
            speed=speed,
            road=road.name,
            verdicts=assess_reduced(
                one,
                assessment.criteria,
                percentile=assessment.percentile,
                top=min(runs.f_max, runs.sampling_frequency / 2.5),
                coverage=runs.coverage,
                events=assessment.events,
            ),
            excited_to=runs.coverage.excited_to,
            warnings=(*contact_warnings(float(one.tension.any(axis=1).mean())), *doubts),
        )
        for road, one in zip(tried.classes, reduced, strict=True)
    ]

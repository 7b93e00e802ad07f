"""Try what would help: other speeds, roads, vehicles, slabs, damping, isolators."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from threadpoolctl import threadpool_limits

from trundle.criteria import Verdict, assess_reduced, spectra_asked_for
from trundle.dynamics import ModalRatio, Modes
from trundle.errors import FitnessWarning, InputError
from trundle.response import behind_isolators, reduce_rougher
from trundle.road import RoadClass
from trundle.route import ConstantSpeed
from trundle.signals import Isolation
from trundle.simulate import PreparedFloor, StaticFlexibility, lay_out, prepare, runs_with_mean
from trundle.simulate.fitness import LOST_CONTACT, contact_warnings
from trundle.structure import build_floor
from trundle.study.mode_cache import modes_of
from trundle.study.model import Case, MethodPlan, Study
from trundle.vehicle import Vehicle

__all__ = ["Change", "Outcome", "Sweep", "resonance_speeds", "try_changes"]

_TAIL = 5.0  # s of record after the last wheel has left
_ORDERS = (1, 2, 3)  # multiples of the axle passing frequency that are marked


@dataclass(frozen=True, kw_only=True, eq=False)
class Change:
    """Hold one change to a study; what is None stays as it is.

    Attributes
    ----------
    label : str
        What it is, for tables.
    vehicle : Vehicle or None
        Drives every route instead.
    slab_thickness : float or None
        Thickness of the slab [m].
    damping_ratio : float or None
        Damping ratio of every mode.
    isolation : Isolator, TransmissibilityTable or None
        Stands at every point.
    """

    label: str = "as in the study"
    vehicle: Vehicle | None = None
    slab_thickness: float | None = None
    damping_ratio: float | None = None
    isolation: Isolation | None = None


@dataclass(frozen=True, kw_only=True, eq=False)
class Outcome:
    """Hold the verdicts of one combination.

    Attributes
    ----------
    change : str
        Label of the change.
    case : str
        What drives.
    speed : float
        Speed of every vehicle [m/s].
    road : str
        Road class.
    verdicts : tuple of Verdict
        By point, then by criterion.
    warnings : tuple of FitnessWarning
        Doubts about it.
    """

    change: str
    case: str
    speed: float
    road: str
    verdicts: tuple[Verdict, ...]
    warnings: tuple[FitnessWarning, ...]


@dataclass(frozen=True, kw_only=True, eq=False)
class Sweep:
    """Hold all combinations that were tried.

    Attributes
    ----------
    study : Study
        What was changed.
    changes, speeds, roads : tuple
        What was combined: labels, speeds [m/s], road classes.
    runs : int
        Runs of each combination.
    outcomes : tuple of Outcome
        One for each combination.
    resonances : mapping of str to tuple of float
        Speeds [m/s] at which axles of a change's vehicle pass at its floor's first frequency, or
        a half or a third of it.
    """

    study: Study
    changes: tuple[str, ...]
    speeds: tuple[float, ...]
    roads: tuple[str, ...]
    runs: int
    outcomes: tuple[Outcome, ...]
    resonances: Mapping[str, tuple[float, ...]]

    def warnings(self) -> tuple[str, ...]:
        """Return every doubt once, with the speed and the road that it is about."""
        found: dict[str, None] = {}
        for one in self.outcomes:
            road = f", class {one.road}"
            for warning in one.warnings:
                place = road if warning.subject == LOST_CONTACT else ""
                found[f"{3.6 * one.speed:.3g} km/h{place}: {warning}"] = None
        return tuple(found)

    def margin(self, change: str, case: str, road: str, point: str, criterion: str) -> np.ndarray:
        """Return the margin to a criterion at every speed, (n_speeds,)."""
        found = {
            o.speed: v.margin
            for o in self.outcomes
            if (o.change, o.case, o.road) == (change, case, road)
            for v in o.verdicts
            if (v.point, v.criterion.name) == (point, criterion)
        }
        return np.array([found[speed] for speed in self.speeds])


def try_changes(
    study: Study,
    *,
    changes: Sequence[Change],
    speeds: Sequence[float],
    roads: Sequence[str],
    runs: int,
    report: Callable[[str, float], None] | None = None,
) -> Sweep:
    """Run every combination of changes, speeds and road classes, and hold it against the criteria.

    Parameters
    ----------
    study : Study
        A study with criteria; its assessed method is used.
    changes : sequence of Change
        Other vehicles, slabs, dampings, isolators.
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
    tell = report or (lambda _what, _share: None)
    total, done = len(changes) * len(speeds) * len(study.cases), 0
    outcomes: list[Outcome] = []
    resonances: dict[str, tuple[float, ...]] = {}
    with threadpool_limits(limits=1, user_api="blas"):
        for change in changes:
            changed, method = _changed(study, change)
            tell(f"{change.label}: modes of the floor", done / total)
            modes = _modes(changed, method)
            prepared = prepare(
                changed.floor,
                method.interaction.integration,
                method.interaction.damping,
                modes=modes,
                flexibility=StaticFlexibility(changed.floor),
            )
            vehicle = next(iter(changed.drives.values())).vehicle
            f1 = float(modes.frequencies[0]) if modes is not None else 0.0
            resonances[change.label] = resonance_speeds(vehicle, f1, speeds)
            for speed in speeds:
                at_speed = _at_speed(changed, speed)
                for case in study.cases:
                    tell(f"{change.label}: {case.name} at {3.6 * speed:.3g} km/h", done / total)
                    outcomes += [
                        Outcome(
                            change=change.label,
                            case=case.name,
                            speed=speed,
                            road=road,
                            verdicts=verdicts,
                            warnings=warnings,
                        )
                        for road, verdicts, warnings in _verdicts(
                            at_speed, case, method, prepared, roads=roads, runs=runs
                        )
                    ]
                    done += 1
    tell("done", 1.0)
    return Sweep(
        study=study,
        changes=tuple(change.label for change in changes),
        speeds=tuple(speeds),
        roads=tuple(roads),
        runs=runs,
        outcomes=tuple(outcomes),
        resonances=resonances,
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


def _changed(study: Study, change: Change) -> tuple[Study, MethodPlan]:
    """Return the study with a change, and its assessed method with it."""
    assert study.assessment is not None  # the caller has looked
    name = study.assessment.method
    method = next(method for method in study.methods if method.name == name)
    if change.damping_ratio is not None:
        damped = replace(method.interaction, damping=ModalRatio(ratio=change.damping_ratio))
        method = replace(method, interaction=damped)
    if change.slab_thickness is not None:
        slab = replace(study.plan.slab, thickness=change.slab_thickness)
        plan = replace(study.plan, slab=slab)
        study = replace(study, plan=plan, floor=build_floor(plan, mesh_size=study.mesh_size))
    if change.vehicle is not None:
        drives = {n: replace(d, vehicle=change.vehicle) for n, d in study.drives.items()}
        study = replace(study, drives=drives)
    if change.isolation is not None:
        study = replace(study, isolations=dict.fromkeys(study.points, change.isolation))
    return study, method


def _at_speed(study: Study, speed: float) -> Study:
    drives = {
        name: replace(drive, route=replace(drive.route, law=ConstantSpeed(speed)))
        for name, drive in study.drives.items()
    }
    return replace(study, drives=drives)


def _modes(study: Study, method: MethodPlan) -> Modes | None:
    f_max = getattr(method.interaction.integration, "f_max", None)
    return None if f_max is None else modes_of(study.floor, f_max=f_max)


def _verdicts(
    study: Study,
    case: Case,
    method: MethodPlan,
    prepared: PreparedFloor,
    *,
    roads: Sequence[str],
    runs: int,
) -> Iterator[tuple[str, tuple[Verdict, ...], tuple[FitnessWarning, ...]]]:
    """Run one case at one speed; roads differ by a factor alone."""
    assessment = study.assessment
    assert assessment is not None  # the caller has looked
    classes = [RoadClass(name) for name in roads]  # pyright: ignore[reportArgumentType] - checked
    smooth = replace(study, roads={"first": classes[0]})
    crossings = smooth.crossings(case, "first", method)
    duration = max(study.duration, max(c.exit_time for c in crossings) + _TAIL)
    layout = lay_out(
        prepared,
        crossings,
        method=method.interaction,
        points=study.points,
        duration=duration,
    )
    found, mean = runs_with_mean(layout, runs=range(runs), seed=study.seed)
    found = behind_isolators(found, study.isolations)
    mean = behind_isolators(mean, study.isolations)
    factors = [float(np.sqrt(c.roughness / classes[0].roughness)) for c in classes]
    reduced = reduce_rougher(
        found,
        mean,
        factors,
        averaging=assessment.averaging,
        quantities=spectra_asked_for(assessment.criteria),
    )
    for road, one in zip(roads, reduced, strict=True):
        verdicts = assess_reduced(
            one,
            assessment.criteria,
            percentile=assessment.percentile,
            top=min(found.f_max, found.sampling_frequency / 2.5),
            events=assessment.events,
        )
        pulling = contact_warnings(float(one.tension.any(axis=1).mean()))
        doubts = tuple(w for w in found.warnings if w.subject != LOST_CONTACT)
        yield road, verdicts, (*pulling, *doubts)

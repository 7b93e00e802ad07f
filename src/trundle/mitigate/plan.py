"""Plan what is run to try changes: each combination once, those of one slab together."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, replace

from trundle._words import in_kmh
from trundle.errors import InputError
from trundle.mitigate.changes import Change, changed_study
from trundle.mitigate.tasks import ChangesTask
from trundle.road import Feature, FeaturedRoad, Road, RoadClass
from trundle.run.jobs import Job, plan_jobs
from trundle.study.model import Study
from trundle.study.plans import Assessment, Case, MethodPlan

__all__ = ["Combination", "assessed", "plan_changes", "sharing_runs"]


@dataclass(frozen=True, kw_only=True, eq=False)
class Combination:
    """Hold what is run for some changes that differ by their isolators alone.

    Attributes
    ----------
    changes : tuple of Change
        The changes.
    case : Case
        What drives.
    speed : float
        Speed of every vehicle [m/s].
    job : Job
        What shares a layout.
    """

    changes: tuple[Change, ...]
    case: Case
    speed: float
    job: Job

    @property
    def slab_thickness(self) -> float | None:
        """Thickness of the slab if it is not the study's [m]."""
        return self.changes[0].slab_thickness

    @property
    def label(self) -> str:
        """What is told while it is run."""
        return f"{self.changes[0].label}: {self.case.name} at {in_kmh(self.speed)}"

    def tasks(self, study: Study) -> tuple[ChangesTask, ...]:
        """Return its tasks."""
        variants = tuple(
            changed_study(study, Change(isolation=change.isolation)).isolations
            for change in self.changes
        )
        return tuple(
            ChangesTask(job=self.job, number=i, variants=variants)
            for i in range(len(self.job.parts))
        )


def plan_changes(
    study: Study,
    *,
    changes: Sequence[Change],
    speeds: Sequence[float],
    roads: Sequence[str],
    runs: int,
) -> tuple[Combination, ...]:
    """Return what is run for every change, speed and case, those of one slab in a row.

    Parameters
    ----------
    study : Study
        A study with criteria; its assessed method is used.
    changes : sequence of Change
        What is changed.
    speeds : sequence of float
        Speeds of every vehicle [m/s].
    roads : sequence of str
        Road classes; they share their runs.
    runs : int
        Runs of each combination.
    """
    _check_vehicles(study)
    features = _features_of_all(study)
    classes: dict[str, Road] = {}
    for name in roads:
        bare = RoadClass(name)  # pyright: ignore[reportArgumentType] - checked
        classes[name] = FeaturedRoad(base=bare, features=features) if features else bare
    found: list[Combination] = []
    for i, together in enumerate(sharing_runs(changes)):
        rest = replace(together[0], slab_thickness=None, isolation=None)
        changed = replace(
            changed_study(study, rest), roads=classes, runs=runs, map=None, schedules={}
        )
        changed = replace(changed, methods=(assessed(changed)[1],))
        for (j, speed), (k, case) in itertools.product(enumerate(speeds), enumerate(study.cases)):
            there = replace(changed.at_speed(speed), cases=(case,))
            acting = there.acting(case, roads[0], there.methods[0])
            jobs = plan_jobs(replace(there, duration=there.long_enough(acting)))
            for n, one in enumerate(jobs):  # one for each road where people are random
                name = f"change{i}-speed{j}-case{k}" + (f"-roads{n}" if n else "")
                job = replace(one, name=name, n_waves=0)
                found.append(Combination(changes=tuple(together), case=case, speed=speed, job=job))
    return tuple(found)


def _check_vehicles(study: Study) -> None:
    """Refuse vehicles whose response on another road does not follow from that on one."""
    for name, drive in study.drives.items():
        if not drive.vehicle.is_linear:
            raise InputError(
                f"route {name!r}: a vehicle that is not linear (friction, stops, lifting off) is "
                "run on each road by itself; compare changes of it by studies of their own"
            )


def _features_of_all(study: Study) -> tuple[Feature, ...]:
    """Return the joints and humps that lie on all roads of a study, to lie on every class.

    Raises
    ------
    InputError
        Roads with different ones.
    """
    each = [one.features if isinstance(one, FeaturedRoad) else () for one in study.roads.values()]
    if any(one != each[0] for one in each):
        raise InputError(
            "changes are compared on road classes, and the features of this study lie on some of "
            "its roads alone: give every road the same, or remove them"
        )
    return each[0]


def sharing_runs(changes: Sequence[Change]) -> list[list[Change]]:
    """Return changes that differ by their isolators alone together, those of one slab in a row."""
    groups: dict[tuple[float, float, int], list[Change]] = {}
    for change in changes:
        key = (change.slab_thickness or 0.0, change.damping_ratio or 0.0, id(change.vehicle))
        groups.setdefault(key, []).append(change)
    return sorted(groups.values(), key=lambda group: group[0].slab_thickness or 0.0)


def assessed(study: Study) -> tuple[Assessment, MethodPlan]:
    """Return what a study with criteria is held against, and by which method."""
    assessment = study.assessment
    assert assessment is not None  # looked for before
    return assessment, next(m for m in study.methods if m.name == assessment.method)

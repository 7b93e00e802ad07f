"""Say what is changed of a study: vehicle, slab, damping, isolator, one at a time or together."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, fields, replace

from trundle.dynamics import ModalRatio
from trundle.errors import InputError
from trundle.signals import Isolation
from trundle.structure import build_floor
from trundle.study.model import Study
from trundle.study.plans import MethodPlan
from trundle.vehicle import Vehicle

__all__ = ["AS_IT_IS", "Change", "changed_study", "each_change", "every_combination"]

AS_IT_IS = "as in the study"
"""Label of the change that changes nothing."""


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

    label: str = AS_IT_IS
    vehicle: Vehicle | None = None
    slab_thickness: float | None = None
    damping_ratio: float | None = None
    isolation: Isolation | None = None

    def but(self, other: Change) -> Change:
        """Return both changes together; what the other says goes."""
        said = {
            field.name: getattr(other, field.name)
            for field in fields(other)
            if field.name != "label" and getattr(other, field.name) is not None
        }
        labels = [one.label for one in (self, other) if one.label != AS_IT_IS]
        return replace(self, **said, label=", ".join(labels) or AS_IT_IS)


def each_change(levers: Sequence[Sequence[Change]]) -> tuple[Change, ...]:
    """Return the study as it is, and every change by itself.

    Parameters
    ----------
    levers : sequence of sequence of Change
        Changes of one kind together: vehicles, slabs, dampings, isolators.
    """
    return (Change(), *itertools.chain.from_iterable(levers))


def every_combination(levers: Sequence[Sequence[Change]]) -> tuple[Change, ...]:
    """Return the study as it is, and its changes of different kinds in every combination.

    Parameters
    ----------
    levers : sequence of sequence of Change
        As for `each_change`; each kind may also stay as it is.
    """
    found: list[Change] = []
    for parts in itertools.product(*([Change(), *lever] for lever in levers)):
        together = Change()
        for part in parts:
            together = together.but(part)
        found.append(together)
    return tuple(found)


def changed_study(study: Study, change: Change) -> Study:
    """Return the study with a change; a slab of another thickness is meshed anew."""
    if change.slab_thickness is not None:
        if study.plan is None:
            raise InputError(f"{study.floor.name} came as a mesh: its slab cannot be changed")
        slab = replace(study.plan.slab, thickness=change.slab_thickness)
        plan = replace(study.plan, slab=slab)
        study = replace(study, plan=plan, floor=build_floor(plan, mesh_size=study.mesh_size))
    if change.vehicle is not None:
        drives = {n: replace(d, vehicle=change.vehicle) for n, d in study.drives.items()}
        study = replace(study, drives=drives)
    if change.isolation is not None:
        study = replace(study, isolations=dict.fromkeys(study.points, change.isolation))
    if change.damping_ratio is not None:
        ratio = ModalRatio(ratio=change.damping_ratio)
        methods = tuple(_damped(method, ratio) for method in study.methods)
        study = replace(study, methods=methods)
    return study


def _damped(method: MethodPlan, ratio: ModalRatio) -> MethodPlan:
    return replace(method, interaction=replace(method.interaction, damping=ratio))

"""Lie under wheels as a floor in all its dofs, or as rigid ground beside it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from trundle._progress import Progress
from trundle._typing import Array
from trundle.dynamics import NewmarkParameters, NewmarkPropagator
from trundle.errors import InputError
from trundle.simulate.direct.floors import FullFloor, RigidGround
from trundle.simulate.direct.laws import laws_of
from trundle.simulate.direct.march import ContactLaw, drive, load_floor, run_in, static_start
from trundle.simulate.wheels.contacts import Contacts, Wheels
from trundle.simulate.wheels.driven import Driven
from trundle.simulate.wheels.roads import RoadUnderWheels

__all__ = ["FullGround", "RigidForNewmark"]


@dataclass(frozen=True, kw_only=True, eq=False)
class RigidForNewmark:
    """Ground that does not move, for vehicles in Newmark's steps."""

    integration: NewmarkParameters

    @property
    def coupled(self) -> bool:
        """Whether it moves under the wheels: never."""
        return False

    @property
    def doubts(self) -> tuple[FitnessWarning, ...]:
        """Return none."""
        return ()

    def check(self, wheels: Wheels) -> None:
        """Bear any contact."""

    def drive(
        self,
        wheels: Wheels,
        road: RoadUnderWheels,
        *,
        weight: Float[Array, " runs"],
        progress: Progress | None = None,
    ) -> Driven:
        """Return the forces on rigid ground."""
        del progress
        _check_weight(weight)
        law = _law(wheels.contacts, self.integration)
        ground = RigidGround(len(law.springs.static))
        vehicle, forces = run_in(law, wheels.timeline, road)
        still = ground.start(road.n_runs, None)
        return drive(law, ground, (vehicle, still, forces), wheels.timeline, road)

    def with_modes_below(self, f: float) -> RigidForNewmark:
        """Refuse: it has no modes."""
        raise InputError(f"rigid ground has no modes to leave out above {f:g} Hz")


@dataclass(frozen=True, kw_only=True, eq=False)
class FullGround:
    """Hold a floor in all its dofs under wheels.

    Attributes
    ----------
    floor : FullFloor
        The floor.
    integration : NewmarkParameters
        Step and parameters, for the vehicles too.
    coupled : bool
        Whether it moves under the wheels.
    """

    floor: FullFloor
    integration: NewmarkParameters
    coupled: bool

    @property
    def doubts(self) -> tuple[FitnessWarning, ...]:
        """Return none."""
        return ()

    def check(self, wheels: Wheels) -> None:
        """Bear any contact: all is solved at the end of the step."""

    def drive(
        self,
        wheels: Wheels,
        road: RoadUnderWheels,
        *,
        weight: Float[Array, " runs"],
        progress: Progress | None = None,
    ) -> Driven:
        """Carry the wheels over the record, step by step."""
        timeline, floor = wheels.timeline, self.floor.for_one_drive()
        if not self.coupled:
            rigid = RigidForNewmark(integration=self.integration)
            forces = rigid.drive(wheels, road, weight=weight).forces
            return load_floor(floor, forces, timeline, static=wheels.static, progress=progress)
        _check_weight(weight)
        law = _law(wheels.contacts, self.integration)
        if wheels.static:
            start = static_start(law, floor, road)
            return drive(law, floor, start, timeline, road, progress=progress)
        vehicle, forces = run_in(law, timeline, road)
        still = floor.start(road.n_runs, None)
        return drive(law, floor, (vehicle, still, forces), timeline, road, progress=progress)

    def with_modes_below(self, f: float) -> FullGround:
        """Refuse: it has no modes."""
        raise InputError(f"only a floor in its modes can be given fewer of them; got {f:g} Hz")


def _law(contacts: Contacts, integration: NewmarkParameters) -> ContactLaw:
    return ContactLaw(
        springs=contacts.springs,
        vehicle=NewmarkPropagator(contacts.free, integration),
        laws=laws_of(contacts.vehicles),
    )


def _check_weight(weight: Array) -> None:
    """Refuse runs that feel a part of their static loads: only exact steps leave them out."""
    if np.any(weight != 1.0):
        raise InputError("exact statistics step the floor in its modes: choose Modal")

"""Lie under wheels as a floor in its modes, or as rigid ground beside it."""

from __future__ import annotations

from dataclasses import dataclass, replace

from jaxtyping import Float

from trundle._progress import Progress
from trundle._typing import Array
from trundle.errors import FitnessWarning, InputError
from trundle.simulate.modal.block_march import drive_in_blocks
from trundle.simulate.modal.floor import ModalFloor
from trundle.simulate.modal.followers import Followers
from trundle.simulate.modal.point_motion import PointFilters, complete, point_filters
from trundle.simulate.step_limits import check_contact_loop
from trundle.simulate.wheels.contacts import Wheels
from trundle.simulate.wheels.driven import Driven
from trundle.simulate.wheels.roads import RoadUnderWheels

__all__ = ["ModalGround", "RigidForExactSteps"]


@dataclass(frozen=True, kw_only=True, eq=False)
class ModalGround:
    """Hold a floor in its modes under wheels, with what completes the motion at its points.

    Attributes
    ----------
    floor : ModalFloor
        The floor.
    residual : ndarray or None, shape (n_points, n_dofs)
        Static flexibility of the modes left out, at the points by the route's dofs [m/N].
    followers : Followers or None
        Modes above half the sampling frequency, which are not stepped.
    filters : PointFilters
        What completes the motion at the points.
    coupled : bool
        Whether it moves under the wheels.
    doubts : tuple of FitnessWarning
        What a result must say of it.
    """

    floor: ModalFloor
    residual: Float[Array, "points dofs"] | None
    followers: Followers | None
    filters: PointFilters
    coupled: bool
    doubts: tuple[FitnessWarning, ...] = ()

    def check(self, wheels: Wheels) -> None:
        """Refuse a step at which vehicle and floor would push each other up without end."""
        if self.coupled:
            record = len(wheels.timeline.time) - wheels.timeline.n_run_in
            check_contact_loop(self.floor.for_one_drive(), wheels.contacts, record)

    def drive(
        self,
        wheels: Wheels,
        road: RoadUnderWheels,
        *,
        weight: Float[Array, " runs"],
        progress: Progress | None = None,
    ) -> Driven:
        """Carry the wheels over the record, and complete the motion at the points."""
        driven = drive_in_blocks(
            wheels, self.floor, road, weight=weight, coupled=self.coupled, progress=progress
        )
        return complete(driven, self.filters)

    def with_modes_below(self, f: float) -> ModalGround:
        """Return the same with fewer modes [Hz]: those left out answer statically, if any do."""
        n_modes = self.floor.count_below(f)
        if n_modes == 0:
            raise InputError(f"no mode lies below {f:g} Hz; raise it")
        residual, followers = self.residual, self.followers
        if residual is not None:
            residual = residual + self.floor.static_share(n_modes)
            residual += 0.0 if followers is None else followers.static_share_above(f)
        followers = None if followers is None else followers.below(f)
        fewer = self.floor.with_first(n_modes)
        return replace(
            self,
            floor=fewer,
            residual=residual,
            followers=followers,
            filters=point_filters(fewer, residual, followers),
        )


@dataclass(frozen=True, kw_only=True)
class RigidForExactSteps:
    """Ground that does not move, for vehicles in exact steps of `dt` [s]."""

    dt: float

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
        return drive_in_blocks(wheels, None, road, weight=weight, coupled=False, dt=self.dt)

    def with_modes_below(self, f: float) -> RigidForExactSteps:
        """Refuse: it has no modes."""
        raise InputError(f"rigid ground has no modes to leave out above {f:g} Hz")

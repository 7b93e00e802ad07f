"""Hold what all runs of an ensemble share, and drive them over any roads."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float
from scipy import sparse
from threadpoolctl import ThreadpoolController

from trundle._typing import Array
from trundle.dynamics import (
    ExactRecursion,
    LinearSystem,
    Modal,
    Newmark,
    NewmarkPropagator,
    block_diagonal,
)
from trundle.errors import FitnessWarning, InputError
from trundle.route import StaticStart
from trundle.simulate.coverage import Coverage, coverage_of
from trundle.simulate.crossing import Coupled, Crossing, Integration, Interaction
from trundle.simulate.direct.floors import FullFloor, RigidGround
from trundle.simulate.direct.march import (
    ContactLaw,
    Progress,
    Record,
    Springs,
    drive,
    load_floor,
    run_in,
    static_start,
)
from trundle.simulate.fitness import resolved_to
from trundle.simulate.modal.block_march import Steps, drive_in_blocks
from trundle.simulate.modal.floor import ModalFloor
from trundle.simulate.modal.followers import Followers
from trundle.simulate.modal.point_motion import PointFilters, complete, point_filters
from trundle.simulate.wheels.roads import RoadUnderWheels
from trundle.simulate.wheels.timeline import Timeline

__all__ = ["Layout", "springs_of"]


@dataclass(frozen=True, kw_only=True, eq=False)
class Layout:
    """Hold what all runs of an ensemble share: everything but the road.

    Attributes
    ----------
    crossings : tuple of Crossing
        Who drives where.
    method : Decoupled or Coupled
        By what method.
    doubts : tuple of FitnessWarning
        Doubts about the method on this floor, whatever the road.
    point_names : tuple of str
        Where the response is read.
    timeline : Timeline
        Where the wheels are.
    floor : ModalFloor, FullFloor or None
        The floor under the wheels.
    residual : ndarray or None, shape (n_points, n_dofs)
        Static flexibility of the modes left out, at the points by the route's dofs [m/N].
    followers : Followers or None
        Modes above half the sampling frequency, which are not stepped.
    filters : PointFilters or None
        What completes the motion at the points of a floor in its modes.
    """

    crossings: tuple[Crossing, ...]
    method: Interaction
    doubts: tuple[FitnessWarning, ...]
    point_names: tuple[str, ...]
    timeline: Timeline
    floor: ModalFloor | FullFloor | None
    residual: Float[Array, "points dofs"] | None
    followers: Followers | None
    filters: PointFilters | None

    @property
    def integration(self) -> Integration:
        """Time integration."""
        return self.method.integration

    @property
    def coupled(self) -> bool:
        """Whether the floor moves under the wheels."""
        return isinstance(self.method, Coupled) and self.floor is not None

    @property
    def contact_names(self) -> tuple[str, ...]:
        """All contacts by name, with their route's where several drive."""
        if len(self.crossings) == 1:
            return self.crossings[0].vehicle.contact_names
        return tuple(
            f"{crossing.route.name} {name}"
            for crossing in self.crossings
            for name in crossing.vehicle.contact_names
        )

    @property
    def f_max(self) -> float:
        """Highest frequency that modes and step show as it is [Hz]."""
        return resolved_to(self.integration)

    @property
    def coverage(self) -> Coverage:
        """Which bands the roads excite, and whether the vehicles have left at the end."""
        return coverage_of(self.crossings, float(self.time[-1]))

    @property
    def time(self) -> Float[Array, " steps"]:
        """Time of the record [s]."""
        return self.timeline.time[self.timeline.n_run_in :]

    @property
    def static(self) -> bool:
        """Whether the record starts in static equilibrium."""
        return isinstance(self.crossings[0].entry, StaticStart)

    def with_modes_below(self, f: float) -> Layout:
        """Return the same with fewer modes: those left out answer statically, if any do.

        Parameters
        ----------
        f : float
            Highest frequency of the modes kept [Hz], at most that of the layout.

        Raises
        ------
        InputError
            The floor is not stepped in its modes, or has none below f.
        """
        modal, floor = self.integration, self.floor
        if not isinstance(modal, Modal) or not isinstance(floor, ModalFloor):
            raise InputError("only a floor in its modes can be given fewer of them")
        n_modes = floor.count_below(f)
        if n_modes == 0:
            raise InputError(f"no mode lies below {f:g} Hz; raise it")
        residual, followers = self.residual, self.followers
        if residual is not None:
            residual = residual + floor.static_share(n_modes)
            residual += 0.0 if followers is None else followers.static_share_above(f)
        followers = None if followers is None else followers.below(f)
        fewer = floor.with_first(n_modes)
        return replace(
            self,
            method=replace(self.method, integration=replace(modal, f_max=min(f, modal.f_max))),
            floor=fewer,
            residual=residual,
            followers=followers,
            filters=point_filters(fewer, residual, followers),
        )

    def over(
        self,
        road: RoadUnderWheels,
        *,
        weight: Float[Array, " runs"] | None = None,
        progress: Progress | None = None,
    ) -> Record:
        """Drive over a road for every run; `weight` scales each run's static wheel loads."""
        many, n_runs = self.crossings, road.n_runs
        weight = np.ones(n_runs) if weight is None else weight
        # Work is shared out in columns or by the sparse solver; threads of small products that
        # wait for each other would only take the cores.
        with ThreadpoolController().select(internal_api="openblas").limit(limits=1):
            if isinstance(self.integration, Newmark):
                record = self._step_by_step(road, progress)
            else:
                record = drive_in_blocks(
                    Steps(
                        vehicles=tuple((springs_of((c,)), self.steps_of((c,))) for c in many),
                        springs=springs_of(many),
                        together=self.steps_of(many),
                        timeline=self.timeline,
                    ),
                    self.floor if isinstance(self.floor, ModalFloor) else None,
                    road,
                    weight=weight,
                    coupled=self.coupled,
                    static=self.static,
                    progress=progress,
                )
            return record if self.filters is None else complete(record, self.filters)

    def steps_of(self, crossings: tuple[Crossing, ...]) -> ExactRecursion:
        """Return the steps of some vehicles on their contact springs."""
        return ExactRecursion(_vehicles(crossings), self.integration.dt)

    def _step_by_step(self, road: RoadUnderWheels, progress: Progress | None) -> Record:
        assert isinstance(self.integration, Newmark)  # the caller has looked
        law = ContactLaw(
            springs=springs_of(self.crossings),
            vehicle=NewmarkPropagator(_free_vehicles(self.crossings), self.integration),
        )
        floor, timeline = self.floor, self.timeline
        if not isinstance(floor, FullFloor) or not self.coupled:
            ground = RigidGround(len(law.springs.static))
            vehicle, forces = run_in(law, timeline, road)
            still = ground.start(road.n_runs, None)
            rigid = drive(law, ground, (vehicle, still, forces), timeline, road)
            if not isinstance(floor, FullFloor):
                return rigid
            return load_floor(floor, rigid.forces, timeline, static=self.static, progress=progress)
        if self.static:
            start = static_start(law, floor, road)
            return drive(law, floor, start, timeline, road, progress=progress)
        vehicle, forces = run_in(law, timeline, road)
        still = floor.start(road.n_runs, None)
        return drive(law, floor, (vehicle, still, forces), timeline, road, progress=progress)


def springs_of(crossings: tuple[Crossing, ...]) -> Springs:
    """Return the contacts of some vehicles."""
    vehicles = [crossing.vehicle for crossing in crossings]
    return Springs(
        contact_map=np.asarray(sparse.block_diag([v.contact_map for v in vehicles]).toarray()),
        stiffness=np.concatenate([v.contact_stiffness for v in vehicles])[:, None],
        damping=np.concatenate([v.contact_damping for v in vehicles])[:, None],
        static=np.concatenate([v.static_forces for v in vehicles])[:, None],
        standing_stiffness=np.asarray(_vehicles(crossings).stiffness),
    )


def _free_vehicles(crossings: tuple[Crossing, ...]) -> LinearSystem:
    return block_diagonal(tuple(crossing.vehicle.free_system for crossing in crossings))


def _vehicles(crossings: tuple[Crossing, ...]) -> LinearSystem:
    return block_diagonal(tuple(crossing.vehicle.system for crossing in crossings))

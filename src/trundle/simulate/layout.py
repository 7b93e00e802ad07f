"""Lay out a set of crossings over a floor, and drive them over any roads."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float
from scipy import sparse
from threadpoolctl import ThreadpoolController

from trundle._checks import positive
from trundle._kinds import kinds_checked
from trundle._typing import Array, SparseMatrix
from trundle.dynamics import (
    ExactRecursion,
    LinearSystem,
    Modal,
    ModalRatio,
    ModalRecursion,
    Newmark,
    NewmarkPropagator,
    block_diagonal,
)
from trundle.errors import FitnessWarning, InputError
from trundle.route import ContactRows, Hermite, StaticStart, contact_rows
from trundle.simulate.coverage import Coverage, coverage_of
from trundle.simulate.crossing import Coupled, Crossing, Decoupled, Integration, Interaction
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
from trundle.simulate.fitness import fitness_warnings, resolved_to
from trundle.simulate.modal.block_march import Steps, drive_in_blocks
from trundle.simulate.modal.floor import ModalFloor
from trundle.simulate.modal.followers import Followers, followers_of
from trundle.simulate.modal.point_motion import PointFilters, complete, point_filters
from trundle.simulate.modal.residual import point_residual
from trundle.simulate.prepared import PreparedFloor, prepare
from trundle.simulate.step_limits import check_contact_loop, step_problem
from trundle.simulate.wheels.given_road import given_road_doubts
from trundle.simulate.wheels.roads import RoadUnderWheels
from trundle.simulate.wheels.timeline import Timeline, operator_rows, timeline_of
from trundle.structure import Floor

__all__ = ["Layout", "lay_out", "lay_out_on_rigid_ground"]

_TAIL = 5.0  # s of free decay after the last wheel has left, unless a duration is given


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
                        vehicles=tuple((_springs((c,)), self.steps_of((c,))) for c in many),
                        springs=_springs(many),
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
            springs=_springs(self.crossings),
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


@kinds_checked
def lay_out(
    floor: Floor | PreparedFloor,
    crossings: Crossing | Sequence[Crossing],
    *,
    method: Interaction,
    points: Mapping[str, tuple[float, float]],
    duration: float | None = None,
) -> Layout:
    """Lay out crossings over a floor: all that their runs share.

    Parameters
    ----------
    floor : Floor or PreparedFloor
        The floor; prepare it once where several layouts share it.
    crossings : Crossing or sequence of Crossing
        One vehicle, or several at once.
    method : Decoupled or Coupled
        Interaction, integration, damping and contact.
    points : mapping of str to (x, y)
        Where the response is read [m].
    duration : float, optional
        Length of the record [s]; until 5 s after the last wheel has left unless given.

    Raises
    ------
    InputError
        A point or wheel off the floor, no point or no crossing, a floor prepared otherwise.
    """
    many = (crossings,) if isinstance(crossings, Crossing) else tuple(crossings)
    if not many:
        raise InputError("an ensemble needs at least one crossing")
    if not points:
        raise InputError("name at least one point where the response is to be read")
    _check_vehicles(many, method.integration)
    doubts = given_road_doubts(many, method.integration.dt, duration)
    if isinstance(floor, Floor):
        floor = prepare(floor, method.integration, method.damping)
    _check_prepared(floor, method)
    dt = method.integration.dt
    length = duration if duration is not None else _natural_duration(many)
    timeline = timeline_of(many, dt, positive("duration", length))
    rows = operator_rows(floor.floor, many, timeline, method.contact)
    if not len(rows.used_dofs()):
        raise InputError(
            "no wheel loads the floor at any step: the route runs along an edge that is held, or "
            "is shorter than a step; move it onto the floor, or lengthen it"
        )
    reader = _point_rows(floor.floor, points)
    coupled = isinstance(method, Coupled)
    residual = None
    if floor.modes is not None and floor.residual:
        residual = point_residual(floor.flexibility, floor.modes, reader, rows.used_dofs())
    followers = followers_of(floor, reader, rows.used_dofs())
    under_wheels = _floor_under_wheels(floor, rows, timeline, reader, coupled=coupled)
    layout = Layout(
        crossings=many,
        method=method,
        doubts=(*fitness_warnings(many, method, floor.floor, floor.modes), *doubts),
        point_names=tuple(points),
        timeline=timeline,
        floor=under_wheels,
        residual=residual,
        followers=followers,
        filters=(
            point_filters(under_wheels, residual, followers)
            if isinstance(under_wheels, ModalFloor)
            else None
        ),
    )
    if coupled and isinstance(under_wheels, ModalFloor):
        check_contact_loop(
            under_wheels.for_one_drive(), _springs(many), layout.steps_of(many), len(layout.time)
        )
    return layout


def lay_out_on_rigid_ground(
    crossing: Crossing, integration: Integration, duration: float
) -> Layout:
    """Lay out a crossing over rigid ground."""
    _check_vehicles((crossing,), integration)
    return Layout(
        crossings=(crossing,),
        method=Decoupled(integration=integration, damping=ModalRatio(ratio=0.0)),
        doubts=(),
        point_names=(),
        timeline=timeline_of((crossing,), integration.dt, duration),
        floor=None,
        residual=None,
        followers=None,
        filters=None,
    )


def _floor_under_wheels(
    prepared: PreparedFloor,
    rows: ContactRows,
    timeline: Timeline,
    points: SparseMatrix,
    *,
    coupled: bool,
) -> ModalFloor | FullFloor:
    speed = timeline.speed[timeline.n_run_in :]
    if isinstance(prepared.propagator, ModalRecursion):
        assert prepared.modes is not None  # a modal recursion is only made with modes
        return ModalFloor(
            prepared.modes.first(prepared.n_stepped),
            prepared.propagator.part(slice(prepared.n_stepped)),
            rows,
            speed,
            points,
            flexibility=prepared.flexibility if coupled and prepared.residual else None,
            single=prepared.single,
        )
    return FullFloor(
        prepared.propagator,
        rows,
        speed,
        points,
        flexibility=prepared.flexibility,
        coupled=coupled,
    )


def _springs(crossings: tuple[Crossing, ...]) -> Springs:
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


def _point_rows(floor: Floor, points: Mapping[str, tuple[float, float]]) -> SparseMatrix:
    places = np.array(list(points.values()), dtype=float).reshape(-1, 2)
    along_x = np.broadcast_to([1.0, 0.0], places.shape)
    rows = contact_rows(floor, places, along_x, shape=Hermite())
    return rows.matrix(rows.value)


def _check_vehicles(crossings: tuple[Crossing, ...], integration: Integration) -> None:
    for crossing in crossings:
        if not isinstance(integration, Modal):
            if crossing.start == "level":
                raise InputError(
                    'direct integration starts vehicles in equilibrium: choose Modal for "level"'
                )
        elif problem := step_problem(crossing.vehicle, integration.dt):
            raise InputError(problem)


def _check_prepared(prepared: PreparedFloor, method: Interaction) -> None:
    if (prepared.integration, prepared.damping) != (method.integration, method.damping):
        raise InputError(
            f"the floor is prepared for {prepared.integration} with {prepared.damping}; "
            f"the method asks for {method.integration} with {method.damping}"
        )


def _natural_duration(crossings: tuple[Crossing, ...]) -> float:
    last = max(crossing.exit_time for crossing in crossings)
    if not np.isfinite(last):
        raise InputError("a vehicle stops on its route; give a duration")
    return last + _TAIL

"""Run an ensemble: one set of crossings, one method, many random roads."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy import sparse
from threadpoolctl import ThreadpoolController

from trundle._checks import count, positive
from trundle._typing import Array, SparseMatrix
from trundle.dynamics import (
    Damping,
    ExactPropagator,
    LinearSystem,
    Modal,
    ModalPropagator,
    ModalRatio,
    Modes,
    Newmark,
    NewmarkPropagator,
    Propagator,
    block_diagonal,
    natural_modes,
)
from trundle.errors import InputError
from trundle.route import ContactRows, Hermite, StaticStart, contact_rows
from trundle.simulate._floors import ContactFloor, FullFloor, ModalFloor, RigidGround
from trundle.simulate._march import ContactLaw, Record, drive, load_floor, run_in, static_start
from trundle.simulate._residual import StaticFlexibility, point_residual, residual_motion
from trundle.simulate._schedule import (
    RoadUnderWheels,
    Timeline,
    lay_out,
    operator_rows,
    roads_under_wheels,
)
from trundle.simulate.crossing import Coupled, Crossing, Integration, Interaction
from trundle.simulate.fitness import fitness_warnings
from trundle.simulate.runs import Runs
from trundle.structure import Floor

__all__ = ["PreparedFloor", "contact_forces", "ensemble", "prepare"]

Progress = Callable[[float], None]

_TAIL = 5.0  # s of free decay after the last wheel has left, unless a duration is given


@dataclass(frozen=True, kw_only=True, eq=False)
class PreparedFloor:
    """Hold a floor with what its integration needs: modes, or a factorised matrix.

    Attributes
    ----------
    floor : Floor
        The floor.
    integration : Newmark or Modal
        Time integration it is prepared for.
    damping : Rayleigh or ModalRatio
        Damping it is prepared for.
    propagator : NewmarkPropagator or ModalPropagator
        The scheme with its coefficients.
    modes : Modes or None
        Natural modes, for `Modal`; a full floor has none.
    flexibility : StaticFlexibility
        Static deflections, for starts at rest and for the modes left out.
    """

    floor: Floor
    integration: Integration
    damping: Damping
    propagator: NewmarkPropagator | ModalPropagator
    modes: Modes | None
    flexibility: StaticFlexibility

    @property
    def residual(self) -> bool:
        """Whether the modes left out answer statically."""
        return isinstance(self.integration, Modal) and self.integration.residual


def prepare(
    floor: Floor,
    integration: Integration,
    damping: Damping,
    *,
    modes: Modes | None = None,
    flexibility: StaticFlexibility | None = None,
    progress: Progress | None = None,
) -> PreparedFloor:
    """Find modes, or factorise, once for all crossings of a floor.

    Parameters
    ----------
    floor : Floor
        The floor.
    integration : Newmark or Modal
        Time integration.
    damping : Rayleigh or ModalRatio
        Damping of the floor.
    modes : Modes, optional
        Modes found before; they must reach as far as `integration` asks.
    flexibility : StaticFlexibility, optional
        Static deflections of the same floor found before.
    progress : callable, optional
        Told the share of modes found.
    """
    flexibility = flexibility or StaticFlexibility(floor)
    if isinstance(integration, Modal):
        if modes is None or modes.f_max < integration.f_max:
            modes = natural_modes(
                floor.mass, floor.stiffness, f_max=integration.f_max, progress=progress
            )
        modes = _below(modes, integration.f_max)
        ratios = damping.ratios(modes.omega)
        propagator = ModalPropagator(modes.omega, ratios, integration.dt)
        return PreparedFloor(
            floor=floor,
            integration=integration,
            damping=damping,
            propagator=propagator,
            modes=modes,
            flexibility=flexibility,
        )
    matrix = (
        0.0 * floor.mass
        if isinstance(damping, ModalRatio)
        else damping.matrix(floor.mass, floor.stiffness)
    )
    system = LinearSystem(mass=floor.mass, damping=matrix, stiffness=floor.stiffness)
    return PreparedFloor(
        floor=floor,
        integration=integration,
        damping=damping,
        propagator=NewmarkPropagator(system, integration),
        modes=None,
        flexibility=flexibility,
    )


def ensemble(
    floor: Floor | PreparedFloor,
    crossings: Crossing | Sequence[Crossing],
    *,
    method: Interaction,
    points: Mapping[str, tuple[float, float]],
    n_runs: int,
    seed: int,
    duration: float | None = None,
    progress: Progress | None = None,
) -> Runs:
    """Run vehicles over a floor on many random roads.

    Parameters
    ----------
    floor : Floor or PreparedFloor
        The floor; prepare it once where several ensembles share it.
    crossings : Crossing or sequence of Crossing
        One vehicle, or several at once.
    method : Decoupled or Coupled
        Interaction, integration, damping and contact.
    points : mapping of str to (x, y)
        Where the response is read [m].
    n_runs : int
        Number of runs; each draws its own roads.
    seed : int
        Seed of all roads; the same seed gives the same bits.
    duration : float, optional
        Length of the record [s]; until 5 s after the last wheel has left unless given.
    progress : callable, optional
        Told the share of steps done.

    Returns
    -------
    Runs
        Histories at the points and under the wheels.

    Raises
    ------
    InputError
        A point or wheel off the floor, a time step too long for the road's shortest wave.
    UnstableStepError
        A number stopped being finite.
    """
    crossings = _as_tuple(crossings)
    n_runs = count("n_runs", n_runs)
    if not points:
        raise InputError("name at least one point where the response is to be read")
    if isinstance(floor, Floor):
        floor = prepare(floor, method.integration, method.damping)
    _check_prepared(floor, method)
    dt = method.integration.dt
    length = duration if duration is not None else _natural_duration(crossings)
    timeline = lay_out(crossings, dt, positive("duration", length))
    road = roads_under_wheels(crossings, timeline, n_runs, seed)
    rows = operator_rows(floor.floor, crossings, timeline, method.contact)
    law = _contact_law(crossings, method.integration)
    coupled = isinstance(method, Coupled)
    reader = _point_rows(floor.floor, points)
    contact_floor = _contact_floor(floor, rows, timeline, reader, coupled=coupled)
    # The steps' products are small; threads that wait for them would only take the cores
    # from the sparse solver, which has threads of its own.
    with ThreadpoolController().select(internal_api="openblas").limit(limits=1):
        record = _run(
            contact_floor,
            law,
            timeline,
            road,
            coupled=coupled,
            static=isinstance(crossings[0].entry, StaticStart),
            progress=progress,
        )
    if floor.modes is not None and floor.residual:
        residual = point_residual(floor.flexibility, floor.modes, reader)
        record = record.plus(*residual_motion(rows, record.forces, residual, dt))
    return Runs(
        time=timeline.time[timeline.n_run_in :],
        displacement=np.transpose(record.displacement, (2, 0, 1)),
        velocity=np.transpose(record.velocity, (2, 0, 1)),
        acceleration=np.transpose(record.acceleration, (2, 0, 1)),
        contact_forces=np.transpose(record.forces, (2, 0, 1)),
        point_names=tuple(points),
        contact_names=_contact_names(crossings),
        seed=seed,
        method=str(method),
        f_max=_highest_frequency(method.integration),
        warnings=fitness_warnings(crossings, method, floor.floor, floor.modes, record.forces),
    )


def contact_forces(
    crossing: Crossing, *, integration: Integration, n_runs: int, seed: int, duration: float
) -> tuple[Array, Array]:
    """Return times [s] and contact forces [N] of a vehicle on rigid ground.

    Returns
    -------
    time : ndarray of float, shape (n_steps,)
        Time since the front axle stood at the start [s].
    forces : ndarray of float, shape (n_runs, n_steps, n_contacts)
        Static and dynamic together, positive when pressing on the ground.
    """
    timeline = lay_out((crossing,), integration.dt, duration)
    road = roads_under_wheels((crossing,), timeline, n_runs, seed)
    record = _on_rigid_ground(_contact_law((crossing,), integration), timeline, road)
    return timeline.time[timeline.n_run_in :], np.transpose(record.forces, (2, 0, 1))


def _run(
    floor: ContactFloor,
    law: ContactLaw,
    timeline: Timeline,
    road: RoadUnderWheels,
    *,
    coupled: bool,
    static: bool,
    progress: Progress | None,
) -> Record:
    if not coupled:
        forces = _on_rigid_ground(law, timeline, road).forces
        return load_floor(floor, forces, timeline, static=static, progress=progress)
    if static:
        start = static_start(law, floor, road)
        return drive(law, floor, start, timeline, road, progress=progress)
    vehicle, forces = run_in(law, timeline, road)
    still = floor.start(road.elevation.shape[2], None)
    return drive(law, floor, (vehicle, still, forces), timeline, road, progress=progress)


def _on_rigid_ground(law: ContactLaw, timeline: Timeline, road: RoadUnderWheels) -> Record:
    ground = RigidGround(len(law.stiffness))
    vehicle, forces = run_in(law, timeline, road)
    still = ground.start(road.elevation.shape[2], None)
    return drive(law, ground, (vehicle, still, forces), timeline, road)


def _contact_law(crossings: tuple[Crossing, ...], integration: Integration) -> ContactLaw:
    vehicles = [crossing.vehicle for crossing in crossings]
    free = block_diagonal(tuple(vehicle.free_system for vehicle in vehicles))
    propagator: Propagator = (
        NewmarkPropagator(free, integration)
        if isinstance(integration, Newmark)
        else ExactPropagator(free, integration.dt)
    )
    return ContactLaw(
        vehicle=propagator,
        contact_map=np.asarray(sparse.block_diag([v.contact_map for v in vehicles]).toarray()),
        stiffness=np.concatenate([v.contact_stiffness for v in vehicles])[:, None],
        damping=np.concatenate([v.contact_damping for v in vehicles])[:, None],
        static=np.concatenate([v.static_forces for v in vehicles])[:, None],
        standing_stiffness=np.asarray(
            block_diagonal(tuple(vehicle.system for vehicle in vehicles)).stiffness
        ),
    )


def _contact_floor(
    prepared: PreparedFloor,
    rows: ContactRows,
    timeline: Timeline,
    points: SparseMatrix,
    *,
    coupled: bool,
) -> ContactFloor:
    speed = timeline.speed[timeline.n_run_in :]
    if isinstance(prepared.propagator, ModalPropagator):
        assert prepared.modes is not None  # a modal propagator is only made with modes
        return ModalFloor(
            prepared.modes,
            prepared.propagator,
            rows,
            speed,
            points,
            flexibility=prepared.flexibility if coupled and prepared.residual else None,
        )
    return FullFloor(
        prepared.propagator,
        rows,
        speed,
        points,
        flexibility=prepared.flexibility,
        coupled=coupled,
    )


def _point_rows(floor: Floor, points: Mapping[str, tuple[float, float]]) -> SparseMatrix:
    places = np.array(list(points.values()), dtype=float).reshape(-1, 2)
    along_x = np.broadcast_to([1.0, 0.0], places.shape)
    rows = contact_rows(floor, places, along_x, shape=Hermite())
    return rows.matrix(rows.value)


def _below(modes: Modes, f_max: float) -> Modes:
    keep = int(np.searchsorted(modes.frequencies, f_max))
    if keep == 0:
        raise InputError(f"no mode lies below f_max = {f_max:g} Hz; raise f_max")
    return Modes(
        omega=modes.omega[:keep],
        shapes=modes.shapes[:, :keep],
        residuals=modes.residuals[:keep],
        f_max=f_max,
    )


def _highest_frequency(integration: Integration) -> float:
    nyquist = 0.5 / integration.dt
    return min(integration.f_max, nyquist) if isinstance(integration, Modal) else nyquist


def _as_tuple(crossings: Crossing | Sequence[Crossing]) -> tuple[Crossing, ...]:
    many = (crossings,) if isinstance(crossings, Crossing) else tuple(crossings)
    if not many:
        raise InputError("an ensemble needs at least one crossing")
    return many


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


def _contact_names(crossings: tuple[Crossing, ...]) -> tuple[str, ...]:
    if len(crossings) == 1:
        return crossings[0].vehicle.contact_names
    return tuple(
        f"{crossing.route.name} {name}"
        for crossing in crossings
        for name in crossing.vehicle.contact_names
    )

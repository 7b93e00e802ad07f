"""Step vehicle and floor together through time, all runs at once."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from trundle._progress import Progress
from trundle._typing import Array
from trundle.dynamics import Motion, Propagator, State
from trundle.errors import UnstableStepError
from trundle.simulate.direct.floors import ContactFloor, RigidGround
from trundle.simulate.direct.laws import Laws, Linear
from trundle.simulate.wheels.contacts import Springs
from trundle.simulate.wheels.driven import Driven
from trundle.simulate.wheels.roads import RoadUnderWheels
from trundle.simulate.wheels.timeline import Timeline

__all__ = [
    "ContactLaw",
    "drive",
    "load_floor",
    "run_in",
    "static_start",
]


@dataclass(frozen=True, kw_only=True, eq=False)
class ContactLaw:
    """Hold a vehicle's contacts, and the vehicle beside them prepared for the time step.

    `laws` say what of them is not linear; None where all is.
    """

    springs: Springs
    vehicle: Propagator
    laws: Laws | None = None


def run_in(law: ContactLaw, timeline: Timeline, road: RoadUnderWheels) -> tuple[State, Array]:
    """Drive on rigid ground up to time 0; return the vehicle's state and contact forces.

    The vehicle starts at rest, in equilibrium on the road under its wheels.
    """
    e, k = law.springs.contact_map, law.springs.stiffness
    ground = RigidGround(len(k))
    still = ground.start(road.n_runs, None)
    z = law.springs.standing_on(road.start)
    forces = law.springs.static - k * (e @ z - road.start)
    state = law.vehicle.start(z)
    for at in range(1, timeline.n_run_in + 1):
        state, _, forces = _step(law, ground, (state, still, forces), at, road, step=at)
    return state, forces


def static_start(
    law: ContactLaw, floor: ContactFloor, road: RoadUnderWheels
) -> tuple[State, State, Array]:
    """Return vehicle and floor in static equilibrium, and the contact forces."""
    springs = law.springs
    z = springs.standing_on(road.start)
    rigid = springs.static - springs.stiffness * (springs.contact_map @ z - road.start)
    forces, _, moved = springs.settled(floor.static_sinking(), rigid)
    return law.vehicle.start(z + moved), floor.start(forces.shape[1], forces), forces


def drive(
    law: ContactLaw,
    floor: ContactFloor,
    start: tuple[State, State, Array],
    timeline: Timeline,
    road: RoadUnderWheels,
    *,
    progress: Progress | None = None,
) -> Driven:
    """Step a coupled vehicle and floor over the record."""
    n_steps = len(timeline.time) - timeline.n_run_in
    state = start
    record = _Recorder(n_steps, floor, state[1], state[2])
    for step in range(1, n_steps):
        state = _step(law, floor, state, timeline.n_run_in + step, road, step=step)
        record.add(step, state[1], state[2], timeline)
        if progress is not None and step % 64 == 0:
            progress(step / n_steps)
    return record.done()


def load_floor(
    floor: ContactFloor,
    forces: Float[Array, "steps contacts runs"],
    timeline: Timeline,
    *,
    static: bool,
    progress: Progress | None = None,
) -> Driven:
    """Step a floor under known contact forces over the record."""
    n_runs = forces.shape[2]
    state = floor.start(n_runs, forces[0] if static else None)
    record = _Recorder(len(forces), floor, state, forces[0])
    for step in range(1, len(forces)):
        motion = floor.predict(step, state, forces[step])
        state = floor.finish(step, state, motion, forces[step], applied=True)
        record.add(step, state, forces[step], timeline)
        if progress is not None and step % 64 == 0:
            progress(step / len(forces))
    return record.done()


def _step(
    law: ContactLaw,
    floor: ContactFloor,
    state: tuple[State, State, Array],
    at: int,
    road: RoadUnderWheels,
    *,
    step: int,
) -> tuple[State, State, Array]:
    """Advance vehicle state, floor state and contact forces by one step.

    `at` counts steps from the start of the run-in, as the road does; `step` counts those of
    the record, as the floor does.

    The contact force is the unknown: with both motions linear in it, what is left is a
    system of n_contacts equations, the same for every run.
    """
    springs = law.springs
    e, k, c = springs.contact_map, springs.stiffness, springs.damping
    vehicle_state, floor_state, before = state
    free = law.vehicle.predict(vehicle_state)
    motion = floor.predict(step, floor_state, None)
    height, rate = floor.under_wheels(step, motion, before)
    sink, sink_rate = floor.compliance(step)
    lift = law.vehicle.respond(e.T)
    stiff = k * (e @ lift.displacement + sink) + c * (e @ lift.velocity + sink_rate)
    gap = e @ free.displacement - height + sink @ springs.static
    gap_rate = e @ free.velocity - rate + sink_rate @ springs.static
    known = road.push[at] - k * gap - c * gap_rate
    if law.laws is None:
        dynamic = np.linalg.solve(np.eye(len(k)) + stiff, known)
    else:
        dynamic = law.laws.solve(
            Linear(
                known=known,
                stiff=stiff,
                static=springs.static,
                stretch=e @ free.displacement,
                by_forces=e @ lift.displacement,
                before=np.array([e @ vehicle_state.displacement, before - springs.static]),
            )
        )
    forces = springs.static + dynamic
    load = e.T @ dynamic
    change = law.vehicle.respond(load)
    vehicle_motion = Motion(
        displacement=free.displacement + change.displacement,
        velocity=free.velocity + change.velocity,
    )
    return (
        law.vehicle.finish(vehicle_state, vehicle_motion, load),
        floor.finish(step, floor_state, motion, forces, applied=False),
        forces,
    )


class _Recorder:
    """Collect readings and forces step by step, and stop at the first that is not finite."""

    def __init__(self, n_steps: int, floor: ContactFloor, state: State, forces: Array) -> None:
        self._floor = floor
        first = floor.read(state)
        shape = (n_steps, *first[0].shape)
        self._readings = tuple(np.zeros(shape) for _ in range(3))
        self._forces = np.zeros((n_steps, *forces.shape))
        for array, values in zip(self._readings, first, strict=True):
            array[0] = values
        self._forces[0] = forces

    def add(self, step: int, state: State, forces: Array, timeline: Timeline) -> None:
        readings = self._floor.read(state)
        for array, values in zip(self._readings, readings, strict=True):
            array[step] = values
        self._forces[step] = forces
        if not (np.isfinite(forces).all() and all(np.isfinite(r).all() for r in readings)):
            time = float(timeline.time[timeline.n_run_in + step])
            raise UnstableStepError(
                f"a number stopped being finite at step {step}, t = {time:g} s; "
                "shorten the time step",
                step=step,
                time=time,
            )

    def done(self) -> Driven:
        displacement, velocity, acceleration = self._readings
        return Driven(
            displacement=displacement,
            velocity=velocity,
            acceleration=acceleration,
            forces=self._forces,
        )

"""Drive over a floor in its modes, a block of steps at a time, all runs together."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy import linalg

from trundle._typing import Array
from trundle.dynamics import ExactRecursion
from trundle.errors import UnstableStepError
from trundle.simulate._blocks import (
    Block,
    ContactMaps,
    FloorPowers,
    VehiclePowers,
    contact_block,
    load_block,
)
from trundle.simulate._march import Progress, Record, Springs
from trundle.simulate._modal_floor import ModalFloor
from trundle.simulate._schedule import RoadUnderWheels, Timeline

__all__ = ["Steps", "drive_in_blocks"]

_BLOCK = 16  # steps; more would spend more on forming maps, fewer on applying them
_COLUMNS = 64  # runs in one product; the same whatever the machine, so that bits are too


@dataclass(frozen=True, kw_only=True, eq=False)
class Steps:
    """Hold what a drive in blocks needs of vehicle and time.

    Attributes
    ----------
    springs : Springs
        Contacts of the vehicle.
    vehicle : ExactRecursion
        The vehicle without its contact springs.
    timeline : Timeline
        Where the wheels are.
    """

    springs: Springs
    vehicle: ExactRecursion
    timeline: Timeline


def drive_in_blocks(
    steps: Steps,
    floor: ModalFloor | None,
    road: RoadUnderWheels,
    *,
    weight: Float[Array, " runs"],
    coupled: bool,
    static: bool,
    progress: Progress | None = None,
) -> Record:
    """Drive every run over the floor, or over rigid ground where there is none.

    Parameters
    ----------
    steps : Steps
        Vehicle and time.
    floor : ModalFloor or None
        The floor.
    road : RoadUnderWheels
        Road of every run.
    weight : ndarray of float, shape (n_runs,)
        What part of its static wheel loads a run feels: 1, or 0 for its dynamics alone.
    coupled : bool
        Whether the floor moves under the wheels.
    static : bool
        Whether the record starts in static equilibrium, or after a run-in.
    progress : callable, optional
        Told the share of steps done.
    """
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        march = _March(steps, road, weight, pool)
        if static:
            march.stand(floor if coupled else None)
        else:
            march.run_in()
        if coupled and floor is not None:
            return march.record(floor, None, progress)
        forces = march.record(None, None, None if floor else progress)
        if floor is None:
            return forces
        march.rest(floor, forces.forces[0] if static else None)
        return march.record(floor, forces.forces, progress)


class _March:
    """The state of every run, in slices of columns, and the way it is carried on."""

    def __init__(self, steps: Steps, road: RoadUnderWheels, weight: Array, pool: Executor) -> None:
        self._steps, self._road, self._pool = steps, road, pool
        springs = steps.springs
        self._n, n_runs = len(springs.static), len(weight)
        self._slices = [slice(i, i + _COLUMNS) for i in range(0, n_runs, _COLUMNS)]
        self._weight = weight
        push = np.hstack(
            [springs.stiffness * springs.contact_map, springs.damping * springs.contact_map]
        )
        self._vehicle = VehiclePowers(steps.vehicle, springs.contact_map, push, _BLOCK)
        still = linalg.solve(
            springs.standing_stiffness,
            springs.contact_map.T @ (springs.stiffness * road.elevation[0]),
        )
        self._z = np.vstack([still, np.zeros_like(still)])
        self._dynamic = -springs.stiffness * (springs.contact_map @ still - road.elevation[0])
        self._x: list[Array] = []

    def stand(self, floor: ModalFloor | None) -> None:
        """Put vehicle and floor in static equilibrium at time 0.

        With S the floor's static sinking under unit forces, ``K_v z = E^T k (r - S f)`` and
        ``f = static - k (E z - r + S f)`` are solved together.
        """
        springs, height = self._steps.springs, self._road.elevation[0]
        e, k, static = springs.contact_map, springs.stiffness, springs.static * self._weight
        sink = np.zeros((self._n, self._n)) if floor is None else floor.static_sinking()
        matrix = np.block(
            [[springs.standing_stiffness, e.T @ (k * sink)], [k * e, np.eye(self._n) + k * sink]]
        )
        solution = linalg.solve(matrix, np.vstack([e.T @ (k * height), static + k * height]))
        still, forces = np.split(solution, [e.shape[1]])
        self._z = np.vstack([still, np.zeros_like(still)])
        self._dynamic = forces - static
        self.rest(floor, forces)

    def rest(self, floor: ModalFloor | None, forces: Array | None) -> None:
        """Put the floor at rest, deflected by static forces if given."""
        if floor is None:
            return
        # Each slice has an array of its own, so that it lies together in cache.
        for part in self._slices:
            n_runs = len(self._weight[part])
            still = np.zeros((2 * floor.n_modes, n_runs))
            self._x.append(still if forces is None else floor.static_state(forces[:, part]))

    def run_in(self) -> None:
        """Drive on rigid ground up to time 0."""
        block: Block | None = None
        for first, n_steps in _parts(self._steps.timeline.n_run_in):
            if block is None or block.n_steps != n_steps:
                block = self._rigid(n_steps)
            self._carry(block, first, None)

    def record(
        self, floor: ModalFloor | None, forces: Array | None, progress: Progress | None
    ) -> Record:
        """Carry on over the record; with `forces` given they load the floor as they are."""
        timeline = self._steps.timeline
        n_steps = len(timeline.time) - timeline.n_run_in
        if floor is not None and not self._x:
            self.rest(floor, None)
        out = _Histories(floor, n_steps, self._n, len(self._weight))
        out.begin(
            np.hstack(self._x) if self._x else np.zeros((0, 0)),
            self._total(self._dynamic) if forces is None else forces[0],
        )
        forming = self._form(floor, forces is None)
        parts = list(_parts(n_steps - 1))
        later = self._pool.submit(forming, *parts[0])
        for number, (first, count) in enumerate(parts):
            block = later.result()
            if number + 1 < len(parts):
                later = self._pool.submit(forming, *parts[number + 1])
            at = timeline.n_run_in + first
            given = None if forces is None else forces[first : first + count + 1]
            out.add(first + 1, *self._carry(block, at, given), timeline)
            if progress is not None:
                progress((first + count) / n_steps)
        return out.done()

    def _form(self, floor: ModalFloor | None, solve: bool) -> Callable[[int, int], Block]:
        """Return the function that forms the block after a step."""
        if floor is None:
            known = {_BLOCK: self._rigid(_BLOCK)}
            return lambda _, count: known.get(count) or self._rigid(count)
        powers = FloorPowers(floor.propagator, floor.points, _BLOCK)
        springs = self._steps.springs
        columns = (springs.stiffness[:, 0], springs.damping[:, 0], springs.static[:, 0])
        if solve:
            return lambda first, count: contact_block(
                floor, powers, self._vehicle, first, count, springs=columns
            )
        return lambda first, count: load_block(floor, powers, first, count)

    def _rigid(self, n_steps: int) -> Block:
        springs = self._steps.springs
        columns = (springs.stiffness[:, 0], springs.damping[:, 0], springs.static[:, 0])
        return contact_block(None, None, self._vehicle, 0, n_steps, springs=columns)

    def _total(self, dynamic: Array) -> Array:
        return dynamic + self._steps.springs.static * self._weight

    def _carry(self, block: Block, at: int, forces: Array | None) -> tuple[Array, Array]:
        """Carry every run over a block that follows step `at` of the whole timeline.

        Returns the forces after it (n_steps, n_contacts, n_runs) and the outputs at the points.
        """
        n_runs, rows = len(self._weight), block.n_steps * self._n
        total = np.empty((rows, n_runs))
        maps = block.floor
        outputs = np.empty((0 if maps is None else len(maps.points_by_state), n_runs))

        def carry(number: int) -> None:
            part = self._slices[number]
            if block.contact is not None:
                every = self._solve(block.contact, at, number)
                total[:, part] = every[self._n :]
            else:
                assert forces is not None  # contacts are solved, or their forces are known
                every = forces[:, :, part].reshape(-1, len(self._weight[part]))
            if maps is not None:
                x = self._x[number]
                outputs[:, part] = maps.points_by_state @ x + maps.points_by_forces @ every
                gained = maps.state_by_forces @ every[maps.standing]
                self._x[number] = _advance(maps.state_by_state, gained, x)

        for _ in self._pool.map(carry, range(len(self._slices))):
            pass
        if block.contact is None and forces is not None:
            return forces[1:], outputs
        return total.reshape(block.n_steps, self._n, n_runs), outputs

    def _solve(self, maps: ContactMaps, at: int, number: int) -> Array:
        """Solve the contact forces of a block; return those before it and in it."""
        part = self._slices[number]
        springs, weight = self._steps.springs, self._weight[part]
        n_steps = len(maps.by_weight) // self._n
        rows = slice(at + 1, at + 1 + n_steps)
        push = springs.stiffness * self._road.elevation[rows, :, part]
        push += springs.damping * self._road.rate[rows, :, part]
        before, z = self._dynamic[:, part], self._z[:, part]
        dynamic = maps.by_road @ push.reshape(-1, len(weight))
        dynamic += maps.by_vehicle @ z
        dynamic += maps.by_before @ before
        dynamic += np.outer(maps.by_weight, weight)
        if maps.floor_rows is not None:
            dynamic += maps.by_floor @ (maps.floor_rows @ self._x[number])
        every = np.vstack([before, dynamic])
        self._z[:, part] = maps.vehicle_by_vehicle @ z + maps.vehicle_by_forces @ every
        self._dynamic[:, part] = dynamic[-self._n :]
        every += np.outer(np.tile(springs.static[:, 0], n_steps + 1), weight)
        return every


def _advance(powers: tuple[Array, ...], gained: Array, x: Array) -> Array:
    """Add the free motion of every mode over the block to what the forces gained."""
    half = len(x) // 2
    u, v, work = x[:half], x[half:], np.empty((half, x.shape[1]))
    for row, (on_u, on_v) in enumerate((powers[:2], powers[2:])):
        here = gained[row * half : (row + 1) * half]
        for power, values in ((on_u, u), (on_v, v)):
            np.multiply(power, values, out=work)
            here += work
    return gained


def _parts(n_steps: int) -> Iterator[tuple[int, int]]:
    """Give the step before each block and the number of steps in it."""
    for first in range(0, n_steps, _BLOCK):
        yield first, min(_BLOCK, n_steps - first)


class _Histories:
    """Collect forces and outputs block by block, and stop at the first that is not finite."""

    def __init__(
        self, floor: ModalFloor | None, n_steps: int, n_contacts: int, n_runs: int
    ) -> None:
        self._floor = floor
        n_points = 0 if floor is None else len(floor.points)
        self._motion = np.zeros((3, n_steps, n_points, n_runs))
        self._forces = np.zeros((n_steps, n_contacts, n_runs))

    def begin(self, x: Array, forces: Array) -> None:
        self._forces[0] = forces
        if self._floor is not None:
            half, points = len(x) // 2, self._floor.points
            self._motion[0, 0] = points @ x[:half]
            load = self._floor.loads(0, 1)[0].T @ forces
            held = (points * self._floor.propagator.square) @ x[:half]
            self._motion[2, 0] = -points @ load - held

    def add(self, step: int, forces: Array, outputs: Array, timeline: Timeline) -> None:
        n_steps, n_runs = len(forces), forces.shape[2]
        rows = slice(step, step + n_steps)
        self._forces[rows] = forces
        if outputs.size:
            self._motion[:, rows] = outputs.reshape(n_steps, 3, -1, n_runs).swapaxes(0, 1)
        if not (np.isfinite(forces).all() and np.isfinite(outputs).all()):
            bad = ~np.isfinite(forces).all(axis=(1, 2))
            late = step + (int(np.argmax(bad)) if bad.any() else n_steps - 1)
            time = float(timeline.time[timeline.n_run_in + late])
            raise UnstableStepError(
                f"a number stopped being finite at step {late}, t = {time:g} s; "
                "shorten the time step",
                step=late,
                time=time,
            )

    def done(self) -> Record:
        return Record(
            displacement=self._motion[0],
            velocity=self._motion[1],
            acceleration=self._motion[2],
            forces=self._forces,
        )

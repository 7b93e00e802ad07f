"""Drive over a floor in its modes, a block of steps at a time, all runs together."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, ThreadPoolExecutor
from dataclasses import dataclass
from functools import cache

import numpy as np
from jaxtyping import Float
from scipy import linalg

from trundle._threads import n_threads
from trundle._typing import Array
from trundle.dynamics import ExactRecursion
from trundle.errors import UnstableStepError
from trundle.simulate._blocks import Block, contact_block, load_block
from trundle.simulate._march import Progress, Record, Springs
from trundle.simulate._modal_floor import ModalFloor
from trundle.simulate._powers import FloorPowers, VehiclePowers
from trundle.simulate._roads import RoadUnderWheels
from trundle.simulate._schedule import Timeline

__all__ = ["Steps", "drive_in_blocks"]

_LONGEST = 32  # steps in a block; more would spend more on forming maps, fewer on applying them
_FORCES = 192  # contact forces in a block: their system is solved densely
_STRETCH = 8  # blocks that a slice is carried over at a time, while the next are formed
_ROWS = 512  # of the state, that forces are added to at a time
_COLUMNS = 128  # runs in one product; the same whatever the machine, so that bits are too


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
    floor = None if floor is None else floor.for_one_drive()
    with ThreadPoolExecutor(n_threads()) as pool:
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
        self._length = block_length(self._n)
        self._vehicle = VehiclePowers(steps.vehicle, springs.contact_map, push, self._length)
        still = linalg.solve(
            springs.standing_stiffness,
            springs.contact_map.T @ (springs.stiffness * road.start),
        )
        self._z = np.vstack([still, np.zeros_like(still)])
        self._dynamic = -springs.stiffness * (springs.contact_map @ still - road.start)
        self._x: list[Array] = []
        self._work = _Work()

    def stand(self, floor: ModalFloor | None) -> None:
        """Put vehicle and floor in static equilibrium at time 0.

        With S the floor's static sinking under unit forces, ``K_v z = E^T k (r - S f)`` and
        ``f = static - k (E z - r + S f)`` are solved together.
        """
        springs, height = self._steps.springs, self._road.start
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
            state = still if forces is None else floor.static_state(forces[:, part])
            self._x.append(state.astype(floor.dtype, copy=False))

    def run_in(self) -> None:
        """Drive on rigid ground up to time 0."""
        forming = self._form(None, solve=True)
        parts = _parts(self._steps.timeline.n_run_in, self._length)
        self._carry([(first, forming(first, count)) for first, count in parts], 0, None, None)

    def record(
        self, floor: ModalFloor | None, forces: Array | None, progress: Progress | None
    ) -> Record:
        """Carry on over the record; with `forces` given they load the floor as they are."""
        timeline = self._steps.timeline
        n_steps = len(timeline.time) - timeline.n_run_in
        if floor is not None and not self._x:
            self.rest(floor, None)
        out = _Histories(floor, timeline, self._n, len(self._weight))
        out.begin(self._x, self._total(self._dynamic) if forces is None else forces[0])
        forming = self._form(floor, solve=forces is None)

        def stretch(parts: list[tuple[int, int]]) -> list[tuple[int, Block]]:
            return [(first, forming(first, count)) for first, count in parts]

        parts = list(_parts(n_steps - 1, self._length))
        stretches = [parts[i : i + _STRETCH] for i in range(0, len(parts), _STRETCH)]
        later = self._pool.submit(stretch, stretches[0])
        for following in [*stretches[1:], []]:
            blocks = later.result()
            later = self._pool.submit(stretch, following)
            self._carry(blocks, timeline.n_run_in, forces, out)
            if progress is not None:
                progress((blocks[-1][0] + blocks[-1][1].n_steps) / n_steps)
        return out.done()

    def _form(self, floor: ModalFloor | None, *, solve: bool) -> Callable[[int, int], Block]:
        """Return the function that forms the block after a step."""
        springs = self._steps.springs
        columns = (springs.stiffness[:, 0], springs.damping[:, 0], springs.static[:, 0])
        if floor is None:
            rigid = cache(
                lambda count: contact_block(None, None, self._vehicle, 0, count, springs=columns)
            )
            return lambda _, count: rigid(count)
        powers = FloorPowers(
            floor.propagator, floor.points, self._length, single=floor.dtype == np.float32
        )
        if solve:
            return lambda first, count: contact_block(
                floor, powers, self._vehicle, first, count, springs=columns
            )
        return lambda first, count: load_block(floor, powers, first, count)

    def _total(self, dynamic: Array) -> Array:
        return dynamic + self._steps.springs.static * self._weight

    def _carry(
        self,
        blocks: list[tuple[int, Block]],
        offset: int,
        forces: Array | None,
        out: _Histories | None,
    ) -> None:
        """Carry every run over blocks, each given with the step before it.

        `offset` is where those steps start on the whole timeline; `forces` load the floor where
        contacts are not solved.
        """

        def carry(number: int) -> None:
            part = self._slices[number]
            for first, block in blocks:
                if block.floor is None:
                    every, seen = self._solve(block, offset + first, number, None), None
                else:
                    every, seen = self._over_floor(block, offset + first, number, forces)
                if out is not None:
                    out.put(first + 1, part, every[self._n :], seen)

        for _ in self._pool.map(carry, range(len(self._slices))):
            pass

    def _over_floor(
        self, block: Block, at: int, number: int, forces: Array | None
    ) -> tuple[Array, Array]:
        """Return all forces of a block on some runs, and what the points do; carry their floor."""
        maps = block.floor
        assert maps is not None  # the caller has looked
        x = self._x[number]
        if forces is None:
            felt = self._work.product("felt", maps.contact_rows, x)
            every = self._solve(block, at, number, felt)
        else:
            first = at - self._steps.timeline.n_run_in
            given = forces[first : first + block.n_steps + 1, :, self._slices[number]]
            every = given.reshape(-1, given.shape[2])
        seen = self._work.product("seen", maps.point_rows, x)
        seen = np.add(
            seen, maps.points_by_forces @ every, out=seen if seen.dtype == every.dtype else None
        )
        if maps.advance is not None:
            _advance(maps.advance, x, self._work.array("advance", x.shape, x.dtype))
        pressing = every[maps.standing].astype(x.dtype, copy=False)
        for top in range(0, len(x), _ROWS):  # what is added is still in cache
            part = slice(top, top + _ROWS)
            x[part] += self._work.product("state", maps.state_by_forces[part], pressing)
        return every, seen

    def _solve(self, block: Block, at: int, number: int, felt: Array | None) -> Array:
        """Solve the contact forces of a block; return those before it and in it.

        `felt` is what the floor's state alone gives contacts that stand on it.
        """
        maps = block.contact
        assert maps is not None  # the caller has looked
        part = self._slices[number]
        static, weight = self._steps.springs.static[:, 0], self._weight[part]
        push = self._road.push[at + 1 : at + 1 + block.n_steps, :, part]
        before, z = self._dynamic[:, part], self._z[:, part]
        known = [push.reshape(-1, len(weight)), z, before, weight[None]]
        dynamic = maps.by_known @ np.vstack(known if felt is None else [*known, felt])
        every = np.vstack([before, dynamic])
        self._z[:, part] = maps.vehicle @ np.vstack([z, every])
        self._dynamic[:, part] = dynamic[-self._n :]
        every += np.outer(np.tile(static, block.n_steps + 1), weight)
        return every


def _advance(power: Array, x: Array, work: Array) -> None:
    """Let every mode move freely, in place."""
    half = len(x) // 2
    u, v, old, more = x[:half], x[half:], work[:half], work[half:]
    (uu, uv), (vu, vv) = power[..., None]
    old[:] = u
    u *= uu
    u += np.multiply(uv, v, out=more)
    v *= vv
    v += np.multiply(vu, old, out=more)


class _Work(threading.local):
    """Each thread's own room for large products: fresh memory costs more than they do."""

    def __init__(self) -> None:
        self._room: dict[str, Array] = {}

    def array(self, name: str, shape: tuple[int, int], kind: np.dtype) -> Array:
        """Return room for an array; what was there under its name is lost."""
        size = shape[0] * shape[1]
        if name not in self._room or self._room[name].size < size:
            self._room[name] = np.empty(size, dtype=kind)
        return self._room[name][:size].reshape(shape)

    def product(self, name: str, a: Array, b: Array) -> Array:
        """Return a matrix product in the room of a name."""
        return np.matmul(a, b, out=self.array(name, (a.shape[0], b.shape[1]), a.dtype))


def block_length(n_contacts: int) -> int:
    """Return how many steps a block has: fewer for many wheels, whose system is dense."""
    return int(np.clip(_FORCES // n_contacts, 8, _LONGEST))


def _parts(n_steps: int, length: int) -> Iterator[tuple[int, int]]:
    """Give the step before each block and the number of steps in it."""
    for first in range(0, n_steps, length):
        yield first, min(length, n_steps - first)


class _Histories:
    """Collect forces and outputs block by block, and stop at the first that is not finite."""

    def __init__(
        self, floor: ModalFloor | None, timeline: Timeline, n_contacts: int, n_runs: int
    ) -> None:
        self._floor, self._time = floor, timeline.time[timeline.n_run_in :]
        n_points = 0 if floor is None else len(floor.points)
        self._motion = np.zeros((3, len(self._time), n_points, n_runs))
        self._forces = np.zeros((len(self._time), n_contacts, n_runs))

    def begin(self, states: list[Array], forces: Array) -> None:
        self._forces[0] = forces
        if self._floor is not None:
            x = np.hstack(states)
            half, points = len(x) // 2, self._floor.points
            self._motion[0, 0] = points @ x[:half]
            load = self._floor.loads(0, 1)[0].T @ forces
            held = (points * self._floor.propagator.square) @ x[:half]
            self._motion[2, 0] = -points @ load - held

    def put(self, step: int, runs: slice, forces: Array, seen: Array | None) -> None:
        """Keep what some runs do from a step on."""
        n_runs = forces.shape[1]
        forces = forces.reshape(-1, self._forces.shape[1], n_runs)
        rows = slice(step, step + len(forces))
        self._forces[rows, :, runs] = forces
        whole = bool(np.isfinite(forces).all())
        if seen is not None:
            motion = seen.reshape(len(forces), 3, -1, n_runs)
            self._motion[:, rows, :, runs] = motion.swapaxes(0, 1)
            whole = whole and bool(np.isfinite(seen).all())
        if not whole:
            self._stop(step, forces)

    def _stop(self, step: int, forces: Array) -> None:
        bad = ~np.isfinite(forces).all(axis=(1, 2))
        late = step + (int(np.argmax(bad)) if bad.any() else len(forces) - 1)
        time = float(self._time[late])
        raise UnstableStepError(
            f"a number stopped being finite at step {late}, t = {time:g} s; shorten the time step",
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

"""Drive over a floor in its modes, a block of steps at a time, all runs together."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, ThreadPoolExecutor

import numpy as np
from jaxtyping import Float

from trundle._checks import positive
from trundle._progress import Progress
from trundle._threads import n_threads
from trundle._typing import Array
from trundle.dynamics import REACH, ExactRecursion
from trundle.simulate.modal.blocks import Block, contact_block, load_block
from trundle.simulate.modal.floor import ModalFloor
from trundle.simulate.modal.histories import Histories
from trundle.simulate.modal.powers import FloorPowers, VehiclePowers
from trundle.simulate.modal.rigid_march import forces_on_rigid_ground
from trundle.simulate.wheels.contacts import Contacts, Wheels
from trundle.simulate.wheels.driven import Driven
from trundle.simulate.wheels.roads import RoadUnderWheels

__all__ = ["drive_in_blocks"]

_LONGEST = 32  # steps in a block; more would spend more on forming maps, fewer on applying them
_FORCES = 192  # contact forces in a block: their system is solved densely
_STRETCH = 8  # blocks that a slice is carried over at a time, while the next are formed
_ROWS = 512  # of the state, that forces are added to at a time
_COLUMNS = 128  # runs in one product; the same whatever the machine, so that bits are too


def drive_in_blocks(
    wheels: Wheels,
    floor: ModalFloor | None,
    road: RoadUnderWheels,
    *,
    weight: Float[Array, " runs"],
    coupled: bool,
    dt: float | None = None,
    progress: Progress | None = None,
) -> Driven:
    """Drive every run over the floor, or over rigid ground where there is none.

    Parameters
    ----------
    wheels : Wheels
        Vehicles and time.
    floor : ModalFloor or None
        The floor.
    road : RoadUnderWheels
        Road of every run.
    weight : ndarray of float, shape (n_runs,)
        What part of its static wheel loads a run feels: 1, or 0 for its dynamics alone.
    coupled : bool
        Whether the floor moves under the wheels.
    dt : float, optional
        Time step [s]; the floor's where there is one.
    progress : callable, optional
        Told the share of steps done.

    Returns
    -------
    Driven
        Motion goes on for REACH steps behind the contact forces, under the last of them.
    """
    floor = None if floor is None else floor.for_one_drive()
    dt = floor.dt if floor is not None else positive("dt", 0.0 if dt is None else dt)
    with ThreadPoolExecutor(n_threads()) as pool:
        march = _March(wheels, dt, road, weight, pool)
        if floor is None:
            return march.on_rigid_ground()
        if coupled:
            march.settle(floor, loaded=wheels.static)
        else:
            march.rest(floor, march.forces[0] if wheels.static else None)
        return march.record(floor, progress, coupled=coupled)


class _March:
    """The state of every run, in slices of columns, and the way it is carried on.

    `forces` are those on rigid ground; a coupled drive puts its own in their place.
    """

    def __init__(
        self, wheels: Wheels, dt: float, road: RoadUnderWheels, weight: Array, pool: Executor
    ) -> None:
        self._dt, self._road, self._pool, self._weight = dt, road, pool, weight
        self._contacts, self._timeline = wheels.contacts, wheels.timeline
        self._springs = springs = wheels.contacts.springs
        self._n, n_runs = len(springs.static), len(weight)
        self._slices = [slice(i, i + _COLUMNS) for i in range(0, n_runs, _COLUMNS)]
        self._length = block_length(self._n)
        self._vehicle = _powers(wheels.contacts, dt, self._length)
        self.forces = self._on_rigid_ground() + springs.static * weight
        self._powers: FloorPowers
        self._zeta = np.zeros((2 * springs.contact_map.shape[1], n_runs))
        self._push = np.zeros((self._n, n_runs))
        self._x: list[Array] = []
        self._work = _Work()

    def _on_rigid_ground(self) -> Array:
        """Return every vehicle's dynamic forces; none knows of the others."""
        timeline, at = self._timeline, 0
        kept = len(self._road.push) - timeline.n_run_in
        forces = np.empty((kept, self._n, len(self._weight)))
        for one, begin in zip(self._contacts.each, timeline.begin, strict=True):
            springs = one.springs
            mine = slice(at, at + len(springs.static))
            at = mine.stop
            forces[:, mine] = forces_on_rigid_ground(
                _powers(one, self._dt, self._length),
                self._road.push[begin:, mine],
                springs.standing_on(self._road.start[mine]),
                kept=kept,
                columns=self._slices,
                pool=self._pool,
            )
        return forces

    def on_rigid_ground(self) -> Driven:
        """Return the forces on rigid ground, and no motion."""
        out = Histories(None, self._timeline, self.forces)
        out.check()
        return out.done()

    def settle(self, floor: ModalFloor, *, loaded: bool) -> None:
        """Put the floor at rest at time 0, or under the vehicles in static equilibrium."""
        if not loaded:
            self.rest(floor, None)
            return
        settled = self._springs.settled(floor.static_sinking(), self.forces[0])
        forces, self._push, moved = settled
        self._zeta[: len(moved)] = moved
        self.forces[0] = forces
        self.rest(floor, forces)

    def rest(self, floor: ModalFloor, forces: Array | None) -> None:
        """Put the floor at rest, deflected by static forces if given."""
        # Each slice has an array of its own, so that it lies together in cache.
        for part in self._slices:
            n_runs = self.forces[0, 0, part].size
            still = np.zeros((2 * floor.n_modes, n_runs))
            state = still if forces is None else floor.static_state(forces[:, part])
            self._x.append(state.astype(floor.dtype, copy=False))

    def record(self, floor: ModalFloor, progress: Progress | None, *, coupled: bool) -> Driven:
        """Carry on over the record; uncoupled forces load the floor as they are."""
        n_steps = len(self.forces)
        out = Histories(floor, self._timeline, self.forces)
        out.begin(self._x)
        forming = self._form(floor, solve=coupled)

        def stretch(parts: list[tuple[int, int]]) -> list[tuple[int, Block]]:
            return [(first, forming(first, count)) for first, count in parts]

        parts = list(_parts(n_steps - 1, self._length))
        stretches = [parts[i : i + _STRETCH] for i in range(0, len(parts), _STRETCH)]
        later = self._pool.submit(stretch, stretches[0])
        for following in [*stretches[1:], []]:
            blocks = later.result()
            later = self._pool.submit(stretch, following)
            self._carry(blocks, out)
            if progress is not None:
                progress((blocks[-1][0] + blocks[-1][1].n_steps) / n_steps)
        self._go_on(floor, out)
        return out.done()

    def _go_on(self, floor: ModalFloor, out: Histories) -> None:
        """Carry the floor on behind the record under the last forces, where wheels stand still."""
        powers, last = self._powers, len(self.forces) - 1
        load = floor.loads(last, last + 1)[0].T
        caught_up = powers.up_to(last)
        step = floor.propagator.from_start + floor.propagator.from_end
        rows = np.concatenate(list(powers.point_rows), axis=1)  # (outputs, 2 modes)

        def go_on(number: int) -> None:
            """Carry some runs on."""
            part, x = self._slices[number], self._x[number].astype(float)
            if caught_up is not None:
                _advance(caught_up, x, np.empty_like(x))
            held = load @ self.forces[last, :, part]
            push = np.concatenate([step[:, :1] * held, step[:, 1:] * held])
            own = floor.points @ held
            for late in range(REACH):
                _advance(powers.phi[0], x, np.empty_like(x))
                x -= push
                seen = rows @ x
                seen[-len(own) :] -= own  # the acceleration feels the force at once
                out.behind(late, part, seen)

        for _ in self._pool.map(go_on, range(len(self._slices))):
            pass

    def _form(self, floor: ModalFloor, *, solve: bool) -> Callable[[int, int], Block]:
        """Return the function that forms the block after a step."""
        springs = self._springs
        columns = (springs.stiffness[:, 0], springs.damping[:, 0])
        self._powers = powers = floor.powers(self._length)
        if solve:
            return lambda first, count: contact_block(
                floor, powers, self._vehicle, first, count, springs=columns
            )
        return lambda first, count: load_block(floor, powers, first, count)

    def _carry(self, blocks: list[tuple[int, Block]], out: Histories) -> None:
        """Carry every run over blocks, each given with the step before it."""

        def carry(number: int) -> None:
            part, x = self._slices[number], self._x[number]
            for first, block in blocks:
                steps = slice(first, first + block.n_steps + 1)
                if block.contact is not None:
                    felt = self._work.product("felt", block.floor.contact_rows, x)
                    self._solve(block, steps, part, felt)
                every = self.forces[steps, :, part].reshape(-1, x.shape[1])
                out.put(first + 1, part, self._over_floor(block, x, every))

        for _ in self._pool.map(carry, range(len(self._slices))):
            pass

    def _over_floor(self, block: Block, x: Array, every: Array) -> Array:
        """Return what the points do in a block under all its forces; carry the floor."""
        maps = block.floor
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
        return seen

    def _solve(self, block: Block, steps: slice, part: slice, felt: Array) -> None:
        """Put a block's contact forces in the place of those on rigid ground.

        `felt` is what the floor's state alone pushes at contacts that stand on it.
        """
        maps = block.contact
        assert maps is not None  # the caller has looked
        forces = self.forces[steps, :, part]
        zeta, before = self._zeta[:, part], self._push[:, part]
        rigid = forces[1:].reshape(-1, forces.shape[2])
        solved = maps.by_known @ np.vstack([rigid, zeta, before, forces[0], felt])
        found, pushes = np.split(solved, 2)
        forces[1:] = found.reshape(block.n_steps, self._n, -1)
        self._zeta[:, part] = maps.vehicle @ np.vstack([zeta, before, pushes])
        self._push[:, part] = pushes[-self._n :]


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


def _powers(contacts: Contacts, dt: float, length: int) -> VehiclePowers:
    springs = contacts.springs
    e = springs.contact_map
    push = np.hstack([springs.stiffness * e, springs.damping * e])
    return VehiclePowers(ExactRecursion(contacts.standing, dt), e, push, length)


def block_length(n_contacts: int) -> int:
    """Return how many steps a block has: fewer for many wheels, whose system is dense."""
    return int(np.clip(_FORCES // n_contacts, 8, _LONGEST))


def _parts(n_steps: int, length: int) -> Iterator[tuple[int, int]]:
    """Give the step before each block and the number of steps in it."""
    for first in range(0, n_steps, length):
        yield first, min(length, n_steps - first)

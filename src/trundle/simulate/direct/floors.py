"""Offer a floor to the stepwise contact solver: rigid, or in full coordinates."""

from __future__ import annotations

from copy import copy
from typing import NamedTuple, Protocol, TypeAlias, runtime_checkable

import numpy as np
from scipy import sparse

from trundle._typing import Array, SparseMatrix
from trundle.dynamics import HalfSolve, HalfStep, Motion, NewmarkPropagator, State
from trundle.simulate.modal.residual import StaticFlexibility, unit_loads
from trundle.simulate.wheels.standing import StandingWheels

__all__ = ["ContactFloor", "FullFloor", "RigidGround"]

_WINDOW = 256  # steps whose rows are formed at once
_MOST_ELEMENTS = 256  # whose half solutions are kept, each some hundred kilobytes

Prediction: TypeAlias = Motion | HalfStep
"""The motion at a step's end without the contact forces there, or a step half done."""

Reading = tuple[Array, Array, Array]
"""Displacement, velocity and acceleration, each of shape (n_points, n_runs)."""


@runtime_checkable
class ContactFloor(Protocol):
    """What the contact solver needs to know of a floor at one step.

    Forces have shape (n_contacts, n_runs) and press on the floor where positive.
    """

    def start(self, n_runs: int, forces: Array | None) -> State:
        """Return the state at rest, deflected by static forces if given."""
        ...

    def predict(self, step: int, state: State, forces: Array | None) -> Prediction:
        """Return the motion at the step's end under known contact forces (none: zero)."""
        ...

    def under_wheels(self, step: int, motion: Prediction, before: Array) -> tuple[Array, Array]:
        """Return the floor's height and its rate under each moving wheel.

        `before` holds the contact forces one step earlier.
        """
        ...

    def compliance(self, step: int) -> tuple[Array, Array]:
        """Return the sinking and its rate under wheel i for a unit force of wheel j."""
        ...

    def static_sinking(self) -> Array:
        """Return the static sinking under wheel i for a unit force of wheel j, at time 0."""
        ...

    def finish(
        self, step: int, state: State, motion: Prediction, forces: Array, *, applied: bool
    ) -> State:
        """Return the state at the step's end; `applied` says the motion has the forces."""
        ...

    def read(self, state: State) -> Reading:
        """Return the response at the points."""
        ...


class RigidGround:
    """A floor that does not move: the ground of a decoupled vehicle."""

    def __init__(self, n_contacts: int) -> None:
        self._n = n_contacts

    def start(self, n_runs: int, forces: Array | None) -> State:
        """Return the state at rest, deflected by static forces if given."""
        del forces
        empty = np.zeros((0, n_runs))
        return State(displacement=empty, velocity=empty, acceleration=empty)

    def predict(self, step: int, state: State, forces: Array | None) -> Prediction:
        """Return the motion at the step's end under known contact forces."""
        del step, forces
        return Motion(displacement=state.displacement, velocity=state.velocity)

    def under_wheels(self, step: int, motion: Prediction, before: Array) -> tuple[Array, Array]:
        """Return the floor's height and its rate under each moving wheel."""
        del step, before
        still = np.zeros((self._n, motion.velocity.shape[1]))
        return still, still

    def compliance(self, step: int) -> tuple[Array, Array]:
        """Return the sinking and its rate under wheel i for a unit force of wheel j."""
        del step
        return np.zeros((self._n, self._n)), np.zeros((self._n, self._n))

    def static_sinking(self) -> Array:
        """Return the static sinking under wheel i for a unit force of wheel j."""
        return np.zeros((self._n, self._n))

    def finish(
        self, step: int, state: State, motion: Prediction, forces: Array, *, applied: bool
    ) -> State:
        """Return the state at the step's end."""
        del step, motion, forces, applied
        return state

    def read(self, state: State) -> Reading:
        """Return displacement, velocity and acceleration at the points."""
        empty = np.zeros((0, state.displacement.shape[1]))
        return empty, empty, empty


def _block_diagonal(weights: Array) -> Array:
    """Return (n, n * width) with the weights of each of n wheels in its own block."""
    n, width = weights.shape
    out = np.zeros((n, n, width))
    out[np.arange(n), np.arange(n)] = weights
    return out.reshape(n, n * width)


class _Under(NamedTuple):
    """What is under the wheels: dofs, weights, share of the load, and the wheels' speeds."""

    dofs: Array
    value: Array
    slope: Array
    load_share: Array
    speed: Array


class FullFloor:
    """A floor in all its dofs, integrated directly.

    The effective stiffness is factorised once, as ``A = L L^T`` where the solver shows both halves
    of a solution. Then ``L^-1`` of a unit force at each dof of the route is kept, which is sparse:
    what the wheels find is its product with the first half of the step, and their forces are added
    before the second. Otherwise whole solutions for unit forces are kept and added after it.
    """

    def __init__(
        self,
        propagator: NewmarkPropagator,
        standing: StandingWheels,
        points: SparseMatrix,
        *,
        flexibility: StaticFlexibility,
        coupled: bool,
    ) -> None:
        self._propagator, self._points = propagator, points
        self._static = flexibility
        self._standing, self._n_dofs = standing, standing.n_dofs
        self._n, self._route_dofs = standing.n_contacts, standing.used_dofs()
        self._first, self._window = 0, self._form(0)
        self._gathered_at = np.zeros(0, dtype=np.intp)
        self._gathered = np.zeros((0, 0))
        self._half_elements: dict[bytes, tuple[Array, Array]] = {}
        self._halves: tuple[HalfSolve, HalfSolve] | None = propagator.halves if coupled else None
        self._unit: Array | SparseMatrix = np.zeros((0, 0))
        self._unit_at_route = np.zeros((0, 0))
        if self._halves is not None:
            self._unit = self._half_solutions(self._halves[0])
            self._unit_at_route = (self._unit @ self._unit.T).toarray()
        elif coupled:
            # one row a route dof, so that a step reads whole rows
            self._unit = self._unit_solutions()
            self._unit_at_route = self._unit[:, self._route_dofs]

    def for_one_drive(self) -> FullFloor:
        """Return the floor with rooms of its own; two drives at once do not share them."""
        own = copy(self)
        own._half_elements, own._gathered_at = {}, np.zeros(0, dtype=np.intp)
        return own

    def start(self, n_runs: int, forces: Array | None) -> State:
        """Return the state at rest, deflected by static forces if given."""
        u = np.zeros((self._n_dofs, n_runs))
        if forces is not None:
            u = self._static.solve(self._load(0, forces))
        return self._propagator.start(u)

    def static_sinking(self) -> Array:
        """Return the static sinking under wheel i for a unit force of wheel j."""
        unit = self._static.solve(self._load(0, np.eye(self._n)))
        return -np.einsum("cw,cwj->cj", self._at(0).value, unit[self._at(0).dofs])

    def predict(self, step: int, state: State, forces: Array | None) -> Prediction:
        """Return the motion at the step's end under known contact forces."""
        if forces is None and self._halves is not None:
            return self._propagator.begin(state, self._halves[0])
        return self._propagator.predict(state, None if forces is None else self._load(step, forces))

    def under_wheels(self, step: int, motion: Prediction, before: Array) -> tuple[Array, Array]:
        """Return the floor's height and its rate under each moving wheel."""
        del before
        dofs = self._at(step).dofs
        u, v = motion.displacement[dofs], motion.velocity[dofs]
        if isinstance(motion, HalfStep):
            halves = [self._half_under_wheel(step, wheel) for wheel in range(self._n)]
            found = np.array([unit @ motion.forward[rows] for rows, unit in halves])
            found += motion.past[dofs]
            u, v = found, v + self._propagator.a1 * (found - u)
        value, slope = self._at(step).value[:, None, :], self._at(step).slope[:, None, :]
        height, rate = (value @ u)[:, 0], (value @ v)[:, 0]
        return height, rate + self._at(step).speed[:, None] * (slope @ u)[:, 0]

    def compliance(self, step: int) -> tuple[Array, Array]:
        """Return the sinking and its rate under wheel i for a unit force of wheel j."""
        under = self._at(step)
        value, slope = _block_diagonal(under.value), _block_diagonal(under.slope)
        at = self._places(step)
        unit = self._unit_at_route[np.ix_(at, at)]
        pressed = unit @ value.T * self._at(step).load_share
        sinking = value @ pressed
        convective = self._at(step).speed[:, None] * (slope @ pressed)
        return sinking, self._propagator.a1 * sinking + convective

    def finish(
        self, step: int, state: State, motion: Prediction, forces: Array, *, applied: bool
    ) -> State:
        """Return the state at the step's end."""
        load = _block_diagonal(self._at(step).value).T @ (
            self._at(step).load_share[:, None] * forces
        )
        if isinstance(motion, HalfStep):
            assert self._halves is not None  # only they leave a step half done
            for wheel, force in enumerate(np.split(load, self._n)):
                rows, unit = self._half_under_wheel(step, wheel)
                motion.forward[rows] -= unit.T @ force
            return self._propagator.complete(motion, self._halves[1])
        if not applied:
            change = -(load.T @ self._unit_under_wheels(step)).T
            motion = Motion(
                displacement=motion.displacement + change,
                velocity=motion.velocity + self._propagator.a1 * change,
            )
        return self._propagator.finish(state, motion)

    def read(self, state: State) -> Reading:
        """Return displacement, velocity and acceleration at the points."""
        points = self._points
        return points @ state.displacement, points @ state.velocity, points @ state.acceleration

    def _unit_solutions(self) -> Array:
        out = np.empty((len(self._route_dofs), self._n_dofs))
        for part, unit in unit_loads(self._route_dofs, self._n_dofs):
            out[part] = self._propagator.respond(unit).displacement.T
        return out

    def _half_solutions(self, forward: HalfSolve) -> SparseMatrix:
        parts = [
            sparse.csr_array(forward(unit).T)
            for _, unit in unit_loads(self._route_dofs, self._n_dofs)
        ]
        return sparse.vstack(parts, format="csr")

    def _load(self, step: int, forces: Array) -> Array:
        load = np.zeros((self._n_dofs, forces.shape[1]))
        under = self._at(step)
        shared = under.load_share[:, None] * forces
        np.subtract.at(load, under.dofs, under.value[:, :, None] * shared[:, None, :])
        return load

    def _half_under_wheel(self, step: int, wheel: int) -> tuple[Array, Array]:
        """Return the half solutions of one wheel's dofs, where they are not nought.

        Wheels that follow each other over an element share them.
        """
        at = np.split(self._places(step), self._n)[wheel]
        key = at.tobytes()
        if key not in self._half_elements:
            if len(self._half_elements) > _MOST_ELEMENTS:
                self._half_elements.clear()
            some = sparse.csc_array(self._unit[at])
            rows = np.flatnonzero(np.diff(some.indptr))
            self._half_elements[key] = (rows, some[:, rows].toarray())
        return self._half_elements[key]

    def _unit_under_wheels(self, step: int) -> Array:
        """Return the unit solutions of the wheels' dofs, gathered anew only at a mesh line."""
        at = self._places(step)
        if not np.array_equal(at, self._gathered_at):
            self._gathered_at = at
            self._gathered = np.asarray(self._unit[at])
        return self._gathered

    def _places(self, step: int) -> Array:
        """Return where the wheels' dofs stand among the route's; unused ones point anywhere."""
        at = np.searchsorted(self._route_dofs, self._at(step).dofs.ravel())
        return np.minimum(at, len(self._route_dofs) - 1)

    def _at(self, step: int) -> _Under:
        """Return what is under the wheels at a step."""
        if not self._first <= step < self._first + len(self._window.dofs):
            self._first = step - step % _WINDOW
            self._window = self._form(self._first)
        return _Under(*(part[step - self._first] for part in self._window))

    def _form(self, start: int) -> _Under:
        stop = min(start + _WINDOW, self._standing.n_steps)
        rows, speed = self._standing.window(start, stop)
        shape = (len(speed), self._n, -1)
        dofs, value, slope = (p.reshape(shape) for p in (rows.dofs, rows.value, rows.slope))
        return _Under(dofs, value, slope, rows.load_share.reshape(shape[:2]), speed)

"""Offer a floor to the contact solver: rigid, in full coordinates, or in its modes."""

from __future__ import annotations

from typing import Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float

from trundle._typing import Array, SparseMatrix
from trundle.dynamics import (
    ModalPropagator,
    Modes,
    Motion,
    NewmarkPropagator,
    State,
)
from trundle.route import ContactRows
from trundle.simulate._residual import StaticFlexibility, residual_block, unit_loads

__all__ = ["ContactFloor", "FullFloor", "ModalFloor", "RigidGround"]

_CHUNK = 256  # steps whose contact shapes are formed at once

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

    def predict(self, step: int, state: State, forces: Array | None) -> Motion:
        """Return the motion at the step's end under known contact forces (none: zero)."""
        ...

    def under_wheels(self, step: int, motion: Motion, before: Array) -> tuple[Array, Array]:
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
        self, step: int, state: State, motion: Motion, forces: Array, *, applied: bool
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
        del forces
        empty = np.zeros((0, n_runs))
        return State(displacement=empty, velocity=empty, acceleration=empty, force=empty)

    def predict(self, step: int, state: State, forces: Array | None) -> Motion:
        del step, forces
        return Motion(displacement=state.displacement, velocity=state.velocity)

    def under_wheels(self, step: int, motion: Motion, before: Array) -> tuple[Array, Array]:
        del step, before
        still = np.zeros((self._n, motion.displacement.shape[1]))
        return still, still

    def compliance(self, step: int) -> tuple[Array, Array]:
        del step
        return np.zeros((self._n, self._n)), np.zeros((self._n, self._n))

    def static_sinking(self) -> Array:
        return np.zeros((self._n, self._n))

    def finish(
        self, step: int, state: State, motion: Motion, forces: Array, *, applied: bool
    ) -> State:
        del step, motion, forces, applied
        return state

    def read(self, state: State) -> Reading:
        empty = np.zeros((0, state.displacement.shape[1]))
        return empty, empty, empty


class ModalFloor:
    """A floor in its modal coordinates."""

    def __init__(
        self,
        modes: Modes,
        propagator: ModalPropagator,
        rows: ContactRows,
        speed: Float[Array, "steps contacts"],
        points: SparseMatrix,
        *,
        flexibility: StaticFlexibility | None,
    ) -> None:
        self._modes, self._propagator = modes, propagator
        self._rows, self._speed = rows, speed
        self._n = speed.shape[1]
        self._load_share = rows.load_share.reshape(-1, self._n)
        self._points = points @ modes.shapes
        self._residual = (
            None if flexibility is None else _Residual(rows, self._n, modes, flexibility)
        )
        self._chunk_start = -1
        self._value = self._slope = np.zeros((0, 0, 0))

    def start(self, n_runs: int, forces: Array | None) -> State:
        q = np.zeros((self._modes.n_modes, n_runs))
        if forces is not None:
            q += self._load(0, forces) / (self._modes.omega**2)[:, None]
        return self._propagator.start(q)

    def predict(self, step: int, state: State, forces: Array | None) -> Motion:
        if forces is None:
            return self._propagator.predict(state)
        return self._propagator.predict(state, self._load(step, forces))

    def under_wheels(self, step: int, motion: Motion, before: Array) -> tuple[Array, Array]:
        value, slope = self._shapes_at(step)
        convective = self._speed[step][:, None] * (slope @ motion.displacement)
        rate = value @ motion.velocity + convective
        if self._residual is not None:
            # The residual rises from its depth a step ago, as a wheel feels it.
            rate = rate + (self._residual.sinking(step - 1) @ before) / self._propagator.dt
        return value @ motion.displacement, rate

    def static_sinking(self) -> Array:
        value, _ = self._shapes_at(0)
        sinking = (value / self._modes.omega**2) @ value.T * self._load_share[0]
        return sinking if self._residual is None else sinking + self._residual.sinking(0)

    def compliance(self, step: int) -> tuple[Array, Array]:
        value, slope = self._shapes_at(step)
        unit = self._propagator.respond(self._load_share[step] * value.T)
        convective = self._speed[step][:, None] * (slope @ unit.displacement)
        sinking, rate = value @ unit.displacement, value @ unit.velocity + convective
        if self._residual is not None:
            extra = self._residual.sinking(step)
            sinking, rate = sinking + extra, rate + extra / self._propagator.dt
        return sinking, rate

    def finish(
        self, step: int, state: State, motion: Motion, forces: Array, *, applied: bool
    ) -> State:
        load = self._load(step, forces)
        if not applied:
            change = self._propagator.respond(load)
            change.displacement[...] += motion.displacement
            change.velocity[...] += motion.velocity
            motion = change
        return self._propagator.finish(state, motion, load)

    def read(self, state: State) -> Reading:
        points = self._points
        acceleration = self._propagator.acceleration(points, state)
        return points @ state.displacement, points @ state.velocity, acceleration

    def _load(self, step: int, forces: Array) -> Array:
        value, _ = self._shapes_at(step)
        return -(value.T @ (self._load_share[step][:, None] * forces))

    def _shapes_at(self, step: int) -> tuple[Array, Array]:
        """Return mode shapes and their slopes under the wheels, (n_contacts, n_modes)."""
        start = step - step % _CHUNK
        if start != self._chunk_start:
            part = self._rows.part(slice(start * self._n, (start + _CHUNK) * self._n))
            shape = (-1, self._n, self._modes.n_modes)
            self._value = (part.matrix(part.value) @ self._modes.shapes).reshape(shape)
            self._slope = (part.matrix(part.slope) @ self._modes.shapes).reshape(shape)
            self._chunk_start = start
        return self._value[step - start], self._slope[step - start]


class _Residual:
    """The static flexibility of the modes left out, between the wheels."""

    def __init__(
        self, rows: ContactRows, n_wheels: int, modes: Modes, flexibility: StaticFlexibility
    ) -> None:
        dofs = rows.used_dofs()
        self._block = residual_block(flexibility, modes, dofs)
        at = np.minimum(np.searchsorted(dofs, rows.dofs), len(dofs) - 1)
        shape = (-1, n_wheels, rows.dofs.shape[1])
        self._at, self._value = at.reshape(shape), rows.value.reshape(shape)
        self._load_share = rows.load_share.reshape(-1, n_wheels)
        self._known: dict[int, Array] = {}

    def sinking(self, step: int) -> Array:
        """Return what the residual adds to the sinking under wheel i for a force of j."""
        if step not in self._known:
            at = self._at[step].ravel()
            value = _spread(self._value[step])
            block = self._block[np.ix_(at, at)]
            sinking = value @ block @ value.T * self._load_share[step]
            # A step asks for itself and for the one before it, and never for an older one.
            self._known = {k: v for k, v in self._known.items() if k == step - 1}
            self._known[step] = sinking
        return self._known[step]


def _spread(weights: Array) -> Array:
    """Return (n, n * width) with the weights of each of n wheels in its own block."""
    n, width = weights.shape
    out = np.zeros((n, n, width))
    out[np.arange(n), np.arange(n)] = weights
    return out.reshape(n, n * width)


class FullFloor:
    """A floor in all its dofs, integrated directly.

    The effective stiffness is factorised once. Its solutions for a unit force at each dof of
    the route are kept, so a coupled step costs one back-substitution and a short update.
    """

    def __init__(
        self,
        propagator: NewmarkPropagator,
        rows: ContactRows,
        speed: Float[Array, "steps contacts"],
        points: SparseMatrix,
        *,
        flexibility: StaticFlexibility,
        coupled: bool,
    ) -> None:
        self._propagator, self._points = propagator, points
        self._static = flexibility
        self._speed, self._n_dofs = speed, rows.n_dofs
        self._n, self._width = speed.shape[1], rows.dofs.shape[1]
        shape = (-1, self._n, self._width)
        self._dofs = rows.dofs.reshape(shape)
        self._value, self._slope = rows.value.reshape(shape), rows.slope.reshape(shape)
        self._load_share = rows.load_share.reshape(-1, self._n)
        self._route_dofs = rows.used_dofs()
        self._gathered_at, self._gathered = np.zeros(0, dtype=np.intp), np.zeros((0, 0))
        # Unit solutions, one row a route dof, so that a step reads whole rows.
        self._unit = self._unit_solutions() if coupled else np.zeros((0, 0))
        self._unit_at_route = self._unit[:, self._route_dofs] if coupled else self._unit

    def start(self, n_runs: int, forces: Array | None) -> State:
        u = np.zeros((self._n_dofs, n_runs))
        if forces is not None:
            u = self._static.solve(self._load(0, forces))
        return self._propagator.start(u)

    def static_sinking(self) -> Array:
        unit = self._static.solve(self._load(0, np.eye(self._n)))
        return -np.einsum("cw,cwj->cj", self._value[0], unit[self._dofs[0]])

    def predict(self, step: int, state: State, forces: Array | None) -> Motion:
        return self._propagator.predict(state, None if forces is None else self._load(step, forces))

    def under_wheels(self, step: int, motion: Motion, before: Array) -> tuple[Array, Array]:
        del before
        dofs = self._dofs[step]
        u, v = motion.displacement[dofs], motion.velocity[dofs]
        value, slope = self._value[step][:, None, :], self._slope[step][:, None, :]
        height, rate = (value @ u)[:, 0], (value @ v)[:, 0]
        return height, rate + self._speed[step][:, None] * (slope @ u)[:, 0]

    def compliance(self, step: int) -> tuple[Array, Array]:
        value, slope = (_spread(weights[step]) for weights in (self._value, self._slope))
        at = self._places(step)
        unit = self._unit_at_route[np.ix_(at, at)]
        pressed = unit @ value.T * self._load_share[step]
        sinking = value @ pressed
        convective = self._speed[step][:, None] * (slope @ pressed)
        return sinking, self._propagator.a1 * sinking + convective

    def finish(
        self, step: int, state: State, motion: Motion, forces: Array, *, applied: bool
    ) -> State:
        if not applied:
            shared = self._load_share[step][:, None] * forces
            load = _spread(self._value[step]).T @ shared
            change = -(load.T @ self._unit_under_wheels(step)).T
            motion = Motion(
                displacement=motion.displacement + change,
                velocity=motion.velocity + self._propagator.a1 * change,
            )
        return self._propagator.finish(state, motion)

    def read(self, state: State) -> Reading:
        points = self._points
        return points @ state.displacement, points @ state.velocity, points @ state.acceleration

    def _unit_solutions(self) -> Array:
        out = np.empty((len(self._route_dofs), self._n_dofs))
        for part, unit in unit_loads(self._route_dofs, self._n_dofs):
            out[part] = self._propagator.respond(unit).displacement.T
        return out

    def _load(self, step: int, forces: Array) -> Array:
        load = np.zeros((self._n_dofs, forces.shape[1]))
        shared = self._load_share[step][:, None] * forces
        np.subtract.at(load, self._dofs[step], self._value[step][:, :, None] * shared[:, None, :])
        return load

    def _unit_under_wheels(self, step: int) -> Array:
        """Return the unit solutions of the wheels' dofs, gathered anew only at a mesh line."""
        at = self._places(step)
        if not np.array_equal(at, self._gathered_at):
            self._gathered_at = at
            self._gathered = np.take(self._unit, at, axis=0)
        return self._gathered

    def _places(self, step: int) -> Array:
        """Return where the wheels' dofs stand among the route's; unused ones point anywhere."""
        at = np.searchsorted(self._route_dofs, self._dofs[step].ravel())
        return np.minimum(at, len(self._route_dofs) - 1)

"""Carry a vehicle and a floor in its modes over a whole block of steps by matrix products.

Vehicle, floor and contact are linear, and their matrices depend on where the wheels are, not on
the road. So a block of B steps is one linear map from the state before it and the road under it
to the contact forces, the response at the points and the state after it; the map is formed once
and applied to every run by products of large matrices, which is as fast as a machine computes.

With X the modal displacements over velocities, exact steps for forces that are linear in between
(`dynamics.exact`) give ``X_k = Phi^k X_0 - sum_j G_kj V_j f_j``, V_j the mode shapes under the
wheels at step j. The same holds for the vehicle. The contact law at every step of the block,
``f_k = static + k (y_k + r_k - E z_k) + c (its rate)``, is then one system in the block's forces,
lower triangular in time.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from trundle._typing import Array
from trundle.dynamics import ExactRecursion, ModalRecursion
from trundle.simulate._modal_floor import ModalFloor

__all__ = ["Block", "FloorPowers", "VehiclePowers", "contact_block", "load_block"]


@dataclass(frozen=True, kw_only=True, eq=False)
class ContactMaps:
    """Hold how a block's contact forces and its last vehicle state follow from what is known.

    Rows of forces run over steps, then contacts. Maps are named by what they act on.

    Attributes
    ----------
    floor_rows : ndarray of float or None
        What the floor's state before the block would give contacts that stand on it; None
        where none does.
    by_floor : ndarray of float
        What those contacts' own part makes of all forces.
    by_vehicle, by_before : ndarray of float
        The vehicle's state and the dynamic forces before the block.
    by_weight : ndarray of float, shape (n_forces,)
        The share of its static forces that a run feels.
    by_road : ndarray of float, shape (n_forces, n_forces)
        The push of the road ``k r + c r'``.
    vehicle_by_vehicle, vehicle_by_forces : ndarray of float
        The vehicle's last state: its state before, and all dynamic forces from the step before
        the block on.
    """

    floor_rows: Float[Array, "standing state"] | None
    by_floor: Float[Array, "forces standing"]
    by_vehicle: Float[Array, "forces vehicle"]
    by_before: Float[Array, "forces contacts"]
    by_weight: Float[Array, " forces"]
    by_road: Float[Array, "forces forces"]
    vehicle_by_vehicle: Float[Array, "vehicle vehicle"]
    vehicle_by_forces: Float[Array, "vehicle all_forces"]


@dataclass(frozen=True, kw_only=True, eq=False)
class FloorMaps:
    """Hold how the response at the points and the floor's last state follow.

    Attributes
    ----------
    points_by_state, points_by_forces : ndarray of float
        Displacement, velocity and acceleration of all points, step by step.
    state_by_state : tuple of ndarray, shapes (n_modes, 1)
        Displacement by displacement and by velocity, then velocity by both.
    state_by_forces : ndarray of float
        What forces from the step before the block on add to the state.
    standing : ndarray of int
        Which of all those forces they are: those of contacts that stand on the floor.
    """

    points_by_state: Float[Array, "outputs state"]
    points_by_forces: Float[Array, "outputs all_forces"]
    state_by_state: tuple[Array, ...]
    state_by_forces: Float[Array, "state standing_forces"]
    standing: Int[Array, " standing_forces"]


@dataclass(frozen=True, kw_only=True, eq=False)
class Block:
    """Hold the maps of one block: of its contacts where they are solved, of the floor if any."""

    n_steps: int
    contact: ContactMaps | None
    floor: FloorMaps | None


class FloorPowers:
    """Hold a modal floor's powers over a block, and what the points read of them."""

    def __init__(self, propagator: ModalRecursion, points: Array, n_steps: int) -> None:
        phi = propagator.phi.transpose(1, 2, 0)
        start, end = propagator.from_start.T, propagator.from_end.T
        powers = [np.broadcast_to(np.eye(2)[:, :, None], phi.shape)]
        for _ in range(n_steps):
            powers.append(np.einsum("abm,bcm->acm", phi, powers[-1]))
        self.n_steps = n_steps
        self.phi = np.array(powers[1:])  # (steps, 2, 2, modes)
        gamma = np.einsum("abm,bm->am", phi, end) + start
        self.start = np.array([_apply(power, start) for power in powers[:-1]])  # (steps, 2, modes)
        self.lag = np.array([end, *(_apply(power, gamma) for power in powers[: n_steps - 1])])
        self.n_points, self.points = len(points), points
        rows = _point_rows(propagator, points)  # (2, 3 points, modes)
        self.points_by_state = np.concatenate(
            [_on_state(rows, power).reshape(-1, 2 * phi.shape[2]) for power in self.phi]
        )
        self.points_lag = np.concatenate([np.einsum("apm,am->pm", rows, g) for g in self.lag])
        self.points_start = np.concatenate([np.einsum("apm,am->pm", rows, g) for g in self.start])


class VehiclePowers:
    """Hold a vehicle's powers over a block, as its contacts feel them."""

    def __init__(
        self, vehicle: ExactRecursion, contact_map: Array, push: Array, n_steps: int
    ) -> None:
        """`push` (n_contacts, 2 n_dofs) is what a state takes off the contact forces."""
        powers = [np.eye(len(vehicle.phi))]
        for _ in range(n_steps):
            powers.append(vehicle.phi @ powers[-1])
        start, end = vehicle.from_start @ contact_map.T, vehicle.from_end @ contact_map.T
        gamma = vehicle.phi @ end + start
        self.phi = np.array(powers[1:])
        self.start = np.array([power @ start for power in powers[:-1]])
        self.lag = np.array([end, *(power @ gamma for power in powers[: n_steps - 1])])
        self.push_by_state = np.concatenate([push @ power for power in self.phi])
        self.push_start, self.push_lag = push @ self.start, push @ self.lag


def contact_block(
    floor: ModalFloor | None,
    powers: FloorPowers | None,
    vehicle: VehiclePowers,
    first: int,
    n_steps: int,
    *,
    springs: tuple[Array, Array, Array],
) -> Block:
    """Form the maps of a coupled block, or of a vehicle on rigid ground.

    Parameters
    ----------
    floor : ModalFloor or None
        The floor under the wheels; None is rigid ground.
    powers : FloorPowers or None
        Its powers.
    vehicle : VehiclePowers
        Powers of the vehicle.
    first : int
        Step before the block.
    n_steps : int
        Steps in the block.
    springs : tuple of ndarray
        Contact stiffness [N/m], damping [N s/m] and static forces [N], shape (n_contacts,).
    """
    stiffness, damping, static = springs
    n = len(static)
    on_dynamic = _toeplitz(-vehicle.push_lag, -vehicle.push_start, n_steps)
    on_total = np.zeros_like(on_dynamic)
    floor_rows, standing, maps = None, np.zeros(0, dtype=np.intp), None
    if floor is not None and powers is not None:
        rows = _contact_rows(floor, first, n_steps, stiffness, damping)
        on_floor = np.flatnonzero(rows.any(axis=(0, 1, 3)))
        if len(on_floor):
            on_total = _floor_influence(floor, powers, rows, first, n_steps)
            _add_residual(on_total, floor, first, stiffness, damping)
            standing = (np.arange(n_steps)[:, None] * n + on_floor).ravel()
            late = _on_state(rows[:, :, on_floor], powers.phi[:n_steps])
            floor_rows = late.reshape(len(standing), -1)
        maps = _floor_maps(floor, powers, first, n_steps)
    both = (on_dynamic + on_total).reshape(n_steps * n, (n_steps + 1) * n)
    solve = np.linalg.inv(np.eye(n_steps * n) - both[:, n:])
    weight = on_total.reshape(n_steps * n, -1) @ np.tile(static, n_steps + 1)
    contact = ContactMaps(
        floor_rows=floor_rows,
        by_floor=solve[:, standing],
        by_vehicle=-solve @ vehicle.push_by_state[: n_steps * n],
        by_before=solve @ both[:, :n],
        by_weight=solve @ weight,
        by_road=solve,
        vehicle_by_vehicle=vehicle.phi[n_steps - 1],
        vehicle_by_forces=np.hstack([vehicle.start[n_steps - 1], *vehicle.lag[:n_steps][::-1]]),
    )
    return Block(n_steps=n_steps, contact=contact, floor=maps)


def load_block(floor: ModalFloor, powers: FloorPowers, first: int, n_steps: int) -> Block:
    """Form the maps of a floor under known contact forces."""
    maps = _floor_maps(floor, powers, first, n_steps)
    return Block(n_steps=n_steps, contact=None, floor=maps)


def _floor_maps(floor: ModalFloor, powers: FloorPowers, first: int, n_steps: int) -> FloorMaps:
    """Return how points and state follow from the state before and all forces."""
    load = floor.loads(first, first + n_steps + 1)  # (steps + 1, contacts, modes)
    n, n_modes = load.shape[1:]
    outputs = 3 * powers.n_points
    flat = load[1:].reshape(n_steps * n, n_modes)
    lagged = (powers.points_lag[: n_steps * outputs] @ flat.T).reshape(n_steps, outputs, n_steps, n)
    points_by_forces = np.zeros((n_steps, outputs, n_steps + 1, n))
    points_by_forces[:, :, 0] = -(powers.points_start[: n_steps * outputs] @ load[0].T).reshape(
        n_steps, outputs, n
    )
    for lag in range(n_steps):
        at = np.arange(n_steps - lag)
        points_by_forces[at + lag, :, at + 1] = -lagged[lag][:, at].transpose(1, 0, 2)
    # the acceleration feels the force of its own step at once
    own = -(powers.points @ flat.T).reshape(powers.n_points, n_steps, n).transpose(1, 0, 2)
    at = np.arange(n_steps)
    points_by_forces[at, 2 * powers.n_points :, at + 1] += own
    gains = np.concatenate([powers.start[n_steps - 1][None], powers.lag[:n_steps][::-1]])
    on_floor = np.flatnonzero(load.any(axis=(0, 2)))
    standing = (np.arange(n_steps + 1)[:, None] * n + on_floor).ravel()
    state_by_forces = -np.einsum("jam,jcm->amjc", gains, load[:, on_floor])
    return FloorMaps(
        points_by_state=powers.points_by_state[: n_steps * outputs],
        points_by_forces=points_by_forces.reshape(n_steps * outputs, -1),
        state_by_state=tuple(powers.phi[n_steps - 1].reshape(4, -1)[:, :, None]),
        state_by_forces=state_by_forces.reshape(2 * n_modes, -1),
        standing=standing,
    )


def _contact_rows(
    floor: ModalFloor, first: int, n_steps: int, stiffness: Array, damping: Array
) -> Array:
    """Return what the floor's state adds to the contact forces: (2, steps, contacts, modes)."""
    value, slope = floor.shapes(first + 1, first + n_steps + 1)
    speed = floor.speed[first + 1 : first + n_steps + 1, :, None]
    k, c = stiffness[:, None], damping[:, None]
    return np.stack([k * value + (c * speed) * slope, c * value])


def _floor_influence(
    floor: ModalFloor, powers: FloorPowers, rows: Array, first: int, n_steps: int
) -> Array:
    """Return how forces through the floor add to later ones: (steps, c, steps + 1, c)."""
    load = floor.loads(first, first + n_steps + 1)
    n = load.shape[1]
    out = np.zeros((n_steps, n, n_steps + 1, n))
    start = rows[0] * powers.start[:n_steps, 0, None] + rows[1] * powers.start[:n_steps, 1, None]
    out[:, :, 0] = -(start.reshape(n_steps * n, -1) @ load[0].T).reshape(n_steps, n, n)
    for lag in range(n_steps):
        late = slice(lag, n_steps)
        felt = rows[0, late] * powers.lag[lag, 0] + rows[1, late] * powers.lag[lag, 1]
        at = np.arange(n_steps - lag)
        out[at + lag, :, at + 1] = -(felt @ load[1 : n_steps - lag + 1].transpose(0, 2, 1))
    return out


def _add_residual(
    out: Array, floor: ModalFloor, first: int, stiffness: Array, damping: Array
) -> None:
    """Add the modes left out: they sink at once, at a rate since the step before."""
    n_steps = len(out)
    sinking = floor.residual_sinking(first, first + n_steps + 1)
    if sinking is None:
        return
    at = np.arange(n_steps)
    rate = (damping / floor.dt)[:, None]
    out[at, :, at + 1] -= (stiffness[:, None] + rate) * sinking[1:]
    out[at, :, at] += rate * sinking[:-1]


def _toeplitz(lag: Array, start: Array, n_steps: int) -> Array:
    """Lay out effects that depend on the lag alone: (steps, rows, steps + 1, columns)."""
    out = np.zeros((n_steps, lag.shape[1], n_steps + 1, lag.shape[2]))
    out[:, :, 0] = start[:n_steps]
    for i in range(n_steps):
        at = np.arange(n_steps - i)
        out[at + i, :, at + 1] = lag[i]
    return out


def _point_rows(propagator: ModalRecursion, points: Array) -> Array:
    """Return displacement, velocity, acceleration at points: (2, 3 points, modes)."""
    zero = np.zeros_like(points)
    on_displacement = np.concatenate([points, zero, -points * propagator.square])
    on_velocity = np.concatenate([zero, points, -points * propagator.double])
    return np.stack([on_displacement, on_velocity])


def _on_state(rows: Array, power: Array) -> Array:
    """Return rows of a later state as rows of the state before: (..., rows, 2 modes)."""
    power = power[..., None, :]
    if power.ndim == 5:  # one power to each step of the rows
        power = np.moveaxis(power, 0, 2)
    late = [rows[0] * power[0, i] + rows[1] * power[1, i] for i in range(2)]
    return np.concatenate(late, axis=-1)


def _apply(power: Array, vector: Array) -> Array:
    return np.einsum("abm,bm->am", power, vector)

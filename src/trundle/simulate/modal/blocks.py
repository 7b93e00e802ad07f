"""Carry a vehicle and a floor in its modes over a whole block of steps by matrix products.

Vehicle, floor and contact are linear, and their matrices depend on where the wheels are, not on
the road. So a block of B steps is one linear map from the state before it and the road under it
to the contact forces, the response at the points and the state after it; the map is formed once
and applied to every run by products of large matrices, which is as fast as a machine computes.

With X the modal displacements over velocities, exact steps for forces that are linear in between
(`dynamics.exact`) give ``X_k = Phi^k X_0 - sum_j G_kj V_j f_j``, V_j the mode shapes under the
wheels at step j.

What the vehicle does on rigid ground is known beforehand (`_rigid_march`). What is left is its
answer to the floor's motion y alone: on its contact springs, which its matrices hold, it is driven
by ``g = k y + c y'`` and moves by zeta, so that ``f = f_rigid + g - [k E, c E] zeta``. Its own
poles are stepped exactly, however stiff its springs; only the floor follows the forces step by
step. With g linear in the block's forces and f in the block's g, both lower triangular in time,
one system in the block's forces is left.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from trundle._typing import Array
from trundle.simulate.modal.floor import ModalFloor
from trundle.simulate.modal.powers import FloorPowers, VehiclePowers, rows_on_state

__all__ = ["Block", "contact_block", "load_block"]


@dataclass(frozen=True, kw_only=True, eq=False)
class ContactMaps:
    """Hold how a block's contact forces and its last vehicle state follow from what is known.

    Rows of forces run over steps, then contacts.

    Attributes
    ----------
    by_known : ndarray of float, shape (2 n_forces, n_known)
        Contact forces, then what the floor's motion pushes at the vehicle, by, in this order: the
        contact forces on rigid ground at every step of the block; the vehicle's state before it;
        that push and the contact forces before it; what the floor's state alone would push at
        contacts that stand on it.
    vehicle : ndarray of float, shape (n_vehicle, n_vehicle + n_contacts + n_forces)
        The vehicle's last state by its state before, and by all pushes from the step before the
        block on.
    """

    by_known: Float[Array, "forces known"]
    vehicle: Float[Array, "vehicle vehicle_and_forces"]


@dataclass(frozen=True, kw_only=True, eq=False)
class FloorMaps:
    """Hold how the response at the points and the floor's state follow.

    Attributes
    ----------
    contact_rows : ndarray of float, shape (n_standing, 2 n_modes)
        What the frame's state gives contacts that stand on the floor, if these are solved [N].
    point_rows : ndarray of float, shape (n_outputs, 2 n_modes)
        Displacement, velocity and acceleration of all points by that state, step by step.
    points_by_forces : ndarray of float
        What all forces from the step before the block on add to the points.
    advance : ndarray of float or None, shape (2, 2, n_modes)
        Free motion that ends the frame, before the forces are added; None within a frame.
    state_by_forces : ndarray of float, shape (2 n_modes, n_standing)
        What forces from the step before the block on add to the state.
    standing : ndarray of int
        Which of all those forces they are: those of contacts that stand on the floor.
    """

    contact_rows: Float[Array, "standing state"]
    point_rows: Float[Array, "outputs state"]
    points_by_forces: Float[Array, "outputs all_forces"]
    advance: Float[Array, "2 2 modes"] | None
    state_by_forces: Float[Array, "state standing_forces"]
    standing: Int[Array, " standing_forces"]


@dataclass(frozen=True, kw_only=True, eq=False)
class Block:
    """Hold the maps of one block: of its contacts where they are solved, and of the floor."""

    n_steps: int
    contact: ContactMaps | None
    floor: FloorMaps


def contact_block(
    floor: ModalFloor,
    powers: FloorPowers,
    vehicle: VehiclePowers,
    first: int,
    n_steps: int,
    *,
    springs: tuple[Array, Array],
) -> Block:
    """Form the maps of a coupled block.

    Parameters
    ----------
    floor : ModalFloor
        The floor under the wheels.
    powers : FloorPowers
        Its powers.
    vehicle : VehiclePowers
        Powers of the vehicle on its contact springs.
    first : int
        Step before the block.
    n_steps : int
        Steps in the block.
    springs : tuple of ndarray
        Contact stiffness [N/m] and damping [N s/m], shape (n_contacts,).
    """
    n = len(springs[0])
    on_floor = floor.on_floor(first, first + n_steps + 1)
    load = floor.loads(first, first + n_steps + 1, on_floor)
    rows = _contact_rows(floor, first, n_steps, springs, on_floor)
    at = powers.place(first)
    late = rows_on_state(rows, powers.phi[at : at + n_steps])
    standing = (np.arange(n_steps)[:, None] * n + on_floor).ravel()

    def form() -> tuple[Array, Array]:
        """Form what drives share."""
        pushed = np.zeros((n_steps, n, n_steps + 1, n))
        influence = _floor_influence(load, powers, (rows, late), first)
        pushed[:, on_floor[:, None], :, on_floor] = influence
        _add_residual(pushed, floor, first, *springs)
        by_known = _contact_maps(pushed.reshape(n_steps * n, -1), vehicle, n_steps, standing)
        return by_known, _points_by_forces(powers, load)

    by_known, points = floor.kept.of((first, n_steps), form)
    late = late.reshape(len(standing), 2 * floor.n_modes)
    return Block(
        n_steps=n_steps,
        contact=ContactMaps(by_known=by_known, vehicle=vehicle.last_state(n_steps)),
        floor=_floor_maps(floor, load, powers, first, (late, points), on_floor=on_floor),
    )


def _contact_maps(pushed: Array, vehicle: VehiclePowers, n_steps: int, standing: Array) -> Array:
    """Solve a block's contact forces, given what forces push at the vehicle through the floor.

    Returns `ContactMaps.by_known`.

    With f, g for the block and f0, g0 for the step before it: ``g = A0 f0 + A f + felt`` and
    ``f = f_rigid + T g - V0 g0 - [kE, cE] Phi^k zeta0``, where ``T = 1 - V`` is what a push at the
    held vehicle leaves of itself.
    """
    size, n = pushed.shape[0], vehicle.n_contacts
    moved = vehicle.push_by_forces(n_steps).reshape(size, size + n)
    left = np.eye(size) - moved[:, n:]
    before, within = pushed[:, :n], pushed[:, n:]
    solve = np.linalg.inv(np.eye(size) - left @ within)
    forces = np.hstack(
        [
            solve,
            -solve @ vehicle.push_by_state[:size],
            -solve @ moved[:, :n],
            solve @ (left @ before),
            solve @ left[:, standing],
        ]
    )
    push = within @ forces
    states = vehicle.push_by_state.shape[1]
    push[:, size + states + n : size + states + 2 * n] += before
    push[standing, size + states + 2 * n + np.arange(len(standing))] += 1.0
    return np.vstack([forces, push])


def load_block(floor: ModalFloor, powers: FloorPowers, first: int, n_steps: int) -> Block:
    """Form the maps of a floor under known contact forces."""
    none = np.zeros((0, 2 * floor.n_modes))
    on_floor = floor.on_floor(first, first + n_steps + 1)
    load = floor.loads(first, first + n_steps + 1, on_floor)
    (points,) = floor.kept.of((first, n_steps), lambda: (_points_by_forces(powers, load),))
    maps = _floor_maps(floor, load, powers, first, (none, points), on_floor=on_floor)
    return Block(n_steps=n_steps, contact=None, floor=maps)


def _floor_maps(
    floor: ModalFloor,
    load: Array,
    powers: FloorPowers,
    first: int,
    rows: tuple[Array, Array],
    *,
    on_floor: Array,
) -> FloorMaps:
    """Return how points and state follow from the state before and all forces.

    `load` holds the modal loads of the contacts that stand on the floor; `rows` their rows on its
    state, and those of the points on their forces.
    """
    contact_rows, points = rows
    n_steps, size, n, kind = len(load) - 1, 2 * load.shape[2], floor.n_contacts, floor.dtype
    standing = (np.arange(n_steps + 1)[:, None] * n + on_floor).ravel()
    gains = powers.gains(first, n_steps)
    state_by_forces = -gains[:, None] * load[:, :, None]  # (steps + 1, c, 2, modes)
    point_rows = powers.points_by_state(first, n_steps)
    points_by_forces = np.zeros((len(point_rows), (n_steps + 1) * n))
    points_by_forces[:, standing] = points
    advance = powers.advance(first, n_steps)
    return FloorMaps(
        contact_rows=contact_rows.astype(kind, copy=False),
        point_rows=point_rows.astype(kind, copy=False),
        points_by_forces=points_by_forces,
        advance=None if advance is None else advance.astype(kind, copy=False),
        state_by_forces=state_by_forces.reshape(len(standing), size).T.astype(kind, copy=False),
        standing=standing,
    )


def _points_by_forces(powers: FloorPowers, load: Array) -> Array:
    """Return what forces on the floor add to the points: (steps, outputs) by (steps + 1, c)."""
    n_steps, n, n_modes = len(load) - 1, *load.shape[1:]
    n_points, outputs = len(powers.points), len(powers.point_rows[0])
    out = np.zeros((n_steps, outputs, n_steps + 1, n))
    out[:, :, 0] = -(powers.points_start[:n_steps].reshape(-1, n_modes) @ load[0].T).reshape(
        n_steps, outputs, n
    )
    flat = load[1:].reshape(n_steps * n, n_modes)
    lagged = powers.points_lag[:n_steps].reshape(-1, n_modes) @ flat.T
    lagged = lagged.reshape(n_steps, outputs, n_steps, n)
    for lag in range(n_steps):
        at = np.arange(n_steps - lag)
        out[at + lag, :, at + 1] = -lagged[lag][:, at].transpose(1, 0, 2)
    # the acceleration feels the force of its own step at once
    own = (powers.points @ flat.T).reshape(n_points, n_steps, n).transpose(1, 0, 2)
    at = np.arange(n_steps)
    out[at, 2 * n_points :, at + 1] -= own
    return out.reshape(n_steps * outputs, -1)


def _contact_rows(
    floor: ModalFloor, first: int, n_steps: int, springs: tuple[Array, Array], on_floor: Array
) -> Array:
    """Return what the floor's state pushes at contacts: (2, steps, standing, modes)."""
    value, slope = (part[:, on_floor] for part in floor.shapes(first + 1, first + n_steps + 1))
    speed = floor.speeds(first + 1, first + n_steps + 1)[:, on_floor, None]
    k, c = (values[on_floor, None] for values in springs)
    return np.stack([k * value + (c * speed) * slope, c * value])


def _floor_influence(
    load: Array, powers: FloorPowers, rows: tuple[Array, Array], first: int
) -> Array:
    """Return how forces through the floor add to later ones.

    `load` holds modal loads from the step before the block on, `rows` those of `_contact_rows`
    and the same on the frame's state. A force at step j is
    what some state at the frame's start would have become; so one product of late rows and early
    loads gives every pair of steps, of which those with j before the row's step count. Without a
    way back each lag is taken by itself.

    Returns
    -------
    ndarray of float, shape (n_standing, n_standing, n_steps, n_steps + 1)
        In the order that indexing contacts of (steps, contacts, steps + 1, contacts) asks for.
    """
    at_once, late = rows
    n_steps, n, size = late.shape
    at = np.arange(n_steps)
    out = np.zeros((n, n, n_steps, n_steps + 1))
    felt = at_once[0] * powers.lag[0, 0] + at_once[1] * powers.lag[0, 1]
    out[:, :, at, at + 1] = -(felt @ load[1:].transpose(0, 2, 1)).transpose(1, 2, 0)
    early = powers.early(first, n_steps)
    if early is None:
        _add_by_lags(out, powers, at_once, load)
        return out
    loads = early[:-1, None] * load[:-1, :, None]  # (steps, c, 2, modes)
    product = late.reshape(n_steps * n, size) @ loads.reshape(n_steps * n, size).T
    pairs = product.reshape(n_steps, n, n_steps, n).transpose(1, 3, 0, 2)
    out[..., :-1] -= np.tril(pairs)
    return out


def _add_by_lags(out: Array, powers: FloorPowers, at_once: Array, load: Array) -> None:
    """Add every lag but 0, and the force before the block, one lag at a time."""
    n_steps, n = at_once.shape[1:3]
    start = powers.start[:n_steps, :, None]
    felt = at_once[0] * start[:, 0] + at_once[1] * start[:, 1]
    before = (felt.reshape(n_steps * n, felt.shape[2]) @ load[0].T).reshape(n_steps, n, n)
    out[..., 0] -= before.transpose(1, 2, 0)
    for lag in range(1, n_steps):
        felt = at_once[0, lag:] * powers.lag[lag, 0] + at_once[1, lag:] * powers.lag[lag, 1]
        at = np.arange(n_steps - lag)
        later = felt @ load[1 : n_steps - lag + 1].transpose(0, 2, 1)
        out[:, :, at + lag, at + 1] -= later.transpose(1, 2, 0)


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

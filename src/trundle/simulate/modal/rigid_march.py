"""Drive a vehicle over rigid ground, all runs together.

A vehicle on its contact springs is one linear system that does not change in time, driven by what
the road pushes at it. Its steps are exact whatever its stiffness, for a push that is straight
between samples; the road is known on both sides of every step, so what a straight line loses of it
is given back before (`dynamics.sampling`), and forces are right up to the highest band.
"""

from __future__ import annotations

from concurrent.futures import Executor

import numpy as np
from jaxtyping import Float
from scipy import linalg

from trundle._typing import Array
from trundle.dynamics import REACH, restoring_filter
from trundle.simulate.modal.powers import VehiclePowers

__all__ = ["forces_on_rigid_ground"]


def forces_on_rigid_ground(
    vehicle: VehiclePowers,
    push: Float[Array, "steps contacts runs"],
    still: Float[Array, "dofs runs"],
    *,
    kept: int,
    columns: list[slice],
    pool: Executor,
) -> Float[Array, "kept contacts runs"]:
    """Return the dynamic contact forces of a vehicle on rough rigid ground.

    Parameters
    ----------
    vehicle : VehiclePowers
        The vehicle on its contact springs, over some steps.
    push : ndarray of float, shape (n_all, n_contacts, n_runs)
        What the road adds to a contact force of a vehicle that is held [N], from the step on at
        which it begins to move.
    still : ndarray of float, shape (n_dofs, n_runs)
        Where the vehicle stands at first, at rest in equilibrium [m].
    kept : int
        How many of the last steps are returned; before it moves the vehicle stands.
    columns : list of slice
        Runs that are carried on together.
    pool : Executor
        What carries them on.

    Returns
    -------
    ndarray of float, shape (kept, n_contacts, n_runs)
        Contact forces without static loads [N], positive when they press on the ground.
    """
    out = np.empty((kept, *push.shape[1:]))
    skipped = len(push) - kept
    length, last = len(vehicle.phi), len(push) - 1
    parts = [(first, min(length, last - first)) for first in range(0, last, length)]
    maps = {n_steps: _maps(vehicle, n_steps) for n_steps in {count for _, count in parts}}

    def carry(runs: slice) -> None:
        """Carry some runs over all steps."""
        state = np.vstack([still[:, runs], np.zeros_like(still[:, runs])])
        mine, kept_here = push[:, :, runs], out[:, :, runs]
        kept_here[: max(0, 1 - skipped)] = mine[0] - (vehicle.push @ state)
        for first, n_steps in parts:
            around = np.arange(first - REACH, first + n_steps + REACH + 1)
            road = mine[np.clip(around, 0, len(push) - 1)]
            known = np.vstack([road.reshape(-1, road.shape[2]), state])
            forces, state = np.split(maps[n_steps] @ known, [n_steps * vehicle.n_contacts])
            at = first + 1 - skipped
            if at + n_steps > 0:
                late = max(0, -at)
                some = forces.reshape(n_steps, vehicle.n_contacts, -1)[late:]
                kept_here[at + late : at + n_steps] = some

    for _ in pool.map(carry, columns):
        pass
    return out


def _maps(vehicle: VehiclePowers, n_steps: int) -> Float[Array, "forces_and_state known"]:
    """Return forces of a block and the state after it, by the road around it and the state before.

    The road runs from REACH steps before the step before the block to REACH behind it.
    """
    n, size = vehicle.n_contacts, n_steps * vehicle.n_contacts
    given_back = linalg.toeplitz(
        np.r_[restoring_filter()[0], np.zeros(n_steps)],
        np.r_[restoring_filter(), np.zeros(n_steps)],
    )
    restored = np.kron(given_back, np.eye(n))  # pushes that drive the vehicle, by the road
    forces = -vehicle.push_by_forces(n_steps).reshape(size, size + n) @ restored
    own = slice((REACH + 1) * n, (REACH + 1) * n + size)
    forces[:, own] += np.eye(size)  # the road's push on the ground itself
    last, states = vehicle.last_state(n_steps), vehicle.push_by_state.shape[1]
    return np.block(
        [
            [forces, -vehicle.push_by_state[:size]],
            [last[:, states:] @ restored, last[:, :states]],
        ]
    )

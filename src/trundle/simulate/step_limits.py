"""Refuse time steps that a vehicle, or its contact with the floor, does not bear.

A vehicle on its contact springs is stepped exactly, but what it does above half the sampling
frequency would be read as something slower. A floor in its modes follows the contact forces as if
these were straight between samples; so the loop of spring and floor may flip its sign from step to
step and grow. It does so first at half the sampling frequency, z = -1, where the loop is a small
real matrix: it is stable while all eigenvalues of one plus that matrix are positive.
"""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from trundle._typing import Array
from trundle.dynamics import TOP, ExactRecursion, ModalRecursion
from trundle.errors import InputError
from trundle.simulate.modal.floor import ModalFloor
from trundle.simulate.wheels.contacts import Contacts, Springs
from trundle.vehicle import Vehicle

__all__ = ["check_contact_loop", "longest_step", "step_problem"]

_FREE = 0.5  # damping ratio below which a motion is an oscillation to be seen
_STRIDE = 8  # steps from one look at the loop to the next: wheels move a few centimetres
_MARGIN = 0.05  # of one: what the smallest eigenvalue must keep


def longest_step(vehicle: Vehicle) -> float:
    """Return the longest time step at which a vehicle's own motions are seen as they are [s].

    Its highest natural frequency on rigid ground, unless it is damped beyond half of critical, lies
    below 0.45 of the sampling frequency.
    """
    poles = vehicle.poles()
    free = poles[-np.real(poles) < _FREE * np.abs(poles)]
    return 2.0 * np.pi * TOP / max(float(np.abs(free).max(initial=0.0)), 1e-300)


def step_problem(vehicle: Vehicle, dt: float) -> str:
    """Say why a step is too long for a vehicle stepped in exact steps; nothing if it is not."""
    longest = longest_step(vehicle)
    if dt <= longest * (1.0 + 1e-9):
        return ""
    return (
        f"vehicle {vehicle.name!r} vibrates at {TOP / longest:.3g} Hz on its own springs, which "
        f"steps of {1e3 * dt:.3g} ms cannot show: shorten dt to {1e3 * longest:.2g} ms, or see "
        "whether a stiffness or a mass has the wrong unit"
    )


def check_contact_loop(floor: ModalFloor, contacts: Contacts, n_steps: int) -> None:
    """Refuse a step at which vehicle and floor would push each other up without end.

    Raises
    ------
    InputError
        An eigenvalue of the loop that is not positive, at some place of the wheels.
    """
    worst, at = 1.0, 0
    springs = contacts.springs
    left = _left_of_a_push(springs, ExactRecursion(contacts.standing, floor.dt))
    displacement, velocity = _at_half_the_rate(floor.propagator)
    k, c = springs.stiffness, springs.damping
    for step in range(0, n_steps, _STRIDE):
        if not len(floor.on_floor(step, step + 1)):
            continue
        value, slope = (part[0] for part in floor.shapes(step, step + 1))
        load = floor.loads(step, step + 1)[0]
        on_displacement = k * value + c * floor.speeds(step, step + 1)[0][:, None] * slope
        pushed = (on_displacement * displacement + c * value * velocity) @ load.T
        residual = floor.residual_sinking(step, step + 1)
        if residual is not None:
            pushed = pushed + (k + 2.0 * c / floor.dt) * residual[0]
        lowest = float(np.linalg.eigvals(np.eye(len(k)) + left @ pushed).real.min())
        if lowest < worst:
            worst, at = lowest, step
    if worst < _MARGIN:
        share = np.sqrt((1.0 - _MARGIN) / (1.0 - worst))
        raise InputError(
            f"contact springs of up to {springs.stiffness.max():.3g} N/m on the floor under the "
            f"wheels at {at * floor.dt:.3g} s need a time step of at most "
            f"{1e3 * share * floor.dt:.2g} ms; got {1e3 * floor.dt:g} ms: shorten dt, or see "
            "whether tyres are too stiff or the floor too light"
        )


def _left_of_a_push(
    springs: Springs, together: ExactRecursion
) -> Float[Array, "contacts contacts"]:
    """Return what a push at the held vehicles leaves of itself at z = -1."""
    e = springs.contact_map
    felt = np.hstack([springs.stiffness * e, springs.damping * e])
    driven = (together.from_start - together.from_end) @ e.T
    return np.eye(len(e)) - felt @ np.linalg.solve(
        -np.eye(len(together.phi)) - together.phi, driven
    )


def _at_half_the_rate(steps: ModalRecursion) -> Float[Array, "2 modes"]:
    """Return displacement and velocity of modes by modal force at z = -1."""
    driven = (steps.from_start - steps.from_end)[:, :, None]
    return np.linalg.solve(-np.eye(2) - steps.phi, driven)[:, :, 0].T

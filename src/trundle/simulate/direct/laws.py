"""Find contact forces that are not linear: wheels that lift off, friction, stops.

At a step's end every contact force d is a function of all of them, for the motions that they leave
are linear in them: of a wheel ``d = F - S d``, its linear force, or minus its static one where that
would be a pull; of friction and stops a law of the suspension's stretch. All are straight between
corners, so Newton's method with the slope on the side where it is ends at the root itself, mostly
after two or three tries; all runs are solved beside each other.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from trundle._typing import Array
from trundle.errors import ConvergenceError
from trundle.vehicle import PartLaw, Vehicle

__all__ = ["Laws", "Linear", "laws_of"]

_MOST_TRIES = 60
_HALF_AFTER = 20  # tries, from which on steps are halved: between two corners they may swing
_ENOUGH = 1e-9  # of the largest static force


@dataclass(frozen=True, kw_only=True, eq=False)
class Linear:
    """Hold what a step leaves to be solved: ``d = known - stiff d`` of wheels.

    Attributes
    ----------
    known : ndarray of float, shape (n_contacts, n_runs)
        Dynamic forces without what they do themselves [N].
    stiff : ndarray of float, shape (n_contacts, n_contacts)
        What they take off each other.
    static : ndarray of float, shape (n_contacts, 1)
        Static forces [N].
    stretch, by_forces : ndarray of float, shape (n_contacts, n_runs), (n_contacts, n_contacts)
        Motion over every contact without the forces [m], and by unit forces [m/N].
    before : ndarray of float, shape (2, n_contacts, n_runs)
        That motion, and the forces, at the step's beginning [m], [N].
    """

    known: Float[Array, "contacts runs"]
    stiff: Float[Array, "contacts contacts"]
    static: Float[Array, "contacts 1"]
    stretch: Float[Array, "contacts runs"]
    by_forces: Float[Array, "contacts contacts"]
    before: Float[Array, "2 contacts runs"]


@dataclass(frozen=True, kw_only=True, eq=False)
class Laws:
    """Hold which contacts are not linear.

    Attributes
    ----------
    lifting : ndarray of bool, shape (n_contacts,)
        Wheels that lift off.
    parts : tuple of (int, Friction or Stop)
        Contacts that are friction or stops.
    """

    lifting: Array
    parts: tuple[tuple[int, PartLaw], ...]

    def solve(self, linear: Linear) -> Float[Array, "contacts runs"]:
        """Return the dynamic forces.

        Raises
        ------
        ConvergenceError
            No forces that all laws agree with were found.
        """
        n, n_runs = linear.known.shape
        eye = np.eye(n)
        found = np.linalg.solve(eye + linear.stiff, linear.known)
        scale = max(float(np.abs(linear.static).max()), 1e-300)
        off = np.inf
        for trial in range(_MOST_TRIES):
            wanted, slope = self._laws(linear, found)
            residual = found - wanted
            off = float(np.abs(residual).max())
            if off <= _ENOUGH * scale:
                return found
            jacobian = eye[None] - np.moveaxis(slope, -1, 0)
            step = np.linalg.solve(jacobian, residual.T[:, :, None])[:, :, 0].T
            found = found - step * (1.0 if trial < _HALF_AFTER else 0.5)
        raise ConvergenceError(
            f"contact forces of a vehicle that is not linear were not found within {_MOST_TRIES} "
            f"tries in {n_runs} runs; shorten the time step",
            residual=off / scale,
        )

    def _laws(self, linear: Linear, found: Array) -> tuple[Array, Array]:
        """Return what the laws make of some forces, and its slope by each: (n, n, n_runs)."""
        wanted = linear.known - linear.stiff @ found
        slope = np.repeat(-linear.stiff[:, :, None], found.shape[1], axis=2)
        off = self.lifting[:, None] & (wanted < -linear.static)
        wanted = np.where(off, -linear.static, wanted)
        slope = np.where(off[:, None, :], 0.0, slope)
        for i, law in self.parts:
            stretch = linear.stretch[i] + linear.by_forces[i] @ found
            wanted[i], rate = law.on_body(stretch, linear.before[:, i])
            slope[i] = rate * linear.by_forces[i][:, None]
        return wanted, slope


def laws_of(vehicles: tuple[Vehicle, ...]) -> Laws | None:
    """Return what is not linear of some vehicles; None where all is."""
    lifting: list[bool] = []
    parts: list[tuple[int, PartLaw]] = []
    for vehicle in vehicles:
        outer = vehicle.n_contacts - vehicle.inner
        at = len(lifting) + outer
        lifting += [vehicle.lifts_off] * outer + [False] * vehicle.inner
        parts += [(at + i, law) for i, law in enumerate(vehicle.laws)]
    if not any(lifting) and not parts:
        return None
    return Laws(lifting=np.array(lifting), parts=tuple(parts))

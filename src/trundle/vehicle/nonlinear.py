"""Parts of a vehicle that are not linear: leaf springs that rub, stops behind a gap.

Each works between a body and an axle, on the stretch of the suspension there. Beside them a vehicle
may lift off (`trundle.vehicle.Vehicle.lifts_off`). A vehicle with any of these is stepped in time
run by run; its response does not grow with the road, and no exact statistics hold for it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from jaxtyping import Float

from trundle._checks import non_negative, positive, set_frozen
from trundle._typing import Array
from trundle.errors import InputError

__all__ = ["Friction", "PartLaw", "Stop"]


@dataclass(frozen=True, kw_only=True)
class Friction:
    """Hold the friction of a leaf spring: a spring that slips at a force (Jenkins's element).

    Attributes
    ----------
    axle : int
        Which axle, from 0.
    force : float
        At which its leaves slip, both sides of the axle together [N].
    stiffness : float
        Before they do [N/m].
    """

    axle: int
    force: float
    stiffness: float

    def __post_init__(self) -> None:
        """Check signs."""
        _check_axle(self.axle)
        set_frozen(
            self,
            force=positive("friction force", self.force),
            stiffness=positive("friction stiffness", self.stiffness),
        )

    def on_body(
        self, stretch: Float[Array, " runs"], before: Float[Array, "2 runs"]
    ) -> tuple[Float[Array, " runs"], Float[Array, " runs"]]:
        """Return what it presses the body up with [N], and how that changes with stretch [N/m].

        Parameters
        ----------
        stretch : ndarray of float, shape (n_runs,)
            Of the suspension at the step's end [m].
        before : ndarray of float, shape (2, n_runs)
            Stretch and force at its beginning [m], [N].
        """
        trial = before[1] - self.stiffness * (stretch - before[0])
        sticks = np.abs(trial) < self.force
        return np.clip(trial, -self.force, self.force), np.where(sticks, -self.stiffness, 0.0)


@dataclass(frozen=True, kw_only=True)
class Stop:
    """Hold a rubber stop behind a gap: it presses where the suspension is compressed further.

    Attributes
    ----------
    axle : int
        Which axle, from 0.
    gap : float
        From static equilibrium [m].
    stiffness : float
        Of the stops of both sides together [N/m].
    """

    axle: int
    gap: float
    stiffness: float

    def __post_init__(self) -> None:
        """Check signs."""
        _check_axle(self.axle)
        set_frozen(
            self,
            gap=non_negative("gap", self.gap),
            stiffness=positive("stop stiffness", self.stiffness),
        )

    def on_body(
        self, stretch: Float[Array, " runs"], before: Float[Array, "2 runs"]
    ) -> tuple[Float[Array, " runs"], Float[Array, " runs"]]:
        """Return what it presses the body up with [N], and how that changes with stretch [N/m].

        Parameters
        ----------
        stretch : ndarray of float, shape (n_runs,)
            Of the suspension at the step's end [m].
        before : ndarray of float, shape (2, n_runs)
            Stretch and force at its beginning; it forgets them.
        """
        del before
        touches = -stretch > self.gap
        force = np.where(touches, self.stiffness * (-stretch - self.gap), 0.0)
        return force, np.where(touches, -self.stiffness, 0.0)


PartLaw: TypeAlias = Friction | Stop
"""What may work beside a linear suspension."""


def _check_axle(axle: int) -> None:
    if axle < 0:
        raise InputError(f"axle must be 0 or more; got {axle}")

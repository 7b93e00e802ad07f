"""What a vehicle brings itself: wheels that are not round, engines, pumps and lifting gear."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from trundle._checks import count, finite, non_negative, positive, set_frozen
from trundle._typing import Array
from trundle.errors import InputError

__all__ = ["BodyForce", "OutOfRound"]


@dataclass(frozen=True, kw_only=True)
class OutOfRound:
    """Hold a wave round the wheels: runout, a flat of many wheels, the lugs of a tread.

    Every wheel lifts its axle by ``a cos(n s / R + phase)`` when it has come s along the road,
    whatever the contact patch.

    Attributes
    ----------
    amplitude : float
        Half of the runout a [m].
    radius : float
        Rolling radius R [m].
    order : int
        Waves round a wheel n: 1 of runout, the number of lugs of a tread.
    phase : float
        At the route's start [rad].
    axle : int or None
        Number of the only axle that has it, from 0, both its wheels; None for all.
    """

    amplitude: float
    radius: float
    order: int = 1
    phase: float = 0.0
    axle: int | None = None

    def __post_init__(self) -> None:
        """Check signs, and that whole waves go round a wheel."""
        set_frozen(
            self,
            amplitude=positive("amplitude", self.amplitude),
            radius=positive("radius", self.radius),
            order=count("order", self.order),
            phase=finite("phase", self.phase),
        )

    def lift(
        self, station: Float[Array, " steps"]
    ) -> tuple[Float[Array, " steps"], Float[Array, " steps"]]:
        """Return height [m] and slope [m/m] under a wheel at stations [m]."""
        n = self.order / self.radius
        angle = n * station + self.phase
        return self.amplitude * np.cos(angle), -self.amplitude * n * np.sin(angle)


@dataclass(frozen=True, kw_only=True)
class BodyForce:
    """Hold a vertical force on a body: an engine, a driveline, a pump, a mast that stops.

    The force is ``F cos(2 pi f t + phase)``, or, of a driveline, ``F cos(n s / R + phase)`` when
    the vehicle has come s.

    Attributes
    ----------
    amplitude : float
        F [N].
    body : int
        Number of the body that it acts on, from 0.
    setback, aside : float
        Where: behind the front axle, and to the left of the centre line [m].
    frequency : float
        f [Hz]; 0 for one that turns with the wheels.
    order : float
        Turns to one of the wheels n, of a driveline.
    radius : float
        Rolling radius R of these wheels [m].
    phase : float
        At time 0, or at the route's start [rad].
    during : tuple of float
        When it acts, on the clock of the record [s].
    name : str
        For tables.
    """

    amplitude: float
    body: int = 0
    setback: float = 0.0
    aside: float = 0.0
    frequency: float = 0.0
    order: float = 0.0
    radius: float = 0.0
    phase: float = 0.0
    during: tuple[float, float] = (-np.inf, np.inf)
    name: str = "engine"

    def __post_init__(self) -> None:
        """Check that it turns by itself or with the wheels."""
        set_frozen(
            self,
            amplitude=positive("amplitude", self.amplitude),
            setback=finite("setback", self.setback),
            aside=finite("aside", self.aside),
            frequency=non_negative("frequency", self.frequency),
            order=non_negative("order", self.order),
            radius=non_negative("radius", self.radius),
            phase=finite("phase", self.phase),
        )
        if not self.during[0] < self.during[1]:
            raise InputError(
                f"a force acts from one time to a later one; got {self.during[0]:g} to "
                f"{self.during[1]:g} s"
            )
        with_wheels = self.order > 0.0 and self.radius > 0.0
        if (self.frequency > 0.0) == with_wheels or (self.order > 0.0) != (self.radius > 0.0):
            raise InputError(
                "a force on a body has a frequency of its own, or an order and the radius of the "
                "wheels that it turns with"
            )

    def force(
        self, time: Float[Array, " steps"], station: Float[Array, " steps"]
    ) -> Float[Array, " steps"]:
        """Return the force, up positive [N], at times [s] and stations of the vehicle [m]."""
        if self.frequency > 0.0:
            angle = 2.0 * np.pi * self.frequency * time
        else:
            angle = self.order / self.radius * station
        acts = (time >= self.during[0]) & (time <= self.during[1])
        return self.amplitude * np.cos(angle + self.phase) * acts

"""Say how a wheel comes onto the floor and leaves it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float

from trundle._checks import one_of, positive, set_frozen
from trundle._typing import Array
from trundle.errors import InputError

__all__ = ["Abrupt", "DriveIn", "Entry", "Ramp", "StaticStart", "entry_named"]


@runtime_checkable
class Entry(Protocol):
    """A way onto a floor, and off it."""

    @property
    def standing(self) -> bool:
        """Whether the vehicle stands on the floor at time 0, in equilibrium with it."""
        ...

    def lead(self, vehicle_length: float) -> float:
        """Return where the front axle stands at time 0 [m]."""
        ...

    def share(
        self, station: Float[Array, ...], route_length: float
    ) -> tuple[Float[Array, ...], Float[Array, ...]]:
        """Return the share of a wheel's force that the floor carries, and its slope [1/m]."""
        ...


@dataclass(frozen=True, kw_only=True)
class Ramp:
    """Let each wheel's force rise linearly over one length before the floor's edge.

    This is the paper's hat function at the first node; at the far edge the force falls in
    the same way.

    Attributes
    ----------
    length : float
        Length of the ramp [m]; the paper's reading is one element.
    """

    length: float

    def __post_init__(self) -> None:
        """Check the length."""
        set_frozen(self, length=positive("ramp length", self.length))

    @property
    def standing(self) -> bool:
        """Whether the vehicle stands on the floor at time 0, in equilibrium with it: no."""
        return False

    def lead(self, vehicle_length: float) -> float:
        """Return where the front axle stands at time 0 [m]: at the foot of the ramp."""
        del vehicle_length
        return -self.length

    def share(
        self, station: Float[Array, ...], route_length: float
    ) -> tuple[Float[Array, ...], Float[Array, ...]]:
        """Return the share of the force that the floor carries, and its slope [1/m]."""
        before, after = station < 0.0, station > route_length
        outside = np.where(before, -station, np.where(after, station - route_length, 0.0))
        share = np.clip(1.0 - outside / self.length, 0.0, 1.0)
        sign = np.where(before, 1.0, np.where(after, -1.0, 0.0))
        return share, np.where(share > 0.0, sign / self.length, 0.0)

    def __str__(self) -> str:
        """Describe the entry for a report."""
        return f"ramp over {self.length:.3g} m before the edge"


@dataclass(frozen=True, kw_only=True)
class DriveIn:
    """Let each wheel drive in from an approach whose far side is rigid.

    The floor's share of the force rises by ``3 x^2 - 2 x^3`` over a length inside the edge
    (a transition slab), and falls in the same way at the exit.

    Attributes
    ----------
    length : float
        Length of the transition [m].
    """

    length: float

    def __post_init__(self) -> None:
        """Check the length."""
        set_frozen(self, length=positive("drive-in length", self.length))

    @property
    def standing(self) -> bool:
        """Whether the vehicle stands on the floor at time 0, in equilibrium with it: no."""
        return False

    def lead(self, vehicle_length: float) -> float:
        """Return where the front axle stands at time 0 [m]: at the edge."""
        del vehicle_length
        return 0.0

    def share(
        self, station: Float[Array, ...], route_length: float
    ) -> tuple[Float[Array, ...], Float[Array, ...]]:
        """Return the share of the force that the floor carries, and its slope [1/m]."""
        x = np.clip(station / self.length, 0.0, 1.0)
        y = np.clip((route_length - station) / self.length, 0.0, 1.0)
        rise, fall = x * x * (3 - 2 * x), y * y * (3 - 2 * y)
        slope = (6 * x * (1 - x) * fall - 6 * y * (1 - y) * rise) / self.length
        return rise * fall, slope

    def __str__(self) -> str:
        """Describe the entry for a report."""
        return f"drive-in over {self.length:g} m"


@dataclass(frozen=True, kw_only=True)
class StaticStart:
    """Start with the whole vehicle on the floor, all in static equilibrium.

    Attributes
    ----------
    exit_length : float
        Length over which each wheel's force falls linearly behind the far edge [m].
    """

    exit_length: float

    def __post_init__(self) -> None:
        """Check the length."""
        set_frozen(self, exit_length=positive("exit_length", self.exit_length))

    @property
    def standing(self) -> bool:
        """Whether the vehicle stands on the floor at time 0, in equilibrium with it: yes."""
        return True

    def lead(self, vehicle_length: float) -> float:
        """Return where the front axle stands at time 0 [m]: the rear axle is at the edge."""
        return vehicle_length

    def share(
        self, station: Float[Array, ...], route_length: float
    ) -> tuple[Float[Array, ...], Float[Array, ...]]:
        """Return the share of the force that the floor carries, and its slope [1/m]."""
        share, slope = Ramp(length=self.exit_length).share(station, route_length)
        # A rear axle may stand a rounding error before the edge at the start.
        before = station < 0.0
        return np.where(before, 1.0, share), np.where(before, 0.0, slope)

    def __str__(self) -> str:
        """Describe the entry for a report."""
        return "static equilibrium on the floor at the start"


@dataclass(frozen=True, kw_only=True)
class Abrupt:
    """Put each wheel's whole force on the floor at the edge, and take it off at the far one.

    Nothing comes onto a floor in this way: its response holds a free vibration from steps of
    the static axle loads, which does not grow with the road's roughness. It is there to show
    what such a reading of a moving load does. In a computation a step rises over one time step,
    so that its response depends on the time step.
    """

    @property
    def standing(self) -> bool:
        """Whether the vehicle stands on the floor at time 0, in equilibrium with it: no."""
        return False

    def lead(self, vehicle_length: float) -> float:
        """Return where the front axle stands at time 0 [m]: at the edge."""
        del vehicle_length
        return 0.0

    def share(
        self, station: Float[Array, ...], route_length: float
    ) -> tuple[Float[Array, ...], Float[Array, ...]]:
        """Return the share of the force that the floor carries, and its slope [1/m]."""
        inside = (station >= 0.0) & (station <= route_length)
        return inside.astype(float), np.zeros_like(station)

    def __str__(self) -> str:
        """Describe the entry for a report."""
        return "abrupt: each axle's whole load at once"


def entry_named(name: str, length: float | None = None) -> Entry:
    """Return the entry of a name.

    Parameters
    ----------
    name : {"drive_in", "ramp", "static", "abrupt"}
        Over a stretch of floor that carries more and more of a wheel; by a ramp before the edge;
        standing on the floor from the start; each axle's whole load at once.
    length : float, optional
        Of the stretch, the ramp, or a static start's way out [m]: 3 m of a drive-in and 1 m of the
        others unless given. An abrupt entry has none.

    Raises
    ------
    InputError
        Another name, or a length of what has none.
    """
    one_of("entry", name, ("drive_in", "ramp", "static", "abrupt"))
    if name == "abrupt":
        if length is not None:
            raise InputError(f"an abrupt entry has no length; got {length:g} m")
        return Abrupt()
    if name == "ramp":
        return Ramp(length=1.0 if length is None else length)
    if name == "static":
        return StaticStart(exit_length=1.0 if length is None else length)
    return DriveIn(length=3.0 if length is None else length)

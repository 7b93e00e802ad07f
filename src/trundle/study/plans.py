"""Hold what a study runs and holds results against: drives, cases, methods, limits, notes."""

from __future__ import annotations

from dataclasses import dataclass

from trundle.criteria import Criterion
from trundle.road import RoughnessBand
from trundle.route import Entry, Route
from trundle.signals import Averaging
from trundle.simulate import Interaction
from trundle.vehicle import Vehicle

__all__ = ["Assessment", "Case", "Drive", "MethodPlan", "Note", "Printed", "PrintedBound"]


@dataclass(frozen=True, kw_only=True, eq=False)
class Drive:
    """Hold a route with the vehicle that drives it.

    Attributes
    ----------
    route : Route
        Where and how fast.
    vehicle : Vehicle
        What drives.
    run_in : float or None
        Distance driven before the floor [m], see `trundle.simulate.Crossing`.
    """

    route: Route
    vehicle: Vehicle
    run_in: float | None


@dataclass(frozen=True, kw_only=True)
class Case:
    """Hold what acts at once: one route or other source, or several.

    Attributes
    ----------
    name : str
        Name of the route or source, or of the traffic.
    routes : tuple of str
        Names of what acts together; a route may be there more than once, with times of its own.
    departs : tuple of float
        When each departs [s]; all at once unless given.
    """

    name: str
    routes: tuple[str, ...]
    departs: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        """Let all depart at once unless told otherwise."""
        if not self.departs:
            object.__setattr__(self, "departs", (0.0,) * len(self.routes))


@dataclass(frozen=True, kw_only=True, eq=False)
class MethodPlan:
    """Hold a method with the entry that goes with it.

    Attributes
    ----------
    name : str
        Name in the study.
    interaction : Decoupled or Coupled
        The method.
    entry : Ramp, DriveIn, StaticStart or Abrupt
        How wheels come onto the floor.
    band : RoughnessBand or None
        Waves of its own; those of the study unless given.
    """

    name: str
    interaction: Interaction
    entry: Entry
    band: RoughnessBand | None = None


@dataclass(frozen=True, kw_only=True, eq=False)
class Assessment:
    """Hold what the response is held against.

    Attributes
    ----------
    criteria : tuple of Criterion
        The curves.
    method : str
        Name of the method whose result is assessed.
    percentile : float
        Share of runs that a level must cover, 0 to 100.
    averaging : {"max_1s", "slow", "fast", "event"}
        Averaging rule of band levels.
    events : float
        How many passages a vibration dose is for.
    """

    criteria: tuple[Criterion, ...]
    method: str
    percentile: float
    averaging: Averaging
    events: float


@dataclass(frozen=True, kw_only=True)
class Printed:
    """Hold published values of one cell: peak acceleration [m/s2] and RMS velocity [m/s]."""

    case: str
    road: str
    method: str
    peak_acceleration: float
    rms_velocity: float


@dataclass(frozen=True, kw_only=True)
class PrintedBound:
    """Hold published upper bounds: peak acceleration [m/s2] and RMS velocity [m/s]."""

    bound: str
    road: str
    method: str
    peak_acceleration: float
    rms_velocity: float


@dataclass(frozen=True, kw_only=True)
class Note:
    """Hold a note for the report."""

    title: str
    text: str

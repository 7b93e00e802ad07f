"""Say which vehicle crosses which floor, on which road, and by which method."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass, field, replace
from typing import Literal

import numpy as np
from jaxtyping import Float

from trundle._checks import finite, non_negative, one_of, set_frozen
from trundle._kinds import kinds_checked
from trundle._typing import Array
from trundle.errors import InputError
from trundle.road import FeaturedRoad, Road, RoughnessBand, Tread
from trundle.route import Along, DriveIn, Entry, Footprint, Route
from trundle.vehicle import Vehicle

__all__ = ["TAIL", "Crossing"]

TAIL = 5.0
"""Free decay after the last wheel has left that a record holds, unless its length is given [s]."""

_ROUNDING = 1e-9  # s
_RUN_IN_LIMIT = 20.0  # s; a vehicle without damping would otherwise run in for ever


@kinds_checked
@dataclass(frozen=True, eq=False)
class Crossing:
    """Hold one vehicle's drive over the floor.

    Attributes
    ----------
    vehicle : Vehicle
        The vehicle, as it was given.
    route : Route
        Where it drives, and how fast.
    road : Road
        Random roughness of a class, drawn anew for each run; a given profile, which must cover
        run-in and route until the last wheel has left; a survey of several tracks; or one of
        these with joints, humps and the like.
    band : RoughnessBand
        Spatial frequencies of a random road; its contact patch averages a given one too. A band
        without a contact patch takes the vehicle's.
    entry : Entry
        How wheels come onto the floor; `entry_named` gives one by its name.
    run_in : float or None
        Distance driven on rigid rough ground before time 0 [m]; None lets the slowest
        motion of the vehicle decay to 5 %, 0 starts it in equilibrium: at rest, or climbing
        steadily where a given profile has a grade at its start.
    depart : float
        Time at which the front axle is at the entry's start [s], 0 or more: the floor is at
        rest at time 0.
    chainage : float
        Station of a given road at the route's start [m]; 0 takes what the road says.
    start : {"equilibrium", "level"}
        How the vehicle begins, before its run-in if it has one: at rest in equilibrium on the
        road under its wheels, or level, as over a road of no height, so that the height of the
        road there hits it as a step; closed forms of the literature mostly begin so. Level needs
        an integration by `Modal`.
    driven : Vehicle
        The vehicle as its route has it: turned round where it drives backwards, with inner
        contacts for all that acts within it. It follows from the others.
    """

    vehicle: Vehicle
    route: Route
    road: Road
    _: KW_ONLY
    band: RoughnessBand = field(default_factory=RoughnessBand)
    entry: Entry = field(default_factory=lambda: DriveIn(length=3.0))
    run_in: float | None = None
    depart: float = 0.0
    chainage: float = 0.0
    start: Literal["equilibrium", "level"] = "equilibrium"
    driven: Vehicle = field(init=False)

    def __post_init__(self) -> None:
        """Check times and distances."""
        one_of("start", self.start, ("equilibrium", "level"))
        if self.start == "level" and self.entry.standing:
            raise InputError(
                "a static start is in equilibrium with the floor: leave start out, or choose "
                "another entry"
            )
        set_frozen(self, depart=non_negative("depart", self.depart))
        set_frozen(self, chainage=finite("chainage", self.chainage))
        if self.chainage != 0.0 and not self.road.is_given:
            raise InputError(
                "chainage is the station of a given profile at the route's start; got "
                f"{self.chainage:g} m with a random road, which has no stations: leave it out"
            )
        set_frozen(self, driven=self.vehicle.backwards() if self.route.reverse else self.vehicle)
        braked = bool(np.any(self.route.law.change(self._clock()) != 0.0))
        set_frozen(self, driven=self.driven.with_inner_contacts(braked=braked))
        if self.band.contact_patch == 0.0 and self.driven.contact_patch > 0.0:
            patch = self.driven.contact_patch
            set_frozen(self, band=replace(self.band, contact_patch=patch))
        self._check_corners()
        self._check_rest()
        set_frozen(self, road=self.road.of(self.route.name))
        if self.chainage == 0.0:
            set_frozen(self, chainage=self.road.start)
        self._check_contact()
        if self.run_in is not None:
            set_frozen(self, run_in=non_negative("run_in", self.run_in))

    def _clock(self) -> Float[Array, " times"]:
        """Return times all along the drive [s], close enough to see where it brakes."""
        law = self.route.law
        ends = (t for t in (law.time_to(self._way), law.rests_from) if np.isfinite(t))
        return np.linspace(0.0, max(0.0, *ends, 0.0), 501)

    def _check_rest(self) -> None:
        """Refuse a vehicle that comes to rest half off the floor."""
        law = self.route.law
        if not self.stays or not np.isfinite(law.rests_from):
            return
        front = self.lead + float(law.distance(law.rests_from))
        if front > self.route.length + 1e-6:
            raise InputError(
                f"route {self.route.name!r}: the vehicle comes to rest with its front axle "
                f"{front - self.route.length:.4g} m behind the route's end: let it stop before, or "
                "drive off"
            )

    def _check_corners(self) -> None:
        """Refuse wheels beside a line that turns sharply: they would jump."""
        bends = self.route.legs.curvature[:, None]
        beside = np.array([self.driven.lateral.min(), self.driven.lateral.max()]) + self.route.lane
        if np.any(1.0 - bends * beside <= 0.0):
            raise InputError(
                f"route {self.route.name!r}: corners of {self.route.radius:g} m are narrower than "
                "half the vehicle is wide: give a larger radius"
            )
        if not self.route.has_sharp_corners:
            return
        aside = float(np.abs(self.driven.lateral + self.route.lane).max())
        if aside > 0.0:
            raise InputError(
                f"route {self.route.name!r} turns sharply, where a wheel {aside:g} m beside its "
                "line would jump: give the radius that its corners are driven with"
            )

    @property
    def footprint(self) -> Footprint:
        """Where its wheels are on the vehicle."""
        vehicle = self.driven
        units = vehicle.units if self.route.steering == "tractrix" else ()
        return Footprint(setback=vehicle.setback, lateral=vehicle.lateral, units=units)

    @property
    def stays(self) -> bool:
        """Whether it comes to rest on the route, and never leaves."""
        return not np.isfinite(self.route.law.time_to(self._way))

    @property
    def _way(self) -> float:
        """What the front axle drives until the last wheel has left [m]."""
        return self.route.length - self.lead + self.driven.length

    def _check_contact(self) -> None:
        """Refuse a point that meets joints and steps: it would be thrown up in no time."""
        features = isinstance(self.road, FeaturedRoad) and self.road.features
        if features and self.band.contact_patch == 0.0 and self.driven.wheel_radius == 0.0:
            raise InputError(
                f"vehicle {self.driven.name!r} meets joints or humps in a point, which no tyre "
                "does: give the length of its contact patch (some 0.2 m of a truck's tyre, 0.1 m "
                "of a forklift's solid one, 0.02 m of a polyurethane wheel)"
            )

    def tread(self, contact: int) -> Tread:
        """Return how one of its wheels meets what is shorter than itself."""
        vehicle = self.driven
        stiffness, load = vehicle.contact_stiffness[contact], vehicle.static_forces[contact]
        sinking = float(load / stiffness) if stiffness > 0.0 else np.inf
        return Tread(sinking=max(sinking, 0.0), radius=vehicle.wheel_radius)

    @property
    def lead(self) -> float:
        """Station of the front axle at the time of departure [m]."""
        return self.entry.lead(self.driven.length)

    @property
    def fastest(self) -> float:
        """Largest speed on its way [m/s]; of one that speeds up for ever, where it leaves."""
        law = self.route.law
        if np.isfinite(law.fastest):
            return law.fastest
        return float(np.max(law.speed(self._clock())))

    @property
    def run_in_time(self) -> float:
        """Time driven on rigid ground before time 0 [s]."""
        speed = float(self.route.law.speed(0.0))
        if speed == 0.0:
            return 0.0  # a standing start
        if self.run_in is not None:
            return self.run_in / speed
        rates = self.driven.decay_rates()
        return float(min(3.0 / max(rates.min(), 1e-9), _RUN_IN_LIMIT))

    @property
    def exit_time(self) -> float:
        """Time at which the last wheel has left the floor, or it has come to rest there [s]."""
        law = self.route.law
        return self.depart + (law.rests_from if self.stays else law.time_to(self._way))

    def begins(self, dt: float) -> float:
        """Return when the vehicle begins to move, a whole number of steps [s]."""
        if self.entry.standing:
            return 0.0
        return -float(np.ceil((self.run_in_time - self.depart) / dt - 1e-9)) * dt

    def along(self, time: Float[Array, " times"], begins: float) -> Along:
        """Return where its wheels are on their way at some times.

        Before its own start a vehicle stands still, so that it drives the same way whether others
        have a longer run-in or not.
        """
        law, clock = self.route.law, np.maximum(time - self.depart, begins - self.depart)
        moving = time - begins > _ROUNDING
        front = self.lead + law.distance(clock)
        station = front[:, None] - self.driven.setback
        speed = np.broadcast_to((law.speed(clock) * moving)[:, None], station.shape)
        return Along(time=time, station=station, speed=speed)

    def wheels_on_floor(self, time: float) -> int:
        """Return how many of the wheels stand on the route at a time."""
        front = self.lead + float(self.route.law.distance(time - self.depart))
        station = front - self.driven.setback
        return int(np.count_nonzero((station >= 0.0) & (station <= self.route.length)))

    def front_axle(self, time: float) -> tuple[float, float] | None:
        """Return where the front axle stands at a time [m], or None when it is off the route."""
        station = self.lead + float(self.route.law.distance(time - self.depart))
        if not 0.0 <= station <= self.route.length:
            return None
        place, _ = self.route.locate(np.array([station]))
        return float(place[0, 0]), float(place[0, 1])

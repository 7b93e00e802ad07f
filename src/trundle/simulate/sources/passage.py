"""Make a crossing a source of vibration: a vehicle that a road pushes at."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from trundle._typing import Array
from trundle._words import in_kmh
from trundle.dynamics import Modes
from trundle.errors import FitnessWarning
from trundle.road import FITTED_RANGE
from trundle.route import Along, Track, follow, wheel_places
from trundle.simulate.sources.axle_hop import axle_hop_warnings
from trundle.simulate.sources.crossing import Crossing
from trundle.simulate.sources.given_road import GivenRoad, given_road, given_road_doubts
from trundle.simulate.sources.random_road import RandomRoad
from trundle.simulate.sources.reach import road_reach
from trundle.simulate.sources.source import Source, WaveSet
from trundle.simulate.sources.waves import waves_under
from trundle.simulate.sources.within import check_within, forces_within, lifts_of_wheels
from trundle.structure import ContactShape, Structure
from trundle.vehicle import Vehicle

__all__ = ["Passage", "as_sources"]

_HARMONICS = 4  # multiples of V / h that the hat function excites noticeably
_NEAR = 0.05  # relative distance within which such a frequency counts as on a mode
_TOP_EDGE = 89.2  # Hz: where the 80 Hz band ends
_PLACES_A_METRE = 50  # of a way, where the dofs under it are looked for


def as_sources(given: Crossing | Source | Sequence[Crossing | Source]) -> tuple[Source, ...]:
    """Return what makes a structure vibrate; crossings become passages."""
    many = (given,) if isinstance(given, Crossing | Source) else tuple(given)
    return tuple(Passage(crossing=one) if isinstance(one, Crossing) else one for one in many)


@dataclass(frozen=True, kw_only=True)
class Passage:
    """A vehicle that crosses a structure on a road.

    Attributes
    ----------
    crossing : Crossing
        Who drives where.
    number : int
        Which passage on its route it is, where there are several: all meet the same road.
    """

    crossing: Crossing
    number: int = 1

    @property
    def name(self) -> str:
        """Name of its route, with its number behind the first."""
        name = self.crossing.route.name
        return name if self.number == 1 else f"{name} ({self.number})"

    @property
    def contact_names(self) -> tuple[str, ...]:
        """Name of every wheel."""
        return self.crossing.driven.contact_names

    @property
    def oscillator(self) -> Vehicle:
        """The vehicle."""
        return self.crossing.driven

    @property
    def standing(self) -> bool:
        """Whether it starts on the structure, in equilibrium with it."""
        return self.crossing.entry.standing

    @property
    def level(self) -> bool:
        """Whether the vehicle starts level."""
        return self.crossing.start == "level"

    @property
    def random(self) -> bool:
        """Whether its road is drawn anew for every run."""
        return self.crossing.road.spectrum is not None

    @property
    def varies(self) -> bool:
        """Whether anything but its road is random: nothing is."""
        return False

    @property
    def complete(self) -> bool:
        """Whether its road holds all waves that there are: none does."""
        return False

    @property
    def leaves(self) -> float:
        """Time at which the last wheel leaves [s]."""
        return self.crossing.exit_time

    @property
    def on(self) -> str | None:
        """Name of the surface that it drives on."""
        return self.crossing.route.on

    def begins(self, dt: float) -> float:
        """Return when it begins to move, a whole number of steps [s]."""
        return self.crossing.begins(dt)

    def later(self, by: float) -> Passage:
        """Return a passage that departs later [s], over the same road."""
        return replace(self, crossing=replace(self.crossing, depart=self.crossing.depart + by))

    def track(self, time: Float[Array, " times"], begins: float) -> Track:
        """Return where its wheels are."""
        crossing = self.crossing
        along = crossing.along(time, begins)
        track = follow(
            crossing.route, crossing.entry, crossing.footprint, along, leaves=not crossing.stays
        )
        if crossing.driven.inner:  # what acts within a vehicle touches no floor
            track.share[:, -crossing.driven.inner :] = 0.0
            track.share_slope[:, -crossing.driven.inner :] = 0.0
        return track

    def swept(self) -> Track:
        """Return where its wheels are all along its way, each carried where it is on it."""
        crossing = self.crossing
        way = crossing.route.length + crossing.driven.length
        front = np.linspace(0.0, way, _PLACES_A_METRE * int(way) + 2)
        station = front[:, None] - crossing.driven.setback
        along = Along(time=front, station=station, speed=np.ones_like(station))
        track = follow(crossing.route, crossing.entry, crossing.footprint, along)
        on = (station >= 0.0) & (station <= crossing.route.length)
        return replace(track, share=on.astype(float))

    def way(self) -> Iterator[tuple[Float[Array, "places 2"], Float[Array, "places 2"]]]:
        """Give places all along each track of its wheels."""
        route, footprint = self.crossing.route, self.crossing.footprint
        if footprint.units:
            way = route.length + self.crossing.driven.length
            front = np.linspace(0.0, way, _PLACES_A_METRE * int(way) + 2)
            found = wheel_places(route, footprint, front)
            station = front[:, None] - footprint.setback
            for i in range(len(footprint.setback)):
                on = (station[:, i] >= 0.0) & (station[:, i] <= route.length)
                yield found.place[on, i], found.direction[on, i]
            return
        station = np.linspace(0.0, route.length, _PLACES_A_METRE * int(route.length) + 2)
        for lateral in np.unique(self.crossing.driven.lateral):
            yield route.locate(station, lateral)

    def inputs(self, time: Float[Array, " times"], begins: float, seed: int) -> RoadInputs:
        """Return what its road pushes at the wheels."""
        crossing = self.crossing
        along = crossing.along(time, begins)
        spectrum = crossing.road.spectrum
        given = given_road(crossing, along) if crossing.road.is_given else None
        random = None if spectrum is None else RandomRoad(crossing, spectrum, along, seed)
        return RoadInputs(
            crossing,
            along,
            _Parts(given, random, along.station.shape, lifts_of_wheels(crossing, along)),
        )

    def waves(
        self, time: Float[Array, " times"], begins: float, n_waves: int
    ) -> tuple[WaveSet, ...]:
        """Return the waves of a random road, each set from an independent source."""
        crossing = self.crossing
        spectrum = crossing.road.spectrum
        if spectrum is None:
            return ()
        return tuple(waves_under(crossing, spectrum, crossing.along(time, begins), n_waves))

    def stands_at(self, time: float) -> tuple[tuple[float, float] | None, int]:
        """Return where the front axle stands at a time, None when off; and how many wheels do."""
        return self.crossing.front_axle(time), self.crossing.wheels_on_floor(time)

    def excited_to(self, ends: float) -> float:
        """Return where the waves of the road end under the vehicle [Hz]."""
        return self._fastest_until(ends) * road_reach(self.crossing).whole

    def partly_excited_to(self, ends: float) -> float:
        """Return to where the road holds some waves under the vehicle [Hz]."""
        speed = self._fastest_until(ends)
        return speed * road_reach(self.crossing).partly if speed > 0.0 else 0.0

    def _fastest_until(self, ends: float) -> float:
        """Return the largest speed on the way, in a record of a length [m/s]."""
        crossing = self.crossing
        until = min(ends, crossing.exit_time) - crossing.depart
        clock = np.linspace(0.0, max(0.0, until), 201)
        return float(np.max(crossing.route.law.speed(clock)))

    def check(self, dt: float, duration: float | None) -> tuple[FitnessWarning, ...]:
        """Refuse a given profile that the step cannot show; return doubts about one."""
        check_within(self.crossing, dt)
        return given_road_doubts((self.crossing,), dt, duration)

    def doubts(
        self, structure: Structure, modes: Modes | None, contact: ContactShape
    ) -> tuple[FitnessWarning, ...]:
        """Return what a result must say of vehicle, road, and mesh under the wheels."""
        found = [*axle_hop_warnings((self.crossing,)), *_extrapolation(self.crossing)]
        found += _not_linear(self.crossing)
        if contact.kinks:
            found.append(_mesh_passing(self.crossing, structure, modes))
        return tuple(found)


class _Parts:
    """A road under the wheels: its given part, the same in every run, and its random part."""

    def __init__(
        self,
        given: GivenRoad | None,
        random: RandomRoad | None,
        shape: tuple[int, ...],
        lifts: Float[Array, "2 times contacts"] | None,
    ) -> None:
        self._random = random
        self._given = np.zeros((2, *shape)) if lifts is None else lifts
        if given is not None:
            self._given = self._given + np.array([given.elevation, given.slope])

    def draw(self, run: int) -> Float[Array, "2 times contacts"]:
        """Return elevation [m] and slope under the wheels."""
        return self._given if self._random is None else self._random.draw(run) + self._given

    def still(self) -> Float[Array, "2 times contacts"]:
        """Return the same without the random part."""
        return self._given


class RoadInputs:
    """What a road pushes at the wheels of a vehicle."""

    def __init__(self, crossing: Crossing, along: Along, road: _Parts) -> None:
        self._road, self._level = road, crossing.start == "level"
        self._stiffness = crossing.driven.contact_stiffness
        self._rolling = crossing.driven.contact_damping * along.speed
        self._within = forces_within(crossing, along)

    def draw(self, run: int) -> tuple[Float[Array, "times contacts"], Float[Array, " contacts"]]:
        """Return the pushes of a run [N], and the height under each wheel at first [m]."""
        return self._pushed(lambda: self._road.draw(run))

    def still(self) -> tuple[Float[Array, "times contacts"], Float[Array, " contacts"]]:
        """Return the same without a random road."""
        return self._pushed(self._road.still)

    def _pushed(self, read: Callable[[], Array]) -> tuple[Array, Array]:
        elevation, slope = read()
        push = self._stiffness * elevation + self._rolling * slope
        if self._within.shape[1]:
            push[:, -self._within.shape[1] :] += self._within
        return push, np.zeros_like(elevation[0]) if self._level else elevation[0]


def _not_linear(crossing: Crossing) -> list[FitnessWarning]:
    vehicle = crossing.driven
    if vehicle.is_linear:
        return []
    what = ["lifts off"] * vehicle.lifts_off
    what += sorted({type(law).__name__.lower() for law in vehicle.laws})
    message = (
        f"it is not linear ({', '.join(what)}): every run is stepped by itself, levels do not grow "
        "with the road, and there are no exact statistics of it"
    )
    return [FitnessWarning(subject=f"vehicle, {vehicle.name}", message=message)]


def _extrapolation(crossing: Crossing) -> list[FitnessWarning]:
    if crossing.road.spectrum is None:
        return []
    speed = crossing.fastest
    n_max = crossing.band.n_max
    if n_max > FITTED_RANGE[1] * (1 + 1e-9):
        message = (
            f"waves to {n_max:.3g} cycle/m are beyond ISO 8608's fitted range "
            f"({FITTED_RANGE[1]:g}); the road above {speed * FITTED_RANGE[1]:.3g} Hz at "
            f"{in_kmh(speed)} is extrapolated"
        )
    else:
        message = (
            f"waves end at {n_max:.3g} cycle/m, which is {speed * n_max:.3g} Hz at "
            f"{in_kmh(speed)}; the road excites nothing above it, and bands there are not "
            f"assessed: n_max = {_TOP_EDGE / speed:.3g} 1/m with a contact patch reaches 80 Hz"
        )
    return [FitnessWarning(subject=f"roughness band, {crossing.route.name}", message=message)]


def _mesh_passing(crossing: Crossing, structure: Structure, modes: Modes | None) -> FitnessWarning:
    size = min(structure.surface(on).element_size for on in crossing.route.visited)
    speed = crossing.fastest
    passing = speed / size * np.arange(1, _HARMONICS + 1)
    note = f"hat functions of {size:.3g} m are passed at {speed / size:.3g} Hz and its multiples"
    if modes is not None:
        f = modes.frequencies[:, None]
        hits = np.unique(np.round(passing[(np.abs(f - passing) < _NEAR * f).any(axis=0)], 2))
        if hits.size:
            note += "; " + ", ".join(f"{hit:g} Hz" for hit in hits) + " lies on a mode"
    return FitnessWarning(subject=f"mesh passing, {crossing.route.name}", message=note)

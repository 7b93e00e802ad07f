"""Read a given profile under the wheels of one crossing."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from trundle._typing import Array
from trundle.errors import FitnessWarning, InputError
from trundle.road import FeaturedRoad, Profile, profile_doubts
from trundle.route import Along
from trundle.simulate.sources.crossing import Crossing
from trundle.simulate.sources.profile_step import check_profile_step, hidden_by_step
from trundle.vehicle import Vehicle

__all__ = ["GivenRoad", "given_road", "given_road_doubts"]

_ROUNDING = 1e-6  # m; a profile may end so little before the last wheel
_DENSE = 3  # of five steps with a kink, from which on a road is a polygon of many short sides
_HIDDEN = 0.003  # of a static wheel force, what a step hides without a word
_PLANE = 1e-6  # of its stiffness, what a motion without spring forces may have


@dataclass(frozen=True, kw_only=True, eq=False)
class GivenRoad:
    """Hold a profile under the wheels of one crossing.

    Elevations are taken above a plane that a vehicle can follow without a force in any
    spring: the plane through the front wheel's first station with the grade that the vehicle
    comes along. Above it a vehicle that starts at rest is one that climbs that grade steadily;
    at constant speed no force differs otherwise, and at an acceleration a the plane leaves
    out the vertical part of it, a times the grade.

    Attributes
    ----------
    elevation : ndarray of float, shape (n_all, n_contacts)
        Elevation under each wheel above that plane [m].
    slope : ndarray of float, shape (n_all, n_contacts)
        Its slope along the way [m/m]; over a kink the mean from half a step before to half a
        step behind, so that the sum over the steps is the elevation gained.
    """

    elevation: Float[Array, "steps contacts"]
    slope: Float[Array, "steps contacts"]


def given_road_doubts(
    crossings: tuple[Crossing, ...], dt: float, duration: float | None = None
) -> tuple[FitnessWarning, ...]:
    """Return the doubts about given profiles; refuse those that a run would refuse.

    Parameters
    ----------
    crossings : tuple of Crossing
        Who drives where; random roads are passed over.
    dt : float
        Time step [s].
    duration : float or None
        Length of the record [s]; until the last wheel has left unless given.
    """
    found: list[FitnessWarning] = []
    for crossing in crossings:
        length = crossing.exit_time if duration is None else duration
        if not crossing.road.is_given or not np.isfinite(length):
            continue
        along = crossing.along(*_alone(crossing, dt, max(length, 2.0 * dt)))
        for profile, contacts in _tracks(crossing):
            found += _track_doubts(crossing, profile, _only(along, contacts), dt)
    # tracks of one road are doubted for the same reasons at almost the same places
    return tuple({one.subject: one for one in reversed(found)}.values())[::-1]


def _track_doubts(
    crossing: Crossing, profile: Profile, along: Along, dt: float
) -> list[FitnessWarning]:
    lying = _lay(crossing, profile, along)
    hidden = hidden_by_step(crossing, lying.road, lying.needed, speed=lying.speed, dt=dt)
    found: list[FitnessWarning] = []
    if hidden.force > _HIDDEN:
        found.append(
            FitnessWarning(
                subject=f"road between steps, {crossing.route.name}",
                message=f"{hidden}; a shorter step, or the tyre's contact patch, would show it",
            )
        )
    # heights of features are what somebody wrote, and no survey
    return found if isinstance(crossing.road, FeaturedRoad) else [*found, *profile_doubts(profile)]


def _tracks(crossing: Crossing) -> list[tuple[Profile, list[int]]]:
    """Return the profiles under a vehicle's wheels, each with the contacts that roll on it."""
    found: list[tuple[Profile, list[int]]] = []
    for contact, aside in enumerate(crossing.driven.lateral[: _outer(crossing.driven)]):
        profile = crossing.road.under(float(aside), crossing.tread(contact))
        if profile is None:
            profile = Profile.smooth()
        same = next((contacts for one, contacts in found if one is profile), None)
        if same is None:
            found.append((profile, [contact]))
        else:
            same.append(contact)
    return found


def _outer(vehicle: Vehicle) -> int:
    """Return how many of a vehicle's contacts touch the ground: the first ones."""
    return vehicle.n_contacts - vehicle.inner


def _only(along: Along, contacts: list[int]) -> Along:
    return replace(along, station=along.station[:, contacts], speed=along.speed[:, contacts])


def _alone(crossing: Crossing, dt: float, duration: float) -> tuple[Array, float]:
    """Return the times of a record that only this crossing is in, and when it begins [s]."""
    begins = crossing.begins(dt)
    before = max(0, int(np.ceil(-begins / dt - 1e-9)))
    return dt * np.arange(-before, round(duration / dt) + 1), begins


def given_road(crossing: Crossing, along: Along) -> GivenRoad:
    """Read the profile of a crossing, averaged over the tyre's contact patch.

    Raises
    ------
    InputError
        A profile that does not cover the way that the wheels need, or that rises and falls
        within a step.
    """
    elevation, slope = np.zeros(along.station.shape), np.zeros(along.station.shape)
    came = _Came.of(along.station.shape[1])
    for profile, contacts in _tracks(crossing):
        lying = _lay(crossing, profile, _only(along, contacts))
        z, g = lying.road.at(lying.station)
        elevation[:, contacts] = z
        slope[:, contacts] = _over_kinks(lying.road, lying.station, g)
        _put(came, contacts, crossing.driven, lying)
    if crossing.start == "level":
        return GivenRoad(elevation=elevation, slope=slope)
    level = came.here[0]
    climbs = _follows_planes(crossing.driven)
    grade = float(came.grade[: _outer(crossing.driven)].mean()) if climbs else 0.0
    way = along.station - along.station[0, 0]
    return GivenRoad(elevation=elevation - level - grade * way, slope=slope - grade)


@dataclass(frozen=True, kw_only=True, eq=False)
class _Lying:
    """A profile under a crossing's wheels, with stations in the profile's own chainage."""

    road: Profile  # averaged by the tyre, and known everywhere
    first: float  # station before which nothing was known of it [m]
    station: Array  # (n_all, n_contacts) [m]
    needed: tuple[float, float]  # from the first wheel's start to the last wheel's leaving [m]
    speed: float  # the largest [m/s]


def _lay(crossing: Crossing, given: Profile, along: Along) -> _Lying:
    """Lay a profile under the wheels of its track, and refuse it where it cannot be right."""
    profile = given.averaged(crossing.band.contact_patch)
    station = along.station + crossing.chainage
    needed = _needed(crossing, station)
    _check_cover(crossing, profile, needed)
    known = profile.beyond != "unknown"
    lying = _Lying(
        # Behind the last wheel's leaving nothing is asked of the road, so it may go on anyhow.
        road=profile if known else replace(profile, beyond="mirror"),
        first=-np.inf if known else float(profile.station[0]),
        station=station,
        needed=needed,
        speed=float(along.speed.max()),
    )
    dt = float(along.time[1] - along.time[0])
    check_profile_step(crossing, lying.road, needed, speed=lying.speed, dt=dt)
    return lying


def _needed(crossing: Crossing, station: Array) -> tuple[float, float]:
    """Return the stations from the first wheel's start to the last wheel's leaving [m]."""
    edge = crossing.chainage + crossing.route.length + max(0.0, -crossing.lead)
    return float(station.min()), min(float(station.max()), edge + crossing.driven.length)


def _check_cover(crossing: Crossing, profile: Profile, needed: tuple[float, float]) -> None:
    first, last = float(profile.station[0]), float(profile.station[-1])
    low, high = needed
    if profile.beyond != "unknown" or (low >= first - _ROUNDING and high <= last + _ROUNDING):
        return
    start = crossing.chainage
    before, behind = start - low, high - start
    patch = crossing.band.contact_patch
    averaged = f" when averaged over a contact patch of {patch:g} m" if patch else ""
    raise InputError(
        f"route {crossing.route.name!r}: the given profile covers stations {first:g} to {last:g} m"
        f"{averaged}, but the wheels need {low:.2f} to {high:.2f} m: {before:.2f} m before the "
        f"route's start, which is station {start:g} m of the profile, for the run-in and the "
        f"vehicle's length, and {behind:.2f} m behind it until the last wheel has left; "
        f"{_remedy(crossing, (first, last), (before, behind))}, or say what the road beyond its "
        'stations is: Profile(..., beyond="mirror") or beyond="level"'
    )


def _remedy(crossing: Crossing, covered: tuple[float, float], reach: tuple[float, float]) -> str:
    (first, last), (before, behind) = covered, reach
    start, way = crossing.chainage, crossing.chainage - crossing.lead - first
    least, most = np.ceil(100 * (first + before)) / 100, np.floor(100 * (last - behind)) / 100
    if least <= most:
        return (
            "give the route's start in the profile's chainage, Crossing(..., chainage=) from "
            f"{least:.2f} to {most:.2f} m, or lay the profile under the route with "
            f"Profile.moved({start - least:.2f}) or less, to {start - most:.2f}"
        )
    shorter = way - crossing.driven.length
    if start + behind <= last + _ROUNDING and shorter >= 0.0:
        # it is rounded up to whole time steps, for which a decimetre is kept
        return f"shorten the run-in to run_in={max(0.0, np.floor(10 * shorter - 1) / 10):g} m"
    return f"give a profile of {before + behind:.4g} m or more, or a shorter run_in"


def _over_kinks(profile: Profile, station: Array, slope: Array) -> Array:
    """Take the mean slope over a step wherever the slope jumps within it.

    A sample of a slope that jumps says nothing of where in the step it does, and a short steep
    piece may lie between two samples: the damper then misses it, or feels it twice.
    """
    kinks = _kinks(profile)
    if kinks.size == 0:
        return slope
    middle = 0.5 * (station[1:] + station[:-1])
    low, high = np.vstack([station[:1], middle]), np.vstack([middle, station[-1:]])
    inside = np.searchsorted(kinks, high, "right") > np.searchsorted(kinks, low, "left")
    width = high - low
    rise = profile.at(high)[0] - profile.at(low)[0]
    mean = np.where(inside & (width > 0.0), rise / np.where(width > 0.0, width, 1.0), slope)
    return _sharpened(mean, inside)


def _sharpened(mean: Array, inside: Array) -> Array:
    """Give means over steps what they take of waves, where a road has a kink in most steps.

    A mean over a step multiplies a wave of x waves a step by ``sin(pi x) / (pi x)``; of its
    inverse, ``1 - d/24 + 3 d^2/640`` of second differences d is taken, which leaves 0.998 at
    40 Hz and 0.92 at 80 Hz with steps of 5 ms. What one sample gains its neighbour loses.
    Single kinks are left alone, for it would overshoot them.
    """
    near = np.sum([np.roll(inside, shift, axis=0) for shift in range(-2, 3)], axis=0)
    dense: Array = np.asarray(near) >= _DENSE
    both = dense[1:] & dense[:-1]

    def second(values: Array) -> Array:
        flow = np.where(both, np.diff(values, axis=0), 0.0)
        return np.diff(flow, axis=0, prepend=0.0, append=0.0)

    once = second(mean)
    return mean - once / 24.0 + 3.0 / 640.0 * second(once)


def _kinks(profile: Profile) -> Array:
    """Return the stations at which the slope jumps."""
    s, g = profile.station, profile.slope
    jumps = s[1:][(np.diff(s) == 0.0) & (np.diff(g) != 0.0)]
    if profile.beyond == "level":
        ends = [at for at, steep in ((s[0], g[0]), (s[-1], g[-1])) if steep != 0.0]
        jumps = np.concatenate([jumps, ends])
    return np.sort(jumps)


@dataclass(frozen=True, kw_only=True, eq=False)
class _Came:
    """The elevation under every wheel at first [m], and the grade that it came along [m/m]."""

    here: Array
    grade: Array

    @classmethod
    def of(cls, n_contacts: int) -> _Came:
        return cls(here=np.zeros(n_contacts), grade=np.zeros(n_contacts))


def _put(came: _Came, contacts: list[int], vehicle: Vehicle, lying: _Lying) -> None:
    """Put in what wheels of one track have come along.

    The grade is the mean over the way that each has come in one period of the vehicle's slowest
    motion, as far as it is known.
    """
    start, profile = lying.station[0], lying.road
    slowest = float(np.abs(vehicle.poles()).min(initial=np.inf))
    back = lying.speed * 2.0 * np.pi / slowest if slowest > 0.0 else 0.0
    behind = np.minimum(np.maximum(start - back, lying.first), start)
    here, steep = profile.at(start)
    way = start - behind
    some = way > _ROUNDING
    chord = (here - profile.at(behind)[0]) / np.where(some, way, 1.0)
    came.here[contacts], came.grade[contacts] = here, np.where(some, chord, steep)


def _follows_planes(vehicle: Vehicle) -> bool:
    """Tell whether all contacts can lie on an inclined plane without a force in any spring."""
    outer = _outer(vehicle)
    e, stiffness = vehicle.contact_map[:outer], np.asarray(vehicle.free_system.stiffness)
    scale = float(np.abs(stiffness).max())
    if scale <= _PLANE**2 * float(np.abs(np.asarray(vehicle.system.stiffness)).max()):
        return bool(np.linalg.matrix_rank(e) >= outer)
    wanted = np.concatenate([-vehicle.setback[:outer], np.zeros(len(stiffness))])
    matrix = np.vstack([e, stiffness / scale])
    motion = np.linalg.lstsq(matrix, wanted, rcond=None)[0]
    return bool(np.abs(matrix @ motion - wanted).max() < _PLANE)

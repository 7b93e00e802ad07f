"""Read a measured road into SI units, track by track."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from jaxtyping import Float

from trundle._typing import Array
from trundle.errors import InputError
from trundle.profiles.profile_format import format_of
from trundle.profiles.survey import Survey
from trundle.profiles.table import read_table
from trundle.road import MeasuredRoad, Profile, check_roughness, fit_roughness, profile_doubts
from trundle.units import to_si

__all__ = ["ProfileOptions", "ReadProfile", "read_profile"]

_LARGEST = 500_000_000  # bytes
_FEWEST = 4  # points of a track
_FARTHEST, _CLOSEST = 1e7, 1e-6  # m, of stations
_GAP = 5.0  # times the usual distance of points
_HIGHEST = 1e5  # m
_STEEPEST = 3.0  # of the slope that every twentieth point exceeds; a worn block pavement has 0.6
_UNIT_WORDS = {
    "inch": "in", "inches": "in", "feet": "ft", "metre": "m", "meter": "m", "metres": "m",
    "meters": "m", "millimeters": "mm", "millimetres": "mm", "milli-m": "mm",
}  # fmt: skip


@dataclass(frozen=True, kw_only=True)
class ProfileOptions:
    """Hold what a file cannot say of itself.

    Attributes
    ----------
    station_unit, unit : str
        Units of stations and heights, as ``m`` and ``mm``; they win over what the file says.
    tracks : tuple of str
        Which columns, by name or number from 1; all unless given.
    lateral : tuple of float
        Where those lie, to the left of the centre line [m].
    first, last : float or None
        The stretch that is taken, in the file's chainage [m]; all of it unless given.
    detrend : bool
        Take off the straight line through each track: a grade is no roughness.
    """

    station_unit: str = ""
    unit: str = ""
    tracks: tuple[str, ...] = ()
    lateral: tuple[float, ...] = ()
    first: float | None = None
    last: float | None = None
    detrend: bool = True


@dataclass(frozen=True, kw_only=True, eq=False)
class ReadProfile:
    """Hold a measured road, and what was noticed when it was read.

    Attributes
    ----------
    road : MeasuredRoad
        In metres.
    told : tuple of str
        What was passed over or taken for granted.
    """

    road: MeasuredRoad
    told: tuple[str, ...] = ()


def read_profile(path: Path, options: ProfileOptions | None = None) -> ReadProfile:
    """Read a measured road.

    The format is told by what is in the file: an ERD file, an OpenCRG file, or a table.

    Parameters
    ----------
    path : Path
        The file.
    options : ProfileOptions, optional
        Units, tracks and the stretch that is wanted, where the file does not say them.

    Returns
    -------
    ReadProfile
        A road in metres, in the file's own chainage; without the trend of each track unless kept.

    Raises
    ------
    InputError
        A file that cannot be read, units that nobody says or that no road has, stations that do
        not rise, tracks whose place nobody says.
    """
    chosen = options or ProfileOptions()
    data = _bytes_of(path)
    kind = format_of(data[:100_000])
    survey = _chosen(
        read_table(data, path) if kind is None else kind.read(data, path), chosen, path
    )
    _check_rising(survey, path)
    station = survey.station * _scale("stations", survey.station_unit, chosen.station_unit, path)
    lateral = _places(survey, chosen, path)
    _check_bounds(station, survey, path)
    order = np.argsort(lateral)
    tracks = tuple(_track(survey, station, int(i), chosen, path) for i in order)
    road = MeasuredRoad(tracks=tracks, lateral=lateral[order], name=path.name)
    return ReadProfile(road=road, told=survey.notes)


def _bytes_of(path: Path) -> bytes:
    try:
        if not path.is_file():
            raise InputError(f"{path}: no such file")
        if path.stat().st_size > _LARGEST:
            raise InputError(f"{path}: a profile may have {_LARGEST / 1e6:g} MB")
        return path.read_bytes()
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror})") from None


def _chosen(survey: Survey, options: ProfileOptions, path: Path) -> Survey:
    """Return the tracks that are wanted, in the order in which they are named."""
    if not options.tracks:
        return survey
    at = [_found(word, survey.names, path) for word in options.tracks]
    if len(set(at)) < len(at):
        raise InputError(f"{path}: tracks names one column twice: {', '.join(options.tracks)}")
    return replace(
        survey,
        elevation=survey.elevation[at],
        names=tuple(survey.names[i] for i in at),
        units=tuple(survey.units[i] for i in at),
        lateral=None if survey.lateral is None else tuple(survey.lateral[i] for i in at),
    )


def _found(word: str, names: Sequence[str], path: Path) -> int:
    like = [i for i, name in enumerate(names) if name.lower() == word.lower()]
    like = like or [i for i, name in enumerate(names) if word.lower() in name.lower()]
    if len(like) == 1:
        return like[0]
    if word.isascii() and word.isdigit() and 1 <= int(word) <= len(names):
        return int(word) - 1
    what = "is several of its tracks" if like else "is no track of it"
    raise InputError(f"{path}: {word!r} {what}; there are: {', '.join(names)}")


def _check_rising(survey: Survey, path: Path) -> None:
    step = np.diff(survey.station)
    if len(survey.station) < _FEWEST:
        raise InputError(
            f"{path}: holds {len(survey.station)} point(s); a profile needs {_FEWEST} at least"
        )
    if np.any(step <= 0.0):
        i = int(np.argmax(step <= 0.0))
        same = "is given twice" if step[i] == 0.0 else "falls"
        raise InputError(
            f"{path}: {survey.where} {survey.lines[i + 1]}: the station {same}: "
            f"{survey.station[i]:g}, then {survey.station[i + 1]:g}; stations must rise: "
            + ("drop one of the two" if step[i] == 0.0 else "sort them, or split the runs")
        )


def _check_bounds(station: Array, survey: Survey, path: Path) -> None:
    """Refuse stations that no road has, and gaps that nobody surveyed.

    Raises
    ------
    InputError
        Stations beyond 10,000 km or closer than a micrometre, or a gap among them.
    """
    step = np.diff(station)
    if not np.all(np.abs(station) < _FARTHEST) or step.min() < _CLOSEST:
        raise InputError(
            f"{path}: its stations go from {station[0]:.4g} to {station[-1]:.4g} m, "
            f"{step.min():.3g} m apart at least: are their unit and step right?"
        )
    usual = float(np.median(step))
    wide = int(np.argmax(step))
    if step[wide] > _GAP * usual:
        raise InputError(
            f"{path}: {survey.where} {survey.lines[wide + 1]}: nothing from station "
            f"{station[wide]:g} to {station[wide + 1]:g} m, where points are {usual:.3g} m apart "
            "elsewhere: fill the gap, or split the survey there"
        )


def _scale(what: str, said: str, stated: str, path: Path) -> float:
    """Return a unit of length [m]; one that nobody says is asked for."""
    unit = stated or said
    if not unit:
        key = "station_unit" if what == "stations" else "unit"
        raise InputError(
            f'{path}: does not say the unit of its {what}: state it, {key} = "m" or "mm", say'
        )
    word = unit.strip().rstrip(".")
    for spelled in (word, word.lower()):
        with suppress(InputError):
            return to_si(f"1 {_UNIT_WORDS.get(spelled, spelled)}", "length")
    raise InputError(
        f"{path}: the unit of its {what}, {word!r}, is no length: write m, mm, in or ft"
    )


def _places(survey: Survey, options: ProfileOptions, path: Path) -> Float[Array, " tracks"]:
    """Return where tracks lie [m]: as stated, as the file says, or in the middle if it is one."""
    count = len(survey.names)
    if options.lateral:
        if len(options.lateral) != count:
            raise InputError(
                f"{path}: lateral gives {len(options.lateral)} places for {count} tracks "
                f"({', '.join(survey.names)}): give one each"
            )
        places = np.array(options.lateral, dtype=float)
    elif survey.lateral is not None:
        places = np.array(survey.lateral, dtype=float)
    elif count == 1:
        places = np.zeros(1)
    else:
        raise InputError(
            f"{path}: has {count} tracks ({', '.join(survey.names)}) and does not say where they "
            'lie: state lateral = ["0.9 m", "-0.9 m"], say, to the left of the middle, or choose '
            "one by tracks"
        )
    if len(np.unique(places)) < count:
        raise InputError(f"{path}: two tracks lie at one place: {places.tolist()} m")
    return places


def _track(
    survey: Survey, station: Array, number: int, options: ProfileOptions, path: Path
) -> Profile:
    name = survey.names[number]
    unit = survey.units[number]
    z = survey.elevation[number] * _scale(f"heights ({name})", unit, options.unit, path)
    inside = _stretch(station, options, path)
    s, z = station[inside], z[inside]
    if not np.all(np.abs(z) < _HIGHEST):
        raise InputError(
            f"{path}: a height of {name!r} is beyond {_HIGHEST:g} m: is its unit right?"
        )
    if options.detrend:
        slope, level = np.polyfit(s - s[0], z - z[0], 1)
        z = z - z[0] - level - slope * (s - s[0])
    profile = Profile.from_samples(s, z)
    if not (options.unit and options.station_unit):  # what somebody states is only doubted
        _check_units(profile, path)
    return profile


def _check_units(profile: Profile, path: Path) -> None:
    """Refuse numbers that no road has in the units that the file says."""
    remedy = 'if it is as the file says, state station_unit and unit too, as in unit = "mm"'
    rise = np.diff(profile.elevation) / np.diff(profile.station)
    steep = float(np.quantile(np.abs(rise - np.median(rise)), 0.95))
    doubts = [d.message for d in profile_doubts(profile) if "steeper" not in d.message]
    if steep > _STEEPEST:
        raise InputError(
            f"{path}: every twentieth point is steeper than {steep:.3g} m/m, which no road is: are "
            f"its heights in mm? {remedy}"
        )
    if doubts:
        raise InputError(f"{path}: {doubts[0]} {remedy}")
    try:
        roughness = fit_roughness(profile).roughness_at_two
    except InputError:
        return  # too short to say
    try:
        check_roughness(roughness)
    except InputError as error:
        raise InputError(f"{path}: {error}; {remedy}") from None


def _stretch(station: Array, options: ProfileOptions, path: Path) -> Array:
    low = -np.inf if options.first is None else options.first
    high = np.inf if options.last is None else options.last
    inside = (station >= low - 1e-9) & (station <= high + 1e-9)
    if np.count_nonzero(inside) < _FEWEST:
        raise InputError(
            f"{path}: holds stations {station[0]:g} to {station[-1]:g} m, and fewer than {_FEWEST} "
            f"of them between {low:g} and {high:g} m"
        )
    return inside

"""Roads: their class, and what waves they contain."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import PurePath
from typing import Annotated, Any, Literal, Self

from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from trundle._words import in_kmh
from trundle.errors import FitnessWarning, Problem
from trundle.profiles import ProfileOptions, read_profile
from trundle.road import Profile, Road, RoadClass, RoadSpectrum, RoughnessBand, flat_floor
from trundle.study_file.attempt import attempted
from trundle.study_file.draft import Draft, refer, unique
from trundle.study_file.fields import (
    Flag,
    Length,
    Line,
    Name,
    NonNegativeLength,
    Number,
    Roughness,
    Section,
    Wavenumber,
)
from trundle.study_file.given_roads import given_road_problems
from trundle.study_file.kinds import SectionKind

__all__ = [
    "NO_ROAD",
    "ROAD",
    "ROUGHNESS",
    "build",
    "fields",
    "problems",
    "refer_road",
    "road_label",
]


NO_ROAD = "no road"
"""Label of the road of a study in which nobody drives."""

_Class = Literal["A", "B", "C", "D", "E", "F", "G", "H"]


class RoadSection(Section):
    """A road: a class, a roughness, a floor's flatness, a measured profile, or smooth."""

    name: Name | None = None
    """Label of the road, in place of its own."""
    class_: Annotated[_Class | None, Field(alias="class")] = None
    """Class of ISO 8608, from A (smooth) to H."""
    level: Literal["lower", "geometric_mean", "upper"] = "geometric_mean"
    """Where in the class it lies."""
    waviness: Annotated[Number, Field(ge=1.0, le=4.0)] = 2.0
    """Exponent w of the spectrum, Gd(n) = Gd(n0) (n/n0)^-w."""
    roughness: Roughness | None = None
    """Gd(n0) of a straight spectrum, in place of a class."""
    flatness: Line | None = None
    """Class of a floor's flatness: "FF 50", "FF 50/FL 30", "FM 2", "DIN 18202 line 3"."""
    smooth: Flag = False
    """Whether it has no roughness: what features do by themselves."""
    file: Line | None = None
    """A measured profile, beside the study."""
    from_: Annotated[Length | None, Field(alias="from")] = None
    """Station of the file that lies at each route's start, in its own chainage."""
    beyond: Literal["unknown", "mirror", "level"] = "unknown"
    """The road beyond the survey: unknown, mirrored, or level."""
    station_unit: Line = ""
    """Unit of stations, where the file does not say it."""
    unit: Line = ""
    """Unit of heights, where the file does not say it."""
    tracks: tuple[Line, ...] = ()
    """Columns that are tracks, by name or number; every one unless given."""
    lateral: tuple[Length, ...] = ()
    """Where tracks lie, to the left of the centre line."""
    detrend: Flag = True
    """Whether the straight line through each track is taken off."""

    @model_validator(mode="after")
    def _check_kind(self) -> Self:
        given = [key for key in _WAYS if self.model_fields_set & {key} and getattr(self, key)]
        names = [key.rstrip("_") for key in given]
        if len(given) != 1:
            rule = (
                "a road is one of: class, roughness, flatness, file, smooth = true; "
                f"got {' and '.join(names) or 'none of them'}"
            )
            raise PydanticCustomError("rule", "{rule}", {"rule": rule})
        extra = self.model_fields_set - {"name", *given, *_WITH[given[0]]}
        if extra:
            keys = ", ".join(sorted(key.rstrip("_") for key in extra))
            rule = f"a road of {names[0]} has no {keys}: leave it out"
            raise PydanticCustomError("rule", "{rule}", {"rule": rule})
        return self


_WAYS = ("class_", "roughness", "flatness", "file", "smooth")
_WITH: dict[str, tuple[str, ...]] = {
    "class_": ("level", "waviness"),
    "roughness": ("waviness",),
    "flatness": (),
    "file": ("from_", "beyond", "station_unit", "unit", "tracks", "lateral", "detrend"),
    "smooth": (),
}


class RoughnessSection(Section):
    """What waves a synthetic road contains."""

    n_min: Wavenumber = 0.011
    """Longest waves of synthetic roads, in cycles a metre."""
    n_max: Wavenumber = 2.83
    """Shortest waves, in cycles a metre; beyond 2.83 ISO 8608 is extrapolated."""
    n_max_follows_dt: Flag = True
    """Whether waves that a time step cannot show are cut off, or refused."""
    contact_patch: NonNegativeLength = 0.0
    """Length over which a tyre averages the road; 0 is a point."""
    gaussian_amplitudes: Flag = False
    """Whether amplitudes are random as well as phases."""


ROAD = SectionKind(name="road", schema=RoadSection, form="list", required=True)
ROUGHNESS = SectionKind(name="roughness", schema=RoughnessSection, form="table")


def _with_band(draft: Draft) -> tuple[Draft, list[Problem]]:
    """Return the draft with its waves."""
    section = draft.file.tables.get("roughness")
    if section is None:
        return replace(draft, band=RoughnessBand(), band_follows_dt=True), []
    band, found = attempted(
        "roughness.n_max",
        lambda: RoughnessBand(
            n_min=section.n_min,
            n_max=section.n_max,
            contact_patch=section.contact_patch,
            gaussian_amplitudes=section.gaussian_amplitudes,
        ),
    )
    return replace(draft, band=band, band_follows_dt=section.n_max_follows_dt), found


def build(draft: Draft) -> tuple[Draft, list[Problem]]:
    """Return the draft with its waves and roads."""
    draft, found = _with_band(draft)
    roads: dict[str, Road] = {}
    if not draft.file.given & {"road", "route", "vehicle"}:  # people and machines need none
        roads[NO_ROAD] = Profile.smooth()
    for i, section in draft.file.lists.get("road", []):
        key = next(key for key in _WAYS if getattr(section, key))
        place = f"road[{i + 1}].{key.rstrip('_')}"
        if section.file is not None:
            draft, made, mistakes = _measured(draft, section, place)
        else:
            made, mistakes = attempted(place, lambda s=section: road_of(s))
        found += mistakes
        if made is not None:
            roads[road_label(section)] = made
    return replace(draft, roads=roads), found


def fields(draft: Draft) -> dict[str, Any]:
    """Return what a study takes from the sections."""
    return {"roads": draft.roads, "band": draft.band, "band_follows_dt": draft.band_follows_dt}


def problems(draft: Draft) -> Iterator[Problem]:
    """Give waves that no step can follow, roads of one name, and surveys that do not reach."""
    labelled = [(f"road[{i + 1}]", road_label(s)) for i, s in draft.file.lists.get("road", [])]
    if draft.band is not None:
        yield from _roughness(draft, draft.band)
        yield from given_road_problems(draft, {label: place for place, label in labelled})
    yield from unique(labelled)


def refer_road(draft: Draft, place: str, label: str) -> Iterator[Problem]:
    """Give the problem of a label that no road of the study has, if so.

    A road that cannot be made of its file has a label; one whose section is unsound may have any.
    """
    labels = {road_label(s) for s in draft.file.items("road")} or set(draft.roads)
    if labels and not draft.file.has_bad("road"):
        yield from refer(place, label, labels, "road")


def road_of(section: RoadSection) -> Road:
    """Return a road that stands in the study file itself."""
    if section.class_ is not None:
        return RoadClass(section.class_, level=section.level, waviness=section.waviness)
    if section.flatness is not None:
        return flat_floor(section.flatness)
    if section.roughness is not None:
        name = section.name or "given roughness"
        return RoadSpectrum(roughness=section.roughness, waviness=section.waviness, name=name)
    return Profile.smooth()


def road_label(section: RoadSection) -> str:
    """Return the short label of a road: its name, or what it is in a word."""
    if section.name is not None:
        return section.name
    if section.file is not None:
        return PurePath(section.file).stem
    if section.class_ is None:
        return section.flatness or ("smooth" if section.smooth else f"{section.roughness:.3g} m3")
    label = section.class_
    if section.level != "geometric_mean":
        label += f" {section.level}"
    return label if section.waviness == 2.0 else f"{label} w={section.waviness:g}"


def _measured(
    draft: Draft, section: RoadSection, place: str
) -> tuple[Draft, Road | None, list[Problem]]:
    """Return a road that is read from a file, and the draft that keeps the file."""
    name = section.file or ""
    path = draft.files.get(name, draft.folder / name)
    options = ProfileOptions(
        station_unit=section.station_unit,
        unit=section.unit,
        tracks=section.tracks,
        lateral=section.lateral,
        detrend=section.detrend,
    )
    read, found = attempted(
        place, lambda: read_profile(path, options), "docs/roads.md says what is read"
    )
    if read is None:
        return draft, None, found
    first = float(read.road.tracks[0].station[0])
    start = first if section.from_ is None else section.from_
    tracks = tuple(replace(track, beyond=section.beyond) for track in read.road.tracks)
    road = replace(read.road, tracks=tracks, name=road_label(section), start=start)
    said = tuple(FitnessWarning(subject=f"road {road.name}", message=one) for one in read.told)
    kept = {**draft.read, name: path.read_bytes()}
    return replace(draft, read=kept, told=(*draft.told, *said)), road, found


def _roughness(draft: Draft, band: RoughnessBand) -> Iterator[Problem]:
    """Give roads whose waves are too short for a method's steps at a route's speed."""
    for name, drive in draft.drives.items():
        speed = drive.route.law.fastest
        for method in draft.methods.values():
            dt = method.interaction.integration.dt
            limit = 0.5 / (speed * dt)
            waves, place = method.band or band, draft.file.place_of(method.name, "method")
            if draft.band_follows_dt and limit <= waves.n_min:
                yield Problem(
                    place=f"{place}.dt",
                    value=f"{1e3 * dt:g} ms",
                    rule=f"at {in_kmh(speed, 6)} on route {name!r} this step follows waves to "
                    f"{limit:.3g} 1/m only, and the road's begin at {waves.n_min:g} 1/m",
                    remedy="shorten dt, or lower n_min or the speed",
                )
            elif not draft.band_follows_dt and waves.n_max > limit * (1 + 1e-9):
                own = waves.n_max != band.n_max
                yield Problem(
                    place=f"{place}.n_max" if own else "roughness.n_max",
                    value=f"{waves.n_max:g} 1/m",
                    rule=f"method {method.name!r} on route {name!r} can follow waves to "
                    f"{limit:.3g} 1/m (dt = {1e3 * dt:g} ms)",
                    remedy="shorten dt, lower n_max, or set roughness.n_max_follows_dt = true",
                )

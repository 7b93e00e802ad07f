"""Roads: their class, and what waves they contain."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Annotated, Any, Literal

from pydantic import Field

from trundle._words import in_kmh
from trundle.errors import Problem
from trundle.road import RoadClass, RoughnessBand
from trundle.study.plans import Drive, MethodPlan
from trundle.study_file.attempt import attempted
from trundle.study_file.draft import Draft, unique
from trundle.study_file.fields import (
    Flag,
    NonNegativeLength,
    Number,
    Section,
    Wavenumber,
)
from trundle.study_file.kinds import SectionKind

__all__ = ["ROAD", "ROUGHNESS", "build", "fields", "problems", "road_label"]


class RoadSection(Section):
    """A road class."""

    class_: Annotated[Literal["A", "B", "C", "D", "E", "F", "G", "H"], Field(alias="class")]
    level: Literal["lower", "geometric_mean", "upper"] = "geometric_mean"
    waviness: Annotated[Number, Field(ge=1.0, le=4.0)] = 2.0


class RoughnessSection(Section):
    """What waves a synthetic road contains."""

    n_min: Wavenumber = 0.011
    n_max: Wavenumber = 2.83
    n_max_follows_dt: Flag = True
    contact_patch: NonNegativeLength = 0.0
    gaussian_amplitudes: Flag = False


ROAD = SectionKind(name="road", schema=RoadSection, form="list", required=True)
ROUGHNESS = SectionKind(name="roughness", schema=RoughnessSection, form="table")


def build(draft: Draft) -> tuple[Draft, list[Problem]]:
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


def fields(draft: Draft) -> dict[str, Any]:
    """Return what a study takes from the sections."""
    return {
        "roads": {road_label(r): road_of(r) for r in draft.file.items("road")},
        "band": draft.band,
        "band_follows_dt": draft.band_follows_dt,
    }


def problems(draft: Draft) -> Iterator[Problem]:
    """Give waves that no step can follow, and roads of one name."""
    if draft.band is not None:
        yield from _roughness(
            draft.drives, draft.methods, draft.band, follows_dt=draft.band_follows_dt
        )
    yield from unique("road", [road_label(s) for s in draft.file.items("road")])


def road_of(section: RoadSection) -> RoadClass:
    """Return a road class."""
    return RoadClass(section.class_, level=section.level, waviness=section.waviness)


def road_label(section: RoadSection) -> str:
    """Return the short label of a road: the class letter, with its level if not the mean."""
    label = section.class_
    if section.level != "geometric_mean":
        label += f" {section.level}"
    return label if section.waviness == 2.0 else f"{label} w={section.waviness:g}"


def _roughness(
    drives: Mapping[str, Drive],
    methods: Mapping[str, MethodPlan],
    band: RoughnessBand,
    *,
    follows_dt: bool,
) -> Iterator[Problem]:
    for name, drive in drives.items():
        speed = float(drive.route.law.speed(0.0))
        for method in methods.values():
            dt = method.interaction.integration.dt
            limit = 0.5 / (speed * dt)
            if follows_dt and limit <= band.n_min:
                yield Problem(
                    place=f"method {method.name!r}.dt",
                    value=f"{1e3 * dt:g} ms",
                    rule=f"at {in_kmh(speed, 6)} on route {name!r} this step follows waves to "
                    f"{limit:.3g} 1/m only, and the road's begin at {band.n_min:g} 1/m",
                    remedy="shorten dt, or lower n_min or the speed",
                )
            elif not follows_dt and (method.band or band).n_max > limit * (1 + 1e-9):
                yield Problem(
                    place="roughness.n_max",
                    value=f"{band.n_max:g} 1/m",
                    rule=f"method {method.name!r} on route {name!r} can follow waves to "
                    f"{limit:.3g} 1/m (dt = {1e3 * dt:g} ms)",
                    remedy="shorten dt, lower n_max, or set n_max_follows_dt = true",
                )

"""Points: where the response is read, on the floor or behind an isolator."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Annotated, Any, Self

import numpy as np
from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from trundle.errors import InputError, Problem
from trundle.signals import Isolation, Isolator, TransmissibilityTable
from trundle.structure import Axis, Spot, Surface
from trundle.study_file.attempt import attempted
from trundle.study_file.draft import (
    Draft,
    covered,
    is_off,
    no_sway,
    still_axes,
    surface_at,
    undrawn,
    unique,
)
from trundle.study_file.fields import (
    Factor,
    Frequency,
    Line,
    Name,
    Place,
    Ratio,
    Section,
)
from trundle.study_file.kinds import SectionKind

__all__ = ["POINT", "build", "fields", "problems"]


class IsolatorSection(Section):
    """What stands between floor and tool: a mass on a spring and a damper, or a table."""

    frequency: Frequency | None = None
    """Natural frequency of the mass on its spring."""
    damping: Ratio | None = None
    """Ratio of critical damping."""
    table: Annotated[tuple[tuple[Frequency, Factor], ...], Field(min_length=2)] | None = None
    """Frequencies, and motion behind over motion before, in place of both."""


class PointSection(Section):
    """A place where the response is read, on the floor or behind an isolator there."""

    name: Name
    """How results call it."""
    at: Place = (0.0, 0.0)
    """Where it is, in plan."""
    drawn: Line | None = None
    """Layer of the building's drawing that shows it, in place of at."""
    on: Name | None = None
    """Surface on which it is, where there are several."""
    axes: Annotated[tuple[Axis, ...], Field(min_length=1)] = ("z",)
    """Motions that are read there; beside z they are points of their own."""
    isolator: IsolatorSection | None = None
    """What stands between floor and tool; its own motion is then assessed."""

    @model_validator(mode="after")
    def _check_place(self) -> Self:
        if ("at" in self.model_fields_set) == (self.drawn is not None):
            rule = "a point has a place, or is drawn on a layer of the building's drawing"
            raise PydanticCustomError("rule", "{rule}", {"rule": rule})
        return self


POINT = SectionKind(name="point", schema=PointSection, form="list", required=True)


def build(draft: Draft) -> tuple[Draft, list[Problem]]:
    """Return the draft with the isolators at its points."""
    isolations: dict[str, Isolation] = {}
    found: list[Problem] = []
    for i, section in draft.file.lists.get("point", []):
        if section.isolator is not None:
            isolation, mistakes = attempted(
                f"point[{i + 1}].isolator", lambda s=section.isolator: isolation_of(s)
            )
            found += mistakes
            if isolation is not None:
                isolations[section.name] = isolation
    return replace(draft, isolations=isolations), found


def fields(draft: Draft) -> dict[str, Any]:
    """Return what a study takes from the section."""
    return {
        "points": {
            named(p, axis): _spot(draft, p, axis)
            for p in draft.file.items("point")
            for axis in p.axes
        },
        "isolations": draft.isolations,
    }


def named(section: PointSection, axis: Axis) -> str:
    """Return what a point's motion along an axis is called: by the point alone for the vertical."""
    return section.name if axis == "z" else f"{section.name} {axis}"


def _spot(draft: Draft, section: PointSection, axis: Axis) -> Spot:
    """Return where a point is, in its surface."""
    surface, _ = surface_at(draft, "", section.on)
    if surface is None:
        return Spot(*section.at)
    x, y = surface.frame.from_plan(np.array([section.at]))[0]
    return Spot(float(x), float(y), section.on, axis)


def problems(draft: Draft) -> Iterator[Problem]:
    """Give points off the floor, and points of one name."""
    yield from undrawn(draft, "point")
    extent = draft.extent
    for i, section in draft.file.lists.get("point", []):
        surface, mistakes = surface_at(draft, f"point[{i + 1}].on", section.on)
        yield from mistakes
        yield from _level(draft, f"point[{i + 1}].axes", section)
        if extent is not None and is_off(extent, section.at):
            yield Problem(
                place=f"point[{i + 1}].at",
                value=f"({section.at[0]:g}, {section.at[1]:g}) m",
                rule=f"a point must lie on the floor; {covered(extent)}",
                remedy="move it onto the floor",
            )
        elif surface is not None and not _is_on(surface, section.at):
            yield Problem(
                place=f"point[{i + 1}].at",
                value=f"({section.at[0]:g}, {section.at[1]:g}) m",
                rule=f"a point must lie on a slab, and {surface.name!r} has none there",
                remedy="move it off the opening, or name another storey: on = ...",
            )
    yield from unique(
        (f"point[{i + 1}]", named(section, axis))
        for i, section in draft.file.lists.get("point", [])
        for axis in section.axes
    )


def _level(draft: Draft, place: str, section: PointSection) -> Iterator[Problem]:
    """Give points that are read along level axes where that says nothing."""
    yield from still_axes(draft, place, section.axes)
    if set(section.axes) == {"z"}:
        return
    if draft.building is None and "building" not in draft.file.given:
        yield no_sway(place, section.axes)
    elif section.isolator is not None:
        yield Problem(
            place=place,
            value=", ".join(section.axes),
            rule="an isolator is known for vertical motion alone",
            remedy='read axes = ["z"] behind it, and the floor by a point of its own',
        )


def _is_on(surface: Surface, at: tuple[float, float]) -> bool:
    return bool(surface.holds(surface.frame.from_plan(np.array([at])))[0])


def isolation_of(section: IsolatorSection) -> Isolation:
    """Return what stands between floor and tool."""
    if section.table is not None and section.frequency is None and section.damping is None:
        f, ratios = np.array(section.table).T
        return TransmissibilityTable(frequencies=f, ratios=ratios)
    if section.table is None and section.frequency is not None and section.damping is not None:
        return Isolator(frequency=section.frequency, damping_ratio=section.damping)
    raise InputError("an isolator is either a frequency and a damping, or a table")

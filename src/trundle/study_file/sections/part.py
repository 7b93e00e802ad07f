"""Parts of a large building that are given: their outline in plan, and where copies of it lie."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import combinations
from typing import Annotated, Any

import numpy as np
from pydantic import Field

from trundle._typing import Array
from trundle.errors import Problem
from trundle.structure.building import Building
from trundle.structure.superelements import Region
from trundle.study_file.attempt import attempted
from trundle.study_file.building_maker import Maker
from trundle.study_file.building_section import BuildingSection
from trundle.study_file.draft import Draft, unique
from trundle.study_file.fields import GridPlace, Length, Name, Place, Section
from trundle.study_file.kinds import SectionKind

__all__ = ["PART", "PartSection", "regions_of"]


class PartSection(Section):
    """One part, and its copies."""

    name: Name
    """Of the part."""
    outline: Annotated[tuple[GridPlace, ...], Field(min_length=3)]
    """Its corners in plan."""
    low: Length | None = None
    """Height at which it begins; the lowest of the building unless given."""
    high: Length | None = None
    """Height at which it ends; the highest of the building unless given."""
    storeys: tuple[str, ...] = ()
    """Storeys of the building that belong to it, in place of heights: cut halfway to others."""
    at: Annotated[tuple[Place, ...], Field(min_length=1)] = ((0.0, 0.0),)
    """How far its copies are moved: each an outline of the same part."""


PART = SectionKind(name="part", schema=PartSection, form="list")


def problems(draft: Draft) -> Iterator[Problem]:
    """Give names that stand twice."""
    yield from unique((f"{place}.name", name) for place, name in draft.file.names("part"))


def regions_of(draft: Draft) -> tuple[dict[str, Region], list[Problem]]:
    """Return all given parts of a draft by where they stand, and what is wrong with them.

    Copies of a part are parts by themselves.
    """
    found: list[Problem] = []
    regions: dict[str, Region] = {}
    for i, section in draft.file.lists.get("part", []):
        place = f"part[{i + 1}]"
        outline, wrong = _outline(draft, place, section)
        low, high, more = _heights(draft, place, section)
        found += [*wrong, *more]
        if wrong or more or outline is None:
            continue
        for j, moved in enumerate(section.at, start=1):
            here = f"{place}.at[{j}]" if len(section.at) > 1 else f"{place}.outline"
            made, mistakes = attempted(
                here,
                lambda o=outline + moved, s=section, a=low, b=high: Region(
                    name=s.name, outline=o, low=a, high=b
                ),
            )
            found += mistakes
            if made is not None:
                regions[here] = made
    for (_, one), (place, other) in combinations(regions.items(), 2):
        if one.overlaps(other):
            found.append(
                Problem(
                    place=place,
                    value=repr(other.name),
                    rule=f"it overlaps part {one.name!r}",
                    remedy="parts touch along their outlines: move it, or give it other heights",
                )
            )
    return regions, found


def _outline(draft: Draft, place: str, section: PartSection) -> tuple[Array | None, list[Problem]]:
    """Return the corners of a part [m], crossings of grid lines found; None if they cannot be."""
    building = draft.file.tables.get("building")
    if isinstance(building, BuildingSection):
        maker = Maker(building, {}, {})
        return maker.places(f"{place}.outline", section.outline), maker.problems
    named = [one for one in section.outline if isinstance(one, str)]
    if not named:
        return np.array(section.outline, dtype=float), []
    if "building" in draft.file.given and building is None:
        return None, []  # told there
    rule, remedy = "grid lines are those of a [building] of storeys", "give [x, y]"
    return None, [_problem(f"{place}.outline", named[0], rule, remedy)]


def _heights(draft: Draft, place: str, section: PartSection) -> tuple[float, float, list[Problem]]:
    """Return between which heights a part lies [m]."""
    low = -np.inf if section.low is None else section.low
    high = np.inf if section.high is None else section.high
    if not section.storeys:
        return low, high, []
    if section.low is not None or section.high is not None:
        rule = "a part lies between heights, or holds storeys"
        return low, high, [_problem(place, "storeys and heights", rule, "keep one")]
    if draft.building is not None:
        return _halfway(draft.building, f"{place}.storeys", section.storeys)
    rule, remedy = "storeys are those of a [building]", "give low and high"
    told = "building" in draft.file.given
    return (
        low,
        high,
        [] if told else [_problem(f"{place}.storeys", section.storeys[0], rule, remedy)],
    )


def _halfway(
    building: Building, place: str, names: Sequence[str]
) -> tuple[float, float, list[Problem]]:
    """Return the heights halfway from some storeys to those below and above [m]."""
    levels = {storey.name: storey.level for storey in building.storeys}
    held = [levels[name] for name in names if name in levels]
    found = [
        _problem(place, name, "it is no storey of the building", f"there are: {', '.join(levels)}")
        for name in names
        if name not in levels
    ]
    if found:
        return -np.inf, np.inf, found
    found = [
        _problem(place, name, f"{name!r} lies between the storeys of this part", "name it too")
        for name, level in levels.items()
        if min(held) < level < max(held) and level not in held
    ]
    under = [level for level in levels.values() if level < min(held)]
    over = [level for level in levels.values() if level > max(held)]
    low = 0.5 * (max(under) + min(held)) if under else -np.inf
    high = 0.5 * (min(over) + max(held)) if over else np.inf
    return low, high, found


def _problem(place: str, value: Any, rule: str, remedy: str) -> Problem:
    return Problem(place=place, value=str(value), rule=rule, remedy=remedy)

"""What groups of a mesh are: plates, sections, supports, springs, or nothing."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Literal

import numpy as np
from pydantic import Field

from trundle.errors import Problem
from trundle.imports import GroupMake
from trundle.structure import DOF_NAMES
from trundle.study_file.building_makes import (
    MaterialSection,
    PlateSection,
    ProfileSection,
    materials_of,
    plates_of,
    profiles_of,
)
from trundle.study_file.building_tables import Dof, SpringsSection
from trundle.study_file.fields import Flag, Length, Line, Name, Number, Section

__all__ = ["GroupSection", "MeshMakes", "makes_of"]

_HOLDS = {"roller": (2,), "pinned": (0, 1, 2), "fixed": (0, 1, 2, 3, 4, 5)}


class GroupSection(Section):
    """What the elements of a group of a mesh are."""

    name: Line
    """Of a physical group of the mesh."""
    plate: Name | None = None
    """What its faces are made of."""
    section: Name | None = None
    """What its lines are."""
    offset: tuple[Length, Length, Length] | None = None
    """From its nodes to the centroids of its members."""
    up: tuple[Number, Number, Number] | None = None
    """Where the depth of its members points."""
    hold: Literal["roller", "pinned", "fixed"] | tuple[Dof, ...] = ()
    """What is held at its nodes."""
    springs: SpringsSection | None = None
    """Springs to the ground at its nodes."""
    nothing: Flag = False
    """Whether it is nothing of the structure."""


class MeshMakes(Section):
    """Materials, sections and plates that groups of a mesh name."""

    materials: dict[Name, MaterialSection] = Field(default_factory=dict)
    """Materials by name; steel is there."""
    sections: dict[Name, ProfileSection] = Field(default_factory=dict)
    """Cross-sections by name."""
    plates: dict[Name, PlateSection] = Field(default_factory=dict)
    """Plates by name."""


def makes_of(
    section: MeshMakes, groups: Sequence[GroupSection]
) -> tuple[dict[str, GroupMake], list[Problem]]:
    """Return what groups are by their names, and what is wrong with them.

    Parameters
    ----------
    section : MeshMakes
        What they may name.
    groups : sequence of GroupSection
        As the file has them.
    """
    materials = materials_of(section)
    profiles, found = profiles_of(section, materials)
    plates, more = plates_of(section, materials)
    found += more
    made: dict[str, GroupMake] = {}
    for i, one in enumerate(groups, start=1):
        place = f"building.group[{i}]"
        wrong = list(_wrong(place, one, section))
        if one.name in made:
            rule = "groups must differ"
            wrong.append(
                Problem(place=f"{place}.name", value=one.name, rule=rule, remedy="remove one")
            )
        found += wrong
        if not wrong:
            made[one.name] = _make(one, plates, profiles)
    return made, found


def _wrong(place: str, one: GroupSection, section: MeshMakes) -> Iterator[Problem]:
    said = (one.plate, one.section, one.springs, one.hold or None)
    if one.nothing == any(part is not None for part in said):
        yield Problem(
            place=place,
            value=repr(one.name),
            rule="a group is a plate, a section, what is held or stands on springs, or nothing",
            remedy="give plate, section, hold or springs; or nothing = true alone",
        )
    for key, known in (("plate", section.plates), ("section", section.sections)):
        name = getattr(one, key)
        if name is not None and name not in known:
            yield Problem(
                place=f"{place}.{key}",
                value=repr(name),
                rule=f"must be one of [building.{key}s]",
                remedy=f"there are: {', '.join(known) or 'none'}",
            )
    if one.up is not None and not np.any(one.up):
        yield Problem(
            place=f"{place}.up", value="0, 0, 0", rule="must point somewhere", remedy="[0, 0, 1]"
        )


def _make(one: GroupSection, plates: Mapping[str, Any], profiles: Mapping[str, Any]) -> GroupMake:
    held = np.zeros(6, dtype=bool)
    hold = _HOLDS[one.hold] if isinstance(one.hold, str) else [*map(DOF_NAMES.index, one.hold)]
    held[list(hold)] = True
    springs = [getattr(one.springs, dof) for dof in DOF_NAMES] if one.springs else [0.0] * 6
    return GroupMake(
        # names with mistakes of their own are missing: told already, and never run
        plate=plates.get(one.plate or ""),
        section=None if (found := profiles.get(one.section or "")) is None else found.section,
        offset=np.array(one.offset or (0.0, 0.0, 0.0)),
        up=np.array(one.up or (0.0, 0.0, 1.0), dtype=float),
        held=held,
        springs=np.array(springs),
    )

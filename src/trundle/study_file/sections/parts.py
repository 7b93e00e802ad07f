"""The parts of a large building: how it is cut, so that its modes are found part by part."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from itertools import pairwise
from typing import Annotated, Any

import numpy as np
from pydantic import Field

from trundle._typing import Array
from trundle.errors import Problem
from trundle.structure.floor import Floor
from trundle.structure.superelements import Cuts, Parting, Region, middles_of
from trundle.study_file.draft import Draft
from trundle.study_file.fields import (
    Flag,
    Length,
    Number,
    PositiveLength,
    Ratio,
    Section,
    Whole,
)
from trundle.study_file.kinds import SectionKind
from trundle.study_file.sections.part import regions_of

__all__ = ["PARTS", "build", "fields"]

_BAND = Annotated[Number, Field(ge=1.2, le=100.0)]


class PartsSection(Section):
    """Planes between parts, or the size of a part."""

    cuts_x: tuple[Length, ...] = ()
    """Planes between parts, across x."""
    cuts_y: tuple[Length, ...] = ()
    """Planes between parts, across y."""
    cuts_z: tuple[Length, ...] = ()
    """Planes between parts, across z."""
    storeys: Flag = False
    """Whether a building is cut halfway between its storeys."""
    nodes: Annotated[Whole, Field(ge=100, le=1_000_000)] | None = None
    """Halves of halves until no part has more nodes, in place of planes."""
    band: _BAND = 2.0
    """Own modes of parts are kept to so many times the highest f_max of the methods."""
    seam_band: _BAND = 5.0
    """Own modes of long seams are kept to so many times it."""
    near: PositiveLength | None = None
    """Parts farther than this from routes, points and maps are kept to less."""
    response_tolerance: Annotated[Ratio, Field(le=0.1)] | None = None
    """Find what answers between routes, points and maps within this error, not all modes."""


PARTS = SectionKind(name="parts", schema=PartsSection, form="table")


def build(draft: Draft) -> tuple[Draft, list[Problem]]:
    """Return the draft with its structure cut into parts."""
    if not draft.file.given & {"parts", "part"} or _unsound(draft):
        return draft, []
    section = draft.file.tables.get("parts", PartsSection())
    regions, found = regions_of(draft)
    found += _problems(draft, section)
    if found:
        return draft, found
    highest = max(_reach(draft), default=0.0)
    if not highest:
        return draft, []  # no sound method needs any
    parting = Parting(
        cuts=_cuts(draft, section, regions.values()),
        largest=section.nodes or 0,
        f_parts=section.band * highest,
        f_seams=max(section.seam_band, section.band) * highest,
        near=section.near,
        response_tolerance=section.response_tolerance or 0.0,
    )
    model = draft.model
    if isinstance(model, Floor):
        found += _empty(model, regions)
        model = model if found else parting.of(model)
    return replace(draft, model=model, parting=parting), found


def _unsound(draft: Draft) -> bool:
    """Return whether a section of either kind has mistakes, that are told elsewhere."""
    unsound = "parts" in draft.file.given and "parts" not in draft.file.tables
    return unsound or draft.file.has_bad("part")


def _empty(floor: Floor, regions: Mapping[str, Region]) -> Iterator[Problem]:
    """Give parts in which nothing of a floor lies."""
    middles = np.concatenate([middles_of(floor.nodes, e.connectivity) for e in floor.elements])
    for place, region in regions.items():
        if not region.holds(middles).any():
            yield Problem(
                place=place,
                value=repr(region.name),
                rule="nothing of the structure lies in it",
                remedy="move its outline or its heights to where the structure is",
            )


def _reach(draft: Draft) -> Iterator[float]:
    """Give how far modes are wanted [Hz]."""
    for plan in draft.methods.values():
        yield plan.interaction.integration.f_max or 0.0


def _cuts(draft: Draft, section: PartsSection, regions: Iterable[Region]) -> Cuts:
    """Return all planes; those between storeys lie halfway up; and given parts."""
    z = set(section.cuts_z)
    if section.storeys and draft.building is not None:
        levels = sorted(storey.level for storey in draft.building.storeys)
        z |= {0.5 * (low + high) for low, high in pairwise(levels)}
    return Cuts(
        x=np.array(sorted(set(section.cuts_x))),
        y=np.array(sorted(set(section.cuts_y))),
        z=np.array(sorted(z)),
        regions=tuple(regions),
    )


def _problems(draft: Draft, section: PartsSection) -> Iterator[Problem]:
    """Give what is wrong with the section beside the structure."""
    planes = [*section.cuts_x, *section.cuts_y, *section.cuts_z]
    here = "parts" if "parts" in draft.file.given else "part"
    cut = bool(planes) or section.storeys or "part" in draft.file.given
    if cut == (section.nodes is not None):
        yield Problem(
            place=here,
            value="cuts and nodes" if cut else "neither cuts nor nodes",
            rule="a building is cut by planes (cuts_x, cuts_y, cuts_z, storeys) and into given "
            "parts ([[part]]), or into parts of about so many nodes, and not by both",
            remedy="keep one" if cut else "add nodes = 5000, or say where it is cut",
        )
    if section.storeys and draft.building is None and "building" not in draft.file.given:
        yield Problem(
            place="parts.storeys",
            value="true",
            rule="storeys are those of a [building]",
            remedy="give the heights of the cuts: cuts_z",
        )
    if draft.methods and not any(_reach(draft)):
        yield Problem(
            place=here,
            value="this section",
            rule="parts are for methods that find modes, and none here does",
            remedy=f'leave [{here}] out, or choose integration = "modal"',
        )
    if draft.model is not None and not isinstance(draft.model, Floor):
        yield Problem(
            place=here,
            value="this section",
            rule=f"{draft.model.name} came without elements, and cannot be cut",
            remedy=f"leave [{here}] out",
        )
    elif (box := _box(draft)) is not None:
        yield from _outside(*box, section)


def _box(draft: Draft) -> tuple[Array, Array] | None:
    """Return the lowest and highest x, y, z of what is cut [m]; None where it is not sound."""
    if draft.model is not None:
        return draft.model.nodes.min(axis=0), draft.model.nodes.max(axis=0)
    if draft.plan is None:
        return None
    plan = draft.plan
    both = (*zip(plan.x_extent, plan.y_extent, strict=True),)
    heights = (-plan.storey_below, plan.storey_above)
    low, high = (np.array([*xy, z]) for xy, z in zip(both, heights, strict=True))
    return low, high


def _outside(low: Array, high: Array, section: PartsSection) -> Iterator[Problem]:
    """Give planes that cut nothing."""
    for axis, name in enumerate("xyz"):
        key = f"cuts_{name}"
        for i, at in enumerate(getattr(section, key)):
            if not low[axis] < at < high[axis]:
                yield Problem(
                    place=f"parts.{key}[{i + 1}]",
                    value=f"{at:g} m",
                    rule=f"the structure lies between {name} = {low[axis]:g} and {high[axis]:g} m",
                    remedy="cut within it",
                )


def fields(draft: Draft) -> dict[str, Any]:
    """Return what a study takes from the section."""
    return {"parting": draft.parting}

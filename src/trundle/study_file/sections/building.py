"""The building: storeys, slabs, beams, columns, walls, ramps and what holds them."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace
from typing import Annotated, Any, TypeAlias

import numpy as np
from pydantic import Field

from trundle.errors import InputError, Problem
from trundle.structure import Floor
from trundle.structure.building import Building, Meshing, build_building, building_problems
from trundle.structure.mesh import Refinement
from trundle.study_file.building_drawing import Drawn, drawn_of, line_on, place_on
from trundle.study_file.building_maker import Maker
from trundle.study_file.building_makes import materials_of
from trundle.study_file.building_models import (
    GmshSection,
    MatricesSection,
    ModelSection,
    ModesSection,
    with_model,
)
from trundle.study_file.building_parts import Origins, parts_of
from trundle.study_file.building_section import BuildingSection
from trundle.study_file.building_tables import RefineSection
from trundle.study_file.draft import Draft
from trundle.study_file.kinds import SectionKind

__all__ = ["BUILDING", "build", "fields"]

_MAX_NODES = 100_000  # 600,000 dofs: beyond this a mesh size is more likely a slip
_BY_PARTS = 20  # times as many where the building is cut into [parts]

AnyBuilding: TypeAlias = Annotated[
    BuildingSection | ModelSection | GmshSection | MatricesSection | ModesSection,
    Field(discriminator="kind"),
]

BUILDING = SectionKind(name="building", schema=AnyBuilding, form="table", usual="storeys")


def build(draft: Draft) -> tuple[Draft, list[Problem]]:
    """Return the draft with the building, and the model that it is meshed to."""
    section = draft.file.tables.get("building")
    if section is None:
        return draft, []
    if not isinstance(section, BuildingSection):
        return with_model(draft, section)
    asked = (one for kind in ("route", "point") for one in draft.file.items(kind))
    used = {one.drawn for one in asked if one.drawn is not None}
    drawn, found = drawn_of(section, draft.folder, draft.files, used)
    if found:
        return draft, found
    draft, found = _with_drawn_lines(draft, drawn)
    names = {
        one.file: draft.files.get(one.file, draft.folder / one.file) for one in section.drawing
    }
    read = {name: path.read_bytes() for name, path in names.items()}
    draft = replace(draft, read={**draft.read, **read})
    section = section.model_copy(update=dict(drawn.tables))
    building, origins, more = parts_of(section, materials_of(section))
    found += [_as_drawn(problem, drawn) for problem in more]
    if building is None:
        return draft, found
    wrong = (_placed(problem, origins) for problem in building_problems(building))
    found += [_as_drawn(problem, drawn) for problem in wrong]
    maker = Maker(section, {}, {})
    meshing = _meshing(draft, section, building, maker)
    found += maker.problems
    most = _MAX_NODES * (_BY_PARTS if draft.file.given & {"parts", "part"} else 1)
    found += _too_fine(building, meshing, most)
    if found:
        return draft, found
    floor, found = _floor(building, meshing)
    size = float(section.mesh_size)
    draft = replace(draft, building=building, meshing=meshing, model=floor, mesh_size=size)
    return draft, found


def _as_drawn(problem: Problem, drawn: Drawn) -> Problem:
    """Return the problem of a part that was drawn with the place that took it from its drawing."""
    match = re.match(r"building\.(\w+)\[(\d+)\](.*)", problem.place)
    where = None if match is None else drawn.places.get((match[1], int(match[2])))
    if match is None or where is None:
        return problem
    return replace(problem, place=f"{where}{match[3]}")


def _with_drawn_lines(draft: Draft, drawn: Drawn) -> tuple[Draft, list[Problem]]:
    """Return the draft with routes and points that drawings show as if they stood in the file."""
    lists, found = dict(draft.file.lists), list[Problem]()
    for kind, key, look in (("route", "path", line_on), ("point", "at", place_on)):
        kept = []
        for i, section in lists.get(kind, []):
            if section.drawn is not None:
                there = look(drawn, section.drawn)
                if there is None:
                    found.append(
                        Problem(
                            place=f"{kind}[{i + 1}].drawn",
                            value=repr(section.drawn),
                            rule="must be a layer of a drawing that shows one "
                            + ("line" if kind == "route" else "shape"),
                            remedy=f"there are: {', '.join(sorted(drawn.layers)) or 'none'}",
                        )
                    )
                    continue
                on, shape = there
                several = len(draft.file.tables["building"].storey) > 1
                where = section.on or (on if several else None)
                kept.append((i, section.model_copy(update={key: shape, "on": where})))
            else:
                kept.append((i, section))
        lists[kind] = kept
    told = (*draft.told, *drawn.told)
    return replace(draft, file=replace(draft.file, lists=lists), told=told), found


def _floor(building: Building, meshing: Meshing) -> tuple[Floor | None, list[Problem]]:
    """Return the model of a building, or why there can be none."""
    try:
        floor = build_building(building, meshing)
    except InputError as error:
        problem = Problem(
            place="building",
            value=building.name,
            rule=str(error).removeprefix(f"{building.name}: "),
            remedy="docs/building.md says what is joined to what, and what holds it",
        )
        return None, [problem]
    return (floor, []) if floor.decks else (None, [_nothing_to_stand_on()])


def _nothing_to_stand_on() -> Problem:
    return Problem(
        place="building",
        value="no slab, ramp or level beam",
        rule="vehicles and points stand on slabs, ramps or beams",
        remedy="add [[building.slab]]",
    )


def fields(draft: Draft) -> dict[str, Any]:
    """Return what a study takes from the section."""
    return {"building": draft.building, "meshing": draft.meshing, "told": draft.told}


def _placed(problem: Problem, origins: Origins) -> Problem:
    """Return a problem with its place as the file has it."""
    match = re.match(r"(\w+)\[(\d+)\](.*)", problem.place)
    if match is None:
        return replace(problem, place=f"building.{problem.place}")
    kind, number, key = match[1], int(match[2]), match[3]
    entry, place = origins[kind][number - 1]
    key = key if place is None else f".at[{place}]" if key == ".at" else key
    return replace(problem, place=f"building.{kind}[{entry}]{key}")


def _too_fine(building: Building, meshing: Meshing, most: int) -> Iterator[Problem]:
    area = sum(slab.area for slab in (*building.slabs, *building.ramps))
    size = meshing.mesh_size
    refined = sum(_more_nodes(one, size, area, len(building.floors)) for one in meshing.refinements)
    nodes = area / size**2 + refined
    if nodes > most:
        alone = refined > most / 2
        yield Problem(
            place="building.mesh_size",
            value=f"{size:g} m"
            + (f", with {refined:.3g} nodes where it is refined" if alone else ""),
            rule=f"the mesh may have {most} nodes; this one would have {nodes:.3g}",
            remedy="refine less, or shorter lines"
            if alone
            else f"use {np.ceil(100.0 * np.sqrt(area / most)) / 100.0:g} m or more",
        )


def _more_nodes(one: Refinement, size: float, area: float, n_floors: int) -> float:
    """Return about how many nodes a refinement adds: within its reach, and where elements grow."""
    length = float(np.linalg.norm(np.diff(one.line, axis=0), axis=1).sum())
    fine = size / 2.0 ** np.ceil(max(np.log2(size / one.size), 0.0))  # elements are halved
    within = min(2.0 * length * one.reach + np.pi * one.reach**2, area) / fine**2
    beyond = 4.0 * (length + np.pi * one.reach) * (1.0 / fine - 1.0 / size)
    return (within + beyond) * (n_floors if one.sheet is None else 1)


def _refined(
    one: RefineSection, place: str, building: Building, maker: Maker
) -> Iterator[Refinement]:
    """Give the refinements of a table; keep what would refine nothing."""
    if one.on is not None and one.on not in building.floors:
        known = f"there are: {', '.join(building.floors)}"
        maker.refuse(f"{place}.on", repr(one.on), "must be the name of a storey or ramp", known)
    if one.size >= maker.mesh_size:
        maker.refuse(
            f"{place}.size",
            f"{one.size:g} m",
            f"elements are smaller than mesh_size = {maker.mesh_size:g} m where they are refined",
            "make it smaller, or remove the table",
        )
    for _, line in maker.line_or_places(place, one):
        yield Refinement(line=line, size=one.size, reach=one.reach, sheet=one.on)


def _at_supports(section: BuildingSection, building: Building) -> Iterator[Refinement]:
    """Give refinements at supports, columns and walls, on every storey that these meet."""
    size = section.size_at_supports
    if size is None:
        return
    for support in building.supports:
        yield Refinement(line=support.along, size=size, reach=1.0, sheet=support.on)
    columns = [(column, column.at[None]) for column in building.columns]
    for part, line in (*columns, *((wall, wall.along) for wall in building.walls)):
        for storey in building.between(part.bottom, part.top):
            yield Refinement(line=line, size=size, reach=1.0, sheet=storey.name)


def _ways_of(route: Any, default: str | None) -> list[tuple[Any, str | None]]:
    """Return the lines of a route on each of its surfaces."""
    line = np.array(route.path, dtype=float)
    if not route.through:
        return [(line, route.only or default)]
    return [(line[i : i + 2], on) for i, on in enumerate(route.through)]


def _meshing(draft: Draft, section: BuildingSection, building: Building, maker: Maker) -> Meshing:
    """Return how a building is meshed: finer where asked, and along routes and points."""
    refinements: list[Refinement] = []
    guides: dict[str, list[Any]] = {}
    default = building.floors[0] if len(building.floors) == 1 else None
    for i, one in enumerate(section.refine, start=1):
        refinements += _refined(one, f"building.refine[{i}]", building, maker)
    for route in draft.file.items("route"):
        for line, on in _ways_of(route, default):
            if section.size_at_routes is not None:
                refinements.append(
                    Refinement(line=line, size=section.size_at_routes, reach=1.5, sheet=on)
                )
            if section.edges_along_routes and on is not None:
                guides.setdefault(on, []).append(line)
    for point in draft.file.items("point"):
        place, on = np.array([point.at], dtype=float), point.on or default
        if section.size_at_points is not None:
            refinements.append(
                Refinement(line=place, size=section.size_at_points, reach=1.0, sheet=on)
            )
        if section.nodes_at_points and on is not None:
            guides.setdefault(on, []).append(place)
    refinements += _at_supports(section, building)
    return Meshing(
        mesh_size=float(section.mesh_size),
        refinements=tuple(refinements),
        guides={on: tuple(lines) for on, lines in guides.items() if on in building.floors},
        only_triangles=section.elements == "triangles",
    )

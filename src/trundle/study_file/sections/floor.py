"""The floor: the reference unit, or a rectangular storey of bays."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Annotated, Any, Literal, TypeAlias

import numpy as np
from pydantic import Field

from trundle.errors import Problem
from trundle.imports import read_model
from trundle.structure import (
    FloorPlan,
    Material,
    Rectangle,
    ShellSection,
    build_floor,
    reference_plan,
)
from trundle.study_file.attempt import attempted
from trundle.study_file.building_models import model_taken
from trundle.study_file.draft import Draft
from trundle.study_file.fields import (
    AreaDensity,
    Density,
    Flag,
    Length,
    Line,
    NonNegativeLength,
    Number,
    PositiveLength,
    Pressure,
    Section,
    Whole,
)
from trundle.study_file.kinds import SectionKind

__all__ = ["FLOOR", "build", "fields", "problems"]

EdgeKind: TypeAlias = Literal["free", "symmetry", "simple", "pinned", "clamped"]
_MAX_NODES = 100_000  # 600,000 dofs: beyond this a mesh size is more likely a slip
_BY_PARTS = 20  # times as many where the building is cut into [parts]


class ReferenceFloorSection(Section):
    """The reference unit at a mesh size."""

    kind: Literal["reference_unit"]
    """The stand-in for the factory floor of Pan, Mita and Li (2001)."""
    mesh_size: PositiveLength = 1.0
    """Largest element edge."""


class RectangleSection(Section):
    """Width and depth of a beam or column."""

    width: PositiveLength
    """Across the member; of a column along y."""
    depth: PositiveLength
    """Upright; of a column along x."""


class MaterialSection(Section):
    """An isotropic material."""

    elastic_modulus: Pressure
    """Dynamic modulus of elasticity."""
    poisson_ratio: Annotated[Number, Field(ge=0.0, lt=0.5)] = 0.2
    """Poisson's ratio."""
    density: Density
    """Mass by volume, of structure alone."""


class EdgesSection(Section):
    """How each edge of the plan is held."""

    x_min: EdgeKind = "free"
    """The edge at the smallest x."""
    x_max: EdgeKind = "free"
    """The edge at the largest x."""
    y_min: EdgeKind = "free"
    """The edge at the smallest y."""
    y_max: EdgeKind = "free"
    """The edge at the largest y."""


class PlanFloorSection(Section):
    """A rectangular storey of bays."""

    kind: Literal["plan"]
    """One rectangular storey of bays."""
    mesh_size: PositiveLength
    """Largest element edge."""
    x_lines: Annotated[tuple[Length, ...], Field(min_length=2)]
    """Column lines across x, rising; columns stand where lines cross."""
    y_lines: Annotated[tuple[Length, ...], Field(min_length=2)]
    """Column lines across y, rising."""
    x_extent: tuple[Length, Length] | None = None
    """Range of the slab along x, where it reaches beyond the outer lines."""
    y_extent: tuple[Length, Length] | None = None
    """Range of the slab along y, where it reaches beyond the outer lines."""
    slab_thickness: PositiveLength
    """Thickness of the slab."""
    superimposed_mass: AreaDensity = 0.0
    """Finishes, machines, stored goods: mass without stiffness."""
    material: MaterialSection
    """Of slab, beams and columns."""
    beams_x: RectangleSection | None = None
    """Main beams along x on every y line."""
    beams_y: RectangleSection | None = None
    """Main beams along y on every x line."""
    secondary_y: RectangleSection | None = None
    """Secondary beams along y, evenly inside each bay."""
    secondary_per_bay: Annotated[Whole, Field(ge=1, le=50)] = 1
    """How many secondary beams are in a bay."""
    column: RectangleSection | None = None
    """Columns; without them the edges must hold the floor."""
    storey_below: NonNegativeLength = 0.0
    """Length of the columns below, to their fixed feet; 0 leaves them out."""
    storey_above: NonNegativeLength = 0.0
    """Length of the columns above, to their fixed heads; 0 leaves them out."""
    eccentric_beams: Flag = True
    """Whether beams hang below the slab, or lie in its mid-plane."""
    column_heads: Literal["point", "rigid"] = "point"
    """Whether a column meets the slab at one node, or over its cross-section."""
    edges: EdgesSection = EdgesSection()
    """How each edge of the plan is held; free unless named."""


class ModelFloorSection(Section):
    """A model that another program wrote."""

    kind: Literal["model"]
    """A model that another program wrote."""
    file: Line
    """Its file, beside the study."""


FloorSection: TypeAlias = Annotated[
    ReferenceFloorSection | PlanFloorSection | ModelFloorSection, Field(discriminator="kind")
]


FLOOR = SectionKind(name="floor", schema=FloorSection, form="table")


def build(draft: Draft) -> tuple[Draft, list[Problem]]:
    """Return the draft with the plan of the floor."""
    section = draft.file.tables.get("floor")
    floors = [name for name in ("floor", "building") if name in draft.file.given]
    if len(floors) != 1:
        return draft, [_one_of_both(len(floors))]
    if section is None:
        return draft, []
    if isinstance(section, ModelFloorSection):
        return _with_model(draft, section)
    plan, found = attempted(
        "floor",
        reference_plan
        if isinstance(section, ReferenceFloorSection)
        else lambda: floor_plan_of(section),
    )
    if plan is not None:
        most = _MAX_NODES * (_BY_PARTS if draft.file.given & {"parts", "part"} else 1)
        found += _mesh_problems(plan, section.mesh_size, most)
    return replace(draft, plan=plan, mesh_size=float(section.mesh_size)), found


def _one_of_both(n: int) -> Problem:
    return Problem(
        place="floor",
        value="[floor] and [building]" if n else "nothing",
        rule="a study needs a [floor] or a [building], and only one of them",
        remedy="remove one"
        if n
        else "add [floor] for a storey of bays, or [building] for any other",
    )


def _with_model(draft: Draft, section: ModelFloorSection) -> tuple[Draft, list[Problem]]:
    """Return the draft with a model that is read from its file."""
    path = draft.files.get(section.file, draft.folder / section.file)
    read, found = attempted(
        "floor.file", lambda: read_model(path), "docs/models.md says what is read"
    )
    if read is None or read.structure is None:
        return draft, found + ([] if read is None else list(read.problems))
    return model_taken(draft, section.file, path, read), found


def fields(draft: Draft) -> dict[str, Any]:
    """Return what a study takes from the section; a plan is meshed."""
    plan = draft.plan
    if draft.model is not None:
        return {"floor": draft.model, "plan": None, "mesh_size": draft.mesh_size}
    assert plan is not None  # a study is made of sound sections alone
    floor = build_floor(plan, mesh_size=draft.mesh_size)
    if draft.parting is not None:
        floor = draft.parting.of(floor)
    return {"floor": floor, "plan": plan, "mesh_size": draft.mesh_size}


def problems(draft: Draft) -> Iterator[Problem]:
    """Give floors that nothing holds."""
    if draft.plan is not None:
        yield from _supports(draft.plan)


def _mesh_problems(plan: FloorPlan, size: float, most: int) -> list[Problem]:
    sides = [high - low for low, high in (plan.x_extent, plan.y_extent)]
    nodes = np.prod([side / size + 1 for side in sides])
    if nodes > most:
        smallest = float(np.sqrt(np.prod(sides) / most))
        return [
            Problem(
                place="floor.mesh_size",
                value=f"{size:g} m",
                rule=f"the mesh may have {most} nodes; this one would have {nodes:.3g}",
                remedy=f"use {np.ceil(100 * smallest) / 100:g} m or more",
            )
        ]
    if size > 0.25 * min(sides):
        return [
            Problem(
                place="floor.mesh_size",
                value=f"{size:g} m",
                rule="an element may be at most a quarter of the floor's shorter side",
                remedy=f"use {0.25 * min(sides):g} m or less; 1 m suits most floors",
            )
        ]
    return []


def floor_plan_of(section: PlanFloorSection) -> FloorPlan:
    """Return the plan of a storey."""
    material = Material(**dict(section.material))
    x, y = np.array(section.x_lines), np.array(section.y_lines)

    def size(rectangle: Any) -> Rectangle | None:
        """Return a rectangle, if one is given."""
        return None if rectangle is None else Rectangle(**dict(rectangle))

    return FloorPlan(
        name="plan",
        x_lines=x,
        y_lines=y,
        x_extent=section.x_extent or (float(x[0]), float(x[-1])),
        y_extent=section.y_extent or (float(y[0]), float(y[-1])),
        slab=ShellSection(
            thickness=section.slab_thickness,
            material=material,
            superimposed_mass=section.superimposed_mass,
        ),
        material=material,
        beams_x=size(section.beams_x),
        beams_y=size(section.beams_y),
        secondary_y=size(section.secondary_y),
        secondary_per_bay=section.secondary_per_bay,
        column=size(section.column),
        storey_below=section.storey_below,
        storey_above=section.storey_above,
        edges=dict(section.edges),
        eccentric_beams=section.eccentric_beams,
        column_heads=section.column_heads,
    )


def _supports(plan: FloorPlan) -> Iterator[Problem]:
    storeys = plan.storey_below > 0.0 or plan.storey_above > 0.0
    if (plan.column is not None) != storeys:
        yield Problem(
            place="floor.column" if plan.column else "floor.storey_below",
            value="columns without a storey" if plan.column else "a storey without columns",
            rule="columns need storey_below or storey_above, and storeys need a column",
            remedy="give both, or neither",
        )
    elif plan.column is None and not _stands(plan.edges):
        yield Problem(
            place="floor.edges",
            value=", ".join(f"{e} {kind}" for e, kind in plan.edges.items() if kind != "free")
            or "no columns, and no simple, pinned or clamped edge",
            rule="nothing holds this floor: it would sink, or tip over about a lone edge",
            remedy="add column and storey_below, or hold another edge: simple, pinned or clamped",
        )


def _stands(edges: Mapping[str, str]) -> bool:
    """Return whether edges alone hold a floor up, and against tipping."""
    bearing = [edge for edge, kind in edges.items() if kind in ("simple", "pinned")]
    level = {edge[0] for edge, kind in edges.items() if kind == "symmetry"}
    if "clamped" in edges.values() or len(bearing) > 1:
        return True
    return bool(bearing) and bearing[0][0] in level

"""The tables of a building in a study file: their keys, each checked by itself."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field
from pydantic_core import PydanticCustomError

from trundle.study_file.building_makes import PlateSection, ProfileSection
from trundle.study_file.fields import (
    Angle,
    Density,
    Flag,
    GridPlace,
    Length,
    Line,
    LineDensity,
    Mass,
    Name,
    Number,
    Place,
    PositiveLength,
    Pressure,
    Ratio,
    RotationalStiffness,
    Section,
    Stiffness,
    StiffnessPerMetre,
)

__all__ = ["BuildingSection", "LineSpringsSection", "RefineSection"]

Corners = Annotated[tuple[GridPlace, ...], Field(min_length=3)]
Places = Annotated[tuple[GridPlace, ...], Field(min_length=1)]
Path = Annotated[tuple[GridPlace, ...], Field(min_length=2)]
Dof = Literal["ux", "uy", "uz", "rx", "ry", "rz"]


def _metres(unit: Any) -> float:
    """Return the size of a drawing's unit [m]."""
    units = {"m": 1.0, "dm": 0.1, "cm": 0.01, "mm": 1e-3, "in": 0.0254, "ft": 0.3048}
    if unit not in units:
        rule = f"must be the unit of the drawing: one of {', '.join(units)}"
        raise PydanticCustomError("rule", "{rule}", {"rule": rule})
    return units[unit]


class MaterialSection(Section):
    """An isotropic material, with its dynamic modulus."""

    elastic_modulus: Pressure
    poisson_ratio: Annotated[Number, Field(ge=0.0, lt=0.5)] = 0.2
    density: Density
    damping_ratio: Ratio | None = None


class StoreySection(Section):
    """A level: the height of the mid-plane of its slabs."""

    name: Name
    level: Length


class GridSection(Section):
    """Grid lines by name: at an x, at a y, or through two places."""

    x: dict[Name, Length] = Field(default_factory=dict)
    y: dict[Name, Length] = Field(default_factory=dict)
    lines: dict[Name, tuple[Place, Place]] = Field(default_factory=dict)


class SlabSection(Section):
    """An area of slab, with openings."""

    on: Name
    plate: Name
    outline: Corners
    openings: tuple[Corners, ...] = ()
    panel: Flag = False


class BeamMake(Section):
    """What a beam is, wherever it runs."""

    section: Name
    below: Flag = True
    hinged: Literal["none", "start", "end", "both"] = "none"


class BeamSection(BeamMake):
    """A beam along a line, below the slab or in its plane."""

    on: Name
    along: Path


class SpringsSection(Section):
    """Six springs to the ground."""

    ux: Stiffness = 0.0
    uy: Stiffness = 0.0
    uz: Stiffness = 0.0
    rx: RotationalStiffness = 0.0
    ry: RotationalStiffness = 0.0
    rz: RotationalStiffness = 0.0


class LineSpringsSection(Section):
    """Three springs to the ground on every metre of a line."""

    ux: StiffnessPerMetre = 0.0
    uy: StiffnessPerMetre = 0.0
    uz: StiffnessPerMetre = 0.0


class ColumnMake(Section):
    """What a column is, wherever it stands."""

    section: Name
    from_: Annotated[Name, Field(alias="from")]
    to: Name
    base: Literal["fixed", "pinned"] | SpringsSection | None = None
    cap: Literal["fixed", "pinned"] | SpringsSection | None = None
    head: Literal["rigid", "point"] = "rigid"


class ColumnSection(ColumnMake):
    """A column at one place or several, from storey to storey."""

    at: Places | Literal["grid"]
    angle: Angle = 0.0


class WallMake(Section):
    """What a wall is, wherever it runs."""

    plate: Name
    from_: Annotated[Name, Field(alias="from")]
    to: Name
    base: Literal["fixed", "pinned"] | LineSpringsSection | None = None


class WallSection(WallMake):
    """A wall along a line, from storey to storey."""

    along: Path


class BraceSection(Section):
    """A member between two places, on the same storey or on two."""

    section: Name
    start: GridPlace
    end: GridPlace
    on: tuple[Name, Name]
    hinged: Flag = True


class RampSection(Section):
    """A slab that rises from its lower edge, two corners, to its upper one, the other two."""

    name: Name
    plate: Name
    outline: Annotated[tuple[GridPlace, ...], Field(min_length=4, max_length=4)]
    from_: Annotated[Name, Field(alias="from")]
    to: Name


class SupportSection(Section):
    """What holds a line or places of a floor: any of six dofs, or springs."""

    on: Name
    along: Path | None = None
    at: Places | None = None
    hold: Literal["roller", "pinned", "fixed"] | tuple[Dof, ...] = ()
    angle: Angle = 0.0
    springs: SpringsSection | LineSpringsSection | None = None


class MassSection(Section):
    """Mass at places, or along a line."""

    on: Name
    along: Path | None = None
    at: Places | None = None
    mass: Mass | None = None
    mass_per_metre: LineDensity | None = None


class SymmetrySection(Section):
    """A vertical plane at which the model ends."""

    axis: Literal["x", "y"] | None = None
    at: Length | None = None
    along: Annotated[tuple[GridPlace, ...], Field(min_length=2, max_length=2)] | None = None


class RefineSection(Section):
    """Smaller elements along a line, or round places."""

    on: Name | None = None
    along: Path | None = None
    at: Places | None = None
    size: PositiveLength
    reach: PositiveLength = 1.0


class Layer(Section):
    """A layer of a drawing."""

    layer: Line

    @property
    def own(self) -> dict[str, Any]:
        """What it says of each part that it shows."""
        return {key: getattr(self, key) for key in type(self).model_fields if key != "layer"}


class DrawnSlabs(Layer):
    """Slabs that a layer outlines."""

    plate: Name
    panel: Flag = False

    def table(self, **drawn: Any) -> SlabSection:
        """Return the table of one of them."""
        return SlabSection.model_construct(**self.own, **drawn)


class DrawnOpenings(Layer):
    """Openings that a layer outlines, in whichever slab they lie."""


class DrawnColumns(Layer, ColumnMake):
    """Columns that a layer shows by outlines, circles or points."""

    def table(self, **drawn: Any) -> ColumnSection:
        """Return the table of one of them."""
        return ColumnSection.model_construct(**self.own, **drawn)


class DrawnBeams(Layer, BeamMake):
    """Beams along the lines of a layer."""

    def table(self, **drawn: Any) -> BeamSection:
        """Return the table of one of them."""
        return BeamSection.model_construct(**self.own, **drawn)


class DrawnWalls(Layer, WallMake):
    """Walls along the lines of a layer."""

    def table(self, *, along: tuple[tuple[float, float], ...], on: str) -> WallSection:
        """Return the table of one of them; where it stands is said by its storeys."""
        del on
        return WallSection.model_construct(**self.own, along=along)


class DrawingSection(Section):
    """A DXF drawing of one storey, and what its layers are."""

    file: Line
    on: Name
    unit: Annotated[float | None, BeforeValidator(_metres)] = None
    origin: Place = (0.0, 0.0)
    slab: tuple[DrawnSlabs, ...] = ()
    opening: tuple[DrawnOpenings, ...] = ()
    column: tuple[DrawnColumns, ...] = ()
    beam: tuple[DrawnBeams, ...] = ()
    wall: tuple[DrawnWalls, ...] = ()


class BuildingSection(Section):
    """A building of storeys."""

    kind: Literal["storeys"] = "storeys"
    name: Line = "building"
    mesh_size: PositiveLength
    elements: Literal["quadrilaterals", "triangles"] = "quadrilaterals"
    size_at_routes: PositiveLength | None = None
    size_at_points: PositiveLength | None = None
    size_at_supports: PositiveLength | None = None
    nodes_at_points: Flag = False
    edges_along_routes: Flag = False
    north: Angle | None = None
    materials: dict[Name, MaterialSection] = Field(default_factory=dict)
    sections: dict[Name, ProfileSection] = Field(default_factory=dict)
    plates: dict[Name, PlateSection] = Field(default_factory=dict)
    grid: GridSection = GridSection()
    storey: Annotated[tuple[StoreySection, ...], Field(min_length=1)]
    slab: tuple[SlabSection, ...] = ()
    beam: tuple[BeamSection, ...] = ()
    column: tuple[ColumnSection, ...] = ()
    wall: tuple[WallSection, ...] = ()
    brace: tuple[BraceSection, ...] = ()
    ramp: tuple[RampSection, ...] = ()
    support: tuple[SupportSection, ...] = ()
    mass: tuple[MassSection, ...] = ()
    symmetry: tuple[SymmetrySection, ...] = ()
    refine: tuple[RefineSection, ...] = ()
    drawing: tuple[DrawingSection, ...] = ()

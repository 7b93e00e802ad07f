"""The section of a building in a study file: all its tables together."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from trundle.study_file.building_layers import DrawingSection
from trundle.study_file.building_makes import MaterialSection, PlateSection, ProfileSection
from trundle.study_file.building_tables import (
    BeamSection,
    BraceSection,
    ColumnSection,
    GridSection,
    JointSection,
    MassSection,
    RampSection,
    RefineSection,
    SlabSection,
    StoreySection,
    SupportSection,
    SymmetrySection,
    WallSection,
)
from trundle.study_file.fields import Angle, Flag, Line, Name, PositiveLength, Section

__all__ = ["BuildingSection"]


class BuildingSection(Section):
    """A building of storeys."""

    kind: Literal["storeys"] = "storeys"
    """A building of storeys."""
    name: Line = "building"
    """What it is called."""
    mesh_size: PositiveLength
    """Largest element edge."""
    elements: Literal["quadrilaterals", "triangles"] = "quadrilaterals"
    """What slabs are meshed with."""
    size_at_routes: PositiveLength | None = None
    """Largest element edge along routes."""
    size_at_points: PositiveLength | None = None
    """Largest element edge round points."""
    size_at_supports: PositiveLength | None = None
    """Largest element edge at supports, columns and walls."""
    nodes_at_points: Flag = False
    """Whether nodes lie at points."""
    edges_along_routes: Flag = False
    """Whether edges of elements follow routes."""
    north: Angle | None = None
    """Where north is on the plan, for pictures."""
    materials: dict[Name, MaterialSection] = Field(default_factory=dict)
    """Materials by name; steel is there."""
    sections: dict[Name, ProfileSection] = Field(default_factory=dict)
    """Cross-sections by name."""
    plates: dict[Name, PlateSection] = Field(default_factory=dict)
    """Plates by name."""
    grid: GridSection = GridSection()
    """Grid lines by name."""
    storey: Annotated[tuple[StoreySection, ...], Field(min_length=1)]
    """Its storeys, from below to above."""
    slab: tuple[SlabSection, ...] = ()
    """Areas of slab."""
    beam: tuple[BeamSection, ...] = ()
    """Beams along lines."""
    column: tuple[ColumnSection, ...] = ()
    """Columns from storey to storey."""
    wall: tuple[WallSection, ...] = ()
    """Walls from storey to storey."""
    brace: tuple[BraceSection, ...] = ()
    """Members between two places."""
    ramp: tuple[RampSection, ...] = ()
    """Slabs that rise from edge to edge."""
    support: tuple[SupportSection, ...] = ()
    """What holds floors."""
    mass: tuple[MassSection, ...] = ()
    """Masses at places and along lines."""
    joint: tuple[JointSection, ...] = ()
    """What connects edges across joints."""
    symmetry: tuple[SymmetrySection, ...] = ()
    """Vertical planes at which the model ends."""
    refine: tuple[RefineSection, ...] = ()
    """Where elements are smaller."""
    drawing: tuple[DrawingSection, ...] = ()
    """Drawings of storeys, and what their layers are."""

"""The tables of the parts of a building in a study file: their keys, each checked by itself."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from trundle.study_file.fields import (
    Angle,
    Flag,
    GridPlace,
    Length,
    LineDensity,
    Mass,
    Name,
    Place,
    PositiveLength,
    RotationalStiffness,
    Section,
    Stiffness,
    StiffnessPerMetre,
)

__all__ = [
    "BeamMake",
    "BeamSection",
    "BraceSection",
    "ColumnMake",
    "ColumnSection",
    "Dof",
    "GridSection",
    "JointSection",
    "LineSpringsSection",
    "MassSection",
    "RampSection",
    "RefineSection",
    "SlabSection",
    "SpringsSection",
    "StoreySection",
    "SupportSection",
    "SymmetrySection",
    "WallMake",
    "WallSection",
]

Corners = Annotated[tuple[GridPlace, ...], Field(min_length=3)]
Places = Annotated[tuple[GridPlace, ...], Field(min_length=1)]
Path = Annotated[tuple[GridPlace, ...], Field(min_length=2)]
Dof = Literal["ux", "uy", "uz", "rx", "ry", "rz"]


class StoreySection(Section):
    """A level: the height of the mid-plane of its slabs."""

    name: Name
    """How parts, routes, points and maps call it."""
    level: Length
    """Height of the mid-plane of its slabs."""


class GridSection(Section):
    """Grid lines by name: at an x, at a y, or through two places."""

    x: dict[Name, Length] = Field(default_factory=dict)
    """Names of lines, and the x at which each lies."""
    y: dict[Name, Length] = Field(default_factory=dict)
    """Names of lines, and the y at which each lies."""
    lines: dict[Name, tuple[Place, Place]] = Field(default_factory=dict)
    """Names of skewed lines, and two places on each."""


class SlabSection(Section):
    """An area of slab, with openings."""

    on: Name
    """Its storey."""
    plate: Name
    """Of [building.plates]."""
    outline: Corners
    """Its corners."""
    openings: tuple[Corners, ...] = ()
    """Corners of each opening."""
    panel: Flag = False
    """Whether it takes the place of a slab that lies there."""


class BeamMake(Section):
    """What a beam is, wherever it runs."""

    section: Name
    """Of [building.sections]."""
    below: Flag = True
    """Whether its top meets the slab's underside, or it lies in its mid-plane."""
    hinged: Literal["none", "start", "end", "both"] = "none"
    """Which ends transmit no bending moment."""


class BeamSection(BeamMake):
    """A beam along a line, below the slab or in its plane."""

    on: Name
    """Its storey or ramp."""
    along: Path
    """Corners of its line."""


class SpringsSection(Section):
    """Six springs to the ground."""

    ux: Stiffness = 0.0
    """Along x."""
    uy: Stiffness = 0.0
    """Along y."""
    uz: Stiffness = 0.0
    """Upright."""
    rx: RotationalStiffness = 0.0
    """About x."""
    ry: RotationalStiffness = 0.0
    """About y."""
    rz: RotationalStiffness = 0.0
    """About the vertical."""


class LineSpringsSection(Section):
    """Three springs to the ground on every metre of a line."""

    ux: StiffnessPerMetre = 0.0
    """Along x, of every metre."""
    uy: StiffnessPerMetre = 0.0
    """Along y, of every metre."""
    uz: StiffnessPerMetre = 0.0
    """Upright, of every metre."""


class ColumnMake(Section):
    """What a column is, wherever it stands."""

    section: Name
    """Of [building.sections]."""
    from_: Annotated[Name, Field(alias="from")]
    """Storey of its foot."""
    to: Name
    """Storey of its head."""
    base: Literal["fixed", "pinned"] | SpringsSection | None = None
    """What its foot stands on; on a slab, a beam or a wall unless given."""
    cap: Literal["fixed", "pinned"] | SpringsSection | None = None
    """What holds its head; the slab alone unless given."""
    head: Literal["rigid", "point"] = "rigid"
    """Whether slabs move with its cross-section, or are held at one node."""


class ColumnSection(ColumnMake):
    """A column at one place or several, from storey to storey."""

    at: Places | Literal["grid"]
    """Where it stands, places, or every crossing of the grid."""
    angle: Angle = 0.0
    """By which it is turned in plan; its depth lies along x without."""


class WallMake(Section):
    """What a wall is, wherever it runs."""

    plate: Name
    """Of [building.plates]."""
    from_: Annotated[Name, Field(alias="from")]
    """Storey of its foot."""
    to: Name
    """Storey of its top."""
    base: Literal["fixed", "pinned"] | LineSpringsSection | None = None
    """What its foot stands on; on a slab, a beam or a wall unless given."""


class WallSection(WallMake):
    """A wall along a line, from storey to storey."""

    along: Path
    """Corners of its line."""


class BraceSection(Section):
    """A member between two places, on the same storey or on two."""

    section: Name
    """Of [building.sections]."""
    start: GridPlace
    """Where it starts in plan."""
    end: GridPlace
    """Where it ends in plan."""
    on: tuple[Name, Name]
    """Storeys of both ends."""
    hinged: Flag = True
    """Whether its ends transmit no bending moment."""


class RampSection(Section):
    """A slab that rises from its lower edge, two corners, to its upper one, the other two."""

    name: Name
    """How routes, points and maps call it."""
    plate: Name
    """Of [building.plates]."""
    outline: Annotated[tuple[GridPlace, ...], Field(min_length=4, max_length=4)]
    """Both ends of its lower edge, then of its upper one."""
    from_: Annotated[Name, Field(alias="from")]
    """Storey of its lower edge."""
    to: Name
    """Storey of its upper edge."""


class SupportSection(Section):
    """What holds a line or places of a floor: any of six dofs, or springs."""

    on: Name
    """Its storey or ramp."""
    along: Path | None = None
    """Line that is held."""
    at: Places | None = None
    """Places that are held, in place of a line."""
    hold: Literal["roller", "pinned", "fixed"] | tuple[Dof, ...] = ()
    """What is held: a word, or any of the six dofs."""
    angle: Angle = 0.0
    """By which its axes are turned in plan."""
    springs: SpringsSection | LineSpringsSection | None = None
    """Springs to the ground; of a line, by the metre."""


class JointSection(Section):
    """What connects two edges across a joint."""

    on: Name
    """Storey or ramp of both."""
    along: Path
    """Edge on one side."""
    to: Path
    """Edge that faces it on the other side."""
    springs: LineSpringsSection
    """Springs between them, of every metre."""


class MassSection(Section):
    """Mass at places, or along a line."""

    on: Name
    """Its storey or ramp."""
    along: Path | None = None
    """Line on which it lies."""
    at: Places | None = None
    """Places where it is, in place of a line."""
    mass: Mass | None = None
    """At each place."""
    mass_per_metre: LineDensity | None = None
    """Along the line."""


class SymmetrySection(Section):
    """A vertical plane at which the model ends."""

    axis: Literal["x", "y"] | None = None
    """Axis across which the plane lies."""
    at: Length | None = None
    """Where it lies on that axis."""
    along: Annotated[tuple[GridPlace, ...], Field(min_length=2, max_length=2)] | None = None
    """Two places of the plane, in place of both."""


class RefineSection(Section):
    """Smaller elements along a line, or round places."""

    on: Name | None = None
    """Storey or ramp; every one unless given."""
    along: Path | None = None
    """Line along which elements are smaller."""
    at: Places | None = None
    """Places round which elements are smaller, in place of a line."""
    size: PositiveLength
    """Largest element edge there."""
    reach: PositiveLength = 1.0
    """How far from it."""

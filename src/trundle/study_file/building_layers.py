"""The tables of a drawing in a study file: its layers, and what they are."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import BeforeValidator
from pydantic_core import PydanticCustomError

from trundle.study_file.building_tables import (
    BeamMake,
    BeamSection,
    ColumnMake,
    ColumnSection,
    SlabSection,
    WallMake,
    WallSection,
)
from trundle.study_file.fields import Flag, Line, Name, Place, Section

__all__ = ["DrawingSection"]


def _metres(unit: Any) -> float:
    """Return the size of a drawing's unit [m]."""
    units = {"m": 1.0, "dm": 0.1, "cm": 0.01, "mm": 1e-3, "in": 0.0254, "ft": 0.3048}
    if unit not in units:
        rule = f"must be the unit of the drawing: one of {', '.join(units)}"
        raise PydanticCustomError("rule", "{rule}", {"rule": rule})
    return units[unit]


class Layer(Section):
    """A layer of a drawing."""

    layer: Line
    """Its name in the drawing."""

    @property
    def own(self) -> dict[str, Any]:
        """What it says of each part that it shows."""
        return {key: getattr(self, key) for key in type(self).model_fields if key != "layer"}


class DrawnSlabs(Layer):
    """Slabs that a layer outlines."""

    plate: Name
    """Of [building.plates]."""
    panel: Flag = False
    """Whether it takes the place of a slab that lies there."""

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
    """The drawing (DXF), beside the study."""
    on: Name
    """Its storey."""
    unit: Annotated[float | None, BeforeValidator(_metres)] = None
    """Of the drawing, where it does not say it."""
    origin: Place = (0.0, 0.0)
    """Place of the drawing that is x = y = 0."""
    slab: tuple[DrawnSlabs, ...] = ()
    """Layers that outline slabs."""
    opening: tuple[DrawnOpenings, ...] = ()
    """Layers that outline openings."""
    column: tuple[DrawnColumns, ...] = ()
    """Layers that show columns."""
    beam: tuple[DrawnBeams, ...] = ()
    """Layers of the lines of beams."""
    wall: tuple[DrawnWalls, ...] = ()
    """Layers of the lines of walls."""

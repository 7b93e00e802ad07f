"""Hold cross-sections with their outer sizes, by which beams hang and columns meet slabs."""

from __future__ import annotations

from dataclasses import dataclass, replace

from trundle._checks import positive, set_frozen
from trundle.structure.profiles import (
    STEEL,
    box_section,
    i_section,
    rolled_section,
    rolled_sizes,
    t_section,
    tube_section,
)
from trundle.structure.sections import BeamSection, Material

__all__ = ["Profile"]


@dataclass(frozen=True, kw_only=True)
class Profile:
    """Hold a section and the box round it.

    Attributes
    ----------
    section : BeamSection
        About its own centroid.
    depth, width : float
        Outer sizes along and across the depth [m].
    above : float
        From its centroid to its top [m].
    name : str
        Name for messages and pictures.
    """

    section: BeamSection
    depth: float
    width: float
    above: float
    name: str = "section"

    def __post_init__(self) -> None:
        """Check the sizes."""
        sizes = ("depth", "width", "above")
        set_frozen(self, **{name: positive(name, getattr(self, name)) for name in sizes})

    @classmethod
    def rectangle(cls, width: float, depth: float, material: Material) -> Profile:
        """Make a solid rectangle [m]."""
        section = BeamSection.rectangle(width, depth, material)
        return cls(section=section, depth=depth, width=width, above=0.5 * depth)

    @classmethod
    def circle(cls, diameter: float, material: Material) -> Profile:
        """Make a solid circle [m]."""
        return cls.tube(diameter, 0.5 * diameter, material)

    @classmethod
    def tube(cls, diameter: float, wall: float, material: Material) -> Profile:
        """Make a circular hollow section [m]."""
        section = tube_section(diameter, wall, material)
        return cls(section=section, depth=diameter, width=diameter, above=0.5 * diameter)

    @classmethod
    def i(
        cls,
        depth: float,
        width: float,
        web: float,
        flange: float,
        material: Material,
        *,
        radius: float = 0.0,
    ) -> Profile:
        """Make an I or H, see `i_section` [m]."""
        section = i_section(depth, width, web, flange, material, radius=radius)
        return cls(section=section, depth=depth, width=width, above=0.5 * depth)

    @classmethod
    def t(
        cls, depth: float, width: float, web: float, flange: float, material: Material
    ) -> Profile:
        """Make a T with its flange on top, see `t_section` [m]."""
        section = t_section(depth, width, web, flange, material)
        clear = depth - flange
        areas = (width * flange, clear * web)
        above = (areas[0] * 0.5 * flange + areas[1] * (flange + 0.5 * clear)) / sum(areas)
        return cls(section=section, depth=depth, width=width, above=above)

    @classmethod
    def box(
        cls, depth: float, width: float, web: float, flange: float, material: Material
    ) -> Profile:
        """Make a rectangular hollow section, see `box_section` [m]."""
        section = box_section(depth, width, web, flange, material)
        return cls(section=section, depth=depth, width=width, above=0.5 * depth)

    @classmethod
    def rolled(cls, name: str, material: Material = STEEL) -> Profile:
        """Take a rolled section by its name, see `rolled_section`."""
        depth, width = rolled_sizes(name)[:2]
        section = rolled_section(name, material)
        return cls(section=section, depth=depth, width=width, above=0.5 * depth, name=name)

    def softened(self, factor: float) -> Profile:
        """Return it with its stiffness times a factor, as when it is cracked; its mass stays."""
        factor = positive("stiffness factor", factor)
        material = self.section.material
        softer = replace(material, elastic_modulus=material.elastic_modulus * factor)
        return replace(self, section=replace(self.section, material=softer))

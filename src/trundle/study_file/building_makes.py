"""Materials, cross-sections and plates of a building, by the names that its parts use."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Field

from trundle.errors import Problem
from trundle.structure import (
    STEEL,
    Material,
    OrthotropicSection,
    ShellSection,
    composite_deck,
    hollow_core_slab,
    ribbed_slab,
    waffle_slab,
)
from trundle.structure import BeamSection as Cross
from trundle.structure.building import Profile
from trundle.structure.sections import PlateSection as Plate
from trundle.study_file.attempt import attempted
from trundle.study_file.fields import (
    Angle,
    AreaDensity,
    CrossArea,
    Density,
    Factor,
    Line,
    Load,
    Name,
    NonNegativeLength,
    Number,
    PositiveLength,
    Pressure,
    Ratio,
    SecondMoment,
    Section,
)

__all__ = [
    "MaterialSection",
    "PlateSection",
    "ProfileSection",
    "materials_of",
    "plates_of",
    "profiles_of",
]

_GRAVITY = 9.80665  # m/s2, standard gravity


class MaterialSection(Section):
    """An isotropic material, with its dynamic modulus."""

    elastic_modulus: Pressure
    """Dynamic modulus of elasticity."""
    poisson_ratio: Annotated[Number, Field(ge=0.0, lt=0.5)] = 0.2
    """Poisson's ratio."""
    density: Density
    """Mass by volume."""
    damping_ratio: Ratio | None = None
    """Ratio of critical damping, for damping by material."""


class ProfileSection(Section):
    """A cross-section by its shape and sizes, or a rolled one by its name."""

    shape: Literal["rectangle", "circle", "tube", "i", "t", "box", "rolled", "own"]
    """Which shape it has; the shape says which sizes it takes."""
    material: Name
    """Of [building.materials], or steel."""
    stiffness_factor: Factor = 1.0
    """Times the stiffness, as for cracking; the mass stays."""
    width: PositiveLength | None = None
    """Across."""
    depth: PositiveLength | None = None
    """Upright."""
    diameter: PositiveLength | None = None
    """Of a circle or a tube."""
    wall: PositiveLength | None = None
    """Thickness of a tube's wall."""
    web: PositiveLength | None = None
    """Thickness of the web."""
    flange: PositiveLength | None = None
    """Thickness of the flanges."""
    radius: NonNegativeLength | None = None
    """Of the fillets of an i."""
    rolled: Line | None = None
    """Name of a rolled section, IPE, HEA, HEB or W."""
    area: CrossArea | None = None
    """Area of the cross-section."""
    inertia_y: SecondMoment | None = None
    """Second moment of area about y."""
    inertia_z: SecondMoment | None = None
    """Second moment of area about z."""
    torsion_constant: SecondMoment | None = None
    """Saint-Venant's constant."""
    shear_area_y: CrossArea | None = None
    """Shear area along y; it does not shear unless given."""
    shear_area_z: CrossArea | None = None
    """Shear area along z; it does not shear unless given."""


class PlateSection(Section):
    """What slabs, walls and ramps are made of, with the mass that lies on them."""

    kind: Literal["solid", "ribbed", "waffle", "hollow_core", "composite_deck"] = "solid"
    """What kind it is; the kind says which sizes it takes."""
    material: Name
    """Of [building.materials], or steel."""
    stiffness_factor: Factor = 1.0
    """Times the stiffness, as for cracking; the mass stays."""
    superimposed_mass: AreaDensity = 0.0
    """What lies on it permanently: mass without stiffness."""
    imposed_load: Load = 0.0
    """What may lie on it, as a load."""
    imposed_share: Annotated[Number, Field(ge=0.0, le=1.0)] = 0.1
    """Share of the imposed load that moves with it."""
    direction: Angle = 0.0
    """Of its ribs, from x."""
    thickness: PositiveLength | None = None
    """Of a solid plate, or of planks."""
    plate: PositiveLength | None = None
    """Thickness of the plate over ribs."""
    rib_width: PositiveLength | None = None
    """Width of ribs."""
    rib_depth: PositiveLength | None = None
    """Depth of ribs below the plate."""
    spacing: PositiveLength | None = None
    """Distance of ribs or voids."""
    spacing_y: PositiveLength | None = None
    """Distance of a waffle's ribs along y; spacing unless given."""
    depth: PositiveLength | None = None
    """Of a composite deck, to its top."""
    void: PositiveLength | None = None
    """Diameter of voids."""
    topping: NonNegativeLength | None = None
    """Thickness of what is cast on planks."""
    deck_height: PositiveLength | None = None
    """Height of the deck's ribs."""
    deck_mass: AreaDensity | None = None
    """Of the steel deck."""

    @property
    def lying_on_it(self) -> float:
        """Mass that moves with it [kg/m2]: what is permanent, and a share of the imposed load."""
        return self.superimposed_mass + self.imposed_share * self.imposed_load / _GRAVITY


_SHAPES: dict[str, tuple[tuple[str, ...], tuple[str, ...]]] = {
    "rectangle": (("width", "depth"), ()),
    "circle": (("diameter",), ()),
    "tube": (("diameter", "wall"), ()),
    "i": (("depth", "width", "web", "flange"), ("radius",)),
    "t": (("depth", "width", "web", "flange"), ()),
    "box": (("depth", "width", "web", "flange"), ()),
    "rolled": (("rolled",), ()),
    "own": (
        ("depth", "width", "area", "inertia_y", "inertia_z", "torsion_constant"),
        ("shear_area_y", "shear_area_z"),
    ),
}
"""Keys that each shape needs, and those that it may have."""

_PLATES: dict[str, tuple[tuple[str, ...], tuple[str, ...]]] = {
    "solid": (("thickness",), ()),
    "ribbed": (("plate", "rib_width", "rib_depth", "spacing"), ("direction",)),
    "waffle": (
        ("plate", "rib_width", "rib_depth", "spacing"),
        ("spacing_y", "direction"),
    ),
    "hollow_core": (("thickness", "void", "spacing"), ("topping", "direction")),
    "composite_deck": (
        ("depth", "deck_height", "rib_width", "spacing"),
        ("deck_mass", "direction"),
    ),
}
_ALWAYS_PROFILE = {"shape", "material", "stiffness_factor"}
_ALWAYS_PLATE = {
    "kind", "material", "stiffness_factor", "superimposed_mass", "imposed_load", "imposed_share",
}  # fmt: skip


def materials_of(section: Any) -> dict[str, Material]:
    """Return materials by name: those of the file, and structural steel."""
    return {"steel": STEEL} | {k: Material(**dict(m)) for k, m in section.materials.items()}


def profiles_of(
    section: Any, materials: Mapping[str, Material]
) -> tuple[dict[str, Profile], list[Problem]]:
    """Return cross-sections by name, and what is wrong with them."""
    return _made(section.sections, "sections", materials, _profile)


def plates_of(
    section: Any, materials: Mapping[str, Material]
) -> tuple[dict[str, Plate], list[Problem]]:
    """Return plates by name, and what is wrong with them."""
    return _made(section.plates, "plates", materials, _plate)


def _made(
    sections: Mapping[str, Any],
    kind: str,
    materials: Mapping[str, Material],
    make: Callable[[Any, Material], Any],
) -> tuple[dict[str, Any], list[Problem]]:
    made: dict[str, Any] = {}
    found: list[Problem] = []
    for name, one in sections.items():
        place = f"building.{kind}.{name}"
        mistakes = list(_keys(place, one))
        if one.material not in materials:
            mistakes.append(
                Problem(
                    place=f"{place}.material",
                    value=repr(one.material),
                    rule="must be a material of the building",
                    remedy=f"there are: {', '.join(materials)}; add [building.materials.NAME]",
                )
            )
        if not mistakes:
            value, mistakes = attempted(place, lambda o=one: make(o, materials[o.material]))
            if value is not None:
                made[name] = value
        found += mistakes
    return made, found


def _keys(place: str, one: Any) -> Iterator[Problem]:
    """Give keys that a shape needs and lacks, and keys of other shapes."""
    plate = isinstance(one, PlateSection)
    what = one.kind if plate else one.shape
    needs, may = (_PLATES if plate else _SHAPES)[what]
    given = set(one.model_fields_set) - (_ALWAYS_PLATE if plate else _ALWAYS_PROFILE)
    for key in needs:
        if key not in given:
            yield Problem(
                place=f"{place}.{key}",
                value="nothing",
                rule=f"a {what.replace('_', '-')} {'plate' if plate else 'section'} needs "
                f"{', '.join(needs)}",
                remedy=f"add {key}",
            )
    for key in sorted(given - {*needs, *may}):
        yield Problem(
            place=f"{place}.{key}",
            value="given",
            rule=f"a {what.replace('_', '-')} {'plate' if plate else 'section'} has no {key}",
            remedy=f"remove it; its keys are {', '.join((*needs, *may))}",
        )


def _profile(one: ProfileSection, material: Material) -> Profile:
    needs, may = _SHAPES[one.shape]
    sizes = {key: getattr(one, key) for key in (*needs, *may) if getattr(one, key) is not None}
    if one.shape == "rolled":
        profile = Profile.rolled(sizes["rolled"], material)
    elif one.shape == "own":
        depth, width = sizes.pop("depth"), sizes.pop("width")
        shear = {"shear_area_y": float("inf"), "shear_area_z": float("inf")}
        section = Cross(**(shear | sizes), material=material)
        profile = Profile(section=section, depth=depth, width=width, above=0.5 * depth)
    else:
        profile = getattr(Profile, one.shape)(**sizes, material=material)
    return profile if one.stiffness_factor == 1.0 else profile.softened(one.stiffness_factor)


def _plate(one: PlateSection, material: Material) -> Plate:
    softer = replace(material, elastic_modulus=material.elastic_modulus * one.stiffness_factor)
    needs, may = _PLATES[one.kind]
    sizes: dict[str, Any] = {
        key: getattr(one, key) for key in (*needs, *may) if getattr(one, key) is not None
    }
    sizes.pop("direction", None)
    common: dict[str, Any] = {"material": softer, "superimposed_mass": one.lying_on_it}
    if one.kind == "solid":
        return ShellSection(**sizes, **common)
    make: Callable[..., OrthotropicSection] = {
        "ribbed": ribbed_slab,
        "waffle": waffle_slab,
        "hollow_core": hollow_core_slab,
        "composite_deck": composite_deck,
    }[one.kind]
    made = make(**sizes, **common)
    return made if one.direction == 0.0 else made.turned(float(np.degrees(one.direction)))

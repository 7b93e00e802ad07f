"""Materials, frame sections and area sections of SAP2000's tables."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import TypeAlias, TypeVar

import numpy as np

from trundle._typing import Array
from trundle.errors import InputError
from trundle.imports.sap_tables import Row, Table
from trundle.structure import BeamSection, Material, OrthotropicSection, ShellSection
from trundle.structure.plates import UNSHEARED

__all__ = [
    "AreaMake",
    "FrameMake",
    "areas_of",
    "frames_of",
    "materials_of",
    "modified_area",
    "modified_frame",
    "used_make",
]

_SYMMETRIC = {
    "rectangular", "i/wide flange", "box/tube", "pipe", "circle", "steel tube", "steel pipe",
    "concrete rectangular", "concrete circle",
}  # fmt: skip
T = TypeVar("T")
_Four: TypeAlias = tuple[float, float, float, float]
_SHELLS = {"shell-thin", "shell-thick", "shell"}
_AREA_KEYS = ("f11", "f22", "f12", "m11", "m22", "m12", "v13", "v23")
_MODIFIERS = ("F11Mod", "F22Mod", "F12Mod", "M11Mod", "M22Mod", "M12Mod", "V13Mod", "V23Mod")


@dataclass(frozen=True, kw_only=True)
class FrameMake:
    """Hold a frame section, in the file's units.

    Attributes
    ----------
    section : BeamSection
        Bending about 3 is about y, for depth lies along 2.
    mass_per_length : float
        With its modifier.
    depth, width : float
        Along 2 and 3, for insertion points; 0 where not known.
    symmetric : bool
        Whether the middle of its box is its centroid.
    """

    section: BeamSection
    mass_per_length: float
    weight_per_length: float
    depth: float
    width: float
    symmetric: bool


@dataclass(frozen=True, kw_only=True)
class AreaMake:
    """Hold an area section without mass, and its mass and weight per area."""

    section: ShellSection | OrthotropicSection
    mass_per_area: float
    weight_per_area: float
    turned: bool  # whether its axes matter


def materials_of(general: Table, basic: Table) -> dict[str, tuple[Material, float]]:
    """Return materials and their weights by volume, by name.

    Parameters
    ----------
    general : Table
        MATERIAL PROPERTIES 01 - GENERAL.
    basic : Table
        MATERIAL PROPERTIES 02 - BASIC MECHANICAL PROPERTIES.

    Raises
    ------
    InputError
        A material that is not isotropic, or whose numbers cannot be.
    """
    for row in general.rows:
        kind = row.text("SymType", "Isotropic")
        name = row.text("Material")
        if kind.lower() not in {"isotropic", "uniaxial"}:
            raise InputError(f"{row.place}: material {name!r} is {kind}; isotropic ones are read")
        if row.yes("TempDepend"):
            raise InputError(f"{row.place}: material {name!r} depends on temperature")
    found: dict[str, tuple[Material, float]] = {}
    for row in basic.rows:
        e = row.number("E1")
        try:
            material = Material(
                elastic_modulus=e,
                poisson_ratio=row.number(
                    "U12", row.number("G12", 0.0) and e / (2.0 * row.number("G12")) - 1.0
                ),
                density=row.number("UnitMass", 0.0),
            )
        except InputError as error:
            raise InputError(f"{row.place}: {error}") from None
        found[row.text("Material")] = material, row.number("UnitWeight", 0.0)
    return found


def frames_of(
    table: Table, materials: Mapping[str, tuple[Material, float]]
) -> dict[str, FrameMake | InputError]:
    """Return frame sections by name, or why one cannot be used.

    Parameters
    ----------
    table : Table
        FRAME SECTION PROPERTIES 01 - GENERAL.
    materials : mapping of str to (Material, float)
        See `materials_of`.
    """
    return {
        row.text("SectionName"): _kept(lambda r=row: _frame(r, materials)) for row in table.rows
    }


def _kept(make: Callable[[], T]) -> T | InputError:
    """Return what is made, or why it cannot be: sections that nothing uses do no harm."""
    try:
        return make()
    except InputError as error:
        return error


def used_make(makes: Mapping[str, T | InputError], row: Row, name: str) -> T:
    """Return a section that is used.

    Parameters
    ----------
    makes : mapping of str
        All sections.
    row : Row
        Who uses it.
    name : str
        Its name.

    Raises
    ------
    InputError
        It is not there, or cannot be used; or another material is assigned than its own.
    """
    if row.text("MatProp", "Default").lower() != "default":
        raise InputError(f"{row.place}: another material than the section's (MatProp) is not read")
    if name not in makes:
        raise InputError(f"{row.place}: names section {name!r}, which is not there")
    found = makes[name]
    if isinstance(found, InputError):
        raise found
    return found


def modified_frame(make: FrameMake, row: Row) -> FrameMake:
    """Return a frame section times the modifiers of FRAME PROPERTY MODIFIERS.

    Parameters
    ----------
    make : FrameMake
        Its section.
    row : Row
        The modifiers.
    """
    by = {k: row.number(f"{k}Mod", 1.0) for k in ("A", "AS2", "AS3", "J", "I22", "I33")}
    section = make.section
    try:
        changed = replace(
            section,
            area=section.area * by["A"],
            inertia_y=section.inertia_y * by["I33"],
            inertia_z=section.inertia_z * by["I22"],
            torsion_constant=section.torsion_constant * by["J"],
            shear_area_z=section.shear_area_z * by["AS2"],
            shear_area_y=section.shear_area_y * by["AS3"],
        )
    except InputError as error:
        raise InputError(f"{row.place}: {error}") from None
    return replace(
        make,
        section=changed,
        mass_per_length=make.mass_per_length * row.number("MassMod", 1.0),
        weight_per_length=make.weight_per_length * row.number("WeightMod", 1.0),
    )


def modified_area(make: AreaMake, row: Row) -> AreaMake:
    """Return an area section times the modifiers of AREA STIFFNESS MODIFIERS.

    Parameters
    ----------
    make : AreaMake
        Its section.
    row : Row
        The modifiers.
    """
    f = [row.number(key, 1.0) for key in _AREA_KEYS]
    section = make.section
    assert isinstance(section, OrthotropicSection)  # areas are made so

    def times(law: _Four, x: float, y: float, twist: float) -> _Four:
        """Return a law times its modifiers, its coupling by the root of both."""
        return law[0] * x, law[1] * y, law[2] * float(np.sqrt(max(x * y, 0.0))), law[3] * twist

    try:
        changed = replace(
            section,
            membrane=times(section.membrane, *f[:3]),
            bending=times(section.bending, *f[3:6]),
            shear=(section.shear[0] * f[6], section.shear[1] * f[7]),
        )
    except InputError as error:
        raise InputError(f"{row.place}: {error}") from None
    return replace(
        make,
        section=changed,
        mass_per_area=make.mass_per_area * row.number("MassMod", 1.0),
        weight_per_area=make.weight_per_area * row.number("WeightMod", 1.0),
    )


def _known(row: Row, materials: Mapping[str, tuple[Material, float]]) -> tuple[Material, float]:
    name = row.text("Material")
    if name not in materials:
        raise InputError(f"{row.place}: names material {name!r}, which is not there")
    return materials[name]


def _frame(row: Row, materials: Mapping[str, tuple[Material, float]]) -> FrameMake:
    shape = row.text("Shape", "General")
    if "nonprismatic" in shape.lower():
        raise InputError(f"{row.place}: a section that changes along its frame is not read")
    material, weight = _known(row, materials)
    aslant = abs(row.number("I23", 0.0))
    if aslant > 1e-6 * row.number("I33"):
        raise InputError(f"{row.place}: I23 is not 0: principal axes that lie aslant are not read")
    by = {k: row.number(f"{k}Mod", 1.0) for k in ("A", "A2", "A3", "J", "I2", "I3", "M", "W")}
    area = row.number("Area")
    shear = [row.number(key, 0.0) * by[k] for key, k in (("AS2", "A2"), ("AS3", "A3"))]
    try:
        section = BeamSection(
            area=area * by["A"],
            inertia_y=row.number("I33") * by["I3"],
            inertia_z=row.number("I22") * by["I2"],
            torsion_constant=row.number("TorsConst") * by["J"],
            # no shear area: shear does not bend it
            shear_area_z=shear[0] or np.inf,
            shear_area_y=shear[1] or np.inf,
            material=replace(material, density=0.0),
        )
    except InputError as error:
        raise InputError(f"{row.place}: {error}") from None
    return FrameMake(
        section=section,
        mass_per_length=material.density * area * by["M"],
        weight_per_length=weight * area * by["W"],
        depth=row.number("t3", 0.0),
        width=row.number("t2", 0.0),
        symmetric=shape.lower() in _SYMMETRIC
        and row.number("t2b", row.number("t2", 0.0)) == row.number("t2", 0.0)
        and row.number("tfb", row.number("tf", 0.0)) == row.number("tf", 0.0),
    )


def areas_of(
    table: Table, materials: Mapping[str, tuple[Material, float]]
) -> dict[str, AreaMake | InputError]:
    """Return area sections by name, or why one cannot be used.

    Parameters
    ----------
    table : Table
        AREA SECTION PROPERTIES.
    materials : mapping of str to (Material, float)
        See `materials_of`.
    """
    return {row.text("Section"): _kept(lambda r=row: _area(r, materials)) for row in table.rows}


def _area(row: Row, materials: Mapping[str, tuple[Material, float]]) -> AreaMake:
    kind, shell = row.text("AreaType", "Shell"), row.text("Type", "Shell-Thin")
    if kind.lower() != "shell" or shell.lower() not in _SHELLS:
        raise InputError(
            f"{row.place}: an area of {kind}, {shell}, is not read; shells, thin and thick, are"
        )
    material, weight = _known(row, materials)
    thick, bend = row.number("Thickness"), row.number("BendThick", row.number("Thickness"))
    try:
        section = _plate(row, material, thick, bend, thin="thick" not in shell.lower())
    except InputError as error:
        raise InputError(f"{row.place}: {error}") from None
    modifiers = [row.number(key, 1.0) for key in _MODIFIERS]
    return AreaMake(
        section=section,
        mass_per_area=material.density * thick * row.number("MMod", 1.0),
        weight_per_area=weight * thick * row.number("WMod", 1.0),
        turned=modifiers[0] != modifiers[1] or modifiers[3] != modifiers[4]
        or modifiers[6] != modifiers[7],
    )  # fmt: skip


def _plate(
    row: Row, material: Material, thick: float, bend: float, *, thin: bool
) -> OrthotropicSection:
    """Return a plate of two thicknesses and stiffnesses by its modifiers, without mass."""
    light = replace(material, density=0.0)
    membrane = ShellSection(thickness=thick, material=light).laws(np.eye(3)[None]).membrane
    laws = ShellSection(thickness=bend, material=light).laws(np.eye(3)[None])
    f = [row.number(key, 1.0) for key in _MODIFIERS]
    if min(f) <= 0.0:
        raise InputError(f"a modifier must be above 0; got {min(f):g}")

    def changed(law: Array, x: float, y: float, twist: float) -> _Four:
        """Return a law's four numbers, its coupling by the root of both modifiers."""
        c = law.reshape(3, 3)
        return (
            float(c[0, 0] * x), float(c[1, 1] * y), float(c[0, 1] * np.sqrt(x * y)),
            float(c[2, 2] * twist),
        )  # fmt: skip

    shear = laws.shear.reshape(2, 2)
    stiff = UNSHEARED if thin else 1.0
    return OrthotropicSection(
        bending=changed(laws.bending, f[3], f[4], f[5]),
        membrane=changed(membrane, f[0], f[1], f[2]),
        shear=(float(shear[0, 0] * f[6] * stiff), float(shear[1, 1] * f[7] * stiff)),
        mass_per_area=0.0,
        thickness=bend,
    )

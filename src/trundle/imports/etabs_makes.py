"""Materials, frame sections and plates of ETABS text files, as rows of SAP2000's tables."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

from trundle.errors import InputError
from trundle.imports.etabs_statements import Statement, number_of
from trundle.imports.sap_tables import Row, Table
from trundle.structure import STEEL
from trundle.structure.building import Profile
from trundle.structure.profiles import rolled_sizes

__all__ = ["Rows", "area_section", "frame_section"]


@dataclass(kw_only=True)
class Rows:
    """Tables that are filled row by row, and the properties that rows name.

    Attributes
    ----------
    tables : dict of str to Table
        By title.
    properties : dict of str to dict of str to str
        Keys of each material, section and plate, by kind and name.
    gravity : float
        In the file's units.
    length : float
        Its unit of length [m].
    made : set of (str, str)
        What stands in a table already.
    """

    tables: dict[str, Table] = field(default_factory=dict[str, Table])
    properties: dict[str, dict[str, str]] = field(default_factory=dict[str, dict[str, str]])
    gravity: float = 9.80665
    length: float = 1.0
    made: set[tuple[str, str]] = field(default_factory=set[tuple[str, str]])

    def row(self, table: str, place: str, **cells: object) -> None:
        """Add a row to a table."""
        rows = self.tables.setdefault(table, Table(name=table, place=place)).rows
        text = {key.lower(): str(value) for key, value in cells.items() if value is not None}
        rows.append(Row(place=place, cells=text, used=set()))

    def once(self, table: str, name: str) -> bool:
        """Return whether a name is new to a table; it is there from then on."""
        new = (table, name) not in self.made
        self.made.add((table, name))
        return new


def _material_row(rows: Rows, one: Statement, name: str) -> None:
    if not rows.once("MATERIAL PROPERTIES 02 - BASIC MECHANICAL PROPERTIES", name):
        return
    keys = rows.properties.get(f"material {name}")
    if keys is None or not {"E", "U"} <= keys.keys():
        raise InputError(f"{one.place}: material {name!r} is not there, or has no E and U")
    if keys.get("SYMTYPE", keys.get("TYPE", "ISOTROPIC")).upper() in {"ORTHOTROPIC", "ANISOTROPIC"}:
        raise InputError(f"{one.place}: material {name!r} is not isotropic")
    weight = number_of(one, keys.get("WEIGHTPERVOLUME", keys.get("W", "0")))
    mass = number_of(one, keys["M"]) if "M" in keys else weight / rows.gravity
    rows.row(
        "MATERIAL PROPERTIES 02 - BASIC MECHANICAL PROPERTIES", one.place, Material=name,
        E1=keys["E"], U12=keys["U"], UnitMass=mass, UnitWeight=weight,
    )  # fmt: skip


def frame_section(rows: Rows, one: Statement, name: str) -> None:
    """Add a frame section to the tables, with its material, if it is new.

    Parameters
    ----------
    rows : Rows
        Takes them.
    one : Statement
        Who names it.
    name : str
        Its name.

    Raises
    ------
    InputError
        It is not there, or of a kind that is not read.
    """
    table = "FRAME SECTION PROPERTIES 01 - GENERAL"
    if not rows.once(table, name):
        return
    keys = rows.properties.get(f"section {name}")
    if keys is None:
        raise InputError(f"{one.place}: names section {name!r}, which is not there")
    _material_row(rows, one, keys.get("MATERIAL", ""))
    profile = _profile(one, name, keys, rows.length)
    section = profile.section
    changed = {f"{k}Mod": keys[f"{k}MOD"] for k in ("A", "A2", "A3", "J", "I2", "I3", "M", "W")
               if f"{k}MOD" in keys}  # fmt: skip
    rows.row(
        table, one.place, SectionName=name, Material=keys.get("MATERIAL", ""), Shape="Rectangular",
        t3=profile.depth, t2=profile.width, Area=section.area, TorsConst=section.torsion_constant,
        I33=section.inertia_y, I22=section.inertia_z, AS2=section.shear_area_z,
        AS3=section.shear_area_y, **changed,
    )  # fmt: skip


def _profile(one: Statement, name: str, keys: Mapping[str, str], length: float) -> Profile:
    """Return a cross-section by its shape, in the file's units."""
    shape = keys.get("SHAPE", "").upper()

    def sizes(*names: str) -> Iterator[float]:
        """Give sizes that must be there."""
        for key in names:
            if key not in keys:
                raise InputError(f"{one.place}: section {name!r} ({shape}) has no {key}")
            yield number_of(one, keys[key])

    if shape in {"RECTANGULAR", "CONCRETE RECTANGULAR", "RECTANGLE"}:
        depth, width = sizes("D", "B")
        return Profile.rectangle(width=width, depth=depth, material=STEEL)
    if shape in {"CIRCLE", "CONCRETE CIRCLE"}:
        (diameter,) = sizes("D")
        return Profile.circle(diameter=diameter, material=STEEL)
    if shape in {"PIPE", "STEEL PIPE"}:
        diameter, wall = sizes("D", "T" if "T" in keys else "TW")
        return Profile.tube(diameter=diameter, wall=wall, material=STEEL)
    if shape in {"BOX/TUBE", "STEEL TUBE", "TUBE"}:
        depth, width, flange, web = sizes("D", "B", "TF", "TW")
        return Profile.box(depth=depth, width=width, web=web, flange=flange, material=STEEL)
    if shape in {"I/WIDE FLANGE", "STEEL I/WIDE FLANGE"}:
        depth, width, flange, web = sizes("D", "B", "TF", "TW")
        return Profile.i(depth=depth, width=width, web=web, flange=flange, material=STEEL)
    try:  # of a catalogue, by its name
        depth, width, web, flange, radius = (size / length for size in rolled_sizes(shape))
    except InputError:
        raise InputError(
            f"{one.place}: a section of shape {keys.get('SHAPE', 'none')!r} is not read; "
            "rectangles, circles, pipes, tubes, I, and W, IPE and HE sections by name are"
        ) from None
    return Profile.i(
        depth=depth, width=width, web=web, flange=flange, radius=radius, material=STEEL
    )


def area_section(rows: Rows, one: Statement, name: str) -> None:
    """Add a slab or wall to the tables, with its material, if it is new.

    Parameters
    ----------
    rows : Rows
        Takes them.
    one : Statement
        Who names it.
    name : str
        Its name.

    Raises
    ------
    InputError
        It is not there, or of a kind that is not read.
    """
    if not rows.once("AREA SECTION PROPERTIES", name):
        return
    keys = rows.properties.get(f"plate {name}")
    if keys is None:
        raise InputError(f"{one.place}: names section {name!r}, which is not there")
    if (
        keys.get("PROPTYPE", "SLAB").upper() == "DECK"
        or keys.get("SLABTYPE", "SLAB").upper() != "SLAB"
    ):
        raise InputError(f"{one.place}: {name!r} is no slab or wall of one thickness")
    thick = next(
        (keys[k] for k in ("SLABTHICKNESS", "WALLTHICKNESS", "TM", "TB") if k in keys), None
    )
    if thick is None:
        raise InputError(f"{one.place}: {name!r} has no thickness")
    _material_row(rows, one, keys.get("MATERIAL", ""))
    kind = re.sub("[^A-Z]", "", keys.get("MODELINGTYPE", keys.get("TYPE", "SHELLTHIN")).upper())
    kinds = {"SHELLTHIN": "Shell-Thin", "SHELLTHICK": "Shell-Thick", "SHELL": "Shell-Thin"}
    rows.row(
        "AREA SECTION PROPERTIES", one.place, Section=name, Material=keys.get("MATERIAL", ""),
        AreaType="Shell", Type=kinds.get(kind, kind), Thickness=thick,
        BendThick=keys.get("TB", thick), **{k: v for k, v in keys.items() if k.endswith("MOD")},
    )  # fmt: skip

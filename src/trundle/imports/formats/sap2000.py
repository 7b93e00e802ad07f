"""SAP2000 text files (.s2k): frames, areas, springs, constraints and masses; other tables are told.

Masses are lumped at joints, as SAP2000's are.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path

import numpy as np
from jaxtyping import Float

from trundle._typing import Array
from trundle.errors import InputError, Problem
from trundle.imports.model_format import Asked, ModelFormat, ReadModel
from trundle.imports.sap_areas import areas_placed, cracks, plates_of, unjoined
from trundle.imports.sap_frames import beams_of, frames_placed
from trundle.imports.sap_joints import constraints_of, joints_of, restraints_of, springs_of
from trundle.imports.sap_makes import areas_of, frames_of, materials_of
from trundle.imports.sap_masses import masses_of
from trundle.imports.sap_tables import Table, read_tables
from trundle.imports.unit_system import Units, agreed_units, in_si, units_of
from trundle.structure import Floor, PointMasses
from trundle.structure.elements import NodeInertia

__all__ = ["FORMAT", "floor_of_tables", "where_apart"]

_READ = {
    "PROGRAM CONTROL", "ACTIVE DEGREES OF FREEDOM", "JOINT COORDINATES",
    "JOINT LOCAL AXES ASSIGNMENTS 1 - TYPICAL", "JOINT RESTRAINT ASSIGNMENTS",
    "JOINT CONSTRAINT ASSIGNMENTS", "JOINT SPRING ASSIGNMENTS 1 - UNCOUPLED",
    "JOINT ADDED MASS ASSIGNMENTS", "JOINT ADDED MASS ASSIGNMENTS 1 - BY MASS",
    "CONNECTIVITY - FRAME", "FRAME SECTION ASSIGNMENTS", "FRAME SECTION PROPERTIES 01 - GENERAL",
    "FRAME LOCAL AXES ASSIGNMENTS 1 - TYPICAL", "FRAME RELEASE ASSIGNMENTS 1 - GENERAL",
    "FRAME OFFSET (LENGTH) ASSIGNMENTS", "FRAME OFFSET ALONG LENGTH ASSIGNMENTS",
    "FRAME INSERTION POINT ASSIGNMENTS", "FRAME AUTO MESH ASSIGNMENTS",
    "FRAME ADDED MASS ASSIGNMENTS", "CONNECTIVITY - AREA", "AREA SECTION ASSIGNMENTS",
    "AREA SECTION PROPERTIES", "AREA AUTO MESH ASSIGNMENTS",
    "AREA LOCAL AXES ASSIGNMENTS 1 - TYPICAL", "AREA ADDED MASS ASSIGNMENTS",
    "AREA STIFFNESS MODIFIERS", "FRAME PROPERTY MODIFIERS", "AREA EDGE CONSTRAINT ASSIGNMENTS",
    "MATERIAL PROPERTIES 01 - GENERAL", "MATERIAL PROPERTIES 02 - BASIC MECHANICAL PROPERTIES",
    "MASS SOURCE", "MASSES 1 - MASS SOURCE",
}  # fmt: skip

_NOTHING = re.compile(
    "^("
    + "|".join(
        (
            "PROJECT INFORMATION", "COORDINATE SYSTEMS", "GRID LINES", "GROUPS", "DATABASE FORMAT",
            "PREFERENCES", "OVERWRITES", "OPTIONS", "LOAD", "CASE", "COMBINATION", "FUNCTION",
            "ANALYSIS", "AUTO ", "BRIDGE", "NAMED", "TABLES", "MATERIAL PROPERTIES 0[3-9]", "REBAR",
            "FRAME SECTION PROPERTIES (0[2-4]|1)", "FRAME (OUTPUT|DESIGN|OVERWRITES - |LOAD)",
            "FRAME (BUCKLING|HINGE)", "AREA (LOADS|DESIGN|OUTPUT)",
            "AREA SECTION PROPERTY (DESIGN|- TIME)", "JOINT (LOADS|PATTERN|ADDED PATTERN)",
            "JOINT PANEL ZONE DESIGN", "SECTION DESIGNER", "HINGES DEF", "LANE", "VEHICLE",
            "PUSHOVER", "SOLID PROPERTY", "CABLE SECTION", "TENDON SECTION",
            "LINK PROPERTY DEFINITIONS", "VIEW", "PROGRAM", "MISC", "STEEL", "CONCRETE", "ALUMINUM",
            "COLD", "SECTION CUT", "GENERALIZED", "RESPONSE", "TARGET", "RUN", "DEFAULT", "MODAL",
            "BASE REACTION", "SELECTION",
        )
    )
    + ")"
)  # fmt: skip
"""Tables that hold nothing of the structure: drawing, loads, cases, design, what is asked for."""


def read(path: Path, asked: Asked) -> ReadModel:
    """Read tables as text.

    Parameters
    ----------
    path : Path
        A file that SAP2000 has exported as text.
    asked : Asked
        Tables to be passed over.
    """
    try:
        tables = read_tables(path)
        unread = [t for name, t in tables.items() if not _is_read(name) and t.rows]
        ignored = {name.upper() for name in asked.ignore}
        wrong = [t for t in unread if not _NOTHING.match(t.name) and t.name not in ignored]
        if wrong:
            return ReadModel(
                structure=None, problems=tuple(_not_read(one) for one in wrong), files=(path,)
            )
        units, said = agreed_units(_stated(tables), asked.units)
        floor, apart = floor_of_tables(tables, units, path.stem)
        floor = in_si(floor, units)
    except InputError as error:
        problem = Problem(
            place=path.name, value="the model", rule=str(error), remedy="docs/models.md"
        )
        return ReadModel(structure=None, problems=(problem,), files=(path,))
    told = [f"passed over: {table.name} ({len(table.rows)})" for table in unread]
    told += [
        f"not used of {name}: {', '.join(table.unused)}"
        for name, table in tables.items()
        if _is_read(name) and table.unused
    ]
    if len(apart):
        told.append(
            f"{where_apart(apart)}: there they are apart, as in SAP2000 without constraints"
        )
    return ReadModel(structure=floor, units=units, told=(*said, *told), files=(path,))


def where_apart(places: Float[Array, "n 3"]) -> str:
    """Say where areas meet without sharing nodes.

    Parameters
    ----------
    places : ndarray of float, shape (n, 3)
        In the file's units.
    """
    first = ", ".join(f"{value:.4g}" for value in places[0])
    return f"areas and frames meet at {len(places)} places without sharing nodes: ({first})"


def _is_read(name: str) -> bool:
    return name in _READ or name.startswith("CONSTRAINT DEFINITIONS")


def _not_read(table: Table) -> Problem:
    return Problem(
        place=table.place,
        value=table.name,
        rule="this table is not read, and nothing is left out in silence",
        remedy="if it is nothing of the structure, put it into ignore = [..]; docs/models.md lists "
        "what is read",
    )


def _stated(tables: Mapping[str, Table]) -> Units | None:
    control = tables.get("PROGRAM CONTROL")
    if control is None or not control.rows:
        return None
    row = control.rows[0]
    try:
        return units_of(row.text("CurrUnits"))
    except InputError as error:
        raise InputError(f"{row.place}: {error}") from None


def floor_of_tables(
    tables: Mapping[str, Table], units: Units, name: str
) -> tuple[Floor, Float[Array, "n 3"]]:
    """Return the structure that tables hold, in their units, and where areas do not meet.

    Parameters
    ----------
    tables : mapping of str to Table
        By title.
    units : Units
        Theirs.
    name : str
        Of the structure.

    Raises
    ------
    InputError
        What is missing, or cannot be made of them.
    """

    def table(title: str) -> Table:
        """Return a table, without rows where it is not there."""
        return tables.get(title) or Table(name=title, place=name)

    if "JOINT COORDINATES" not in tables:
        raise InputError("has no joints: export the model definition, all tables")
    _check_names(tables)
    joints = joints_of(
        tables["JOINT COORDINATES"], tables.get("JOINT LOCAL AXES ASSIGNMENTS 1 - TYPICAL")
    )
    materials = materials_of(
        table("MATERIAL PROPERTIES 01 - GENERAL"),
        table("MATERIAL PROPERTIES 02 - BASIC MECHANICAL PROPERTIES"),
    )
    areas = areas_placed(joints, tables, areas_of(table("AREA SECTION PROPERTIES"), materials))
    makes = frames_of(table("FRAME SECTION PROPERTIES 01 - GENERAL"), materials)
    parts = frames_placed(joints, tables, makes)
    masses = masses_of(joints, parts, areas, tables, 9.80665 / units.length)
    fixed = restraints_of(
        joints, tables.get("JOINT RESTRAINT ASSIGNMENTS"), tables.get("ACTIVE DEGREES OF FREEDOM")
    )
    shells, triangles = plates_of(areas)
    beams, released = beams_of(parts)
    floor = Floor(
        nodes=np.array(joints.places),
        fixed=fixed,
        shells=tuple(shells),
        beams=tuple(beams),
        springs=tuple(springs_of(joints, tables.get("JOINT SPRING ASSIGNMENTS 1 - UNCOUPLED"))),
        masses=tuple(one for one in masses if isinstance(one, PointMasses)),
        others=(*triangles, *released, *(m for m in masses if isinstance(m, NodeInertia))),
        links=constraints_of(joints, fixed, tables),
        name=name,
    )
    ends = np.unique(np.array([part.nodes for part in parts]).reshape(-1).astype(int))
    return floor, np.concatenate([cracks(joints, areas), unjoined(joints, areas, ends)])


_CLOSED = {
    "JOINT RESTRAINT ASSIGNMENTS": {"joint", "u1", "u2", "u3", "r1", "r2", "r3"},
    "ACTIVE DEGREES OF FREEDOM": {"ux", "uy", "uz", "rx", "ry", "rz"},
    "FRAME RELEASE ASSIGNMENTS 1 - GENERAL": {
        "frame", "pi", "v2i", "v3i", "ti", "m2i", "m3i", "pj", "v2j", "v3j", "tj", "m2j", "m3j",
        "partialfix",
    },
    "FRAME PROPERTY MODIFIERS": {
        "frame", "amod", "as2mod", "as3mod", "jmod", "i22mod", "i33mod", "massmod", "weightmod",
    },
    "AREA STIFFNESS MODIFIERS": {
        "area", "f11", "f22", "f12", "m11", "m22", "m12", "v13", "v23", "massmod", "weightmod",
    },
}  # fmt: skip
"""Tables of which every key counts: one that is not known is no matter of drawing."""


def _check_names(tables: Mapping[str, Table]) -> None:
    """Refuse what is assigned to nothing, keys that cannot be left out, and what is there twice."""
    known = {
        "joint": _named(tables, "JOINT COORDINATES", "Joint"),
        "frame": _named(tables, "CONNECTIVITY - FRAME", "Frame"),
        "area": _named(tables, "CONNECTIVITY - AREA", "Area"),
    }
    for title, table in tables.items():
        if not _is_read(title) or not re.search("ASSIGNMENTS|MODIFIERS|ACTIVE", title):
            continue
        closed = _CLOSED.get(title)
        for row in table.rows:
            for thing, names in known.items():
                name = row.cells.get(thing, "")
                if name and name not in names:
                    raise InputError(f"{row.place}: names {thing} {name!r}, which is not there")
            if closed is not None and (odd := set(row.cells) - closed):
                raise InputError(f"{row.place}: {sorted(odd)[0]} is not known in {title.title()}")
    for title, key in (
        ("FRAME SECTION PROPERTIES 01 - GENERAL", "SectionName"),
        ("AREA SECTION PROPERTIES", "Section"),
        ("MATERIAL PROPERTIES 02 - BASIC MECHANICAL PROPERTIES", "Material"),
        ("FRAME SECTION ASSIGNMENTS", "Frame"),
        ("AREA SECTION ASSIGNMENTS", "Area"),
        ("PROGRAM CONTROL", "CurrUnits"),
    ):
        rows = tables[title].rows if title in tables else []
        if title != "PROGRAM CONTROL" and len(_named(tables, title, key)) < len(rows):
            raise InputError(f"{tables[title].place}: a {key} stands twice in {title.title()}")
        if title == "PROGRAM CONTROL" and len(rows) > 1:
            raise InputError(f"{rows[1].place}: PROGRAM CONTROL has one row")


def _named(tables: Mapping[str, Table], title: str, key: str) -> set[str]:
    rows = tables[title].rows if title in tables else []
    return {row.text(key, "") for row in rows}


FORMAT = ModelFormat(
    kind="sap2000",
    name="SAP2000 text file",
    suffixes=(".s2k", ".$2k"),
    claims=lambda data: re.search(rb'^\s*TABLE:\s*"', data, re.I | re.M) is not None,
    read=read,
)

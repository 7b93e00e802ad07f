"""Masses of SAP2000's tables: of elements, of joints, and of loads, lumped at nodes."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Float

from trundle._typing import Array
from trundle.errors import InputError
from trundle.imports.sap_areas import Area
from trundle.imports.sap_frames import FramePart
from trundle.imports.sap_joints import Joints
from trundle.imports.sap_tables import Row, Table
from trundle.structure import PointMasses
from trundle.structure.elements import NodeInertia
from trundle.structure.frames import plate_areas

__all__ = ["Lumps", "masses_of"]

_INERTIA = ("Mass1", "Mass2", "Mass3", "MMI1", "MMI2", "MMI3")
_GRAVITY = {"gravity", "grav"}
_OF_LOADS = {
    "JOINT LOADS - FORCE", "FRAME LOADS - DISTRIBUTED", "AREA LOADS - UNIFORM",
    "LOAD PATTERN DEFINITIONS",
}  # fmt: skip


@dataclass(frozen=True, kw_only=True, eq=False)
class Lumps:
    """Hold the inertia of nodes while it is gathered, in the file's units.

    Attributes
    ----------
    joints : Joints
        All nodes.
    parts : sequence of FramePart
        All frames; half the mass of each is at either end.
    areas : sequence of Area
        All areas; the mass of each element is at its corners, alike.
    at_joints : ndarray of float, shape (n_nodes, 6)
        What is at joints themselves.
    by_section : dict of str to ndarray of float, shape (n_nodes,)
        Mass of frames and areas by their sections.
    """

    joints: Joints
    parts: Sequence[FramePart]
    areas: Sequence[Area]
    at_joints: Float[Array, "nodes 6"]
    by_section: dict[str, Float[Array, " nodes"]] = field(default_factory=dict[str, Array])

    def _of(self, section: str) -> Array:
        return self.by_section.setdefault(section, np.zeros(len(self.at_joints)))

    def frames(self, per_length: Callable[[FramePart], float]) -> None:
        """Add mass along frames."""
        for part in self.parts:
            self._of(part.section)[list(part.nodes)] += 0.5 * per_length(part) * part.length

    def plates(self, per_area: Callable[[Area], float]) -> None:
        """Add mass over areas."""
        for area in self.areas:
            corners = area.elements.shape[1]
            mass = plate_areas(self.joints.at(area.elements)) * per_area(area) / corners
            np.add.at(self._of(area.section), area.elements.ravel(), np.repeat(mass, corners))

    def groups(self) -> Iterator[PointMasses | NodeInertia]:
        """Give all that has mass, a group a section."""
        for section, mass in self.by_section.items():
            heavy = np.flatnonzero(mass)
            if len(heavy):
                yield PointMasses(nodes=heavy, mass=mass[heavy], name=f"{section}, lumped")
        heavy = np.flatnonzero(self.at_joints.any(axis=1))
        if len(heavy):
            yield NodeInertia(nodes=heavy, inertia=self.at_joints[heavy], name="joint masses")


def masses_of(
    joints: Joints,
    parts: Sequence[FramePart],
    areas: Sequence[Area],
    tables: Mapping[str, Table],
    gravity: float,
) -> tuple[PointMasses | NodeInertia, ...]:
    """Return all that has mass, in the file's units.

    Parameters
    ----------
    joints : Joints
        All nodes.
    parts : sequence of FramePart
        All frames.
    areas : sequence of Area
        All areas.
    tables : mapping of str to Table
        Added masses, the source of mass, and loads.
    gravity : float
        In the file's units.

    Raises
    ------
    InputError
        A source of mass, or loads in it, that is not read.
    """
    none = np.zeros((len(joints.places), 6))
    lumps = Lumps(joints=joints, parts=parts, areas=areas, at_joints=none)
    elements, added, patterns = _source(tables)
    if elements:
        frame = _added(tables, "FRAME ADDED MASS ASSIGNMENTS", "Frame", "MassPerLen")
        lumps.frames(lambda part: part.make.mass_per_length + frame.get(part.name, 0.0))
        area = _added(tables, "AREA ADDED MASS ASSIGNMENTS", "Area", "MassPerArea")
        lumps.plates(lambda one: one.make.mass_per_area + area.get(one.name, 0.0))
    if added:
        for row in _rows(tables, "JOINT ADDED MASS ASSIGNMENTS"):
            node = joints.node(row.text("Joint"), row.place)
            lumps.at_joints[node] += _joint_mass(joints, row)
    if patterns:
        _check_loads(tables, patterns)
        _of_weight(lumps, tables, patterns, gravity)
        _of_loads(lumps, tables, patterns, gravity)
    return tuple(lumps.groups())


def _rows(tables: Mapping[str, Table], title: str) -> Iterator[Row]:
    """Give the rows of a table, or of that of its later name."""
    for name, table in tables.items():
        if name in {title, f"{title} 1 - BY MASS"}:
            yield from table.rows


def _joint_mass(joints: Joints, row: Row) -> Array:
    if row.text("Joint") in joints.turned:
        raise InputError(f"{row.place}: mass of a joint in axes of its own is not read")
    row.text("CoordSys", "Local")
    row.text("Type", "")
    mass = np.array([row.number(key, 0.0) for key in _INERTIA])
    if np.any(mass < 0.0):
        raise InputError(f"{row.place}: mass must be 0 or more; got {mass.min():g}")
    return mass


def _added(tables: Mapping[str, Table], title: str, thing: str, key: str) -> dict[str, float]:
    table = tables.get(title)
    rows = table.rows if table else ()
    return {row.text(thing): row.number(key) for row in rows}


def _source(tables: Mapping[str, Table]) -> tuple[bool, bool, dict[str, float]]:
    """Return whether elements and joints have mass, and by how much which loads do."""
    table = tables.get("MASS SOURCE") or tables.get("MASSES 1 - MASS SOURCE")
    if table is None:
        return True, True, {}
    loads: dict[str, float] = {}
    elements = added = True
    default = next((r.text("MassSource", "") for r in table.rows if r.yes("IsDefault")), None)
    for row in table.rows:
        if default is not None and row.text("MassSource", default) != default:
            continue
        if "massfrom" in row.cells:
            words = row.text("MassFrom").lower()
            if not re.search("element|load", words):
                raise InputError(f"{row.place}: a source of mass {words!r} is not known")
            elements = added = "element" in words
        elif "elements" in row.cells:
            elements, added = row.yes("Elements"), row.yes("Masses")
            row.yes("Loads")
        if "loadpat" in row.cells:
            loads[row.text("LoadPat")] = row.number("Multiplier", 1.0)
    return elements, added, loads


def _check_loads(tables: Mapping[str, Table], patterns: Mapping[str, float]) -> None:
    for name, table in tables.items():
        for row in table.rows if " LOADS - " in name and name not in _OF_LOADS else ():
            if row.text("LoadPat", "") in patterns:
                raise InputError(f"{row.place}: {name.title()} are not read as a source of mass")


def _of_weight(
    lumps: Lumps, tables: Mapping[str, Table], patterns: Mapping[str, float], gravity: float
) -> None:
    """Add the mass of elements' own weight, where a pattern holds it."""
    table = tables.get("LOAD PATTERN DEFINITIONS")
    for row in table.rows if table else ():
        share = patterns.get(row.text("LoadPat"), 0.0) * row.number("SelfWtMult", 0.0) / gravity
        if share:
            lumps.frames(lambda part, s=share: s * part.make.weight_per_length)
            lumps.plates(lambda area, s=share: s * area.make.weight_per_area)


def _of_loads(
    lumps: Lumps, tables: Mapping[str, Table], patterns: Mapping[str, float], gravity: float
) -> None:
    """Add the masses of loads that press down, by the shares of their patterns."""
    for row, share in _loads(tables, "JOINT LOADS - FORCE", patterns):
        node = lumps.joints.node(row.text("Joint"), row.place)
        if row.text("CoordSys", "GLOBAL").upper() != "GLOBAL":
            raise InputError(f"{row.place}: a force in another system is not read as mass")
        weight = -row.number("F3", 0.0)
        _check(row, weight)
        lumps.at_joints[node, :3] += share * weight / gravity
    frames, areas = defaultdict[str, float](float), defaultdict[str, float](float)
    for row, share in _loads(tables, "FRAME LOADS - DISTRIBUTED", patterns):
        weight = _down(row, row.number("FOverLA"))
        even = row.number("FOverLB") == row.number("FOverLA")
        if not even or row.number("RelDistA", 0.0) != 0.0 or row.number("RelDistB", 1.0) != 1.0:
            raise InputError(f"{row.place}: a load on part of a frame is not read as mass")
        frames[row.text("Frame")] += share * weight / gravity
    for row, share in _loads(tables, "AREA LOADS - UNIFORM", patterns):
        weight = _down(row, row.number("UnifLoad"))
        areas[row.text("Area")] += share * weight / gravity
    lumps.frames(lambda part: frames[part.name])
    lumps.plates(lambda area: areas[area.name])


def _loads(
    tables: Mapping[str, Table], name: str, patterns: Mapping[str, float]
) -> Iterator[tuple[Row, float]]:
    for row in tables[name].rows if name in tables else ():
        share = patterns.get(row.text("LoadPat"), 0.0)
        if share:
            yield row, share


def _down(row: Row, value: float) -> float:
    """Return a load that presses down, by its direction."""
    way = row.text("Dir", "Gravity").lower()
    system = row.text("CoordSys", "GLOBAL").lower()
    if way in {"x", "y"} and system == "global":
        return 0.0  # of no weight
    if way == "z" and system == "global":
        value = -value
    elif way not in _GRAVITY:
        raise InputError(f"{row.place}: a load along {way} ({system}) is not read as mass")
    _check(row, value)
    return value


def _check(row: Row, weight: float) -> None:
    if weight < 0.0:
        raise InputError(f"{row.place}: a load that lifts is no mass")

"""Joints of SAP2000's tables: where they are, what holds them, and which move as one."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Bool, Float

from trundle._typing import Array
from trundle.errors import InputError
from trundle.imports.sap_tables import Row, Table
from trundle.structure import RigidLinks, SpringGroup
from trundle.structure.elements import GROUND

__all__ = ["Joints", "constraints_of", "joints_of", "restraints_of", "springs_of"]

_DOFS = ("U1", "U2", "U3", "R1", "R2", "R3")
_ACTIVE = ("UX", "UY", "UZ", "RX", "RY", "RZ")
_IN_PLAN = np.array([True, True, False, False, False, True])


@dataclass(kw_only=True, eq=False)
class Joints:
    """Nodes of a model: its joints, and those that meshes and offsets add.

    Attributes
    ----------
    rows : dict of str to int
        Node of each joint.
    places : list of ndarray of float, shape (3,)
        In the file's units.
    turned : set of str
        Joints with local axes of their own.
    leads, follows : list of int
        Nodes that follow joints as rigid bodies.
    """

    rows: dict[str, int] = field(default_factory=dict[str, int])
    places: list[Array] = field(default_factory=list[Array])
    turned: set[str] = field(default_factory=set[str])
    leads: list[int] = field(default_factory=list[int])
    follows: list[int] = field(default_factory=list[int])

    def node(self, name: str, place: str) -> int:
        """Return the node of a joint.

        Raises
        ------
        InputError
            No joint is called so.
        """
        if name not in self.rows:
            raise InputError(f"{place}: names joint {name!r}, which is not there")
        return self.rows[name]

    def at(self, nodes: Array) -> Float[Array, "*nodes 3"]:
        """Return where nodes are."""
        return np.array(self.places)[nodes]

    def add(self, place: Array) -> int:
        """Return a new node."""
        self.places.append(np.asarray(place, dtype=float))
        return len(self.places) - 1

    def behind(self, node: int, offset: Array) -> int:
        """Return a node that follows another, off by a vector; itself where that is nought."""
        if not np.any(offset):
            return node
        new = self.add(self.places[node] + offset)
        self.leads.append(node)
        self.follows.append(new)
        return new


def joints_of(coordinates: Table, axes: Table | None) -> Joints:
    """Return the joints.

    Parameters
    ----------
    coordinates : Table
        JOINT COORDINATES.
    axes : Table or None
        JOINT LOCAL AXES ASSIGNMENTS 1 - TYPICAL.

    Raises
    ------
    InputError
        A joint that stands there twice, or in a system that is not read.
    """
    joints = Joints()
    for row in coordinates.rows:
        name = row.text("Joint")
        if name in joints.rows:
            raise InputError(f"{row.place}: joint {name!r} is there twice")
        joints.rows[name] = joints.add(_place(row))
    for row in axes.rows if axes else ():
        if any(row.number(key, 0.0) for key in ("AngleA", "AngleB", "AngleC")):
            joints.turned.add(row.text("Joint"))
    return joints


def _place(row: Row) -> Array:
    for key in ("SpecialJt",):  # of drawing alone
        row.text(key, "No")
    system, kind = row.text("CoordSys", "GLOBAL"), row.text("CoordType", "Cartesian")
    theirs = [row.text(key, "0") for key in ("XorR", "Y", "T", "Z")]
    if "globalx" in row.cells:
        return np.array([row.number(f"Global{axis}", 0.0) for axis in "XYZ"])
    if system.upper() != "GLOBAL" or kind.lower() != "cartesian":
        raise InputError(
            f"{row.place}: a place in {system} ({kind}) needs GlobalX, GlobalY, GlobalZ"
        )
    del theirs
    return np.array([row.number("XorR", 0.0), row.number("Y", 0.0), row.number("Z", 0.0)])


def restraints_of(
    joints: Joints, restraints: Table | None, active: Table | None
) -> Bool[Array, "nodes 6"]:
    """Return which dofs of which nodes are held.

    Parameters
    ----------
    joints : Joints
        All nodes.
    restraints : Table or None
        JOINT RESTRAINT ASSIGNMENTS.
    active : Table or None
        ACTIVE DEGREES OF FREEDOM.
    """
    fixed = np.zeros((len(joints.places), 6), dtype=bool)
    for row in restraints.rows if restraints else ():
        name = row.text("Joint")
        held = [row.yes(dof) for dof in _DOFS]
        if name in joints.turned and (
            any(held[:3]) != all(held[:3]) or any(held[3:]) != all(held[3:])
        ):
            raise InputError(f"{row.place}: joint {name!r} is held in part in axes of its own")
        fixed[joints.node(name, row.place)] |= held
    for row in active.rows if active else ():
        still = [not row.yes(dof, default=True) for dof in _ACTIVE]
        followers = np.zeros(len(fixed), dtype=bool)
        followers[joints.follows] = True  # they are still where those are that they follow
        fixed[~followers] |= np.array(still)
    return fixed


def springs_of(joints: Joints, table: Table | None) -> list[SpringGroup]:
    """Return springs to the ground.

    Parameters
    ----------
    joints : Joints
        All nodes.
    table : Table or None
        JOINT SPRING ASSIGNMENTS 1 - UNCOUPLED.
    """
    found: dict[tuple[float, ...], list[int]] = defaultdict(list)
    for row in table.rows if table else ():
        name = row.text("Joint")
        if name in joints.turned:
            raise InputError(f"{row.place}: springs of joint {name!r} are in axes of its own")
        row.text("CoordSys", "Local")
        stiffness = tuple(row.number(dof, 0.0) for dof in _DOFS)
        found[stiffness].append(joints.node(name, row.place))
    return [
        SpringGroup(
            elements=np.column_stack([nodes, np.full(len(nodes), GROUND)]),
            stiffness=np.array(stiffness),
            name="joint spring",
        )
        for stiffness, nodes in found.items()
    ]


def constraints_of(
    joints: Joints, fixed: Bool[Array, "nodes 6"], tables: Mapping[str, Table]
) -> tuple[RigidLinks, ...]:
    """Return which nodes follow which: bodies, diaphragms and offsets of frames.

    Parameters
    ----------
    joints : Joints
        All nodes.
    fixed : ndarray of bool, shape (n_nodes, 6)
        What is held: who leads is chosen among those.
    tables : mapping of str to Table
        JOINT CONSTRAINT ASSIGNMENTS and CONSTRAINT DEFINITIONS of bodies and diaphragms.

    Raises
    ------
    InputError
        A constraint of another kind, or one that is not defined.
    """
    kinds = _kinds(tables)
    members: dict[str, list[int]] = defaultdict(list)
    assigned = tables.get("JOINT CONSTRAINT ASSIGNMENTS")
    for row in assigned.rows if assigned else ():
        name = row.text("Constraint")
        row.text("Type", "")
        if name not in kinds:
            raise InputError(f"{row.place}: names constraint {name!r}, which is not defined")
        members[name].append(joints.node(row.text("Joint"), row.place))
    body, plan = ([], []), ([], [])
    for name, nodes in members.items():
        lead = max(nodes, key=lambda node, k=kinds[name]: int(fixed[node][k].sum()))
        leads, behind = body if kinds[name].all() else plan
        others = [node for node in dict.fromkeys(nodes) if node != lead]
        leads += [lead] * len(others)
        behind += others
    root = dict(zip(body[1], body[0], strict=True))
    first = [root.get(node, node) for node in joints.leads]
    return tuple(
        RigidLinks(leads=np.array(leads), follows=np.array(behind), dofs=dofs)
        for leads, behind, dofs in (
            (body[0] + first, body[1] + joints.follows, np.ones(6, dtype=bool)),
            (plan[0], plan[1], _IN_PLAN),
        )
        if behind
    )


def _kinds(tables: Mapping[str, Table]) -> dict[str, Array]:
    """Return the dofs that each constraint ties."""
    found: dict[str, Array] = {}
    title = "CONSTRAINT DEFINITIONS - "
    for name, table in tables.items():
        if not name.startswith(title):
            continue
        for row in table.rows:
            row.text("CoordSys", "GLOBAL")
            if name == title + "DIAPHRAGM":
                if row.text("Axis", "Z").upper() not in {"Z", "AUTO"} or row.yes("MultiLevel"):
                    raise InputError(f"{row.place}: a diaphragm across Z of one level is read")
                found[row.text("Name")] = _IN_PLAN
            elif name == title + "BODY":
                if not all(row.yes(dof, default=True) for dof in _ACTIVE):
                    raise InputError(f"{row.place}: a body that is rigid in all six dofs is read")
                found[row.text("Name")] = np.ones(6, dtype=bool)
            else:
                raise InputError(
                    f"{row.place}: {name.title()} is not read; bodies and diaphragms are"
                )
    return found

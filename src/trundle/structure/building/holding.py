"""Hold a building: at the feet of columns and walls, at supports, in planes of symmetry."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import pairwise

import numpy as np
from jaxtyping import Bool, Float

from trundle._typing import Array
from trundle.structure.building.held import ON_PLANE, Base, share_inside
from trundle.structure.building.holds import Holds
from trundle.structure.building.nodes import Nodes
from trundle.structure.building.parts import Building
from trundle.structure.building.sheets import has_slab, passes
from trundle.structure.elements import GROUND, JointSprings, PointMasses, SpringGroup
from trundle.structure.links import RigidLinks
from trundle.structure.mesh.merging import linked
from trundle.structure.mesh.polygons import covers
from trundle.structure.mesh.sheet_mesh import SheetMesh
from trundle.structure.model import MirrorPlane

__all__ = ["heads", "held_dofs", "joints", "masses", "springs"]

_PINNED = np.array([True, True, True, False, False, False])
_ACROSS_X = np.array([True, False, False, False, True, True])


def held_dofs(
    building: Building,
    mesh: SheetMesh,
    nodes: Nodes,
    xyz: Float[Array, "nodes 3"],
    idle: Iterable[tuple[int, Bool[Array, " 6"], float]],
) -> tuple[Bool[Array, "nodes 6"], Float[Array, "nodes 2"] | None]:
    """Return which dofs are held, and how far the axes are turned along which they are.

    `idle` are rotations that turn nothing, see `idle_rotations`.
    """
    holds = Holds(len(xyz))
    for base, some, _ in _feet(building, mesh, nodes):
        if isinstance(base, str):
            holds.add(some, np.ones(6, dtype=bool) if base == "fixed" else _PINNED)
    for support in building.supports:
        some, _ = _pieces(building, mesh, support.on, support.along)
        holds.add(some, np.array(support.held), np.radians(support.angle))
    for plane in building.mirrors:
        on = np.flatnonzero(np.abs(plane.away(xyz)) < ON_PLANE)
        # no motion across it, and no rotation out of it
        holds.add(on, _ACROSS_X, float(np.arctan2(plane.normal[1], plane.normal[0])))
    for node, held, angle in idle:
        holds.add(np.array([node]), held, angle)
    return holds.found()


def _feet(building: Building, mesh: SheetMesh, nodes: Nodes) -> Iterator[tuple[Base, Array, Array]]:
    """Give what ends of columns and walls stand on, their nodes, and each one's length [m]."""
    for column in building.columns:
        ends: tuple[tuple[Base | None, str], ...] = (
            (column.base, column.bottom),
            (column.cap, column.top),
        )
        for base, storey in ends:
            if base is not None:
                node = nodes.at(storey, column.at, f"column {column.name!r}")
                yield base, np.array([node]), share_inside(column.at[None, None], building.mirrors)
    number = {name: i for i, name in enumerate(building.floors)}
    for wall in building.walls:
        if wall.base is not None:
            some = mesh.along(number[wall.bottom], wall.along)
            yield wall.base, some, _tributary(mesh.nodes[some], building.mirrors)


def _tributary(places: Array, planes: Sequence[MirrorPlane]) -> Array:
    """Return the length of a line that belongs to each of its nodes [m]."""
    steps = np.linalg.norm(np.diff(places, axis=0), axis=1)
    steps *= share_inside(np.stack([places[:-1], places[1:]], axis=1), planes)
    return 0.5 * (np.concatenate([[0.0], steps]) + np.concatenate([steps, [0.0]]))


def _pieces(building: Building, mesh: SheetMesh, on: str, along: Array) -> tuple[Array, Array]:
    """Return the nodes of a line or a place, and the length that belongs to each [m], or 1."""
    sheet = list(building.floors).index(on)
    if len(along) == 1:
        found = mesh.at(sheet, along[0])
        some = np.array([] if found is None else [found], dtype=np.intp)
        return some, share_inside(mesh.nodes[some][:, None], building.mirrors)
    rows = [mesh.along(sheet, np.stack(pair)) for pair in pairwise(along)]
    lengths = [_tributary(mesh.nodes[row], building.mirrors) for row in rows]
    some, place = np.unique(np.concatenate(rows), return_inverse=True)
    return some, np.bincount(place, weights=np.concatenate(lengths))


def springs(building: Building, mesh: SheetMesh, nodes: Nodes) -> Iterator[SpringGroup]:
    """Give springs to the ground: under columns and walls, and at supports."""
    found: list[tuple[str, Array, Array, Array]] = []
    for base, some, length in _feet(building, mesh, nodes):
        if not isinstance(base, str):
            found.append(("ground", some, length, np.array(base)))
    for support in building.supports:
        if any(support.springs):
            some, length = _pieces(building, mesh, support.on, support.along)
            found.append((support.name, some, length, np.array(support.springs)))
    for name, some, length, stiffness in found:
        for share, at in _alike(some, length):
            ends = np.stack([at, np.full(len(at), GROUND)], axis=1)
            yield SpringGroup(elements=ends, stiffness=share * stiffness, name=name)


def joints(building: Building, mesh: SheetMesh) -> Iterator[JointSprings]:
    """Give the springs of joints: from every node of one edge to the nearest of the other."""
    for joint in building.joints:
        some, length = _pieces(building, mesh, joint.on, joint.along)
        others, _ = _pieces(building, mesh, joint.on, joint.to)
        ways = mesh.nodes[some][:, None, :2] - mesh.nodes[others][None, :, :2]
        nearest = others[np.argmin(np.linalg.norm(ways, axis=2), axis=1)]
        yield JointSprings(
            elements=np.stack([some, nearest], axis=1),
            stiffness=length[:, None] * np.array(joint.springs),
            name=joint.name,
        )


def masses(building: Building, mesh: SheetMesh) -> Iterator[PointMasses]:
    """Give point masses, those of lines by the length that belongs to each node."""
    for mass in building.masses:
        some, length = _pieces(building, mesh, mass.on, mass.along)
        yield PointMasses(nodes=some, mass=mass.mass * length, name=mass.name)


def _alike(nodes: Array, lengths: Array) -> Iterator[tuple[float, Array]]:
    """Give lengths, and the nodes that have them."""
    rounded = np.round(lengths, 9)
    for length in np.unique(rounded):
        yield float(length), nodes[rounded == length]


def heads(building: Building, mesh: SheetMesh, nodes: Nodes) -> tuple[RigidLinks, ...]:
    """Return which nodes of slabs lie in the cross-section of a column, and follow its axis."""
    leads, behind = [np.zeros(0, np.intp)], [np.zeros(0, np.intp)]
    there = {s.name: mesh.of(i) for i, s in enumerate(building.storeys)}
    may_follow = _followers(building, mesh, nodes)
    for column in building.columns:
        if column.head == "point":
            continue
        for storey in building.between(column.bottom, column.top):
            joined = has_slab(building, storey.name, column.at)
            if not joined or not passes(building, column, storey.name):
                continue
            head = nodes.at(storey.name, column.at, f"column {column.name!r}")
            some = there[storey.name]
            near = np.abs(mesh.nodes[some, :2] - column.at).max(axis=1)
            some = some[near <= np.hypot(column.profile.depth, column.profile.width)]
            follow = some[covers(column.footprint, (), mesh.nodes[some, :2])]
            follow = follow[(follow != head) & may_follow(head, follow)]
            leads.append(np.full(len(follow), head))
            behind.append(follow)
    return _as_blocks(np.concatenate(leads), np.concatenate(behind))


def _followers(
    building: Building, mesh: SheetMesh, nodes: Nodes
) -> Callable[[int, Array], Bool[Array, " some"]]:
    """Return what says which nodes may follow another: those that nothing holds otherwise.

    What a support holds does not move as a column's axis does, nor does what lies in a plane of
    symmetry, unless the axis lies in it too.
    """
    free = np.ones(len(mesh.nodes), dtype=bool)
    for base, some, _ in _feet(building, mesh, nodes):
        if isinstance(base, str):
            free[some] = False
    for support in building.supports:
        if any(support.held):
            free[_pieces(building, mesh, support.on, support.along)[0]] = False
    on = [np.abs(plane.away(mesh.nodes)) < ON_PLANE for plane in building.mirrors]

    def may_follow(head: int, some: Array) -> Array:
        """Return which of some nodes may follow a head."""
        out = free[some]
        for plane in on:
            out &= ~plane[some] | bool(plane[head])
        return out

    return may_follow


def _as_blocks(leads: Array, behind: Array) -> tuple[RigidLinks, ...]:
    """Return links of which no node follows two: heads that share a node are one block.

    Such are the heads of columns above and below a slab, and of columns that touch.
    """
    if not len(behind):
        return ()
    nodes, ends = np.unique(np.stack([leads, behind]), return_inverse=True)
    one, other = ends.reshape(2, -1)
    axis = np.full(len(nodes), -1)
    block = linked(np.stack([one, other], axis=1), len(nodes))
    axis[block[one]] = one  # any of the axes leads
    follow = np.flatnonzero(axis[block] != np.arange(len(nodes)))
    return (RigidLinks(leads=nodes[axis[block[follow]]], follows=nodes[follow]),)

"""Give a structure's elements bodies to be drawn: plates by thickness, members by their sections.

A vertex hangs on a node by an arm, and moves with it as a rigid body does. Of a member's section
area and second moments are known; it is drawn as the rectangle that has them.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from trundle._typing import Array
from trundle.structure import BeamGroup, Structure
from trundle.structure.elements import GROUND, Elements, JointSprings, ReleasedBeams
from trundle.structure.frames import beam_frames

__all__ = ["Solid", "moved", "solids_of"]

_THIN = 0.05  # m: what is drawn of plates and members whose size nobody says
_SIDES = np.array(
    [[0, 1, 5], [0, 5, 4], [1, 2, 6], [1, 6, 5], [2, 3, 7], [2, 7, 6], [3, 0, 4], [3, 4, 7],
     [0, 2, 1], [0, 3, 2], [4, 5, 6], [4, 6, 7]]
)  # fmt: skip


@dataclass(frozen=True, kw_only=True, eq=False)
class Solid:
    """Hold the body of a group of elements.

    Attributes
    ----------
    name : str
        Of the group.
    kind : str
        ``plate``, ``member``, ``spring`` or ``mass``.
    node : ndarray of int, shape (n_vertices,)
        Node that each vertex hangs on.
    arm : ndarray of float, shape (n_vertices, 3)
        From it to the vertex [m].
    triangles : ndarray of int, shape (n_triangles, 3)
        Outside faces, counterclockwise seen from outside.
    """

    name: str
    kind: str
    node: Int[Array, " vertices"]
    arm: Float[Array, "vertices 3"]
    triangles: Int[Array, "triangles 3"]


def solids_of(structure: Structure) -> tuple[Solid, ...]:
    """Return the bodies of all groups of elements, those of one name together."""
    found: dict[tuple[str, str], list[Solid]] = {}
    plates: dict[tuple[str, float], list[Array]] = {}
    for group in structure.elements:
        corners = group.connectivity
        if corners.shape[1] in {3, 4}:
            thick = float(getattr(getattr(group, "section", None), "thickness", _THIN))
            # a triangle is drawn as a quadrilateral of which two corners are one
            plates.setdefault((group.name, thick), []).append(corners[:, [0, 1, 2, -1]])
            continue
        for solid in _solids(structure.nodes, group):
            found.setdefault((solid.name, solid.kind), []).append(solid)
    for (name, thick), blocks in plates.items():
        solid = _plates(structure.nodes, name, np.concatenate(blocks), thick)
        found.setdefault((name, "plate"), []).append(solid)
    return tuple(_joined(solids) for solids in found.values())


def moved(
    solid: Solid, motion: Float[Array, "nodes 6"], nodes: Float[Array, "nodes 3"] | None = None
) -> Float[Array, "vertices 3"]:
    """Return how far vertices move with their nodes, or where they are then.

    Parameters
    ----------
    solid : Solid
        The body.
    motion : ndarray of float, shape (n_nodes, 6)
        Translations and rotations of all nodes [m], [rad].
    nodes : ndarray of float, shape (n_nodes, 3), optional
        Where these are: given, places are returned.
    """
    own = motion[solid.node]
    out = own[:, :3] + np.cross(own[:, 3:], solid.arm)
    return out if nodes is None else nodes[solid.node] + solid.arm + out


def _solids(nodes: Array, group: Elements) -> Iterator[Solid]:
    corners = group.connectivity
    if isinstance(group, ReleasedBeams):
        yield _members(nodes, group.beams)
    elif isinstance(group, BeamGroup):
        yield _members(nodes, group)
    elif isinstance(group, JointSprings):
        yield _marks(group.name, "spring", np.unique(corners), 0.1)
    elif corners.shape[1] == 2 and GROUND in corners:
        yield _marks(group.name, "spring", np.unique(corners[corners != GROUND]), 0.15)
    elif corners.shape[1] == 1:
        yield _marks(group.name, "mass", np.unique(corners), 0.05)


def _joined(solids: list[Solid]) -> Solid:
    first = np.cumsum([0, *(len(one.node) for one in solids[:-1])])
    return Solid(
        name=solids[0].name,
        kind=solids[0].kind,
        node=np.concatenate([one.node for one in solids]),
        arm=np.concatenate([one.arm for one in solids]),
        triangles=np.concatenate(
            [one.triangles + at for one, at in zip(solids, first, strict=True)]
        ),
    )


def _members(nodes: Array, group: BeamGroup) -> Solid:
    """Return bars between both ends of each member."""
    xyz = nodes[group.elements]
    _, frames = beam_frames(xyz, group.up)
    section = group.section
    depth = np.sqrt(12.0 * section.inertia_y / section.area)
    width = np.sqrt(12.0 * section.inertia_z / section.area)
    y, z = 0.5 * width * frames[:, 1], 0.5 * depth * frames[:, 2]
    ring = np.stack([-y - z, y - z, y + z, -y + z], axis=1) + group.offset
    arm = np.concatenate([ring, ring], axis=1).reshape(-1, 3)
    node = np.repeat(group.elements, 4, axis=1).ravel()
    first = 8 * np.arange(len(group.elements))[:, None, None]
    return Solid(
        name=group.name,
        kind="member",
        node=node,
        arm=arm,
        triangles=(first + _SIDES).reshape(-1, 3),
    )


def _plates(nodes: Array, name: str, corners: Array, thickness: float) -> Solid:
    """Return the upper and lower faces of plates, and sides where they end.

    Each node has one vertex above and one below a group's elements of one direction: those of
    other directions have their own.
    """
    xyz = nodes[corners]
    normal = np.cross(xyz[:, 2] - xyz[:, 0], xyz[:, 3] - xyz[:, 1])
    size = np.linalg.norm(normal, axis=1, keepdims=True)
    normal = normal / np.where(size > 0.0, size, 1.0)
    direction = np.round(normal, 3)
    key = np.column_stack([corners.ravel(), np.repeat(direction, corners.shape[1], axis=0)])
    _, first, which = np.unique(key, axis=0, return_index=True, return_inverse=True)
    which = which.reshape(corners.shape)
    owner = first // corners.shape[1]
    node, n = corners.ravel()[first], len(first)
    arm = 0.5 * thickness * normal[owner]
    upper = _fans(which)
    lower = _fans(which)[:, ::-1] + n
    return Solid(
        name=name,
        kind="plate",
        node=np.concatenate([node, node]),
        arm=np.concatenate([arm, -arm]),
        triangles=np.concatenate([upper, lower, _edges(which, n)]),
    )


def _fans(corners: Array) -> Array:
    """Return quadrilaterals as two triangles each, triangles as one."""
    second = corners[corners[:, 2] != corners[:, 3]]
    return np.concatenate([corners[:, [0, 1, 2]], second[:, [0, 2, 3]]])


def _edges(corners: Array, n: int) -> Array:
    """Return the sides along edges that one element alone has."""
    a, b = corners.ravel(), np.roll(corners, -1, axis=1).ravel()
    a, b = a[a != b], b[a != b]
    both = np.sort(np.column_stack([a, b]), axis=1)
    _, first, times = np.unique(both, axis=0, return_index=True, return_counts=True)
    free = first[times == 1]
    a, b = a[free], b[free]
    return np.concatenate([np.column_stack([a, a + n, b + n]), np.column_stack([a, b + n, b])])


def _marks(name: str, kind: str, nodes: Array, size: float) -> Solid:
    """Return small boxes at nodes."""
    half = 0.5 * size
    box = half * np.array(
        [[-1, -1, -1], [1, -1, -1], [1, 1, -1], [-1, 1, -1], [-1, -1, 1], [1, -1, 1], [1, 1, 1],
         [-1, 1, 1]]
    )  # fmt: skip
    first = 8 * np.arange(len(nodes))[:, None, None]
    return Solid(
        name=name,
        kind=kind,
        node=np.repeat(nodes, 8),
        arm=np.tile(box, (len(nodes), 1)),
        triangles=(first + _SIDES).reshape(-1, 3),
    )

"""Read nodes of which only the motion is known, and the faces between them that are stood on."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Float, Int
from scipy.spatial import Delaunay, QhullError

from trundle._typing import Array
from trundle.errors import InputError
from trundle.imports.number_tables import NumberTable, read_table
from trundle.structure import FaceGroup
from trundle.units import to_si

__all__ = ["DOFS", "NODE", "NodeTable", "faces_of", "read_nodes"]

NODE = ("node", "joint", "point", "grid", "id", "node_id", "gid")
"""What programs call a node."""

DOFS = tuple(
    (name, f"{kind}{axis}", *more)
    for name, kind, axis, more in (
        ("ux", "u", 1, ("t1", "dx", "x_displacement")),
        ("uy", "u", 2, ("t2", "dy", "y_displacement")),
        ("uz", "u", 3, ("t3", "dz", "z_displacement")),
        ("rx", "r", 1, ("rotx",)),
        ("ry", "r", 2, ("roty",)),
        ("rz", "r", 3, ("rotz",)),
    )
)
"""What programs call the six dofs of a node."""

_LEVEL = 2e-3  # m, within which nodes are of one level
_LONGEST = 1.75  # times the median side: longer triangles span openings and bays between slabs


@dataclass(frozen=True, kw_only=True, eq=False)
class NodeTable:
    """Hold nodes by their numbers.

    Attributes
    ----------
    labels : ndarray of str, shape (n_nodes,)
        As files call them.
    places : ndarray of float, shape (n_nodes, 3)
        Coordinates [m].
    name : str
        File that they came from.
    """

    labels: Array
    places: Float[Array, "nodes 3"]
    name: str

    def rows(self, labels: Array, place: str) -> Array:
        """Return the rows of nodes by their labels, of any shape.

        Raises
        ------
        InputError
            A label that is not there.
        """
        order = np.argsort(self.labels, kind="stable")
        at = np.minimum(np.searchsorted(self.labels[order], labels), len(order) - 1)
        rows = order[at]
        if wrong := labels[self.labels[rows] != labels].ravel().tolist():
            raise InputError(f"{place} names node {wrong[0]}, which is not in {self.name}")
        return rows


def read_nodes(table: NumberTable, length: float) -> NodeTable:
    """Return the nodes of a table with columns node, x, y, z.

    Parameters
    ----------
    table : NumberTable
        Rows in any order; a node that stands in several must lie at one place.
    length : float
        One unit of its places [m].

    Raises
    ------
    InputError
        Columns that are missing, or a node at two places.
    """
    labels = table.labels(NODE)
    for axis in "xyz":
        _check_unit(table, axis, length)
    places = length * np.column_stack([table.need((axis,)) for axis in "xyz"])
    unique, first, which = np.unique(labels, return_index=True, return_inverse=True)
    apart = np.abs(places - places[first][which]).max(axis=1)
    if np.any(apart > 0.0):
        row = int(apart.argmax())
        raise InputError(
            f"{table.name}, line {table.lines[row]}: node {labels[row]} is at another place before"
        )
    order = np.argsort(first, kind="stable")
    first = first[order]
    return NodeTable(labels=unique[order], places=places[first], name=table.name)


def _check_unit(table: NumberTable, axis: str, length: float) -> None:
    """Refuse places whose heading names another unit than the model's."""
    unit = table.unit_of((axis,))
    if unit in {"", "text", "unitless"}:
        return
    if abs(to_si(f"1 {unit}", "length") / length - 1.0) > 1e-9:
        raise InputError(f"{table.name}: {axis} is in {unit!r}, and the model's units are others")


def faces_of(
    nodes: NodeTable, elements: Path | None, *, smooth: bool, known: Int[Array, " some"]
) -> tuple[tuple[FaceGroup, ...], tuple[str, ...]]:
    """Return what is stood on, and what was assumed of it.

    Parameters
    ----------
    nodes : NodeTable
        All nodes.
    elements : Path or None
        Table of elements, with columns node_1 to node_2, node_3 or node_4; None: nodes of a level
        are joined by triangles, and those of one line by lines.
    smooth : bool
        Whether rotations are known.
    known : ndarray of int, shape (n_some,)
        Rows of nodes whose vertical motion is known.
    """
    if elements is not None:
        return _read_faces(nodes, read_table(elements), smooth=smooth), ()
    found = _joined(nodes.places, known)
    faces = tuple(
        FaceGroup(connectivity=block, smooth=smooth, name=name) for name, block in found.items()
    )
    if not faces:
        raise InputError(f"{nodes.name}: no two nodes lie at one height: nothing can be stood on")
    return faces, (
        "elements: none were given; between nodes of a level the motion is that of "
        + ("triangles" if any(f.connectivity.shape[1] == 3 for f in faces) else "lines")
        + f" with sides up to {_longest(nodes.places, faces):.3g} m, "
        + ("smooth by their rotations" if smooth else "straight from node to node"),
    )


def _read_faces(nodes: NodeTable, table: NumberTable, *, smooth: bool) -> tuple[FaceGroup, ...]:
    names = [(f"node_{i}", f"n{i}", f"joint{i}", f"node{i}") for i in range(1, 5)]
    given = [table.texts(words) for words in names]
    corners = np.column_stack([column for column in given if column is not None] or [[""]])
    n = np.sum(corners != "", axis=1)
    gaps = (np.diff((corners != "").astype(int), axis=1) > 0).any(axis=1)
    for wrong, why in ((n < 2, "names fewer than two nodes, in columns node_1 to node_4"),
                       (gaps, "a corner is missing between others")):  # fmt: skip
        if np.any(wrong):
            raise InputError(f"{table.name}, line {table.lines[np.flatnonzero(wrong)[0]]}: {why}")
    if table.unused:
        raise InputError(f"{table.unused[0]}; columns are node_1 to node_4")
    groups = []
    for k in sorted(set(n.tolist())):
        numbers = nodes.rows(corners[n == k, :k], table.name)
        _check_faces(nodes.places[numbers], numbers, table, np.flatnonzero(n == k))
        groups.append(FaceGroup(connectivity=numbers, smooth=smooth, name=f"{k} nodes"))
    return tuple(groups)


def _check_faces(at: Array, numbers: Array, table: NumberTable, rows: Array) -> None:
    """Refuse faces with a corner twice, without extent, folded, or there twice."""
    k = numbers.shape[1]
    repeated = np.array([len(set(row)) < k for row in numbers.tolist()])
    folded = np.zeros(len(numbers), dtype=bool)
    if k > 2:
        ahead, back = np.roll(at, -1, axis=1) - at, at - np.roll(at, 1, axis=1)
        turns = np.cross(back, ahead)
        whole = turns.sum(axis=1, keepdims=True)
        folded = (np.sum(turns * whole, axis=2) <= 0.0).any(axis=1)
    for wrong, why in ((repeated, "names a node twice"), (folded, "is folded, or has no extent")):
        if wrong.any():
            raise InputError(f"{table.name}, line {table.lines[rows[wrong][0]]}: a face {why}")
    if len(np.unique(np.sort(numbers, axis=1), axis=0)) < len(numbers):
        raise InputError(f"{table.name}: a face stands in it twice")


def _joined(places: Array, known: Array) -> dict[str, Array]:
    """Return triangles between nodes of each level, or lines between those of one line."""
    triangles, lines = list[Array](), list[Array]()
    z = places[known, 2]
    order = known[np.argsort(z, kind="stable")]
    levels = np.split(order, np.flatnonzero(np.diff(places[order, 2]) > _LEVEL) + 1)
    for level in levels:
        flat = places[level, :2]
        if len(level) < 2:
            continue
        middle = flat - flat.mean(axis=0)
        size, ways = np.linalg.svd(middle, full_matrices=False)[1:]
        if len(level) == 2 or size[1] < 1e-6 * size[0]:
            along = level[np.argsort(middle @ ways[0], kind="stable")]
            lines.append(np.column_stack([along[:-1], along[1:]]))
        elif (made := _triangles(flat)) is not None:
            triangles.append(level[made])
    found = {"triangles": triangles, "lines": lines}
    return {name: np.concatenate(blocks) for name, blocks in found.items() if blocks}


def _triangles(flat: Array) -> Array | None:
    """Return Delaunay's triangles that are not long, each to the left."""
    try:
        made = Delaunay(flat).simplices
    except QhullError:
        return None
    corners = flat[made]
    sides = np.linalg.norm(corners - np.roll(corners, -1, axis=1), axis=2)
    first, second = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    twice = first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]
    longest = sides.max(axis=1)
    keep = (longest <= _LONGEST * np.median(sides)) & (np.abs(twice) > 1e-3 * longest**2)
    made, twice = made[keep], twice[keep]
    made[twice < 0.0] = made[twice < 0.0][:, ::-1]
    return made


def _longest(places: Array, faces: tuple[FaceGroup, ...]) -> float:
    sides = [
        np.linalg.norm(
            places[face.connectivity] - places[np.roll(face.connectivity, -1, axis=1)], axis=2
        ).max()
        for face in faces
    ]
    return float(max(sides))

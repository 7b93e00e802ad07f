"""Hold the mesh of sheets, and find nodes on their lines."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Float, Int
from scipy import sparse
from scipy.sparse import csgraph
from scipy.spatial import cKDTree

from trundle._typing import Array
from trundle.errors import InputError
from trundle.structure.mesh.planar import MOVED, on_segment
from trundle.structure.mesh.quality import MeshQuality, quality_of

__all__ = ["SheetMesh"]


@dataclass(frozen=True, kw_only=True, eq=False)
class SheetMesh:
    """Hold the mesh of sheets.

    Attributes
    ----------
    nodes : ndarray of float, shape (n_nodes, 3)
        Places [m].
    quads, triangles : ndarray of int
        Node numbers of elements, counterclockwise from above.
    quad_owner, triangle_owner : ndarray of int, shape (n, 2)
        Sheet and tag of each.
    hard : tuple of ndarray of int
        Nodes on the edges of each sheet and at its points.
    sides : tuple of ndarray of int, shape (n, 2)
        Parts of the edges of each sheet, by both nodes.
    """

    nodes: Float[Array, "nodes 3"]
    quads: Int[Array, "quads 4"]
    triangles: Int[Array, "triangles 3"]
    quad_owner: Int[Array, "quads 2"]
    triangle_owner: Int[Array, "triangles 2"]
    hard: tuple[Int[Array, " _"], ...]
    sides: tuple[Int[Array, "_ 2"], ...]

    def along(self, sheet: int, line: Float[Array, "2 2"]) -> Int[Array, " nodes"]:
        """Return the nodes of a sheet on a line, from its first end to its second.

        Raises
        ------
        InputError
            No edges of the sheet lead along the line.
        """
        some = self.hard[sheet]
        some = some[on_segment(self.nodes[some, :2], line, MOVED)]
        station = (self.nodes[some, :2] - line[0]) @ (line[1] - line[0])
        row = some[np.argsort(station)]
        # else some are nodes of a line that leaves this one at less than a milliradian
        return row if self._follow(sheet, row) else self._path(sheet, row, line)

    def _follow(self, sheet: int, row: Array) -> bool:
        """Return whether each node is joined to the next by a part of an edge."""
        steps = np.sort(np.stack([row[:-1], row[1:]], axis=1), axis=1) @ [len(self.nodes), 1]
        return bool(np.isin(steps, self._side_keys[sheet]).all())

    def _path(self, sheet: int, row: Array, line: Array) -> Array:
        """Return those of nodes that lead from the start of a line to its end along edges."""
        place = np.full(len(self.nodes), -1)
        place[row] = np.arange(len(row))
        ends = place[self.sides[sheet]]
        ends = ends[(ends >= 0).all(axis=1)]
        xy = self.nodes[row, :2]
        weight = np.linalg.norm(xy[ends[:, 1]] - xy[ends[:, 0]], axis=1)
        graph = sparse.coo_array((weight, ends.T), shape=(len(row), len(row)))
        first, last = (int(np.linalg.norm(xy - end, axis=1).argmin()) for end in line)
        _, before = csgraph.dijkstra(
            graph, directed=False, indices=np.array([first]), return_predecessors=True
        )
        path = [last]
        while path[-1] >= 0 and path[-1] != first:
            path.append(int(before[0, path[-1]]))
        if path[-1] != first:
            x, y = xy[first]
            raise InputError(f"no element edges lead along the line from ({x:g}, {y:g}) m")
        return row[path[::-1]]

    @cached_property
    def _side_keys(self) -> tuple[Array, ...]:
        return tuple(np.sort(side, axis=1) @ [len(self.nodes), 1] for side in self.sides)

    def at(self, sheet: int, place: Float[Array, " 2"]) -> int | None:
        """Return the node of a sheet at a place; None where there is none."""
        some = self.hard[sheet]
        if not len(some):
            return None
        away, nearest = self._trees[sheet].query(place)
        return int(some[nearest]) if away <= MOVED else None

    def of(self, sheet: int) -> Int[Array, " nodes"]:
        """Return all nodes of a sheet, those inside its faces too."""
        mine = (
            elements[owner[:, 0] == sheet].ravel()
            for elements, owner in (
                (self.quads, self.quad_owner),
                (self.triangles, self.triangle_owner),
            )
        )
        return np.unique(np.concatenate([self.hard[sheet], *mine]))

    @cached_property
    def _trees(self) -> tuple[cKDTree, ...]:
        return tuple(cKDTree(self.nodes[some, :2].reshape(-1, 2)) for some in self.hard)

    @property
    def quality(self) -> MeshQuality:
        """How well its elements are shaped, in plan."""
        return quality_of(self.nodes[e][:, :, :2] for e in (self.quads, self.triangles))

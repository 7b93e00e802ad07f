"""Hold the mesh of sheets, and find nodes on their lines."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Float, Int
from scipy.spatial import cKDTree

from trundle._typing import Array
from trundle.structure.mesh.planar import SNAP, on_segment
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
    """

    nodes: Float[Array, "nodes 3"]
    quads: Int[Array, "quads 4"]
    triangles: Int[Array, "triangles 3"]
    quad_owner: Int[Array, "quads 2"]
    triangle_owner: Int[Array, "triangles 2"]
    hard: tuple[Int[Array, " _"], ...]

    def along(self, sheet: int, line: Float[Array, "2 2"]) -> Int[Array, " nodes"]:
        """Return the nodes of a sheet on a line, from its first end to its second."""
        some = self.hard[sheet]
        some = some[on_segment(self.nodes[some, :2], line)]
        station = (self.nodes[some, :2] - line[0]) @ (line[1] - line[0])
        return some[np.argsort(station)]

    def at(self, sheet: int, place: Float[Array, " 2"]) -> int | None:
        """Return the node of a sheet at a place; None where there is none."""
        some = self.hard[sheet]
        if not len(some):
            return None
        away, nearest = self._trees[sheet].query(place)
        return int(some[nearest]) if away <= 2.0 * SNAP else None

    @cached_property
    def _trees(self) -> tuple[cKDTree, ...]:
        return tuple(cKDTree(self.nodes[some, :2].reshape(-1, 2)) for some in self.hard)

    @property
    def quality(self) -> MeshQuality:
        """How well its elements are shaped, in plan."""
        return quality_of(self.nodes[e][:, :, :2] for e in (self.quads, self.triangles))

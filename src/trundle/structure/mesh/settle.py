"""Settle how many elements every edge of all sheets has, and which faces are grids."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Float, Int
from scipy.spatial import cKDTree

from trundle._typing import Array
from trundle.structure.mesh.division import Classes, Patch, divided, patches_of
from trundle.structure.mesh.free import FreeFace
from trundle.structure.mesh.merging import linked
from trundle.structure.mesh.planar import MOVED, SNAP, Face, PlaneGraph, on_segment
from trundle.structure.mesh.sheet import Tie

__all__ = ["FreeOne", "Settled", "settled"]

_SAMPLES = (np.arange(100) + 0.5) / 100  # of an edge, where sizes are asked for
_GRADED = 1.3  # ratio of sizes along an edge, from which its elements differ


def settled(
    graphs: Sequence[PlaneGraph],
    sizes: Sequence[Callable[[Array], Array]],
    ties: Sequence[Tie],
) -> Settled:
    """Return counts that grids and free faces can both live with.

    Parameters
    ----------
    graphs : sequence of PlaneGraph
        Sheets, cut along their lines.
    sizes : sequence of callable
        For each, the largest element edge at places [m].
    ties : sequence of Tie
        Where two sheets are divided alike.
    """
    first = np.concatenate([[0], np.cumsum([len(g.edges) for g in graphs])])
    ends = [g.points[g.edges] for g in graphs]
    length = np.concatenate([np.linalg.norm(e[:, 1] - e[:, 0], axis=1) for e in ends])
    density = np.concatenate([_density(e, f) for e, f in zip(ends, sizes, strict=True)])
    pairs = [pair for tie in ties for pair in _tied(graphs, first, tie)]
    density = _shared(density, pairs)
    wanted = length * density.mean(axis=1)
    patches = [
        patches_of(g, wanted[a:b], int(a))
        for g, a, b in zip(graphs, first[:-1], first[1:], strict=True)
    ]
    classes = divided(wanted, length, [patch for some in patches for patch in some], pairs)
    return Settled.of(graphs, patches, classes, density)


def _tied(graphs: Sequence[PlaneGraph], first: Array, tie: Tie) -> list[tuple[int, int]]:
    """Return the edges of both sheets that lie on a tie, matched by their middles."""
    found = []
    for i in tie.sheets:
        ends = graphs[i].points[graphs[i].edges]
        on = np.all([on_segment(ends[:, i], tie.line, MOVED) for i in (0, 1)], axis=0)
        found.append((np.flatnonzero(on) + first[i], ends[on].mean(axis=1)))
    (one, here), (other, there) = found
    if not len(one) or not len(other):
        return []
    found_there = cKDTree(there).query(here)
    away, match = (np.asarray(values) for values in found_there)
    same, matched = away <= SNAP, other[match]
    return list(zip(one[same].tolist(), matched[same].tolist(), strict=True))


def _shared(density: Array, pairs: Sequence[tuple[int, int]]) -> Array:
    """Return densities of which those of tied edges are the same: the largest of any of them."""
    same = linked(np.array(pairs, dtype=np.intp).reshape(-1, 2), len(density))
    out = np.zeros_like(density)
    np.maximum.at(out, same, density)
    return out[same]


def _density(ends: Array, size: Callable[[Array], Array]) -> Array:
    """Return elements a metre asked for along each edge, at evenly spaced places."""
    step = ends[:, 1] - ends[:, 0]
    places = ends[:, None, 0] + _SAMPLES[None, :, None] * step[:, None]
    return 1.0 / size(places.reshape(-1, 2)).reshape(len(ends), len(_SAMPLES))


def _graded(share: Array, density: Array) -> Array:
    """Return where on an edge so many shares of its elements lie, when they follow a density."""
    reached = np.concatenate([[0.0], np.cumsum(density)]) / density.sum()
    return np.interp(share, reached, np.arange(len(reached)) / len(density))


@dataclass(frozen=True, kw_only=True, eq=False)
class FreeOne:
    """Hold a face that no grid fits.

    Attributes
    ----------
    sheet, tag : int
        Where it lies, and the area that it is part of.
    face : FreeFace
        What its mesh must hold.
    nodes : ndarray of int
        Numbers of the nodes that it starts from.
    """

    sheet: int
    tag: int
    face: FreeFace
    nodes: Int[Array, " nodes"]


@dataclass(frozen=True, kw_only=True, eq=False)
class Settled:
    """How edges are divided: nodes of vertices and edges, and which faces are grids."""

    graphs: Sequence[PlaneGraph]
    patches: Sequence[dict[int, Patch]]
    counts: Int[Array, " edges"]
    density: Float[Array, "edges samples"]
    first_edge: Int[Array, " sheets_and_one"]
    first_vertex: Int[Array, " sheets_and_one"]
    first_node: Int[Array, " edges_and_one"]  # of those between an edge's ends

    @classmethod
    def of(
        cls,
        graphs: Sequence[PlaneGraph],
        patches: Sequence[Sequence[Patch]],
        classes: Classes,
        density: Array,
    ) -> Settled:
        """Lay out counts; a patch whose opposite sides differ is none."""
        counts = classes.on_edges
        vertices = np.concatenate([[0], np.cumsum([len(g.points) for g in graphs])])
        between = vertices[-1] + np.concatenate([[0], np.cumsum(counts - 1)])
        fits = [
            {
                p.face: p
                for p in some
                if all(counts[p.sides[i]].sum() == counts[p.sides[i + 2]].sum() for i in (0, 1))
            }
            for some in patches
        ]
        return cls(
            graphs=graphs,
            patches=fits,
            counts=counts,
            density=density,
            first_edge=np.concatenate([[0], np.cumsum([len(g.edges) for g in graphs])]),
            first_vertex=vertices,
            first_node=between,
        )

    @property
    def n_nodes(self) -> int:
        """How many nodes stand on edges."""
        return int(self.first_node[-1])

    @cached_property
    def xy(self) -> Array:
        """Place of every node in plan, of vertices first [m]."""
        parts = [graph.points for graph in self.graphs]
        ends = np.concatenate([g.points[g.edges] for g in self.graphs])
        inner = self.counts - 1
        owner = np.repeat(np.arange(len(ends)), inner)
        place = np.arange(len(owner)) - np.repeat(np.cumsum(inner) - inner, inner) + 1
        share = place / self.counts[owner]
        for edge in np.flatnonzero(self.density.max(axis=1) > _GRADED * self.density.min(axis=1)):
            mine = owner == edge
            share[mine] = _graded(share[mine], self.density[edge])
        share = share[:, None]
        start, end = ends[owner, 0], ends[owner, 1]
        return np.concatenate([*parts, start + share * (end - start)])

    def edge_nodes(self, sheet: int, edge: int) -> Array:
        """Return the nodes of an edge of a sheet, from its lower vertex to its higher."""
        number = edge + self.first_edge[sheet]
        start, end = self.graphs[sheet].edges[edge] + self.first_vertex[sheet]
        inner = self.first_node[number] + np.arange(int(self.counts[number]) - 1)
        return np.concatenate([[start], inner, [end]])

    def hard(self, sheet: int) -> Array:
        """Return the nodes of a sheet's edges and vertices."""
        a, b = self.first_edge[sheet], self.first_edge[sheet + 1]
        inner = np.arange(int(self.first_node[a]), int(self.first_node[b]))
        low, high = int(self.first_vertex[sheet]), int(self.first_vertex[sheet + 1])
        return np.concatenate([np.arange(low, high), inner])

    @cached_property
    def _numbers(self) -> list[dict[tuple[int, int], int]]:
        return [{tuple(e): i for i, e in enumerate(g.edges.tolist())} for g in self.graphs]

    def loop_nodes(self, sheet: int, loop: Array) -> list[Array]:
        """Return the nodes along each step of a loop, both ends included."""
        steps = []
        for a, b in zip(loop.tolist(), np.roll(loop, -1).tolist(), strict=True):
            nodes = self.edge_nodes(sheet, self._numbers[sheet][min(a, b), max(a, b)])
            steps.append(nodes if a < b else nodes[::-1])
        return steps

    @cached_property
    def free_faces(self) -> tuple[FreeOne, ...]:
        """All faces that are no grids."""
        return tuple(
            self._free(sheet, face)
            for sheet, graph in enumerate(self.graphs)
            for i, face in enumerate(graph.faces)
            if i not in self.patches[sheet]
        )

    def _free(self, sheet: int, face: Face) -> FreeOne:
        names = self._numbers[sheet]
        edges = [
            names[min(a, b), max(a, b)]
            for loop in face.loops
            for a, b in zip(loop.tolist(), np.roll(loop, -1).tolist(), strict=True)
        ] + face.inner_edges.tolist()
        rows = [self.edge_nodes(sheet, edge) for edge in edges]
        sides = np.concatenate([np.stack([r[:-1], r[1:]], axis=1) for r in rows])
        lone = face.inner_points + self.first_vertex[sheet]
        nodes = np.unique(np.concatenate([sides.ravel(), lone]))
        return FreeOne(
            sheet=sheet,
            tag=face.tag,
            face=FreeFace(
                polygon=face.polygon,
                points=self.xy[nodes],
                sides=np.searchsorted(nodes, sides),
            ),
            nodes=nodes,
        )

    @property
    def node_sheet(self) -> Int[Array, " nodes"]:
        """Sheet of every node."""
        number = np.arange(len(self.graphs))
        inner = np.diff(self.first_node[self.first_edge])
        return np.concatenate(
            [np.repeat(number, np.diff(self.first_vertex)), np.repeat(number, inner)]
        )

    @property
    def sides(self) -> tuple[Int[Array, "_ 2"], ...]:
        """Both nodes of every part of an edge, for each sheet."""
        return tuple(self._sides(sheet) for sheet in range(len(self.graphs)))

    def _sides(self, sheet: int) -> Array:
        n = len(self.graphs[sheet].edges)
        rows = [self.edge_nodes(sheet, edge) for edge in range(n)]
        pairs = [np.stack([row[:-1], row[1:]], axis=1) for row in rows]
        return np.concatenate([np.zeros((0, 2), dtype=np.intp), *pairs])

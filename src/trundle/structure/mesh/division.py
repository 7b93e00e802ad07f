"""Decide into how many elements each edge is divided, so that sheets and faces meet node to node.

A face with four corners is meshed by a grid if opposite sides have as many elements. Edges that
face each other across such faces, and those that two sheets share, are therefore classes that are
divided alike: as finely as any of them asks for. What a grid cannot reach (an odd number of edges
on one side, more than four corners, holes) is left to `free`, which takes edges as they come.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float, Int

from trundle._typing import Array
from trundle.structure.mesh.planar import Face, PlaneGraph

__all__ = ["Classes", "Patch", "divided", "patches_of"]

_CORNER = np.deg2rad(30.0)  # turn from which a vertex is a corner
_STRAIGHT = np.deg2rad(10.0)
_SKEW = np.sin(np.deg2rad(40.0))  # corners of a grid are within 40 degrees of right angles
_ALIKE = 0.15  # of a side, by which vertices on opposite sides may be apart
_ROUNDS = 40
_GROWTH = 1.6  # by which an edge is divided further for the sake of a grid
_UNEVEN = 1.5  # ratio of element sizes asked for round a face from which it is graded, no grid


@dataclass(frozen=True, kw_only=True, eq=False)
class Patch:
    """Hold a face with four corners.

    Attributes
    ----------
    face : int
        Its number.
    corners : tuple of four int
        Where in its loop the corners are.
    sides : tuple of four ndarray of int
        Edges of each side, in order round it.
    """

    face: int
    corners: tuple[int, ...]
    sides: tuple[Int[Array, " _"], ...]


@dataclass(frozen=True, kw_only=True, eq=False)
class Classes:
    """Hold edges that are divided alike.

    Attributes
    ----------
    of : ndarray of int, shape (n_edges,)
        Class of each edge.
    counts : ndarray of int, shape (n_classes,)
        Elements on an edge of the class.
    """

    of: Int[Array, " edges"]
    counts: Int[Array, " classes"]

    @property
    def on_edges(self) -> Int[Array, " edges"]:
        """Number of elements on each edge."""
        return self.counts[self.of]


def patches_of(graph: PlaneGraph, wanted: Float[Array, " edges"], first: int) -> tuple[Patch, ...]:
    """Return the faces that a grid fits; `wanted` are elements asked for on edges from `first`."""
    number = {tuple(e): first + i for i, e in enumerate(graph.edges.tolist())}
    found = (_patch(i, face, graph.points, number) for i, face in enumerate(graph.faces))
    length = np.linalg.norm(np.diff(graph.points[graph.edges], axis=1)[:, 0], axis=1)
    size = length / wanted
    return tuple(p for p in found if p is not None and _even(size[np.concatenate(p.sides) - first]))


def _even(size: Array) -> bool:
    return bool(size.max() < _UNEVEN * size.min())


def _patch(
    number: int, face: Face, points: Array, edges: dict[tuple[int, int], int]
) -> Patch | None:
    if face.inner_edges.size or face.inner_points.size or len(face.loops) != 1:
        return None
    (loop,) = face.loops
    step = np.roll(points[loop], -1, axis=0) - points[loop]
    before = np.roll(step, 1, axis=0)
    cosine = np.einsum("ij,ij->i", step, before)
    sine = before[:, 0] * step[:, 1] - before[:, 1] * step[:, 0]
    turn = np.arctan2(sine, cosine)
    corners = np.flatnonzero(turn > _CORNER)
    straight = np.abs(np.delete(turn, corners)) < _STRAIGHT
    if len(corners) != 4 or not straight.all() or np.abs(np.cos(turn[corners])).max() > _SKEW:
        return None
    around = np.sort(np.stack([loop, np.roll(loop, -1)], axis=1), axis=1).tolist()
    names = np.array([edges[tuple(e)] for e in around])
    rolled = np.roll(names, -corners[0])
    sides = np.split(rolled, (corners - corners[0])[1:])
    return Patch(face=number, corners=tuple(int(c) for c in corners), sides=tuple(sides))


def divided(
    wanted: Float[Array, " edges"],
    length: Float[Array, " edges"],
    patches: Sequence[Patch],
    ties: Sequence[tuple[int, int]],
) -> Classes:
    """Return classes of edges, as finely divided as each asks for and as grids need.

    Parameters
    ----------
    wanted : ndarray of float, shape (n_edges,)
        Elements asked for.
    length : ndarray of float, shape (n_edges,)
        Length of each edge [m].
    patches : sequence of Patch
        Faces that a grid fits, over edges of all sheets.
    ties : sequence of (int, int)
        Edges that are divided alike whatever happens.
    """
    parent = list(range(len(wanted)))
    pairs = list(ties)
    for patch in patches:
        for one, other in ((0, 2), (1, 3)):
            pairs += _opposite(patch.sides[one], patch.sides[other][::-1], length)
    for a, b in pairs:
        parent[_root(parent, a)] = _root(parent, b)
    roots = np.array([_root(parent, i) for i in range(len(parent))], dtype=np.intp)
    names, of = np.unique(roots, return_inverse=True)
    counts = np.ones(len(names), dtype=np.intp)
    np.maximum.at(counts, of, np.ceil(wanted - 1e-6).astype(np.intp))
    return _evened(Classes(of=of, counts=counts), length, patches)


def _root(parent: list[int], i: int) -> int:
    while parent[i] != i:
        parent[i] = parent[parent[i]]
        i = parent[i]
    return i


def _opposite(side: Array, other: Array, length: Array) -> list[tuple[int, int]]:
    """Return edges that face each other across a patch."""
    if len(side) != len(other):
        return []
    ends = [np.cumsum(length[s]) / length[s].sum() for s in (side, other)]
    if np.abs(ends[0] - ends[1]).max() > _ALIKE:
        return []
    return list(zip(side.tolist(), other.tolist(), strict=True))


def _evened(classes: Classes, length: Array, patches: Sequence[Patch]) -> Classes:
    """Divide shorter sides of patches further, until opposite ones agree or it is not worth it."""
    counts, most = classes.counts.copy(), np.ceil(classes.counts * _GROWTH).astype(np.intp)
    for _ in range(_ROUNDS):
        changed = False
        for patch in patches:
            for one, other in ((0, 2), (1, 3)):
                few, many = sorted(
                    (patch.sides[one], patch.sides[other]),
                    key=lambda side: int(counts[classes.of[side]].sum()),
                )
                lacking = counts[classes.of[many]].sum() - counts[classes.of[few]].sum()
                if not lacking:
                    continue
                longest = few[np.argmax(length[few] / counts[classes.of[few]])]
                cls = classes.of[longest]
                if cls in classes.of[many] or counts[cls] >= most[cls]:
                    continue
                counts[cls] += 1
                changed = True
        if not changed:
            break
    return replace(classes, counts=counts)

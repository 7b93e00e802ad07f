"""Fill faces with elements: grids where four sides agree, triangles and pairs of them elsewhere."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from jaxtyping import Float, Int

from trundle._typing import Array
from trundle.structure.mesh.free import triangles_of
from trundle.structure.mesh.grids import grid_between
from trundle.structure.mesh.pairing import paired
from trundle.structure.mesh.settle import Settled
from trundle.structure.mesh.smoothing import smoothed

__all__ = ["Filling", "filled"]


@dataclass(frozen=True, kw_only=True, eq=False)
class Filling:
    """Hold the elements of all faces.

    Attributes
    ----------
    xy : ndarray of float, shape (n_nodes, 2)
        Nodes in plan [m]: those of vertices and edges first.
    sheet : ndarray of int, shape (n_nodes,)
        Sheet of each.
    quads, triangles : ndarray of int
        Node numbers.
    quad_owner, triangle_owner : ndarray of int, shape (n, 2)
        Sheet and tag of each.
    """

    xy: Float[Array, "nodes 2"]
    sheet: Int[Array, " nodes"]
    quads: Int[Array, "quads 4"]
    triangles: Int[Array, "triangles 3"]
    quad_owner: Int[Array, "quads 2"]
    triangle_owner: Int[Array, "triangles 2"]


@dataclass(frozen=True, kw_only=True, eq=False)
class _Face:
    """A face's new nodes, and its elements."""

    sheet: int
    tag: int
    inner: Float[Array, "inner 2"]
    elements: Int[Array, "elements corners"]

    @property
    def owner(self) -> Array:
        return np.tile([self.sheet, self.tag], (len(self.elements), 1))


def filled(settled: Settled, sizes: Sequence[Callable[[Array], Array]]) -> Filling:
    """Mesh all faces.

    Parameters
    ----------
    settled : Settled
        How edges are divided.
    sizes : sequence of callable
        For each sheet, the largest element edge at places [m].
    """
    grids = list(_grids(settled))
    first_free = settled.n_nodes + sum(len(one.inner) for one in grids)
    free = list(_free(settled, sizes, first_free))
    xy = np.concatenate([settled.xy, *(one.inner for one in (*grids, *free))])
    triangles, number = _stacked([one.elements for one in free], 3)
    quads, rest, quad_face, rest_face = paired(xy, triangles, number, np.concatenate(settled.sides))
    all_quads = np.concatenate([_stacked([one.elements for one in grids], 4)[0], quads])
    may_move = np.arange(len(xy)) >= first_free
    of_free = np.array([(one.sheet, one.tag) for one in free], dtype=np.intp).reshape(-1, 2)
    owners = [np.zeros((0, 2), dtype=np.intp), *(one.owner for one in grids), of_free[quad_face]]
    sheets = [np.full(len(one.inner), one.sheet) for one in (*grids, *free)]
    return Filling(
        xy=smoothed(xy, all_quads, rest, may_move),
        sheet=np.concatenate([settled.node_sheet, *sheets]),
        quads=all_quads,
        triangles=rest,
        quad_owner=np.concatenate(owners),
        triangle_owner=of_free[rest_face],
    )


def _stacked(elements: Sequence[Array], corners: int) -> tuple[Array, Array]:
    """Return elements of faces one after the other, and the number of each one's face."""
    number = np.repeat(np.arange(len(elements)), [len(some) for some in elements])
    return np.concatenate([np.zeros((0, corners), dtype=np.intp), *elements]), number


def _grids(settled: Settled) -> Iterator[_Face]:
    n = settled.n_nodes
    for sheet, graph in enumerate(settled.graphs):
        for number, patch in settled.patches[sheet].items():
            face = graph.faces[number]
            steps = settled.loop_nodes(sheet, face.loops[0])
            steps = steps[patch.corners[0] :] + steps[: patch.corners[0]]
            ends = np.cumsum([0, *(len(side) for side in patch.sides)])
            sides = [_chained(steps[a:b]) for a, b in pairwise(ends)]
            inner, elements = grid_between(sides, settled.xy, n)
            n += len(inner)
            yield _Face(sheet=sheet, tag=face.tag, inner=inner, elements=elements)


def _free(
    settled: Settled, sizes: Sequence[Callable[[Array], Array]], first: int
) -> Iterator[_Face]:
    n = first
    for one in settled.free_faces:
        inner, found = triangles_of(one.face, sizes[one.sheet])
        names = np.concatenate([one.nodes, n + np.arange(len(inner))])
        n += len(inner)
        yield _Face(sheet=one.sheet, tag=one.tag, inner=inner, elements=names[found])


def _chained(steps: Sequence[Array]) -> Array:
    return np.concatenate([*(step[:-1] for step in steps), steps[-1][-1:]])

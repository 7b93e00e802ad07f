"""Mesh sheets: conforming to their lines and points and to each other, mostly by quadrilaterals."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from trundle._checks import positive
from trundle._typing import Array
from trundle.errors import InputError
from trundle.structure.mesh.fill import Filling, filled
from trundle.structure.mesh.merging import first_there
from trundle.structure.mesh.planar import MOVED, SNAP, PlaneGraph, away_from, cut, on_segment
from trundle.structure.mesh.quality import signed_areas
from trundle.structure.mesh.settle import Settled, settled
from trundle.structure.mesh.sheet import Refinement, Sheet, Tie
from trundle.structure.mesh.sheet_mesh import SheetMesh

__all__ = ["mesh_sheets"]

_NEAR = "lines nearly touch there; move them apart, or onto each other"
_GROW = 0.5  # of the distance from a refinement, by which elements may be larger


def mesh_sheets(
    sheets: Sequence[Sheet],
    *,
    size: float,
    refinements: Sequence[Refinement] = (),
    ties: Sequence[Tie] = (),
    only_triangles: bool = False,
) -> SheetMesh:
    """Mesh sheets with elements no longer than a size.

    Parameters
    ----------
    sheets : sequence of Sheet
        What is meshed.
    size : float
        Largest element edge [m].
    refinements : sequence of Refinement
        Where elements are smaller.
    ties : sequence of Tie
        Lines along which two sheets are divided alike; nodes at one place are one node.
    only_triangles : bool
        Cut every quadrilateral in two.

    Raises
    ------
    InputError
        A sheet without a line to mesh.
    """
    size = positive("mesh size", size)
    graphs = _cut_alike(sheets, ties)
    sizes = [_size_of(sheet, size, refinements) for sheet in sheets]
    if not sum(len(graph.edges) for graph in graphs):
        raise InputError(f"nothing to mesh in {', '.join(sheet.name for sheet in sheets)}")
    edges = settled(graphs, sizes, ties)
    filling = filled(edges, sizes)
    if only_triangles:
        filling = _halved(filling)
    mesh = _merged(sheets, filling, edges)
    _check(sheets, mesh, ties)
    return mesh


def _cut_alike(sheets: Sequence[Sheet], ties: Sequence[Tie]) -> list[PlaneGraph]:
    """Cut all sheets, those that are tied at each other's vertices too."""
    graphs = [cut(sheet, np.zeros((0, 2))) for sheet in sheets]
    counts: list[int] = []
    while counts != (counts := [len(graph.points) for graph in graphs]):
        # what one sheet is given it hands on: a wall through ten storeys takes nine rounds at most
        more: dict[int, list[Array]] = {}
        for tie in ties:
            for here, there in (tie.sheets, tie.sheets[::-1]):
                points = graphs[there].points
                more.setdefault(here, []).append(points[on_segment(points, tie.line)])
        for i, places in more.items():
            graphs[i] = cut(sheets[i], np.concatenate(places))
    return graphs


def _size_of(
    sheet: Sheet, size: float, refinements: Sequence[Refinement]
) -> Callable[[Array], Array]:
    near = [r for r in refinements if r.sheet in (None, sheet.name) and r.size < size]

    def at(places: Array) -> Array:
        """Return the largest element edge at places [m]."""
        out = np.full(len(places), size)
        for one in near:
            line = one.line if len(one.line) > 1 else np.repeat(one.line, 2, axis=0)
            away, _ = away_from(np.stack([line[:-1], line[1:]], axis=1), places)
            out = np.minimum(out, one.size + _GROW * np.maximum(away - one.reach, 0.0))
        return out

    return at


def _halved(filling: Filling) -> Filling:
    """Cut each quadrilateral along its shorter diagonal."""
    corners = filling.xy[filling.quads]
    first = np.linalg.norm(corners[:, 2] - corners[:, 0], axis=1)
    second = np.linalg.norm(corners[:, 3] - corners[:, 1], axis=1)
    other = (second < first - 1e-9)[:, None]
    quads = np.where(other, np.roll(filling.quads, -1, axis=1), filling.quads)
    halves = [quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]]
    owners = [filling.triangle_owner, filling.quad_owner, filling.quad_owner]
    return replace(
        filling,
        quads=quads[:0],
        quad_owner=filling.quad_owner[:0],
        triangles=np.concatenate([filling.triangles, *halves]),
        triangle_owner=np.concatenate(owners),
    )


def _merged(sheets: Sequence[Sheet], filling: Filling, edges: Settled) -> SheetMesh:
    """Put nodes into space; those of two sheets at one place are one."""
    planes = np.array([sheet.plane for sheet in sheets])[filling.sheet]
    z = planes[:, 0] + np.einsum("ij,ij->i", planes[:, 1:], filling.xy)
    nodes = np.column_stack([filling.xy, z])
    first, number = np.unique(
        first_there(nodes, 0.5 * SNAP, apart=filling.sheet), return_inverse=True
    )
    return SheetMesh(
        nodes=nodes[first],
        quads=number[filling.quads],
        triangles=number[filling.triangles],
        quad_owner=filling.quad_owner,
        triangle_owner=filling.triangle_owner,
        hard=tuple(np.unique(number[edges.hard(i)]) for i in range(len(sheets))),
        sides=tuple(number[some] for some in edges.sides),
    )


def _check(sheets: Sequence[Sheet], mesh: SheetMesh, ties: Sequence[Tie]) -> None:
    """Refuse elements that lines which nearly touch leave no room, and ties that do not meet.

    Raises
    ------
    InputError
        With the place of the first of them.
    """
    for elements in (mesh.quads, mesh.triangles):
        corners = mesh.nodes[elements][:, :, :2]
        flat = np.flatnonzero(signed_areas(corners) <= 0.0)
        if len(flat):
            x, y = corners[flat[0]].mean(axis=0)
            raise InputError(f"no room for an element at ({x:.4g}, {y:.4g}) m: {_NEAR}")
    for tie in ties:
        one, other = (mesh.nodes[mesh.along(i, tie.line), :2] for i in tie.sheets)
        if len(one) != len(other) or np.abs(one - other).max() > MOVED:
            names = " and ".join(repr(sheets[i].name) for i in tie.sheets)
            (x, y), (to_x, to_y) = tie.line
            raise InputError(
                f"{names} are not divided alike along the line from ({x:g}, {y:g}) to ({to_x:g}, "
                f"{to_y:g}) m: {_NEAR}"
            )

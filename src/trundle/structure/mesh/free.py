"""Mesh faces of any shape by triangles: a lattice inside, Delaunay between it and the edges.

The lattice lies along the face's longest edge and is twice as fine wherever elements are asked to
be smaller, so that most of its triangles pair to squares. Every part of an edge must come out as a
side of triangles, or neighbours would not meet: the triangulation is constrained to them. Lattice
points in the way of a side are left out first, as triangles would be thin beside it.
"""

# pyright: reportUnknownMemberType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false, reportAttributeAccessIssue=false
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import pythoncdt as cdt
import shapely
from jaxtyping import Float, Int
from scipy.spatial import Delaunay, cKDTree

from trundle._typing import Array
from trundle.errors import InputError
from trundle.structure.mesh.planar import away_from, inside

__all__ = ["FreeFace", "triangles_of"]

_CLOSE = 0.55  # of an element's size, to which lattice points may come near edges
_GROW = 0.4  # of the distance from a short edge, by which elements may be larger
_LEVELS = 6  # halvings of the lattice
_GAP = 1e-6  # of a face, that its triangles may leave out or cover twice
_ROOM = 1e-6  # of its size: a triangle flatter than that is none


@dataclass(frozen=True, kw_only=True, eq=False)
class FreeFace:
    """Hold a face with what its mesh must contain.

    Attributes
    ----------
    polygon : shapely polygon
        Itself.
    points : ndarray of float, shape (n, 2)
        Nodes on its edges, and within it where one must be [m].
    sides : ndarray of int, shape (n_sides, 2)
        Parts of edges, by their places in `points`.
    """

    polygon: shapely.Polygon
    points: Float[Array, "points 2"]
    sides: Int[Array, "sides 2"]


def triangles_of(
    face: FreeFace, size: Callable[[Array], Array]
) -> tuple[Float[Array, "inner 2"], Int[Array, "triangles 3"]]:
    """Mesh a face.

    Parameters
    ----------
    face : FreeFace
        Its edges, divided.
    size : callable
        Largest element edge at places [m].

    Returns
    -------
    inner : ndarray of float, shape (n, 2)
        New nodes [m].
    triangles : ndarray of int, shape (n_triangles, 3)
        Places in its points, and behind them in the new ones; counterclockwise.

    Raises
    ------
    InputError
        No mesh that meets its neighbours side by side fits it.
    """
    inner = _clear(face, _lattice(face, size))
    points = np.concatenate([face.points, inner])
    found = _constrained(points, face.sides)
    centres = points[found].mean(axis=1)
    found = found[inside(face.polygon, centres) & _solid(points, found)]
    _check(face, points, found)
    return inner, found


def _clear(face: FreeFace, inner: Array) -> Array:
    """Leave out lattice points that would spoil the triangles at a side: inside its circle."""
    lost = face.sides[_missing(_delaunay(np.concatenate([face.points, inner])), face.sides)]
    middle = face.points[lost].mean(axis=1)
    radius = 0.5 * np.linalg.norm(np.diff(face.points[lost], axis=1)[:, 0], axis=1)
    near = np.linalg.norm(inner[:, None] - middle, axis=2) < 1.2 * radius
    return inner[~near.any(axis=1)]


def _constrained(points: Array, sides: Array) -> Array:
    """Return triangles between points of which all sides are sides; none where sides cross."""
    mesh = cdt.Triangulation(
        cdt.VertexInsertionOrder.AUTO, cdt.IntersectingConstraintEdges.NOT_ALLOWED, 0.0
    )
    vertices: Any = np.ascontiguousarray(points)
    edges: Any = sides.astype(np.uint32)
    try:
        mesh.insert_vertices(vertices)
        mesh.insert_edges(edges)
    except RuntimeError:  # two points are one, or sides cross
        return np.zeros((0, 3), dtype=np.intp)
    mesh.erase_super_triangle()
    return mesh.triangles_array()["vertices"].astype(np.intp)


def _check(face: FreeFace, points: Array, found: Array) -> None:
    """Refuse a mesh with a gap, or one that does not meet its neighbours side by side.

    Raises
    ------
    InputError
        Where lines nearly touch, or meet at an angle too sharp for elements.
    """
    area = 0.5 * _twice(points, found).sum() if len(found) else 0.0
    lost = np.flatnonzero(_missing(found, face.sides)) if len(found) else np.arange(1)
    if len(lost) or abs(area - face.polygon.area) > _GAP * face.polygon.area:
        x, y = face.points[face.sides[lost[0] if len(lost) else 0]].mean(axis=0)
        raise InputError(
            f"no mesh fits the area of {face.polygon.area:.3g} m2 at ({x:.4g}, {y:.4g}) m: lines "
            "nearly touch there, or meet at a very sharp angle; move them apart, or onto each other"
        )


def _delaunay(points: Array) -> Array:
    """Return Delaunay triangles, counterclockwise."""
    found = np.asarray(Delaunay(points - points.mean(axis=0)).simplices, dtype=np.intp)
    turned = _twice(points, found) < 0.0
    found[turned] = found[turned][:, [0, 2, 1]]
    return found


def _twice(points: Array, triangles: Array) -> Array:
    """Return twice the area of triangles, negative for those that run clockwise."""
    a, b, c = (points[triangles[:, i]] for i in range(3))
    return (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]


def _solid(points: Array, triangles: Array) -> Array:
    a, b, c = (points[triangles[:, i]] for i in range(3))
    longest = np.max([np.sum((p - q) ** 2, axis=1) for p, q in ((a, b), (b, c), (c, a))], axis=0)
    return _twice(points, triangles) > _ROOM * longest


def _missing(triangles: Array, sides: Array) -> Array:
    """Return which sides no triangle has."""
    big = int(max(triangles.max(), sides.max())) + 1
    there = np.sort(
        np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    )
    wanted = np.sort(sides, axis=1)
    return ~np.isin(wanted[:, 0] * big + wanted[:, 1], there[:, 0] * big + there[:, 1])


def _lattice(face: FreeFace, size: Callable[[Array], Array]) -> Array:
    """Return lattice points inside a face, off its edges, as close as elements are small."""
    ends = face.points[face.sides]
    step = ends[:, 1] - ends[:, 0]
    length = np.linalg.norm(step, axis=1)
    along = _direction(step, length)
    turn = np.array([along, [-along[1], along[0]]])
    flat = ends.reshape(-1, 2) @ turn.T
    low, high = flat.min(axis=0), flat.max(axis=0)
    coarse = float(np.max(size(ends.mean(axis=1))))
    coarse = max(coarse, float(np.max(size(face.points))))
    n = np.maximum(1, np.ceil((high - low) / coarse - 1e-6))
    spacing = (high - low) / n
    kept = [np.zeros((0, 2))]
    for level in range(_LEVELS + 1):
        places = _level_points(low, spacing, n, level) @ turn
        places = places[inside(face.polygon, places)]
        if not len(places):
            continue
        here, away = _local_size(places, ends, length, size)
        asked = np.clip(np.ceil(np.log2(np.max(spacing) / here) - 0.3), 0, _LEVELS)
        kept.append(places[(asked >= level) & (away >= _CLOSE * np.minimum(here, np.max(spacing)))])
        if asked.max() <= level:
            break
    return _off_points(np.concatenate(kept), face, float(np.min(spacing)))


def _direction(step: Array, length: Array) -> Array:
    """Return the direction of most of the edges, modulo a right angle."""
    angle = np.arctan2(step[:, 1], step[:, 0])
    fourfold = np.sum(length * np.exp(4j * angle))
    if abs(fourfold) < 0.2 * length.sum():
        return step[length.argmax()] / length.max()
    mean = np.angle(fourfold) / 4.0
    return np.array([np.cos(mean), np.sin(mean)])


def _level_points(low: Array, spacing: Array, n: Array, level: int) -> Array:
    """Return the points that a lattice gains by its so-many-th halving."""
    steps = [np.arange(int(k) * 2**level + 1) for k in n]
    x, y = np.meshgrid(*steps, indexing="ij")
    new = np.ones(x.shape, bool) if level == 0 else (x % 2 == 1) | (y % 2 == 1)
    return low + np.stack([x[new], y[new]], axis=1) * spacing / 2**level


def _local_size(
    places: Array, ends: Array, length: Array, size: Callable[[Array], Array]
) -> tuple[Array, Array]:
    """Return the size of elements at places, which short edges limit, and the nearest edge [m]."""
    away, nearest = away_from(ends, places)
    return np.minimum(size(places), length[nearest] + _GROW * away), away


def _off_points(places: Array, face: FreeFace, spacing: float) -> Array:
    """Leave out what comes too near to nodes that stand inside."""
    used = np.zeros(len(face.points), bool)
    used[face.sides] = True
    lone = face.points[~used]
    if not len(lone) or not len(places):
        return places
    away, _ = cKDTree(lone).query(places)
    return places[away >= _CLOSE * spacing]

"""Cut a plane along lines: vertices, the edges between them, and the faces that edges enclose.

All geometry of polygons is shapely's, and stays in this module. Ends that lie within a millimetre
of each other, or of a line, are taken to meet: drawings are no more exact.
"""

# pyright: reportUnknownMemberType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from jaxtyping import Float, Int

from trundle._typing import Array
from trundle.errors import InputError
from trundle.structure.mesh.merging import first_there
from trundle.structure.mesh.sheet import Area, Sheet

__all__ = ["MOVED", "SNAP", "Face", "PlaneGraph", "away_from", "cut", "inside", "on_segment"]

SNAP = 1e-3
"""Distance at which ends and lines are taken to meet [m]."""

MOVED = 2.0 * SNAP
"""Distance within which an edge lies of the line that was asked for [m]."""

_PER_METRE = 1_000_000  # steps of the grid that crossings are placed on
_ROUNDS = 20


@dataclass(frozen=True, kw_only=True, eq=False)
class Face:
    """Hold what edges enclose.

    Attributes
    ----------
    loops : tuple of ndarray of int
        Vertices round it, counterclockwise; then those of holes, clockwise.
    inner_edges : ndarray of int
        Edges that end inside it.
    inner_points : ndarray of int
        Vertices inside it that no edge meets.
    tag : int
        Of the area that it is part of.
    polygon : shapely polygon
        Itself.
    """

    loops: tuple[Int[Array, " _"], ...]
    inner_edges: Int[Array, " edges"]
    inner_points: Int[Array, " points"]
    tag: int
    polygon: shapely.Polygon


@dataclass(frozen=True, kw_only=True, eq=False)
class PlaneGraph:
    """Hold a plane cut along lines.

    Attributes
    ----------
    points : ndarray of float, shape (n_vertices, 2)
        Vertices [m].
    edges : ndarray of int, shape (n_edges, 2)
        The two vertices of each.
    faces : tuple of Face
        Those of areas.
    """

    points: Float[Array, "vertices 2"]
    edges: Int[Array, "edges 2"]
    faces: tuple[Face, ...]


def cut(sheet: Sheet, more: Float[Array, "more 2"]) -> PlaneGraph:
    """Cut a sheet along the outlines of its areas and its lines.

    Parameters
    ----------
    sheet : Sheet
        What is cut.
    more : ndarray of float, shape (n, 2)
        Further places where a vertex must be [m].
    """
    rings = [ring for area in sheet.areas for ring in (area.outline, *area.openings)]
    lines = [np.vstack([ring, ring[:1]]) for ring in rings] + [*sheet.lines]
    ends = np.concatenate([np.stack([line[:-1], line[1:]], axis=1) for line in lines] or [_NO_ENDS])
    single = np.concatenate([sheet.points, more])
    pieces, single = _cut_at_each_other(ends, single, sheet.name)
    points, numbers = np.unique(
        _on_grid(np.concatenate([pieces.reshape(-1, 2), single])),
        axis=0,
        return_inverse=True,
    )
    edges = numbers.ravel()[: 2 * len(pieces)].reshape(-1, 2)
    edges = np.unique(np.sort(edges, axis=1), axis=0)
    faces = _faces(points, edges, sheet.areas)
    return PlaneGraph(points=points / _PER_METRE, edges=edges, faces=faces)


def _cut_at_each_other(ends: Array, single: Array, name: str) -> tuple[Array, Array]:
    """Cut segments wherever they meet, and return their pieces, with the single places.

    Where crossings lie within `SNAP` of each other, or of a line, they become one, which moves
    pieces, which may cross anew: again, until nothing moves. Then all vertices are apart.
    """
    own = np.concatenate([ends.reshape(-1, 2), single])
    known, before = own, np.zeros((0, 4))
    for _ in range(_ROUNDS):
        known, ends = _met(known, ends)
        own = known[: len(own)]
        segments = shapely.linestrings(_split_at(ends, known))
        ends = _segments_of(shapely.union_all(segments, grid_size=1.0 / _PER_METRE))
        after = _as_rows(ends)
        if np.array_equal(before, after):
            return ends, own[len(own) - len(single) :]
        known, before = np.concatenate([own, ends.reshape(-1, 2)]), after
    raise InputError(f"{name}: too many lines nearly touch; move them apart, or onto each other")


def _as_rows(ends: Array) -> Array:
    """Return segments in one order, and each from its lower end, to compare them with others."""
    xy = _on_grid(ends)
    turned = (xy[:, 0, 0] > xy[:, 1, 0]) | (
        (xy[:, 0, 0] == xy[:, 1, 0]) & (xy[:, 0, 1] > xy[:, 1, 1])
    )
    xy[turned] = xy[turned][:, ::-1]
    return np.unique(xy.reshape(-1, 4), axis=0)


_NO_ENDS = np.zeros((0, 2, 2))


def _on_grid(xy: Array) -> Array:
    return np.round(xy * _PER_METRE).astype(np.int64)


def _met(known: Array, ends: Array) -> tuple[Array, Array]:
    """Move places that lie within `SNAP` of each other to the first of them, known ones first."""
    places = np.concatenate([known, ends.reshape(-1, 2)])
    moved = places[first_there(places, SNAP)]
    ends = moved[len(known) :].reshape(-1, 2, 2)
    return moved[: len(known)], ends[(ends[:, 0] != ends[:, 1]).any(axis=1)]


def _split_at(ends: Array, places: Array) -> Array:
    """Return segments, each cut at the places that lie on it within `SNAP`."""
    if not len(ends):
        return ends
    places = np.unique(places, axis=0)
    tree = shapely.STRtree([shapely.Point(place) for place in places])
    owner, found = tree.query(shapely.linestrings(ends), predicate="dwithin", distance=SNAP)
    along = ends[owner, 1] - ends[owner, 0]
    share = np.einsum("ij,ij->i", places[found] - ends[owner, 0], along)
    order = np.lexsort((share, owner))
    owner, found = owner[order], found[order]
    same = owner[1:] == owner[:-1]
    return np.stack([places[found[:-1]], places[found[1:]]], axis=1)[same]


def _segments_of(drawn: shapely.Geometry) -> Array:
    """Return every segment of a drawing of lines, (n, 2, 2)."""
    parts = shapely.get_parts(drawn)
    xy, owner = shapely.get_coordinates(parts, return_index=True)
    same = owner[1:] == owner[:-1]
    return np.stack([xy[:-1], xy[1:]], axis=1)[same]


def _faces(points: Array, edges: Array, areas: Sequence[Area]) -> tuple[Face, ...]:
    pieces = [shapely.LineString(piece) for piece in points[edges] / _PER_METRE]
    polygons = shapely.get_parts(shapely.polygonize(pieces))
    tags = _tags(polygons, areas)
    polygons, tags = polygons[tags >= 0], tags[tags >= 0]
    if not len(polygons):
        return ()
    rows = {tuple(p): i for i, p in enumerate(points.tolist())}
    loops = [_loops(polygon, rows) for polygon in polygons]
    inner_edges, inner_points = _inside_faces(polygons, loops, points / _PER_METRE, edges)
    return tuple(
        Face(loops=loop, inner_edges=e, inner_points=p, tag=int(tag), polygon=polygon)
        for polygon, loop, e, p, tag in zip(
            polygons, loops, inner_edges, inner_points, tags, strict=True
        )
    )


def _tags(polygons: Array, areas: Sequence[Area]) -> Array:
    """Return the number of the area that each polygon is part of, -1 for none."""
    tags = np.full(len(polygons), -1)
    within = shapely.point_on_surface(polygons)
    for area in areas:
        shape = shapely.Polygon(area.outline, area.openings)
        shapely.prepare(shape)
        inside_it = shapely.contains(shape, within)
        if area.over:
            whole = shapely.Polygon(area.outline)
            tags[shapely.contains(whole, within) & ~inside_it] = -1
            inside_it &= tags >= 0
        tags[inside_it] = area.tag
    return tags


def _loops(polygon: shapely.Polygon, rows: dict[tuple[int, int], int]) -> tuple[Array, ...]:
    """Return the vertices of a polygon's rings, the outer one counterclockwise."""
    found = []
    for i, ring in enumerate(shapely.get_rings(polygon)):
        xy = shapely.get_coordinates(ring)[:-1]
        if bool(shapely.is_ccw(ring)) != (i == 0):
            xy = xy[::-1]
        keys = _on_grid(xy).tolist()
        found.append(np.array([rows[tuple(key)] for key in keys]))
    return tuple(found)


def _inside_faces(
    polygons: Array, loops: Sequence[tuple[Array, ...]], points: Array, edges: Array
) -> tuple[list[Array], list[Array]]:
    """Return the edges and the lone vertices that lie inside each face."""
    around = [np.stack([ring, np.roll(ring, -1)], axis=1) for loop in loops for ring in loop]
    bounding = {tuple(e) for e in np.sort(np.concatenate([*around, _NO_EDGES]), axis=1).tolist()}
    loose = np.array([i for i, e in enumerate(edges.tolist()) if tuple(e) not in bounding], int)
    lone = np.setdiff1d(np.arange(len(points)), edges)
    tree = shapely.STRtree(polygons)
    middles = points[edges[loose]].mean(axis=1)
    out: list[list[Array]] = []
    for numbers, places in ((loose, middles), (lone, points[lone])):
        which, face = tree.query(shapely.points(places), predicate="within")
        order = np.argsort(face, kind="stable")
        ends = np.searchsorted(face[order], np.arange(1, len(polygons)))
        out.append(np.split(numbers[which[order]], ends))
    return out[0], out[1]


_NO_EDGES = np.zeros((0, 2), dtype=np.intp)


def inside(polygon: shapely.Polygon, places: Float[Array, "n 2"]) -> Array:
    """Return which places lie inside a polygon."""
    shapely.prepare(polygon)
    return np.asarray(shapely.contains_xy(polygon, places[:, 0], places[:, 1]))


def away_from(
    segments: Float[Array, "segments 2 2"], places: Float[Array, "n 2"]
) -> tuple[Float[Array, " n"], Int[Array, " n"]]:
    """Return the distance of each place from the nearest segment [m], and its number."""
    tree = shapely.STRtree([shapely.LineString(segment) for segment in segments])
    which, away = tree.query_nearest(
        shapely.points(places), return_distance=True, all_matches=False
    )
    return np.asarray(away), np.asarray(which[1])


def on_segment(
    places: Float[Array, "n 2"], line: Float[Array, "2 2"], within: float = SNAP
) -> Array:
    """Return which places lie on a segment, within a distance [m]."""
    along = line[1] - line[0]
    length = np.hypot(*along)
    unit = along / length
    from_start = places - line[0]
    station = from_start @ unit
    aside = np.abs(from_start @ np.array([-unit[1], unit[0]]))
    return (aside <= within) & (station >= -within) & (station <= length + within)

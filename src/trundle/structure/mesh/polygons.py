"""Ask polygons what they cover, and what is wrong with them."""

# pyright: reportUnknownMemberType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false
from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np
import shapely
from jaxtyping import Float

from trundle._typing import Array
from trundle.structure.mesh.planar import SNAP

__all__ = [
    "area_of",
    "box_round",
    "covers",
    "fault_of",
    "overlap",
    "rings_of",
    "shared_length",
    "uncovered",
]


def covers(
    outline: Float[Array, "corners 2"],
    openings: Sequence[Float[Array, "_ 2"]],
    places: Float[Array, "n 2"],
) -> Array:
    """Return which places lie on a polygon with openings, or within `SNAP` of it."""
    shape = shapely.Polygon(outline, openings).buffer(SNAP)
    return np.asarray(shapely.contains_xy(shape, places[:, 0], places[:, 1]))


def fault_of(outline: Float[Array, "corners 2"]) -> str | None:
    """Return what is wrong with a polygon's outline, None for a sound one."""
    if len(outline) < 3:
        return f"an outline has 3 corners or more; this one has {len(outline)}"
    steps = np.linalg.norm(np.roll(outline, -1, axis=0) - outline, axis=1)
    if steps.min() <= 2.0 * SNAP:
        x, y = outline[int(steps.argmin())]
        return f"two corners in a row are the same, ({x:g}, {y:g}) m"
    shape = shapely.Polygon(outline)
    if not shape.is_valid:
        where = re.search(r"\[(\S+) (\S+)\]", shapely.is_valid_reason(shape))
        at = "" if where is None else f" at ({float(where[1]):.4g}, {float(where[2]):.4g}) m"
        return f"an outline must not cross or touch itself; this one does{at}"
    if shape.area < 100.0 * SNAP**2:
        return "an outline must enclose an area"
    return None


def area_of(
    outline: Float[Array, "corners 2"], openings: Sequence[Float[Array, "_ 2"]] = ()
) -> float:
    """Return the area of a polygon with openings [m2]."""
    return float(shapely.Polygon(outline, openings).area)


def overlap(one: tuple[Array, Sequence[Array]], other: tuple[Array, Sequence[Array]]) -> float:
    """Return the area that two polygons with openings share [m2]; none for slivers of `SNAP`."""
    shapes = [shapely.Polygon(*polygon) for polygon in (one, other)]
    if not shapes[0].buffer(-SNAP).intersects(shapes[1].buffer(-SNAP)):
        return 0.0
    return float(shapes[0].intersection(shapes[1]).area)


def uncovered(inner: Float[Array, "corners 2"], outer: tuple[Array, Sequence[Array]]) -> float:
    """Return the area of a polygon outside another [m2], but for slivers of `SNAP`."""
    shape = shapely.Polygon(inner).buffer(-SNAP)
    return float(shape.difference(shapely.Polygon(*outer)).area)


def shared_length(one: Float[Array, "corners 2"], other: Float[Array, "corners 2"]) -> float:
    """Return the length of a line that lies within `SNAP` of another [m]."""
    low, high = np.maximum(one.min(0), other.min(0)), np.minimum(one.max(0), other.max(0))
    if np.any(low > high + SNAP):
        return 0.0
    near = shapely.LineString(other).buffer(SNAP)
    return float(shapely.LineString(one).intersection(near).length)


def rings_of(lines: Sequence[Float[Array, "_ 2"]]) -> list[Float[Array, "_ 2"]]:
    """Return what lines enclose together, by its corners; dead ends enclose nothing."""
    if not lines:
        return []
    drawn = shapely.union_all([shapely.LineString(np.round(line, 4)) for line in lines])
    rings = shapely.get_parts(shapely.polygonize(list(shapely.get_parts(drawn))))
    return [shapely.get_coordinates(ring.exterior.simplify(SNAP))[:-1] for ring in rings]


def box_round(outline: Float[Array, "corners 2"]) -> tuple[float, float, float]:
    """Return length, width and direction of the smallest box round an outline [m], [degrees]."""
    box = shapely.Polygon(outline).minimum_rotated_rectangle
    corners = shapely.get_coordinates(box)
    sides = corners[1:3] - corners[:2]
    lengths = np.linalg.norm(sides, axis=1)
    along = sides[int(lengths.argmax())]
    angle = float(np.degrees(np.arctan2(along[1], along[0])))
    return float(lengths.max()), float(lengths.min()), angle % 180.0

"""Find ends and corners that come near to a part of their storey without meeting it."""

# pyright: reportUnknownMemberType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false
from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
import shapely

from trundle._typing import Array
from trundle.structure.building.parts import Building
from trundle.structure.mesh.planar import SNAP

__all__ = ["Gap", "gaps_of"]

_ROUND_OFF = 1e-6  # m
_NEAR = 0.05  # m, within which parts are likely to be meant to meet


class Gap(NamedTuple):
    """A place that comes near to a part and does not meet it; distances in m."""

    storey: str
    part: str
    place: tuple[float, float]
    other: str
    distance: float


def gaps_of(building: Building) -> Iterator[Gap]:
    """Give the gaps of each storey that no slab bridges.

    Ends that lie within a millimetre of a part are joined to it; across a slab two parts are joined
    by its elements, however near they are to each other.
    """
    for storey in building.storeys:
        lines = list(_lines(building, storey.name))
        if len(lines) < 2:
            continue
        ends = np.concatenate([line for _, line in lines])
        owner = np.repeat(np.arange(len(lines)), [len(line) for _, line in lines])
        shapes = [shapely.LineString(line) for _, line in lines]
        tree = shapely.STRtree(shapes)
        at, other = tree.query(shapely.points(ends), predicate="dwithin", distance=_NEAR)
        slabs = shapely.union_all(
            [shapely.Polygon(s.outline, s.openings) for s in building.slabs if s.on == storey.name]
        ).buffer(_ROUND_OFF)
        for i, j in zip(at.tolist(), other.tolist(), strict=True):
            way = shapely.shortest_line(shapely.Point(ends[i]), shapes[j])
            if owner[i] == j or way.length <= SNAP or slabs.covers(way):
                continue
            x, y = ends[i].tolist()
            yield Gap(storey.name, lines[owner[i]][0], (x, y), lines[j][0], float(way.length))


def _lines(building: Building, storey: str) -> Iterator[tuple[str, Array]]:
    """Give what lies on a storey, as lines, with what it is called in a study."""
    for i, slab in enumerate(building.slabs, start=1):
        if slab.on == storey and not slab.panel:
            for ring in (slab.outline, *slab.openings):
                yield f"slab {i}", np.vstack([ring, ring[:1]])
    for i, beam in enumerate(building.beams, start=1):
        if beam.on == storey:
            yield f"beam {i}", beam.along
    for i, wall in enumerate(building.walls, start=1):
        if storey in [s.name for s in building.between(wall.bottom, wall.top)]:
            yield f"wall {i}", wall.along
    for ramp in building.ramps:
        if ramp.bottom == storey:
            yield f"ramp {ramp.name!r}", ramp.outline[:2]
        if ramp.top == storey:
            yield f"ramp {ramp.name!r}", ramp.outline[2:]

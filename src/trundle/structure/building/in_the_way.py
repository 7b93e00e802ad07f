"""Find the walls and columns that stand in the way of a line on a storey."""

# pyright: reportUnknownMemberType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false
from __future__ import annotations

from collections.abc import Iterator

import shapely
from jaxtyping import Float

from trundle._typing import Array
from trundle.structure.building.parts import Building

__all__ = ["in_the_way"]

_GATE = 0.05  # m


def in_the_way(
    building: Building, storey: str, line: Float[Array, "corners 2"]
) -> Iterator[tuple[str, float, float]]:
    """Give what stands on a storey where a line runs, and where that is in plan [m].

    A wall at which the line begins or ends is none: there is a gate.
    """
    way = shapely.LineString(line)
    shapes = [
        (f"wall {i}", w, shapely.LineString(w.along)) for i, w in enumerate(building.walls, 1)
    ]
    shapes += [
        (f"column {i}", c, shapely.Polygon(c.footprint)) for i, c in enumerate(building.columns, 1)
    ]
    for name, part, shape in shapes:
        between = [s.name for s in building.between(part.bottom, part.top)]
        if storey not in between[:-1]:  # what ends at a storey does not stand on it
            continue
        met = way.intersection(shape)
        if met.is_empty or min(met.distance(shapely.Point(end)) for end in line[[0, -1]]) < _GATE:
            continue
        x, y = shapely.get_coordinates(met.centroid)[0].tolist()
        yield name, x, y

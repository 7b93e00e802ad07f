"""The sections of a study file, a file each: fields, conversion, how they fit together.

A file here has `SectionKind` values for its tables, and any of three functions:

- ``build(draft)`` returns the draft with the section's values, and the mistakes on the way;
- ``problems(draft)`` gives what can only be told when all sections are built;
- ``fields(draft)`` returns what a `Study` takes from it.
"""

from trundle.study_file.kinds import SectionKind
from trundle.study_file.sections import (
    criteria,
    floor,
    general,
    map,
    method,
    point,
    published,
    road,
    route,
    vehicle,
)

__all__ = ["FILES", "KINDS"]

FILES = (general, floor, vehicle, route, road, method, criteria, point, map, published)
"""In the order in which they are built: each may use what those before it have made."""

KINDS: tuple[SectionKind, ...] = (
    floor.FLOOR,
    road.ROUGHNESS,
    criteria.CRITERIA,
    map.MAP,
    published.PUBLICATION,
    vehicle.VEHICLE,
    road.ROAD,
    route.ROUTE,
    route.TRAFFIC,
    point.POINT,
    method.METHOD,
    published.PRINTED,
    published.PRINTED_BOUND,
    published.NOTE,
)
"""In the order in which they are listed where one is unknown."""

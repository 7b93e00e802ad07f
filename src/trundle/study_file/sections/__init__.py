"""The sections of a study file, a file each: fields, conversion, how they fit together.

A file here has `SectionKind` values for its tables, and any of three functions:

- ``build(draft)`` returns the draft with the section's values, and the mistakes on the way;
- ``problems(draft)`` gives what can only be told when all sections are built;
- ``fields(draft)`` returns what a `Study` takes from it.

A file that is not named here is found, and built after those that are.
"""

from importlib import import_module
from pkgutil import iter_modules

from trundle.study_file.kinds import SectionKind
from trundle.study_file.sections import (
    building,
    criteria,
    feature,
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

_FIRST = (
    general,
    floor,
    building,
    vehicle,
    route,
    road,
    feature,
    method,
    criteria,
    point,
    map,
    published,
)
_OTHERS = tuple(
    import_module(f"{__name__}.{found.name}")
    for found in iter_modules(__path__)
    if f"{__name__}.{found.name}" not in {file.__name__ for file in _FIRST}
)
FILES = (*_FIRST, *_OTHERS)
"""In the order in which they are built: each may use what those before it have made."""

KINDS: tuple[SectionKind, ...] = (
    floor.FLOOR,
    building.BUILDING,
    road.ROUGHNESS,
    criteria.CRITERIA,
    map.MAP,
    published.PUBLICATION,
    vehicle.VEHICLE,
    road.ROAD,
    feature.FEATURE,
    route.ROUTE,
    route.TRAFFIC,
    point.POINT,
    method.METHOD,
    published.PRINTED,
    published.PRINTED_BOUND,
    published.NOTE,
    *(kind for file in _OTHERS for kind in vars(file).values() if isinstance(kind, SectionKind)),
)
"""In the order in which they are listed where one is unknown."""

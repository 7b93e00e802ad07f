"""Turn a building into what is meshed: a sheet for each storey and ramp, tied along walls."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import combinations, pairwise
from typing import TypeAlias

import numpy as np
from jaxtyping import Float

from trundle._typing import Array
from trundle.errors import InputError
from trundle.structure.building.parts import Building, Column, Ramp
from trundle.structure.mesh.planar import SNAP, on_segment
from trundle.structure.mesh.polygons import covers
from trundle.structure.mesh.sheet import Area, Sheet, Tie

__all__ = ["Guides", "has_slab", "meets", "passes", "plane_of", "sheets_of", "ties_of"]


Guides: TypeAlias = Mapping[str, Sequence[Float[Array, "_ 2"]]]
"""Lines, and places with one corner, by the storey or ramp whose mesh follows them [m]."""


def sheets_of(building: Building, guides: Guides) -> tuple[Sheet, ...]:
    """Return a sheet for each storey, then for each ramp."""
    storeys = [_storey_sheet(building, s.name, s.level, guides) for s in building.storeys]
    return (*storeys, *(_ramp_sheet(building, ramp, guides) for ramp in building.ramps))


def _storey_sheet(building: Building, name: str, level: float, guides: Guides) -> Sheet:
    slabs = [(i, slab) for i, slab in enumerate(building.slabs) if slab.on == name]
    areas = [
        Area(outline=s.outline, openings=s.openings, tag=i, over=s.panel)
        for i, s in sorted(slabs, key=lambda pair: pair[1].panel)  # panels take over
    ]
    lines = [*_lines_on(building, name, guides)]
    lines += [w.along for w in building.walls if name in _names(building, w.bottom, w.top)]
    lines += [*_ramp_edges(building, name)]
    nodes = [column.at for column in building.columns if passes(building, column, name)]
    lines += [*_heads(building, name, areas)]
    return Sheet(
        name=name,
        areas=tuple(areas),
        lines=tuple(lines),
        points=np.concatenate([*(n[None] for n in nodes), _points_on(building, name, guides)]),
        plane=np.array([level, 0.0, 0.0]),
    )


def _ramp_edges(building: Building, name: str) -> Iterator[Array]:
    """Give the edges at which ramps begin and end on a storey."""
    for ramp in building.ramps:
        if ramp.bottom == name:
            yield ramp.outline[:2]
        if ramp.top == name:
            yield ramp.outline[2:]


def _ramp_sheet(building: Building, ramp: Ramp, guides: Guides) -> Sheet:
    tag = len(building.slabs) + building.ramps.index(ramp)
    return Sheet(
        name=ramp.name,
        areas=(Area(outline=ramp.outline, tag=tag),),
        lines=tuple(_lines_on(building, ramp.name, guides)),
        points=_points_on(building, ramp.name, guides),
        plane=plane_of(building, ramp),
    )


def _lines_on(building: Building, name: str, guides: Guides) -> Iterator[Array]:
    """Give the lines of beams, supports, masses, joints and guides on a sheet."""
    yield from (beam.along for beam in building.beams if beam.on == name)
    yield from (line for line in _laid(building, name, guides) if len(line) > 1)


def _points_on(building: Building, name: str, guides: Guides) -> Array:
    """Return the places of point supports, masses and guides on a sheet."""
    single = [line for line in _laid(building, name, guides) if len(line) == 1]
    braces = [b.ends[i][None] for b in building.braces for i in (0, 1) if b.on[i] == name]
    return np.concatenate([np.zeros((0, 2)), *braces, *single])


def _laid(building: Building, name: str, guides: Guides) -> Iterator[Array]:
    for part in (*building.supports, *building.masses):
        if part.on == name:
            yield part.along
    for joint in building.joints:
        if joint.on == name:
            yield from (joint.along, joint.to)
    yield from guides.get(name, ())


def _heads(building: Building, name: str, areas: list[Area]) -> Iterator[Array]:
    """Give the outlines of columns' cross-sections that a slab is joined to."""
    for column in building.columns:
        joined = column.head == "rigid" and passes(building, column, name)
        if joined and any(covers(a.outline, a.openings, column.at[None])[0] for a in areas):
            yield np.vstack([column.footprint, column.footprint[:1]])


def passes(building: Building, column: Column, name: str) -> bool:
    """Return whether a column has a node at a storey: its ends, and where something meets it."""
    if name not in _names(building, column.bottom, column.top):
        return False
    return name in (column.bottom, column.top) or meets(building, name, column.at)


def meets(building: Building, name: str, place: Float[Array, " 2"]) -> bool:
    """Return whether a slab, a beam, a wall or a ramp's edge of a storey is at a place."""
    at = place[None]
    if has_slab(building, name, place):
        return True
    lines = [beam.along for beam in building.beams if beam.on == name]
    lines += [w.along for w in building.walls if name in _names(building, w.bottom, w.top)]
    lines += [*_ramp_edges(building, name)]
    pairs = (np.stack(pair) for line in lines for pair in pairwise(line))
    return any(on_segment(at, pair)[0] for pair in pairs)


def has_slab(building: Building, name: str, place: Float[Array, " 2"]) -> bool:
    """Return whether a slab of a storey is at a place, and no panel has an opening there."""
    at, slabs = place[None], [s for s in building.slabs if s.on == name]
    if not any(covers(s.outline, s.openings, at)[0] for s in slabs if not s.panel):
        return False
    return all(
        covers(s.outline, s.openings, at)[0] or not covers(s.outline, (), at)[0]
        for s in slabs
        if s.panel
    )


def _names(building: Building, bottom: str, top: str) -> list[str]:
    return [storey.name for storey in building.between(bottom, top)]


def plane_of(building: Building, ramp: Ramp) -> Float[Array, " 3"]:
    """Return the plane of a ramp, ``z = p[0] + p[1] x + p[2] y``.

    Raises
    ------
    InputError
        Corners that lie in no plane: edges that are not parallel, as a ramp's must be.
    """
    z = np.repeat([building.level(ramp.bottom), building.level(ramp.top)], 2)
    rows = np.column_stack([np.ones(4), ramp.outline])
    plane, *_ = np.linalg.lstsq(rows, z, rcond=None)
    if np.abs(rows @ plane - z).max() > SNAP:
        raise InputError(
            f"ramp {ramp.name!r} is warped: its lower and its upper edge must be parallel"
        )
    return plane


def ties_of(building: Building) -> tuple[Tie, ...]:
    """Return where sheets are divided alike: along walls, and where ramps begin and end."""
    number = {name: i for i, name in enumerate(building.floors)}
    found = []
    for wall in building.walls:
        names = [number[n] for n in _names(building, wall.bottom, wall.top)]
        found += [Tie(sheets=(a, b), line=wall.along) for a, b in pairwise(names)]
    for ramp in building.ramps:
        for storey, edge in ((ramp.bottom, ramp.outline[:2]), (ramp.top, ramp.outline[2:])):
            found.append(Tie(sheets=(number[storey], number[ramp.name]), line=edge))
    for one, other in combinations(building.ramps, 2):
        for line in _shared_edges(building, one, other):
            found.append(Tie(sheets=(number[one.name], number[other.name]), line=line))
    return tuple(found)


def _shared_edges(building: Building, one: Ramp, other: Ramp) -> Iterator[Float[Array, "2 2"]]:
    """Give the lines along which two ramps lie beside each other at one height."""
    planes = [plane_of(building, ramp) for ramp in (one, other)]
    for a in _sides(one):
        for b in _sides(other):
            along = (a[1] - a[0]) / np.hypot(*(a[1] - a[0]))
            aside = np.abs((b - a[0]) @ np.array([-along[1], along[0]]))
            reach = np.sort((b - a[0]) @ along)
            low, high = max(reach[0], 0.0), min(reach[1], float(np.hypot(*(a[1] - a[0]))))
            line = a[0] + np.outer([low, high], along)
            z = np.column_stack([np.ones(2), line]) @ np.transpose(planes)
            if aside.max() < SNAP and high - low > SNAP and np.abs(np.diff(z)).max() < SNAP:
                yield line


def _sides(ramp: Ramp) -> Iterator[Float[Array, "2 2"]]:
    yield from np.stack([ramp.outline, np.roll(ramp.outline, -1, axis=0)], axis=1)

"""Tell mistakes in beams, columns, walls, braces, supports, masses and joints."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations, pairwise

import numpy as np

from trundle._typing import Array
from trundle.errors import Problem
from trundle.structure.building.check_words import parts, shared_storeys, shown
from trundle.structure.building.joint import line_problems
from trundle.structure.building.parts import Building, Column
from trundle.structure.building.sheets import meets
from trundle.structure.mesh.planar import SNAP, on_segment
from trundle.structure.mesh.polygons import covers, overlap, shared_length
from trundle.structure.sections import ShellSection

__all__ = ["joint_problems", "member_problems"]

_SHORT = 0.02  # m, below which a member has no length
_SHARED = 0.2  # m; lines that cross at more than a degree lie within `SNAP` of each other for less


def joint_problems(building: Building) -> Iterator[Problem]:
    """Give members that meet nothing, or lie in each other."""
    yield from _columns(building)
    yield from _walls(building)
    yield from _twice(building)
    yield from _braces(building)
    yield from _on_something(building)
    yield from line_problems(building.joints)


def member_problems(building: Building) -> Iterator[Problem]:
    """Give members without length, and storeys in the wrong order."""
    lines = [(f"beam[{i}].along", b.along) for i, b in enumerate(building.beams, start=1)]
    lines += [(f"wall[{i}].along", w.along) for i, w in enumerate(building.walls, start=1)]
    for kind in ("support", "mass"):
        for i, part in enumerate(parts(building, kind), start=1):
            if len(part.along) > 1:
                lines.append((f"{kind}[{i}].along", part.along))
    for i, joint in enumerate(building.joints, start=1):
        lines += [(f"joint[{i}].along", joint.along), (f"joint[{i}].to", joint.to)]
    for place, line in lines:
        steps = np.linalg.norm(np.diff(line, axis=0), axis=1)
        if len(line) < 2 or steps.min() < _SHORT:
            yield Problem(
                place=place,
                value=shown(line),
                rule=f"a line has two places or more, {1e3 * _SHORT:g} mm or more apart",
                remedy="give where it begins and where it ends",
            )
        elif _doubles_back(line):
            yield Problem(
                place=place,
                value=shown(line),
                rule="a line does not run over itself: what lies there would count twice",
                remedy="remove the places that lead back",
            )
    for kind in ("column", "wall", "ramp"):
        for i, part in enumerate(parts(building, kind), start=1):
            if building.level(part.bottom) >= building.level(part.top):
                yield Problem(
                    place=f"{kind}[{i}].to",
                    value=f"{part.top!r}, which is not above {part.bottom!r}",
                    rule=f"a {kind} rises from one storey to another",
                    remedy="exchange from and to, or name two storeys",
                )


def _doubles_back(line: Array) -> bool:
    """Return whether pieces of a line lie on each other."""
    pieces = [np.stack(pair) for pair in pairwise(line)]
    return any(shared_length(a, b) > _SHARED for a, b in combinations(pieces, 2))


def _columns(building: Building) -> Iterator[Problem]:
    for i, column in enumerate(building.columns, start=1):
        at = f"({column.at[0]:g}, {column.at[1]:g}) m"
        if column.base is None and not meets(building, column.bottom, column.at):
            yield Problem(
                place=f"column[{i}].base",
                value=f"nothing under it on {column.bottom!r} at {at}",
                rule="a column stands on a slab, a beam or a wall, or has a base",
                remedy='set base = "fixed" or "pinned", or move it onto something',
            )
        if column.cap is None and not meets(building, column.top, column.at):
            yield Problem(
                place=f"column[{i}].at",
                value=f"{at}: nothing over it on {column.top!r}",
                rule="a column carries a slab, a beam or a wall at its top",
                remedy="move it under something, end it lower, or set cap where it is held above",
            )
    yield from _columns_together(building)


def _columns_together(building: Building) -> Iterator[Problem]:
    """Give columns that stand in each other."""
    for (i, one), (j, other) in combinations(enumerate(building.columns, start=1), 2):
        reach = 0.5 * (_diagonal(one) + _diagonal(other))
        if np.hypot(*(one.at - other.at)) >= reach or not shared_storeys(building, one, other):
            continue
        if overlap((one.footprint, ()), (other.footprint, ())) > 0.0:
            yield Problem(
                place=f"column[{j}].at",
                value=f"({other.at[0]:g}, {other.at[1]:g}) m, within column {i}",
                rule="columns must not stand in each other",
                remedy="remove one, or move it; where the section changes, end one below the other",
            )


def _diagonal(column: Column) -> float:
    return float(np.hypot(column.profile.depth, column.profile.width))


def _walls(building: Building) -> Iterator[Problem]:
    for i, wall in enumerate(building.walls, start=1):
        if not isinstance(wall.section, ShellSection):
            yield Problem(
                place=f"wall[{i}].plate",
                value="ribbed, hollow, or of other stiffness along its axis than across it",
                rule="a wall is a solid plate: the axis of such a plate lies level",
                remedy="give its plate a thickness, and a stiffness_factor that makes it as stiff",
            )
        if wall.base is None and not all(
            any(covers(s.outline, s.openings, end[None])[0] for s in building.slabs
                if s.on == wall.bottom)
            or any(_on_line(b.along, end) for b in building.beams if b.on == wall.bottom)
            for end in wall.along
        ):  # fmt: skip
            yield Problem(
                place=f"wall[{i}].base",
                value=f"nothing under an end of it on {wall.bottom!r}",
                rule="a wall stands on a slab or a beam, or has a base",
                remedy='set base = "fixed" or "pinned", or move it onto something',
            )
        for plane in building.symmetry:
            if (np.abs(plane.away(wall.along)) < SNAP).all():
                yield Problem(
                    place=f"wall[{i}].along",
                    value=f"in the plane {plane}",
                    rule="a wall in a plane of symmetry would belong to the model by half",
                    remedy="model the building beyond the plane, or leave the wall out",
                )


def _on_line(line: Array, place: Array) -> bool:
    return any(on_segment(place[None], np.stack(pair))[0] for pair in pairwise(line))


def _braces(building: Building) -> Iterator[Problem]:
    for i, brace in enumerate(building.braces, start=1):
        if brace.on[0] == brace.on[1] and np.hypot(*(brace.ends[1] - brace.ends[0])) < _SHORT:
            yield Problem(
                place=f"brace[{i}]",
                value=shown(brace.ends),
                rule="a brace joins two places",
                remedy="give where it begins and where it ends, and on which storeys",
            )
        for on, end in zip(brace.on, brace.ends, strict=True):
            if not _joint(building, on, end):
                yield Problem(
                    place=f"brace[{i}]",
                    value=f"nothing on {on!r} at ({end[0]:g}, {end[1]:g}) m",
                    rule="a brace ends at a slab, a beam, a column or a wall",
                    remedy="move the end to one of them",
                )


def _joint(building: Building, on: str, place: Array) -> bool:
    """Return whether anything of a building has a node there."""
    if on in {r.name for r in building.ramps}:
        ramp = next(r for r in building.ramps if r.name == on)
        return bool(covers(ramp.outline, (), place[None])[0])
    ends = (c for c in building.columns if on in (c.bottom, c.top))
    return meets(building, on, place) or any(np.hypot(*(c.at - place)) < SNAP for c in ends)


def _on_something(building: Building) -> Iterator[Problem]:
    """Give supports and masses where nothing is, and supports that hold nothing."""
    for kind in ("support", "mass"):
        for i, part in enumerate(parts(building, kind), start=1):
            key = "at" if len(part.along) == 1 else "along"
            for place in part.along:
                if not _joint(building, part.on, place):
                    yield Problem(
                        place=f"{kind}[{i}].{key}",
                        value=f"nothing on {part.on!r} at ({place[0]:g}, {place[1]:g}) m",
                        rule=f"a {kind} is on a slab, a beam, a column or a wall",
                        remedy="move it there",
                    )
                    break
    for i, joint in enumerate(building.joints, start=1):
        for key, line in (("along", joint.along), ("to", joint.to)):
            where = next((p for p in line if not _joint(building, joint.on, p)), None)
            if where is not None:
                yield Problem(
                    place=f"joint[{i}].{key}",
                    value=f"nothing on {joint.on!r} at ({where[0]:g}, {where[1]:g}) m",
                    rule="each edge of a joint is on a slab, a beam or a wall",
                    remedy="move it there",
                )
    for i, support in enumerate(building.supports, start=1):
        if not any(support.held) and not any(support.springs):
            yield Problem(
                place=f"support[{i}]",
                value="nothing held, and no spring",
                rule="a support holds something",
                remedy='set hold = ["uz"], a kind such as "pinned", or springs',
            )


def _twice(building: Building) -> Iterator[Problem]:
    """Give beams and walls that lie on each other: both would count."""
    for kind in ("beam", "wall"):
        numbered = list(enumerate(parts(building, kind), start=1))
        for (i, one), (j, other) in combinations(numbered, 2):
            together = (
                one.on == other.on if kind == "beam" else shared_storeys(building, one, other)
            )
            if together and shared_length(one.along, other.along) > _SHARED:
                yield Problem(
                    place=f"{kind}[{j}].along",
                    value=shown(other.along),
                    rule=f"it lies on {kind} {i}, and both would count",
                    remedy="remove one, or shorten it to where the other ends",
                )

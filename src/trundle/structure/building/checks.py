"""Tell every mistake in a building before anything is meshed, with its place and its remedy."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import chain, combinations, pairwise

import numpy as np

from trundle.errors import Problem
from trundle.structure.building.check_areas import area_problems, overlap_problems
from trundle.structure.building.check_members import joint_problems, member_problems
from trundle.structure.building.check_words import parts
from trundle.structure.building.parts import Building
from trundle.structure.mesh.planar import SNAP

__all__ = ["building_problems"]

_FAR = 10_000.0  # m
_CLOSE = 0.2  # m between storeys
_SQUARE = 1e-6  # of angles between planes of symmetry


def building_problems(building: Building) -> list[Problem]:
    """Return the mistakes of a building; what they make meaningless is not looked at.

    Parameters
    ----------
    building : Building
        Any.

    Returns
    -------
    list of Problem
        Places as in a study file, counted from 1: ``column[3].at``.
    """
    for some in (
        (_far, _storeys, _names),
        (area_problems, member_problems),
        (overlap_problems, joint_problems, _symmetry),
    ):
        found = list(chain.from_iterable(look(building) for look in some))
        if found:
            return found
    return []


def _far(building: Building) -> Iterator[Problem]:
    """Give places that are further off than any building reaches."""
    for kind in ("slab", "beam", "wall", "column", "ramp", "support", "mass", "brace", "joint"):
        for i, part in enumerate(parts(building, kind), start=1):
            for key in ("outline", "along", "to", "at", "ends"):
                places = getattr(part, key, None)
                if places is not None and np.abs(places).max(initial=0.0) > _FAR:
                    yield Problem(
                        place=f"{kind}[{i}].{key}",
                        value=f"{np.abs(places).max():.3g} m",
                        rule=f"places lie within {_FAR:g} m of the origin",
                        remedy="check the unit, or give coordinates from a corner of the building",
                    )


def _storeys(building: Building) -> Iterator[Problem]:
    if not building.storeys:
        yield Problem(
            place="storey",
            value="none",
            rule="a building has a storey at least",
            remedy='add [[building.storey]] with name = "ground" and level = "0 m"',
        )
    for i, (low, high) in enumerate(pairwise(building.storeys), start=2):
        if high.level - low.level < _CLOSE:
            yield Problem(
                place=f"storey[{i}].level",
                value=f"{high.level:g} m, above {low.name!r} at {low.level:g} m",
                rule=f"storeys stand from below to above, {_CLOSE:g} m or more apart",
                remedy="put them in order, or join two levels to one",
            )
    for name in {n for n in building.floors if building.floors.count(n) > 1}:
        yield Problem(
            place="storey",
            value=f"{name!r} {building.floors.count(name)} times",
            rule="names of storeys and ramps must differ, for parts are found by them",
            remedy="rename one",
        )


def _names(building: Building) -> Iterator[Problem]:
    """Give names of storeys that there are not."""
    storeys = [s.name for s in building.storeys]
    asked = [
        (f"{kind}[{i}].on", part.on, building.floors if kind != "slab" else storeys)
        for kind in ("slab", "beam", "support", "mass", "joint")
        for i, part in enumerate(parts(building, kind), start=1)
    ]
    for kind in ("column", "wall", "ramp"):
        for i, part in enumerate(parts(building, kind), start=1):
            asked += [(f"{kind}[{i}].from", part.bottom, storeys)]
            asked += [(f"{kind}[{i}].to", part.top, storeys)]
    for i, brace in enumerate(building.braces, start=1):
        asked += [(f"brace[{i}].on", name, building.floors) for name in brace.on]
    for place, name, known in asked:
        if name not in known:
            yield Problem(
                place=place,
                value=repr(name),
                rule="must be the name of a storey" + (" or ramp" if known != storeys else ""),
                remedy=f"there are: {', '.join(known) or 'none'}",
            )


def _symmetry(building: Building) -> Iterator[Problem]:
    """Give planes of symmetry with parts on both sides."""
    rows = [s.outline for s in (*building.slabs, *building.ramps)]
    rows += [part.along for part in (*building.beams, *building.walls)]
    rows += [column.at[None] for column in building.columns]
    if not rows:
        return
    places = np.concatenate(rows)
    for i, plane in enumerate(building.symmetry, start=1):
        away = plane.away(places)
        if np.abs(away).min() > SNAP:
            yield Problem(
                place=f"symmetry[{i}].at",
                value=str(plane),
                rule="a plane of symmetry ends the model: a part reaches it",
                remedy="move it to where the model ends, or remove it: loads would have images "
                "beyond it",
            )
        if away.min() < -SNAP and away.max() > SNAP:
            yield Problem(
                place=f"symmetry[{i}].at",
                value=str(plane),
                rule="a plane of symmetry ends the model: all parts lie on one side of it",
                remedy="remove the parts beyond it: they are the mirror images of those before",
            )
    yield from _wedges(building)


def _wedges(building: Building) -> Iterator[Problem]:
    """Give planes that meet at an angle whose mirror images do not close round their corner."""
    numbered = enumerate(building.mirrors, start=1)
    for (i, one), (j, other) in combinations(numbered, 2):
        angle = one.angle_to(other)
        if angle < _SQUARE or abs(np.pi / angle - np.round(np.pi / angle)) < _SQUARE:
            continue
        yield Problem(
            place=f"symmetry[{j}].along",
            value=f"{other}, at {np.degrees(angle):.4g} degrees to plane {i}",
            rule="planes of symmetry meet at 90, 60, 45, ... degrees: mirror images close so alone",
            remedy="turn one of them, or model the building beyond it",
        )

"""Tell mistakes in slabs, openings and ramps."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations

import numpy as np

from trundle._typing import Array
from trundle.errors import Problem
from trundle.structure.building.check_words import outline, shown
from trundle.structure.building.parts import Building, Ramp
from trundle.structure.building.sheets import plane_of
from trundle.structure.mesh.polygons import fault_of, overlap, uncovered

__all__ = ["area_problems", "overlap_problems"]

_STEEP = 0.5  # rise over run of a ramp
_SLIVER = 1e-3  # m2


def area_problems(building: Building) -> Iterator[Problem]:
    """Give outlines that enclose nothing sound, openings outside, and ramps that are warped."""
    yield from _slabs(building)
    yield from _ramps(building)


def _slabs(building: Building) -> Iterator[Problem]:
    """Give outlines that enclose nothing sound, and openings outside."""
    for i, slab in enumerate(building.slabs, start=1):
        fault = fault_of(slab.outline)
        if fault is not None:
            yield outline(f"slab[{i}].outline", slab.outline, fault)
            continue
        for j, opening in enumerate(slab.openings, start=1):
            place, fault = f"slab[{i}].openings[{j}]", fault_of(opening)
            if fault is not None:
                yield outline(place, opening, fault)
            elif uncovered(opening, (slab.outline, ())) > _SLIVER:
                yield Problem(
                    place=place,
                    value=shown(opening),
                    rule="an opening must lie within the outline",
                    remedy="move it inside, or draw the outline round it",
                )
            elif any(_crosses(opening, other) for other in slab.openings[: j - 1]):
                yield Problem(
                    place=place,
                    value=shown(opening),
                    rule="openings must not overlap",
                    remedy="join the two to one",
                )


def _crosses(one: Array, other: Array) -> bool:
    return fault_of(other) is None and overlap((one, ()), (other, ())) > _SLIVER


def _ramps(building: Building) -> Iterator[Problem]:
    for i, ramp in enumerate(building.ramps, start=1):
        fault = fault_of(ramp.outline)
        if fault is not None:
            yield outline(f"ramp[{i}].outline", ramp.outline, fault)
        elif building.level(ramp.bottom) < building.level(ramp.top):
            yield from _one_ramp(building, f"ramp[{i}].outline", ramp)


def _one_ramp(building: Building, place: str, ramp: Ramp) -> Iterator[Problem]:
    lower, upper = ramp.outline[:2], ramp.outline[2:]
    edges = [lower[1] - lower[0], upper[1] - upper[0]]
    cross = edges[0][0] * edges[1][1] - edges[0][1] * edges[1][0]
    if abs(cross) > 1e-3 * np.linalg.norm(edges[0]) * np.linalg.norm(edges[1]):
        yield Problem(
            place=place,
            value=shown(ramp.outline),
            rule="the lower and the upper edge of a ramp must be parallel, or it would be warped",
            remedy="give both ends of the lower edge, then of the upper one, in order round it",
        )
        return
    slope = float(np.hypot(*plane_of(building, ramp)[1:]))
    if slope > _STEEP:
        yield Problem(
            place=place,
            value=f"a slope of {100.0 * slope:.0f} %",
            rule=f"a ramp rises by {100.0 * _STEEP:g} % at most",
            remedy="lengthen it; its first two corners are the lower edge, the other two the upper",
        )


def overlap_problems(building: Building) -> Iterator[Problem]:
    """Give slabs that lie in each other, and panels that lie on none."""
    numbered = list(enumerate(building.slabs, start=1))
    for (i, one), (j, other) in combinations(numbered, 2):
        shared = (
            overlap((one.outline, one.openings), (other.outline, other.openings))
            if one.on == other.on and one.panel == other.panel
            else 0.0
        )
        if shared > _SLIVER:
            yield Problem(
                place=f"slab[{j}].outline",
                value=f"{shared:.3g} m2 shared with slab {i}",
                rule="slabs of a storey must not overlap: which one would be there?",
                remedy="draw them side by side"
                + ("" if one.panel else "; a thicker part over another has panel = true"),
            )
    for i, slab in numbered:
        under = [s for s in building.slabs if s.on == slab.on and not s.panel]
        if slab.panel and not any(
            overlap((slab.outline, ()), (s.outline, s.openings)) > _SLIVER for s in under
        ):
            yield Problem(
                place=f"slab[{i}].panel",
                value="true",
                rule="a panel takes the place of a slab, and none lies there",
                remedy="remove panel = true, or move it onto a slab",
            )

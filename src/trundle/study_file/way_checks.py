"""Say where a route leaves the slabs: its line, and the wheels beside and behind it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise

import numpy as np

from trundle._typing import Array
from trundle.errors import Problem
from trundle.road import RoadClass
from trundle.route import wheel_places
from trundle.simulate import Crossing
from trundle.simulate.sources.passage import Passage
from trundle.simulate.sources.within import check_within
from trundle.simulate.wheels.surfaces import tracks_on
from trundle.structure import Structure, Surface
from trundle.study_file.attempt import attempted
from trundle.study_file.draft import Draft, covered, is_off, surface_at

__all__ = ["off_slabs", "standing_problems", "way_problems", "wheels_off"]

_LOOKED_AT = 0.1  # m along a route
_ON_PLANE = 1e-6  # m


def off_slabs(draft: Draft) -> Iterator[Problem]:
    """Give routes on no storey, and routes that leave its slabs: over an opening, past an edge."""
    for i, section in draft.file.lists.get("route", []):
        legs = list(pairwise(np.array(section.path)))
        names = section.through or (section.only,) * len(legs)
        surfaces: dict[str | None, Surface | None] = {}
        for name in dict.fromkeys(names):
            surfaces[name], mistakes = surface_at(draft, f"route[{i + 1}].on", name)
            yield from mistakes
        if draft.extent is None or any(is_off(draft.extent, place) for place in section.path):
            continue  # told already
        for j, ((start, end), name) in enumerate(zip(legs, names, strict=True), start=1):
            surface = surfaces[name]
            if surface is not None:
                yield from _leg_off(f"route[{i + 1}].path[{j}]", start, end, surface)


def _place_problems(
    draft: Draft, place: str, key: str, at: Sequence[Sequence[float]], on: str | None
) -> Iterator[Problem]:
    """Give places off the floor, over no slab, or on no storey."""
    surface, mistakes = surface_at(draft, f"{place}.on", on)
    yield from mistakes
    for i, one in enumerate(np.array(at, dtype=float).reshape(-1, 2)):
        here = f"{place}.{key}" + (f"[{i + 1}]" if len(at) > 1 else "")
        value = f"({one[0]:g}, {one[1]:g}) m"
        if draft.extent is not None and is_off(draft.extent, (one[0], one[1])):
            rule = f"must stand on the floor; {covered(draft.extent)}"
            yield Problem(place=here, value=value, rule=rule, remedy="move it onto the floor")
        elif surface is not None and not surface.holds(surface.frame.from_plan(one[None]))[0]:
            rule = f"must stand on a slab of {surface.name!r}"
            yield Problem(place=here, value=value, rule=rule, remedy="move it onto the slab")


def standing_problems(
    draft: Draft, place: str, key: str, at: Sequence[Sequence[float]], on: str | None
) -> Iterator[Problem]:
    """Give what stands off the floor, and what stands on a plane of symmetry, half of it beyond.

    Parameters
    ----------
    draft : Draft
        With a floor.
    place : str
        What stands there.
    key : str
        Its key that says where.
    at : sequence of pairs of float
        Where, in plan [m].
    on : str or None
        Name of the surface.

    Yields
    ------
    Problem
        One for each place.
    """
    yield from _place_problems(draft, place, key, at, on)
    for i, one in enumerate(np.array(at, dtype=float).reshape(-1, 2)):
        if _on_mirror(draft, one, on):
            yield Problem(
                place=f"{place}.{key}" + (f"[{i + 1}]" if len(at) > 1 else ""),
                value=f"({one[0]:g}, {one[1]:g}) m",
                rule="what stands on a plane of symmetry is half beyond it, with half its force",
                remedy="move it off the plane, where it has an image beyond; or model the whole",
            )


def _on_mirror(draft: Draft, place: Array, on: str | None) -> bool:
    """Return whether a place of the plan lies on a plane of symmetry."""
    if draft.plan is not None:
        (x0, x1), (y0, y1) = draft.plan.x_extent, draft.plan.y_extent
        lines = {"x_min": (0, x0), "x_max": (0, x1), "y_min": (1, y0), "y_max": (1, y1)}
        return any(
            draft.plan.edges.get(name) == "symmetry" and abs(place[axis] - at) < _ON_PLANE
            for name, (axis, at) in lines.items()
        )
    surface, _ = surface_at(draft, "", on)
    if draft.model is None or surface is None:
        return False
    space = surface.frame.in_space(surface.frame.from_plan(place[None]))
    return any(abs(float(m.away(space)[0])) < _ON_PLANE for m in draft.model.mirrors)


def way_problems(
    draft: Draft, place: str, path: Sequence[Sequence[float]], on: str | None
) -> Iterator[Problem]:
    """Give corners of a way off the floor, and legs over no slab.

    Parameters
    ----------
    draft : Draft
        With a floor.
    place : str
        Who goes there.
    path : sequence of pairs of float
        Corners in plan [m].
    on : str or None
        Name of the surface.

    Yields
    ------
    Problem
        One for each corner or leg.
    """
    off = list(_place_problems(draft, place, "path", path, on))
    yield from off
    surface, _ = surface_at(draft, f"{place}.on", on)
    if surface is None or off:
        return
    for j, (start, end) in enumerate(pairwise(np.array(path)), start=1):
        yield from _leg_off(f"{place}.path[{j}]", start, end, surface)


def _leg_off(place: str, start: Array, end: Array, surface: Surface) -> Iterator[Problem]:
    n = max(2, int(np.ceil(np.hypot(*(end - start)) / _LOOKED_AT)) + 1)
    places = start + np.linspace(0.0, 1.0, n)[:, None] * (end - start)
    off = places[~surface.holds(surface.frame.from_plan(places))]
    if len(off):
        (a, b), (c, d) = off[0], off[-1]
        yield Problem(
            place=place,
            value=f"a way over no slab from ({a:.4g}, {b:.4g}) to ({c:.4g}, {d:.4g}) m",
            rule=f"a route must stay on the slabs of {surface.name!r}",
            remedy="lead it round openings and walls; 'trundle check' draws the plan",
        )


def wheels_off(draft: Draft) -> Iterator[Problem]:
    """Give vehicles that cannot drive a route, and wheels beside it that leave the slabs."""
    method = next(iter(draft.methods.values()), None)
    for i, section in draft.file.lists.get("route", []):
        drive = draft.drives.get(section.name)
        if drive is None or method is None:
            continue
        place = f"route[{i + 1}]"
        crossing, mistakes = attempted(
            place,
            lambda d=drive, m=method: Crossing(
                d.vehicle, d.route, RoadClass("A"), entry=m.entry, run_in=d.run_in
            ),
        )
        yield from mistakes
        if crossing is None:
            continue
        for one in draft.methods.values():
            dt = one.interaction.integration.dt
            _, mistakes = attempted(
                f"{draft.file.place_of(one.name, 'method')}.dt",
                lambda c=crossing, d=dt: check_within(c, d),
            )
            yield from mistakes
        if not section.through:
            surface, _ = surface_at(draft, place, section.only)
            yield from _aside(draft, place, crossing, surface)
        elif draft.model is not None:
            yield from _aside_through(draft.model, place, crossing)


def _aside(
    draft: Draft, place: str, crossing: Crossing, surface: Surface | None
) -> Iterator[Problem]:
    """Give the first wheel that stands on no slab while the middle of its route does."""
    if (
        not np.any(crossing.driven.lateral)
        and not crossing.route.lane
        and not crossing.route.radius
    ):
        return
    way = crossing.route.length + crossing.driven.length
    front = np.linspace(0.0, way, max(3, int(way / _LOOKED_AT)))
    wheels = wheel_places(crossing.route, crossing.footprint, front)
    station = front[:, None] - crossing.footprint.setback
    on = (station >= 0.0) & (station <= crossing.route.length)
    for contact, name in enumerate(crossing.driven.contact_names):
        at = wheels.place[on[:, contact], contact]
        if surface is not None:
            off = at[~surface.holds(at)]
            off = surface.frame.to_plan(off) if len(off) else off
        else:
            outside = [draft.extent is not None and is_off(draft.extent, tuple(p)) for p in at]
            off = at[np.array(outside, dtype=bool)]
        if len(off):
            x, y = off[0]
            yield Problem(
                place=f"{place}.path",
                value=f"{name} at ({x:.4g}, {y:.4g}) m",
                rule="every wheel must stay on the slabs, those beside the path and behind it too",
                remedy="lead the path further from edges and openings, or round corners wider",
            )
            return


def _aside_through(model: Structure, place: str, crossing: Crossing) -> Iterator[Problem]:
    """Give the first wheel that stands on no slab of a way through several surfaces."""
    track = Passage(crossing=crossing).swept()
    for part in tracks_on(model, track) if all(n in model.surfaces for n in track.surfaces) else ():
        at = part.there & (track.share.ravel() != 0.0)
        off = np.flatnonzero(at)[~model.surface(part.on).holds(part.place[at])]
        if len(off):
            x, y = track.place.reshape(-1, 2)[off[0]]
            name = crossing.driven.contact_names[off[0] % track.share.shape[1]]
            yield Problem(
                place=f"{place}.path",
                value=f"{name} at ({x:.4g}, {y:.4g}) m",
                rule=f"every wheel must stay on the slabs, here those of {part.on!r}",
                remedy="let the way come onto another surface where the two meet, and lead it "
                "further from edges",
            )
            return

"""Say where a route leaves the slabs: its line, and the wheels beside and behind it."""

from __future__ import annotations

from collections.abc import Iterator
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
from trundle.study_file.draft import Draft, is_off, surface_at

__all__ = ["off_slabs", "wheels_off"]

_LOOKED_AT = 0.1  # m along a route


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
                f"method {one.name!r}.dt", lambda c=crossing, d=dt: check_within(c, d)
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
        not np.any(crossing.vehicle.lateral)
        and not crossing.route.lane
        and not crossing.route.radius
    ):
        return
    way = crossing.route.length + crossing.vehicle.length
    front = np.linspace(0.0, way, max(3, int(way / _LOOKED_AT)))
    wheels = wheel_places(crossing.route, crossing.footprint, front)
    station = front[:, None] - crossing.footprint.setback
    on = (station >= 0.0) & (station <= crossing.route.length)
    for contact, name in enumerate(crossing.vehicle.contact_names):
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
            name = crossing.vehicle.contact_names[off[0] % track.share.shape[1]]
            yield Problem(
                place=f"{place}.path",
                value=f"{name} at ({x:.4g}, {y:.4g}) m",
                rule=f"every wheel must stay on the slabs, here those of {part.on!r}",
                remedy="let the way come onto another surface where the two meet, and lead it "
                "further from edges",
            )
            return

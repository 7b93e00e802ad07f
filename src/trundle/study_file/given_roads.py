"""Say where a measured road, or a feature of one, does not suit what drives on it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from trundle.errors import InputError, Problem
from trundle.road import FeaturedRoad, MeasuredRoad, Road
from trundle.simulate import Crossing
from trundle.simulate.sources.given_road import given_road_doubts
from trundle.study.plans import Drive, MethodPlan
from trundle.study_file.draft import Draft

__all__ = ["given_road_problems"]

_ROUNDING = 1e-6  # m
_PYTHON = "RoughnessBand(contact_patch=0.2)"  # what a message says to who writes Python


def given_road_problems(draft: Draft, places: Mapping[str, str]) -> Iterator[Problem]:
    """Give surveys that do not cover a drive, and roads that a method's step cannot show.

    Parameters
    ----------
    draft : Draft
        With roads, drives and methods.
    places : mapping of str to str
        Where in the file each road stands, by label.

    Yields
    ------
    Problem
        One for each road, route and method of the kind.
    """
    for label, road in draft.roads.items():
        if not road.is_given:
            continue
        for name, drive in draft.drives.items():
            for method in draft.methods.values():
                who = f"route {name!r}"
                found = list(_of_one(draft, who, (places[label], road), drive, method))
                yield from found
                if found:
                    break


def _of_one(
    draft: Draft, who: str, road: tuple[str, Road], drive: Drive, method: MethodPlan
) -> Iterator[Problem]:
    assert draft.band is not None  # the caller has looked
    place, surface = road
    try:
        crossing = Crossing(
            drive.vehicle, drive.route, surface,
            band=method.band or draft.band, entry=method.entry, run_in=drive.run_in,
        )  # fmt: skip
        dt = method.interaction.integration.dt
        if (missing := _missing(crossing, dt)) is not None:
            value, rule, remedy = missing
            yield Problem(place=place, value=value, rule=who + rule, remedy=remedy)
            return
        given_road_doubts((crossing,), dt)
    except InputError as error:
        yield Problem(
            place=place,
            value=f"driven on {who} by method {method.name!r}",
            rule=str(error).replace(_PYTHON, 'contact_patch = "0.2 m"'),
            remedy="docs/roads.md says how tyres meet joints and profiles",
        )


def _missing(crossing: Crossing, dt: float) -> tuple[str, str, str] | None:
    """Return what a survey covers, which stretch of road is missing, and what would help."""
    base = crossing.road.base if isinstance(crossing.road, FeaturedRoad) else crossing.road
    if not isinstance(base, MeasuredRoad) or base.tracks[0].beyond != "unknown":
        return None
    half = 0.5 * crossing.band.contact_patch
    first = max(float(track.station[0]) for track in base.tracks) + half
    last = min(float(track.station[-1]) for track in base.tracks) - half
    begins = crossing.begins(dt)
    start, vehicle = crossing.chainage, crossing.driven.length
    low = float(crossing.along(np.array([begins]), begins).station.min()) + start
    high = start + crossing.route.length + max(0.0, -crossing.lead) + vehicle
    gaps = []
    if low < first - _ROUNDING:
        gaps.append(f"{low:.2f} to {first:.2f} m")
    if high > last + _ROUNDING:
        gaps.append(f"{last:.2f} to {high:.2f} m")
    if not gaps:
        return None
    before, behind = start - low, high - start
    least, most = np.ceil(100 * (first + before)) / 100, np.floor(100 * (last - behind)) / 100
    rule = (
        f" needs {low:.2f} to {high:.2f} m of it, from the run-in's start until the last wheel has "
        f"left: {' and '.join(gaps)} missing"
    )
    if least <= most:
        remedy = f'let the route start at from = "{least:.2f} m" to "{most:.2f} m"'
    else:
        remedy = "shorten the route's run_in or path"
    return (
        f"{first:.2f} to {last:.2f} m", rule,
        f'{remedy}, or say what the road beyond is: beyond = "mirror" or "level"',
    )  # fmt: skip

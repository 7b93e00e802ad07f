"""Features: joints, potholes, humps and the like on the roads of a study."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace

import numpy as np

from trundle._typing import Array
from trundle.errors import Problem
from trundle.road import (
    ExpansionJoint,
    Feature,
    FeaturedRoad,
    Shape,
)
from trundle.route import Route
from trundle.study_file.attempt import attempted
from trundle.study_file.draft import Draft, refer
from trundle.study_file.feature_kinds import FeatureSection, PlacedSection
from trundle.study_file.kinds import SectionKind
from trundle.study_file.sections.road import refer_road

__all__ = ["FEATURE", "build", "problems"]

_RUN_IN = 200.0  # m before a route, that a vehicle may come along


FEATURE = SectionKind(name="feature", schema=FeatureSection, form="list")


def build(draft: Draft) -> tuple[Draft, list[Problem]]:
    """Return the draft with features on its roads."""
    found: list[Problem] = []
    by_road: dict[str, list[Feature]] = {label: [] for label in draft.roads}
    for i, section in draft.file.lists.get("feature", []):
        made, mistakes = attempted(f"feature[{i + 1}]", lambda s=section: _features(s, draft))
        found += mistakes
        for label in section.roads or tuple(by_road):
            by_road.get(label, []).extend(made or ())
    shared: dict[tuple[int, ...], tuple[Feature, ...]] = {}  # roads with the same are run together
    roads = dict(draft.roads)
    for label, features in by_road.items():
        if features:
            key = tuple(map(id, features))
            same = shared.setdefault(key, tuple(features))
            roads[label] = FeaturedRoad(base=draft.roads[label], features=same)
    return replace(draft, roads=roads), found


def problems(draft: Draft) -> Iterator[Problem]:
    """Give features of unknown routes and roads, and lines that no route crosses."""
    declared = draft.file.declared["route"]
    for i, section in draft.file.lists.get("feature", []):
        place = f"feature[{i + 1}]"
        if section.route is not None:
            yield from refer(f"{place}.route", section.route, declared, "route")
        for j, label in enumerate(section.roads):
            yield from refer_road(draft, f"{place}.roads[{j + 1}]", label)
        if section.line is None or not draft.drives:
            continue
        crossed, _ = attempted(place, lambda s=section: _crossings(s, draft))
        if crossed == []:
            (a, b), (c, d) = section.line
            yield Problem(
                place=f"{place}.line",
                value=f"from ({a:g}, {b:g}) to ({c:g}, {d:g}) m",
                rule="no route crosses this line",
                remedy="draw it from one side of a route to the other",
            )
    yield from _met_by_nobody(draft)


def _met_by_nobody(draft: Draft) -> Iterator[Problem]:
    """Give features behind the end of every route that they are for."""
    for i, section in draft.file.lists.get("feature", []):
        drives = [d for n, d in draft.drives.items() if section.route in (None, n)]
        starts = [road.start for label, road in draft.roads.items()
                  if not section.roads or label in section.roads]  # fmt: skip
        if not drives or not starts:
            continue
        longest = max(d.route.length for d in drives)
        for station in section.stations:
            behind = all(station - start > longest for start in starts)
            if behind or all(station - start < -_RUN_IN for start in starts):
                yield Problem(
                    place=f"feature[{i + 1}].at",
                    value=f"{station:g} m",
                    rule=f"no route meets it: the longest ends after {longest:.4g} m"
                    if behind
                    else f"no route meets it: it lies more than {_RUN_IN:g} m before the start",
                    remedy="give its station from the route's start (or in the chainage of a "
                    "measured road)",
                )
                break


def _features(section: PlacedSection, draft: Draft) -> tuple[Feature, ...]:
    shape = section.shape()
    if section.line is not None:
        return tuple(
            replace(one, shape=_turned(shape, upward), across=_both(one.across, section.across))
            for one, upward in _crossings(section, draft)
        )
    return tuple(
        Feature(shape=shape, station=station, skew=section.skew, across=section.across,
                route=section.route)
        for station in section.stations
    )  # fmt: skip


def _turned(shape: Shape, upward: bool) -> Shape:
    """Return a joint as a route meets it: its step is from the right of its line to the left."""
    if isinstance(shape, ExpansionJoint) and not upward:
        return replace(shape, step=-shape.step)
    return shape


def _both(one: tuple[float, float], other: tuple[float, float]) -> tuple[float, float]:
    return max(one[0], other[0]), min(one[1], other[1])


def _crossings(section: PlacedSection, draft: Draft) -> list[tuple[Feature, bool]]:
    """Return where routes cross a line: a feature each, and whether from its right to its left."""
    routes: Mapping[str, Route] = {
        name: drive.route for name, drive in draft.drives.items() if section.route in (None, name)
    }
    line = np.array(section.line)
    shape = section.shape()
    return [
        (replace(one, route=name), upward)
        for name, route in routes.items()
        for one, upward in _on_route(shape, route, line)
    ]


def _on_route(shape: Shape, route: Route, line: Array) -> Iterator[tuple[Feature, bool]]:
    station = np.linspace(0.0, route.length, max(3, int(20.0 * route.length)))
    place, _ = route.locate(station)
    along = line[1] - line[0]
    across = np.array([-along[1], along[0]]) / np.hypot(*along)
    side = (place - line[0]) @ across
    for i in np.flatnonzero((side[1:] > 0.0) != (side[:-1] > 0.0)):
        share = side[i] / (side[i] - side[i + 1])
        at = station[i] + share * (station[i + 1] - station[i])
        (here,), (ahead,) = route.locate(np.array([at]))
        if not -1e-9 <= (here - line[0]) @ along / (along @ along) <= 1.0 + 1e-9:
            continue
        left = np.array([-ahead[1], ahead[0]])
        ends = np.sort((line - here) @ left)
        angle = np.arctan2(along @ ahead, along @ left)
        angle -= np.pi * np.round(angle / np.pi)  # a line has no head
        yield (
            Feature(shape=shape, station=float(at), skew=float(angle),
                    across=(float(ends[0]), float(ends[1]))),
            bool(side[i + 1] > side[i]),
        )  # fmt: skip

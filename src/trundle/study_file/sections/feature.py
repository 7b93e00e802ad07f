"""Features: joints, potholes, humps and the like on the roads of a study."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Annotated, Any, Literal, Self, TypeAlias

import numpy as np
from pydantic import BeforeValidator, Field, model_validator
from pydantic_core import PydanticCustomError

from trundle._typing import Array
from trundle.errors import Problem
from trundle.road import (
    Bump,
    CableProtector,
    CosineHump,
    ExpansionJoint,
    Feature,
    FeaturedRoad,
    Patch,
    Pothole,
    RailCrossing,
    RampKink,
    Shape,
)
from trundle.route import Route
from trundle.study_file.attempt import attempted
from trundle.study_file.draft import Draft, refer
from trundle.study_file.fields import (
    Angle,
    Grade,
    Length,
    Name,
    NonNegativeLength,
    Place,
    PositiveLength,
    Section,
)
from trundle.study_file.kinds import SectionKind
from trundle.study_file.sections.road import refer_road

__all__ = ["FEATURE", "build", "problems"]

_MOST = 10_000  # repetitions, and stations of one feature
_RUN_IN = 200.0  # m before a route, that a vehicle may come along


def _as_list(value: Any) -> Any:
    return value if isinstance(value, list | tuple) else [value]


class _Placed(Section):
    """Where a feature lies."""

    at: Annotated[tuple[Length, ...], BeforeValidator(_as_list), Field(max_length=_MOST)] = ()
    """Where it begins, along every route: from its start, or in a survey's chainage."""
    every: PositiveLength | None = None
    """Distance to the next one of its kind."""
    count: Annotated[int, Field(strict=True, ge=2, le=_MOST)] | None = None
    """How many there are in all."""
    line: tuple[Place, Place] | None = None
    """Two places in plan that it lies between, in place of at."""
    skew: Angle = 0.0
    """Angle by which it lies aslant: the left wheel meets it later."""
    side: Literal["both", "left", "right"] = "both"
    """Under which wheels it lies."""
    route: Name | None = None
    """The route on which it lies; every one unless given."""
    roads: tuple[Name, ...] = ()
    """The roads on which it lies; every one unless given."""

    @model_validator(mode="after")
    def _check_place(self) -> Self:
        rule = ""
        if bool(self.at) == (self.line is not None):
            rule = (
                "a feature lies at stations along routes (at), or on a line across the plan (line)"
            )
        elif (self.every is None) != (self.count is None):
            rule = "every and count go together: every 6 m, 8 times"
        elif self.every is not None and len(self.at) != 1:
            rule = "repeated features begin at one station: at"
        elif self.line is not None and {"skew", "every"} & self.model_fields_set:
            rule = "a line in plan says its own angle, and is there once: leave skew and every out"
        if rule:
            raise PydanticCustomError("rule", "{rule}", {"rule": rule})
        return self

    @property
    def stations(self) -> tuple[float, ...]:
        """Where it begins along a route [m]."""
        if self.every is None or self.count is None:
            return self.at
        return tuple(self.at[0] + self.every * i for i in range(self.count))

    @property
    def across(self) -> tuple[float, float]:
        """Where it lies across a road [m]."""
        low = 0.0 if self.side == "left" else -np.inf
        return low, 0.0 if self.side == "right" else np.inf

    def shape(self) -> Shape:
        """Return what it looks like."""
        where = set(_Placed.model_fields) | {"kind"}
        values = {k: v for k, v in self if k not in where and v is not None}
        return _SHAPES[getattr(self, "kind")](**values)  # noqa: B009 - of its kinds alone


class JointSection(_Placed):
    """A joint between slabs."""

    kind: Literal["joint"]
    """A joint between slabs."""
    gap: NonNegativeLength = 0.0
    """Width of the gap."""
    depth: PositiveLength | None = None
    """Depth of the gap; as deep as the tyre sinks unless given."""
    step: Length = 0.0
    """Height of the far edge above the near one; negative drops."""
    runout: PositiveLength | None = None
    """Length over which the far slab returns to the level before; it stays unless given."""


class PotholeSection(_Placed):
    """A hole."""

    kind: Literal["pothole"]
    """A hole with a level bottom."""
    length: PositiveLength
    """From rim to rim."""
    depth: PositiveLength
    """Depth of its bottom."""
    edge: PositiveLength | None = None
    """Length of each side; upright unless given."""


class PatchSection(_Placed):
    """A patch or a plate."""

    kind: Literal["patch"]
    """A patch or a plate."""
    length: PositiveLength
    """From foot to foot."""
    height: Length
    """Of its top; negative lies lower."""
    ramp: PositiveLength | None = None
    """Length of the ramp at either end; upright unless given."""


class HumpSection(_Placed):
    """A bump of half a sine, or a hump of a cosine."""

    kind: Literal["bump", "cosine_hump"]
    """A bump of half a sine, or a hump of h (1 - cos) / 2."""
    length: PositiveLength
    """From foot to foot."""
    height: Length
    """Of its crest; negative lies lower."""


class KinkSection(_Placed):
    """A change of grade."""

    kind: Literal["ramp_kink"]
    """A change of grade."""
    grade: Grade
    """Rise by length."""
    length: PositiveLength
    """Until the road turns back into its former grade."""
    rounding: NonNegativeLength = 0.0
    """Length over which each turn is rounded."""


class RailSection(_Placed):
    """A level crossing of two rails."""

    kind: Literal["rail_crossing"]
    """A level crossing of two rails."""
    flangeway: PositiveLength | None = None
    """Width of the groove beside each rail; 65 mm unless given."""
    depth: PositiveLength | None = None
    """Depth of the groove; 40 mm unless given."""
    head: PositiveLength | None = None
    """Width of a rail's head; 70 mm unless given."""
    proud: Length = 0.0
    """How far heads stand above the road; negative lies lower."""
    gauge: PositiveLength | None = None
    """Between the inner sides of the heads; 1.435 m unless given."""


class ProtectorSection(_Placed):
    """A cable protector, a threshold, a hose bridge."""

    kind: Literal["cable_protector"]
    """A cable protector, a threshold, a hose bridge: a trapezoid."""
    length: PositiveLength
    """From foot to foot."""
    height: PositiveLength
    """Of its top."""
    top: PositiveLength
    """Length of its top."""


FeatureSection: TypeAlias = Annotated[
    JointSection
    | PotholeSection
    | PatchSection
    | HumpSection
    | KinkSection
    | RailSection
    | ProtectorSection,
    Field(discriminator="kind"),
]

_SHAPES: dict[str, Any] = {
    "joint": ExpansionJoint,
    "pothole": Pothole,
    "patch": Patch,
    "bump": Bump,
    "cosine_hump": CosineHump,
    "ramp_kink": RampKink,
    "rail_crossing": RailCrossing,
    "cable_protector": CableProtector,
}

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


def _features(section: _Placed, draft: Draft) -> tuple[Feature, ...]:
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


def _crossings(section: _Placed, draft: Draft) -> list[tuple[Feature, bool]]:
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

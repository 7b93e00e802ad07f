"""Routes: where a vehicle drives, and how fast; traffic: several at once."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Annotated, Any, Self, TypeAlias

import numpy as np
from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from trundle.errors import Problem
from trundle.route import ConstantSpeed, Route, SpeedLaw, SpeedOverTime, Steering
from trundle.structure import FloorPlan
from trundle.study.model import Extent
from trundle.study.plans import Case, Drive
from trundle.study_file.attempt import attempted
from trundle.study_file.document import StudyFile
from trundle.study_file.draft import (
    Draft,
    behind_the_end,
    covered,
    is_off,
    refer,
    surface_at,
    undrawn,
    unique,
    unknown,
)
from trundle.study_file.fields import (
    AnySpeed,
    AnyTime,
    Flag,
    GroupName,
    Length,
    Line,
    Name,
    NonNegativeLength,
    Place,
    Section,
    Speed,
    Time,
)
from trundle.study_file.kinds import SectionKind
from trundle.study_file.way_checks import off_slabs, wheels_off

__all__ = ["ROUTE", "TRAFFIC", "build", "fields", "problems"]

_EDGE = 1e-6  # m
_SPEEDS = ("speed", "speeds", "speeds_over_time")
_NOWHERE = ((0.0, 0.0), (1.0, 0.0))  # of a route that is drawn, until its drawing is read


_OverStations: TypeAlias = Annotated[
    tuple[tuple[NonNegativeLength, AnySpeed], ...], Field(min_length=2)
]
_OverTime: TypeAlias = Annotated[tuple[tuple[AnyTime, AnySpeed], ...], Field(min_length=2)]


class RouteSection(Section):
    """Where a vehicle drives, and how fast."""

    name: GroupName
    """How results, traffic and schedules call it."""
    vehicle: Name
    """Which of the [vehicle] tables drives it."""
    path: Annotated[tuple[Place, ...], Field(min_length=2)] = _NOWHERE
    """Places that it leads through."""
    drawn: Line | None = None
    """Layer of the building's drawing that shows it, in place of path."""
    on: Name | tuple[Name, ...] | None = None
    """Surface on which it runs, or one of each leg."""
    speed: Speed | None = None
    """The one speed of the drive."""
    speeds: _OverStations | None = None
    """Speeds over stations of the way driven; acceleration is steady in between."""
    speeds_over_time: _OverTime | None = None
    """Speeds over time; acceleration is steady in between."""
    waits: tuple[AnyTime, ...] = ()
    """How long it waits at each station with speed 0."""
    run_in: NonNegativeLength | None = None
    """Length of road before the route on which the vehicle comes to vibrate."""
    radius: NonNegativeLength = 0.0
    """Of arcs in place of corners; 0 leaves them sharp."""
    lane: Length = 0.0
    """How far to the left of the path the vehicle drives."""
    steering: Steering | None = None
    """Whether wheels follow the path, or are pulled; pulled where there is a radius."""
    reverse: Flag = False
    """Whether the vehicle drives last axle first."""

    @model_validator(mode="after")
    def _check_path(self) -> Self:
        rule = ""
        given = [k for k in _SPEEDS if getattr(self, k) is not None]
        if ("path" in self.model_fields_set) == (self.drawn is not None):
            rule = "a route has a path, or is drawn on a layer of the building's drawing"
        elif len(given) != 1:
            rule = "a route has one of speed, speeds (over stations) and speeds_over_time; got "
            rule += " and ".join(given) or "none"
        elif isinstance(self.on, tuple) and len(self.on) != len(self.path) - 1:
            rule = f"a path of {len(self.path)} points has {len(self.path) - 1} legs: name the "
            rule += "surface of each, or one for all"
        elif self.waits and self.speeds is None:
            rule = "waits are of stops among speeds over stations: leave them out"
        elif self.reverse and self.steering == "tractrix":
            rule = "a vehicle that is pushed backwards is not pulled: leave steering out"
        if rule:
            raise PydanticCustomError("rule", "{rule}", {"rule": rule})
        return self

    @property
    def through(self) -> tuple[str, ...]:
        """Surface of every leg, if there are several."""
        return self.on if isinstance(self.on, tuple) and len(set(self.on)) > 1 else ()

    @property
    def only(self) -> str | None:
        """The surface of all legs, if they have one."""
        if isinstance(self.on, tuple):
            return None if self.through else self.on[0]
        return self.on

    @property
    def law(self) -> SpeedLaw:
        """How fast it goes."""
        if self.speeds is not None:
            station, value = np.array(self.speeds).T
            return SpeedOverTime.over_stations(station, value, waits=self.waits)
        if self.speeds_over_time is not None:
            time, value = np.array(self.speeds_over_time).T
            return SpeedOverTime(time=time, value=value)
        return ConstantSpeed(self.speed or 0.0)


class TrafficSection(Section):
    """Several routes driven at once."""

    name: GroupName
    """How results call it."""
    routes: Annotated[tuple[Name, ...], Field(min_length=2, max_length=100)]
    """Routes, walkers and machines that act together."""
    departures: tuple[AnyTime, ...] | None = None
    """When each begins, later than by itself."""
    headway: Time | None = None
    """Time from one to the next, in place of departures."""

    @model_validator(mode="after")
    def _check_times(self) -> Self:
        rule = ""
        if self.departures is not None and self.headway is not None:
            rule = "give departures, or a headway between one route and the next"
        elif self.departures is not None and len(self.departures) != len(self.routes):
            rule = f"{len(self.routes)} routes need as many departures; got {len(self.departures)}"
        if rule:
            raise PydanticCustomError("rule", "{rule}", {"rule": rule})
        return self

    @property
    def times(self) -> tuple[float, ...]:
        """When each departs [s]."""
        if self.headway is not None:
            return tuple(self.headway * i for i in range(len(self.routes)))
        return self.departures or (0.0,) * len(self.routes)


ROUTE = SectionKind(name="route", schema=RouteSection, form="list", required=True)
TRAFFIC = SectionKind(name="traffic", schema=TrafficSection, form="list")


def build(draft: Draft) -> tuple[Draft, list[Problem]]:
    """Return the draft with its routes and what drives on them."""
    drives: dict[str, Drive] = {}
    found: list[Problem] = []
    known = draft.file.declared["vehicle"]
    for i, section in draft.file.lists.get("route", []):
        place = f"route[{i + 1}]"
        if section.vehicle not in draft.vehicles:
            if section.vehicle not in known:
                found.append(unknown(f"{place}.vehicle", section.vehicle, sorted(known), "vehicle"))
            continue
        path, through = np.array(section.path), section.through
        if not through:
            surface, _ = surface_at(draft, f"{place}.on", section.only)
            path = path if surface is None else surface.frame.from_plan(path)
        law, mistakes = attempted(f"{place}.speeds", lambda s=section: s.law)
        found += mistakes
        if law is None:
            continue
        # whose corners are rounded drives as vehicles do: what is behind the front axle is pulled
        steering = section.steering or ("tractrix" if _is_pulled(section) else "path")
        route, mistakes = attempted(
            f"{place}.path",
            lambda s=section, p=path, law=law, how=steering: Route(
                points=p, law=law, name=s.name, on=s.only, surfaces=s.through,
                radius=s.radius, lane=s.lane, steering=how, reverse=s.reverse,
            ),
        )  # fmt: skip
        found += mistakes
        if route is not None:
            drives[section.name] = Drive(
                route=route, vehicle=draft.vehicles[section.vehicle], run_in=section.run_in
            )
    return replace(draft, drives=drives), found


def _is_pulled(section: RouteSection) -> bool:
    return section.radius > 0.0 and not section.reverse


def fields(draft: Draft) -> dict[str, Any]:
    """Return what a study takes from the sections."""
    alone = (*draft.drives, *draft.sources)
    singles = tuple(Case(name=name, routes=(name,)) for name in alone)
    traffic = tuple(
        Case(name=t.name, routes=t.routes, departs=t.times) for t in draft.file.items("traffic")
    )
    return {"drives": draft.drives, "sources": draft.sources, "cases": singles + traffic}


def problems(draft: Draft) -> Iterator[Problem]:
    """Give routes off the floor, along an edge or too short, and traffic of unknown routes."""
    yield from undrawn(draft, "route")
    yield from _traffic(draft)
    yield from off_slabs(draft)
    yield from wheels_off(draft)
    if draft.extent is not None:
        yield from _off_the_floor(draft, draft.extent)
    if draft.plan is not None:
        yield from _on_held_edges(draft.file, draft.plan)
    yield from _short_routes(draft)
    yield from _not_yet(draft)
    named = draft.file.names("route", "traffic", *draft.file.shaking)
    yield from unique((f"{place}.name", name) for place, name in named)


def _traffic(draft: Draft) -> Iterator[Problem]:
    for i, section in draft.file.lists.get("traffic", []):
        for j, route in enumerate(section.routes):
            place = f"traffic[{i + 1}].routes[{j + 1}]"
            yield from refer(place, route, draft.acting, "route")
        for name, times in _times_of(section).items():
            if len(set(times)) < len(times):
                yield Problem(
                    place=f"traffic[{i + 1}].routes",
                    value=", ".join(section.routes),
                    rule="a route can carry one vehicle at a time",
                    remedy="name each route once, or give each its own time in departures",
                )
            elif len(times) > 1 and name in draft.sources:
                yield Problem(
                    place=f"traffic[{i + 1}].routes",
                    value=f"{name!r} {len(times)} times",
                    rule="people and machines are there once; their own keys say when and how many",
                    remedy="name it once",
                )
        yield from _late(draft, f"traffic[{i + 1}]", section)


def _late(draft: Draft, place: str, section: TrafficSection) -> Iterator[Problem]:
    """Give the first of a section that departs when the record has ended."""
    for j, (name, depart) in enumerate(zip(section.routes, section.times, strict=True), start=1):
        source = draft.sources.get(name)  # people and machines may begin later by themselves
        own = getattr(source, "depart", getattr(source, "starts", 0.0))
        key = "headway" if section.departures is None else f"departures[{j}]"
        late = list(behind_the_end(draft, f"{place}.{key}", depart + own)) if depart else []
        if late:
            yield from late
            return


def _times_of(section: TrafficSection) -> dict[str, list[float]]:
    """Return when each route of a section is departed on [s]."""
    out: dict[str, list[float]] = {}
    for name, time in zip(section.routes, section.times, strict=True):
        out.setdefault(name, []).append(time)
    return out


def _off_the_floor(draft: Draft, extent: Extent) -> Iterator[Problem]:
    for i, section in draft.file.lists.get("route", []):
        for j, place in enumerate(section.path):
            if is_off(extent, place):
                yield Problem(
                    place=f"route[{i + 1}].path[{j + 1}]",
                    value=f"({place[0]:g}, {place[1]:g}) m",
                    rule=f"a route must stay on the floor; {covered(extent)}",
                    remedy="start and end it at the floor's edges; 'trundle check' draws the plan",
                )


def _on_held_edges(file: StudyFile, plan: FloorPlan) -> Iterator[Problem]:
    """Give routes that run along an edge that is held: their wheels load nothing."""
    for i, section in file.lists.get("route", []):
        for edge, (axis, position) in plan.held_edges().items():
            if all(abs(place[axis] - position) < _EDGE for place in section.path):
                yield Problem(
                    place=f"route[{i + 1}].path",
                    value=f"a way along {edge}, which is {plan.edges[edge]}",
                    rule="wheels on an edge that is held load the floor nowhere",
                    remedy="move the route onto the floor, or hold the edge otherwise",
                )


def _short_routes(draft: Draft) -> Iterator[Problem]:
    """Give routes that a wheel is on for less than two steps."""
    for name, drive in draft.drives.items():
        time = drive.route.law.time_to(drive.route.length)
        for method in draft.methods.values():
            dt = method.interaction.integration.dt
            if time < 2.0 * dt:
                yield Problem(
                    place=f"{draft.file.place_of(name, 'route')}.path",
                    value=f"{drive.route.length:g} m",
                    rule=f"a wheel is on it for {1e3 * time:.3g} ms, and method {method.name!r} "
                    f"looks every {1e3 * dt:g} ms",
                    remedy="lengthen the route; 'trundle check' draws the plan",
                )


def _not_yet(draft: Draft) -> Iterator[Problem]:
    """Give vehicles that wait before the floor until the record has ended."""
    for i, section in draft.file.lists.get("route", []):
        drive = draft.drives.get(section.name)
        if drive is None or any(
            method.entry.lead(drive.vehicle.length) > 0.0 for method in draft.methods.values()
        ):  # who stands on it at first loads it
            continue
        key = next(k for k in _SPEEDS if getattr(section, k) is not None)
        yield from behind_the_end(
            draft, f"route[{i + 1}].{key}", float(drive.route.law.time_to(_EDGE))
        )

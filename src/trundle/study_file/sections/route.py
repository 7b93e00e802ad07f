"""Routes: where a vehicle drives, and how fast; traffic: several at once."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from itertools import pairwise
from typing import Annotated, Any, Self

import numpy as np
from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from trundle.errors import Problem
from trundle.route import ConstantSpeed, Route
from trundle.structure import (
    FloorPlan,
)
from trundle.study.model import Extent
from trundle.study.plans import Case, Drive, MethodPlan
from trundle.study_file.attempt import attempted
from trundle.study_file.document import StudyFile
from trundle.study_file.draft import (
    Draft,
    covered,
    is_off,
    refer,
    surface_at,
    undrawn,
    unique,
    unknown,
)
from trundle.study_file.fields import (
    GroupName,
    Line,
    Name,
    NonNegativeLength,
    Place,
    Section,
    Speed,
)
from trundle.study_file.kinds import SectionKind

__all__ = ["ROUTE", "TRAFFIC", "build", "fields", "problems"]

_EDGE = 1e-6  # m
_NOWHERE = ((0.0, 0.0), (1.0, 0.0))  # of a route that is drawn, until its drawing is read
_LOOKED_AT = 0.1  # m along a route


class RouteSection(Section):
    """Where a vehicle drives, and how fast."""

    name: GroupName
    vehicle: Name
    path: Annotated[tuple[Place, ...], Field(min_length=2)] = _NOWHERE
    drawn: Line | None = None
    on: Name | None = None
    speed: Speed
    run_in: NonNegativeLength | None = None

    @model_validator(mode="after")
    def _check_path(self) -> Self:
        if ("path" in self.model_fields_set) == (self.drawn is not None):
            rule = "a route has a path, or is drawn on a layer of the building's drawing"
            raise PydanticCustomError("rule", "{rule}", {"rule": rule})
        return self


class TrafficSection(Section):
    """Several routes driven at once."""

    name: GroupName
    routes: Annotated[tuple[Name, ...], Field(min_length=2)]


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
        surface, _ = surface_at(draft, f"{place}.on", section.on)
        path = np.array(section.path)
        path = path if surface is None else surface.frame.from_plan(path)
        route, mistakes = attempted(
            f"{place}.path",
            lambda s=section, p=path: Route(
                points=p, law=ConstantSpeed(s.speed), name=s.name, on=s.on
            ),
        )
        found += mistakes
        if route is not None:
            drives[section.name] = Drive(
                route=route, vehicle=draft.vehicles[section.vehicle], run_in=section.run_in
            )
    return replace(draft, drives=drives), found


def fields(draft: Draft) -> dict[str, Any]:
    """Return what a study takes from the sections."""
    alone = (*draft.drives, *draft.sources)
    singles = tuple(Case(name=name, routes=(name,)) for name in alone)
    traffic = tuple(Case(name=t.name, routes=t.routes) for t in draft.file.items("traffic"))
    return {"drives": draft.drives, "sources": draft.sources, "cases": singles + traffic}


def problems(draft: Draft) -> Iterator[Problem]:
    """Give routes off the floor, along an edge or too short, and traffic of unknown routes."""
    yield from undrawn(draft, "route")
    yield from _traffic(draft)
    yield from _off_slabs(draft)
    if draft.extent is not None:
        yield from _off_the_floor(draft, draft.extent)
    if draft.plan is not None:
        yield from _on_held_edges(draft.file, draft.plan)
    yield from _short_routes(draft.drives, draft.methods)
    named = [s.name for kind in ("route", "traffic") for s in draft.file.items(kind)]
    named += draft.sources
    yield from unique("route and traffic", named)


def _traffic(draft: Draft) -> Iterator[Problem]:
    for i, section in draft.file.lists.get("traffic", []):
        for j, route in enumerate(section.routes):
            place = f"traffic[{i + 1}].routes[{j + 1}]"
            known = draft.file.declared["route"] | set(draft.sources)
            yield from refer(place, route, known, "route")
        if len(set(section.routes)) < len(section.routes):
            yield Problem(
                place=f"traffic[{i + 1}].routes",
                value=", ".join(section.routes),
                rule="a route can carry one vehicle at a time",
                remedy="name each route once",
            )


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


def _off_slabs(draft: Draft) -> Iterator[Problem]:
    """Give routes on no storey, and routes that leave its slabs: over an opening, past an edge."""
    for i, section in draft.file.lists.get("route", []):
        surface, mistakes = surface_at(draft, f"route[{i + 1}].on", section.on)
        yield from mistakes
        if surface is None or draft.extent is None:
            continue
        if any(is_off(draft.extent, place) for place in section.path):
            continue  # told already
        for j, (start, end) in enumerate(pairwise(np.array(section.path)), start=1):
            n = max(2, int(np.ceil(np.hypot(*(end - start)) / _LOOKED_AT)) + 1)
            places = start + np.linspace(0.0, 1.0, n)[:, None] * (end - start)
            off = places[~surface.holds(surface.frame.from_plan(places))]
            if len(off):
                (a, b), (c, d) = off[0], off[-1]
                yield Problem(
                    place=f"route[{i + 1}].path[{j}]",
                    value=f"a way over no slab from ({a:.4g}, {b:.4g}) to ({c:.4g}, {d:.4g}) m",
                    rule=f"a route must stay on the slabs of {surface.name!r}",
                    remedy="lead it round openings and walls; 'trundle check' draws the plan",
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


def _short_routes(
    drives: Mapping[str, Drive], methods: Mapping[str, MethodPlan]
) -> Iterator[Problem]:
    """Give routes that a wheel is on for less than two steps."""
    for name, drive in drives.items():
        time = drive.route.law.time_to(drive.route.length)
        for method in methods.values():
            dt = method.interaction.integration.dt
            if time < 2.0 * dt:
                yield Problem(
                    place=f"route {name!r}.path",
                    value=f"{drive.route.length:g} m",
                    rule=f"a wheel is on it for {1e3 * time:.3g} ms, and method {method.name!r} "
                    f"looks every {1e3 * dt:g} ms",
                    remedy="lengthen the route; 'trundle check' draws the plan",
                )

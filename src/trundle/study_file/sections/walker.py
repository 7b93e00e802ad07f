"""Walkers: people on a way or at a place, by the load function of a guide."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Annotated, Literal, Self

import numpy as np
from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from trundle.errors import Problem
from trundle.footfall import FOOTFALLS, footfall_load
from trundle.route import ConstantSpeed, Route
from trundle.simulate.sources.walker import Gait, StandsAt, Walker
from trundle.study_file.attempt import attempted
from trundle.study_file.draft import Draft, behind_the_end, surface_at
from trundle.study_file.fields import (
    AnyTime,
    Flag,
    Frequency,
    GroupName,
    Mass,
    Name,
    NonNegativeLength,
    Place,
    Ratio,
    Section,
    Speed,
    Time,
    Whole,
)
from trundle.study_file.kinds import SectionKind
from trundle.study_file.way_checks import standing_problems, way_problems

__all__ = ["WALKER", "build", "problems"]

_GRAVITY = 9.81  # m/s2
_MASSES, _SPEEDS = (10.0, 400.0), (0.1, 6.0)  # kg, m/s: beyond is a slip of the unit


class WalkerSection(Section):
    """People who walk along a path, or stay at a place."""

    name: GroupName
    """How results and traffic call it."""
    guide: Literal[FOOTFALLS]  # pyright: ignore[reportInvalidTypeForm] - files in a folder
    """Whose load factors and impulses are taken."""
    pace: Frequency
    """Steps a second."""
    path: Annotated[tuple[Place, ...] | None, Field(min_length=2)] = None
    """Places that the walk leads through."""
    at: Place | None = None
    """Where somebody stays, in place of a path."""
    on: Name | None = None
    """Surface of the walk, where there are several."""
    speed: Speed | None = None
    """Of walking; the guide's for the pace unless given."""
    radius: NonNegativeLength = 0.0
    """Of arcs in place of corners."""
    lasts: Time | None = None
    """How long somebody stays; 10 s unless given."""
    mass: Annotated[Mass | None, Field(gt=0.0)] = None
    """Of one person; the guide's unless given."""
    people: Annotated[Whole, Field(ge=1, le=200)] = 1
    """How many walk one behind the other."""
    headway: AnyTime = 2.0
    """Time from one to the next."""
    depart: AnyTime = 0.0
    """When the first begins."""
    pace_spread: Ratio = 0.0
    """Standard deviation of paces between people, over the mean."""
    mass_spread: Ratio = 0.0
    """Standard deviation of masses between people, over the mean."""
    step_scatter: Ratio = 0.0
    """Standard deviation of single steps' durations, over their mean."""
    random_phase: Flag = True
    """Whether everybody's first step falls at a random time of a step."""

    @model_validator(mode="after")
    def _check_where(self) -> Self:
        rule = ""
        if (self.path is None) == (self.at is None):
            rule = "somebody walks along a path, or stays at a place: give path or at"
        elif self.at is not None and (self.speed is not None or self.radius):
            rule = "speed and radius are of a path; who stays at a place has lasts"
        elif self.path is not None and self.lasts is not None:
            rule = "lasts is of a place; a path lasts as long as its length and speed say"
        elif self.mass is not None and not _MASSES[0] <= self.mass <= _MASSES[1]:
            rule = f"people weigh {_MASSES[0]:g} to {_MASSES[1]:g} kg; got {self.mass:g} kg"
        elif self.speed is not None and not _SPEEDS[0] <= self.speed <= _SPEEDS[1]:
            rule = f"people walk at {_SPEEDS[0]:g} to {_SPEEDS[1]:g} m/s; got {self.speed:.3g} m/s"
        if rule:
            raise PydanticCustomError("rule", "{rule}", {"rule": rule})
        return self


WALKER = SectionKind(name="walker", schema=WalkerSection, form="list", shakes=True)


def build(draft: Draft) -> tuple[Draft, list[Problem]]:
    """Return the draft with its walkers."""
    walkers: dict[str, Walker] = {}
    found: list[Problem] = []
    for i, section in draft.file.lists.get("walker", []):
        walker, mistakes = attempted(
            f"walker[{i + 1}]", lambda s=section, i=i: _walker(draft, s, f"walker[{i + 1}].on")
        )
        found += mistakes
        if walker is not None:
            walkers[section.name] = walker
    return replace(draft, sources={**draft.sources, **walkers}), found


def _walker(draft: Draft, section: WalkerSection, place: str) -> Walker:
    load = footfall_load(section.guide)
    surface, _ = surface_at(draft, place, section.on)
    given = np.array([section.at] if section.path is None else section.path)
    there = given if surface is None else surface.frame.from_plan(given)
    if section.path is None:
        x, y = there[0]
        where = StandsAt(x=float(x), y=float(y), on=section.on, lasts=section.lasts or 10.0)
    else:
        speed = section.speed or load.walking_speed(section.pace)
        where = Route(
            points=there, law=ConstantSpeed(speed), name=section.name, on=section.on,
            radius=section.radius,
        )  # fmt: skip
    weight = load.weight if section.mass is None else _GRAVITY * section.mass
    gait = Gait(
        pace=section.pace, weight=weight, pace_spread=section.pace_spread,
        weight_spread=section.mass_spread, step_scatter=section.step_scatter,
        random_phase=section.random_phase,
    )  # fmt: skip
    return Walker(
        name=section.name, load=load, gait=gait, where=where, people=section.people,
        headway=section.headway, depart=section.depart,
    )  # fmt: skip


def problems(draft: Draft) -> Iterator[Problem]:
    """Give people off the floor, and steps that do not show how they walk."""
    for i, section in draft.file.lists.get("walker", []):
        place = f"walker[{i + 1}]"
        if section.path is None:
            yield from standing_problems(draft, place, "at", [section.at], section.on)
        else:
            yield from way_problems(draft, place, section.path, section.on)
        yield from behind_the_end(draft, f"{place}.depart", section.depart)
        walker = draft.sources.get(section.name)
        if walker is None:
            continue
        for method in draft.methods.values():
            dt = method.interaction.integration.dt
            _, mistakes = attempted(f"{place}.pace", lambda w=walker, dt=dt: w.check(dt, None))
            yield from mistakes

"""Schedules: who drives on a day, by times, headways, counts by hour, or a timetable."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Annotated, Any, Self

import numpy as np
from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from trundle.errors import InputError, Problem
from trundle.study_file.attempt import attempted
from trundle.study_file.draft import Draft, refer
from trundle.study_file.fields import GroupName, Line, Name, Number, Section, Time
from trundle.study_file.kinds import SectionKind
from trundle.study_file.timetables import TimeOfDay, read_timetable
from trundle.traffic import DAY, Poisson, Schedule, Stream, Times, evenly

__all__ = ["SCHEDULE", "build", "fields", "problems"]

_WAYS = ("times", "headway", "per_hour", "by_hour", "timetable")
_Count = Annotated[Number, Field(ge=0.0, le=10_000.0)]


class ScheduleSection(Section):
    """Part of a day's schedule; parts of one name are of one day."""

    name: GroupName
    """The day that it is a part of; parts of one name are of one day."""
    route: Name | None = None
    """Which route is driven."""
    mix: Annotated[dict[Name, Annotated[Number, Field(gt=0.0)]] | None, Field(min_length=1)] = None
    """Routes and their shares, in place of one route; drawn at random."""
    times: Annotated[tuple[TimeOfDay, ...] | None, Field(min_length=1)] = None
    """Times of the day, such as "8:05"."""
    headway: Time | None = None
    """Even time from one passage to the next."""
    per_hour: Annotated[_Count, Field(gt=0.0)] | None = None
    """Mean passages an hour, at random."""
    by_hour: Annotated[tuple[_Count, ...] | None, Field(min_length=24, max_length=24)] = None
    """Mean passages in each of 24 hours, at random."""
    timetable: Line | None = None
    """File with the columns time and route, beside the study."""
    from_: Annotated[TimeOfDay | None, Field(alias="from")] = None
    """When a headway or an even rate begins; midnight unless given."""
    to: TimeOfDay | None = None
    """When it ends; midnight unless given."""

    @model_validator(mode="after")
    def _check_way(self) -> Self:
        given = [key for key in _WAYS if getattr(self, key) is not None]
        rule = ""
        if len(given) != 1:
            rule = f"a schedule has one of {', '.join(_WAYS)}; got {' and '.join(given) or 'none'}"
        elif given[0] == "timetable" and (self.route is not None or self.mix is not None):
            rule = "a timetable names its routes itself: leave route and mix out"
        elif given[0] != "timetable" and (self.route is None) == (self.mix is None):
            rule = "name the route, or a mix of routes with their shares"
        elif given[0] in {"times", "headway"} and self.mix is not None:
            rule = f"a mix is drawn at random, and {given[0]} are not: name the route"
        elif given[0] in {"times", "by_hour", "timetable"} and self.from_to:
            rule = f"from and to are of a headway or of per_hour; {given[0]} needs none"
        elif not self.start < self.end:
            rule = "to must come after from; a schedule over midnight is two parts"
        if rule:
            raise PydanticCustomError("rule", "{rule}", {"rule": rule})
        return self

    @property
    def from_to(self) -> bool:
        """Whether either is given."""
        return self.from_ is not None or self.to is not None

    @property
    def start(self) -> float:
        """When it begins [s]."""
        return self.from_ or 0.0

    @property
    def end(self) -> float:
        """When it ends [s]."""
        return DAY if self.to is None else self.to

    def streams(self) -> list[Stream]:
        """Return it as it stands in the study file."""
        shares = self.mix or {self.route or "": 1.0}
        if self.times is not None:
            return [Times(route=self.route or "", times=np.array(self.times))]
        if self.headway is not None:
            return [evenly(self.route or "", first=self.start, last=self.end, headway=self.headway)]
        if self.by_hour is not None:
            return [Poisson.by_hour(self.by_hour, shares)]
        return [
            Poisson.through(start=self.start, end=self.end, rate=self.per_hour or 0.0, mix=shares)
        ]


SCHEDULE = SectionKind(name="schedule", schema=ScheduleSection, form="list")


def build(draft: Draft) -> tuple[Draft, list[Problem]]:
    """Return the draft with its schedules."""
    streams: dict[str, list[Stream]] = {}
    found: list[Problem] = []
    kept: dict[str, bytes] = {}
    for i, section in draft.file.lists.get("schedule", []):
        made, mistakes = attempted(f"schedule[{i + 1}]", lambda s=section: _streams(draft, s, kept))
        found += mistakes
        streams.setdefault(section.name, []).extend(made or [])
    schedules: dict[str, Schedule] = {}
    for name, some in streams.items():
        schedule, mistakes = attempted(
            draft.file.place_of(name, "schedule"),
            lambda n=name, s=some: Schedule(name=n, streams=tuple(s)),
        )
        found += mistakes if some else []
        if schedule is not None:
            schedules[name] = schedule
    return replace(draft, schedules=schedules, read={**draft.read, **kept}), found


def _streams(draft: Draft, section: ScheduleSection, kept: dict[str, bytes]) -> list[Stream]:
    """Return the streams of a section, and keep the file that it names."""
    if section.timetable is None:
        return section.streams()
    path = draft.files.get(section.timetable, draft.folder / section.timetable)
    found = read_timetable(path)
    try:
        kept[section.timetable] = path.read_bytes()
    except OSError as error:
        raise InputError(f"{path.name}: cannot be read ({error.strerror})") from None
    return [Times(route=route, times=np.array(times)) for route, times in found.items()]


def fields(draft: Draft) -> dict[str, Any]:
    """Return what a study takes from the sections."""
    return {"schedules": draft.schedules}


def problems(draft: Draft) -> Iterator[Problem]:
    """Give routes that there are not, what never ends, and a day that nothing is held against."""
    for i, section in draft.file.lists.get("schedule", []):
        place = f"schedule[{i + 1}]"
        if section.route:
            yield from _driven(draft, f"{place}.route", section.route)
        for name in section.mix or {}:
            yield from _driven(draft, f"{place}.mix.{name}", name)
    for name, schedule in draft.schedules.items():
        for route in sorted(set(schedule.routes) - _written(draft)):
            yield from _driven(draft, _timetable_of(draft, name), route)
        if draft.assessment is None and "criteria" not in draft.file.given:
            yield Problem(
                place=draft.file.place_of(name, "schedule"),
                value=repr(name),
                rule="a day is held against limits, and this study has none",
                remedy="add [criteria]",
            )


def _driven(draft: Draft, place: str, name: str) -> Iterator[Problem]:
    """Give a name that nothing has which could be an event of a day."""
    yield from refer(place, name, draft.acting, "route")
    if not np.isfinite(getattr(draft.sources.get(name), "lasts", 0.0)):
        yield Problem(
            place=place,
            value=repr(name),
            rule="a machine that never stops is no event of a day",
            remedy="give it lasts, or put it into [[traffic]]",
        )


def _timetable_of(draft: Draft, name: str) -> str:
    """Return where a schedule names a timetable."""
    sections = draft.file.lists.get("schedule", [])
    there = (i for i, section in sections if section.name == name and section.timetable)
    return f"schedule[{next(there) + 1}].timetable"


def _written(draft: Draft) -> set[str]:
    """Return the routes that sections name themselves: they are told where they stand."""
    sections = [section for _, section in draft.file.lists.get("schedule", [])]
    return {s.route for s in sections if s.route} | {n for s in sections for n in s.mix or {}}

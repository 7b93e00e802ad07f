"""Title, seed, runs and duration: the keys above the first table."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, Any

from pydantic import Field

from trundle.errors import InputError, Problem
from trundle.road import RoadClass
from trundle.simulate import Crossing
from trundle.simulate.ensembles import LEAST_BATCH
from trundle.simulate.sources.crossing import TAIL
from trundle.study.plans import Drive
from trundle.study_file.draft import Draft
from trundle.study_file.fields import (
    Line,
    Section,
    Time,
    Whole,
)

__all__ = ["MAX_STEPS", "GeneralSection", "fields", "problems"]

MAX_STEPS = 1_000_000
"""Of a record: beyond them a time is more likely a slip."""

_MANY = 1_000_000
_MAX_HISTORY = 4e9  # bytes of histories held at once for one cell


class GeneralSection(Section):
    """Title, seed, number of runs and record length: the keys above the first table."""

    title: Annotated[Line, Field(max_length=200)]
    """What the study is called, in tables and in the report."""
    seed: Annotated[Whole, Field(ge=0, lt=2**63)]
    """Where random numbers begin: the same seed gives the same result, bit for bit."""
    runs: Annotated[Whole, Field(ge=1, le=_MANY)]
    """Realisations of the road in every cell of results."""
    duration: Time | None = None
    """Length of every record; without it each lasts until its vehicles have left."""


def fields(draft: Draft) -> dict[str, Any]:
    """Return what a study takes from the section."""
    general = draft.file.general
    return {} if general is None else dict(general)


def problems(draft: Draft) -> Iterator[Problem]:
    """Give studies that would not fit in memory, or take too many steps."""
    if draft.file.general is not None:
        yield from _runs(draft, draft.file.general)
        yield from _steps(draft, draft.file.general)


def _contacts(draft: Draft) -> int:
    """Return how many contacts all vehicles have, 1 at least."""
    return max(1, sum(drive.vehicle.n_contacts for drive in draft.drives.values()))


def _runs(draft: Draft, general: GeneralSection) -> Iterator[Problem]:
    """Give runs of which too much would be kept: of every one a few numbers a point."""
    points = max(1, len(draft.file.items("point")))
    cases = len(draft.drives) + len(draft.sources) + max(1, len(draft.file.items("traffic")))
    cells = len(draft.methods) * max(1, len(draft.file.items("road"))) * cases
    kept = 8 * cells * (24 * points + 2 * _contacts(draft))
    if general.runs * kept > _MAX_HISTORY:
        yield Problem(
            place="runs",
            value=str(general.runs),
            rule="what is kept of every run would not fit in memory",
            remedy=f"use at most {int(_MAX_HISTORY / kept)} runs, or fewer points",
        )


def _steps(draft: Draft, general: GeneralSection) -> Iterator[Problem]:
    """Give records of too many steps, and those whose histories are too long to be held."""
    points, contacts = max(1, len(draft.file.items("point"))), _contacts(draft)
    # Histories are held for a batch at a time.
    per_step = 8 * LEAST_BATCH * (6 * points + 4 * contacts) + 1200 * contacts
    place, duration = "duration", general.duration
    if duration is None:
        place, duration = max(_lengths(draft), key=lambda one: one[1], default=(place, TAIL))
    before = max(map(_run_in_time, draft.drives.values()), default=0.0)
    for method in draft.methods.values():
        steps = (before + duration) / method.interaction.integration.dt
        if steps > MAX_STEPS:
            yield Problem(
                place=place,
                value=f"{duration:g} s",
                rule=f"method {method.name!r} would take {steps:.3g} steps, those of the "
                f"{before:.3g} s of run-in included; "
                f"the limit is {MAX_STEPS}",
                remedy="shorten duration or run_in, or lengthen dt"
                if general.duration
                else "give a duration, shorten run_in, or lengthen dt",
            )
        elif steps * per_step > _MAX_HISTORY:
            yield Problem(
                place=place,
                value=f"{duration:g} s",
                rule=f"the histories of method {method.name!r} would not fit in memory, even of "
                f"{LEAST_BATCH} runs at a time",
                remedy="use fewer points, a shorter record, or a longer dt",
            )


def _lengths(draft: Draft) -> Iterator[tuple[str, float]]:
    """Give how long a record is that lasts until all has left, and whose it is [s]."""
    ways = {name: _time_needed(drive) for name, drive in draft.drives.items()}
    ways |= {name: source.leaves for name, source in draft.sources.items()}
    for name, time in ways.items():
        yield draft.file.place_of(name, "route", *draft.file.shaking), time + TAIL
    for i, section in draft.file.lists.get("traffic", []):
        there = zip(section.routes, section.times, strict=True)
        last = max((ways[name] + depart for name, depart in there if name in ways), default=0.0)
        yield f"traffic[{i + 1}]", last + TAIL


def _time_needed(drive: Drive) -> float:
    """Return how long a vehicle is on its way: until it has left, or stands for ever [s]."""
    law, way = drive.route.law, drive.route.length + 2.0 * drive.vehicle.length
    return min(law.time_to(way), law.rests_from)


def _run_in_time(drive: Drive) -> float:
    """Return how long a vehicle drives on rigid ground before the record begins [s]."""
    anywhere = RoadClass("A")
    try:
        return Crossing(drive.vehicle, drive.route, anywhere, run_in=drive.run_in).run_in_time
    except InputError:  # what cannot be driven is told of the route
        return 0.0

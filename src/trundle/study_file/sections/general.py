"""Title, seed, runs and duration: the keys above the first table."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Annotated, Any

from pydantic import Field

from trundle.errors import InputError, Problem
from trundle.road import RoadClass
from trundle.simulate import Crossing
from trundle.simulate.ensembles import LEAST_BATCH
from trundle.study.plans import Drive, MethodPlan
from trundle.study_file.document import StudyFile
from trundle.study_file.draft import Draft
from trundle.study_file.fields import (
    Line,
    Section,
    Time,
    Whole,
)

__all__ = ["GeneralSection", "fields", "problems"]

_MANY = 1_000_000
_MAX_STEPS = 1_000_000
_MAX_HISTORY = 4e9  # bytes of histories held at once for one cell


class GeneralSection(Section):
    """Title, seed, number of runs and record length: the keys above the first table."""

    title: Annotated[Line, Field(max_length=200)]
    seed: Annotated[Whole, Field(ge=0, lt=2**63)]
    runs: Annotated[Whole, Field(ge=1, le=_MANY)]
    duration: Time | None = None


def fields(draft: Draft) -> dict[str, Any]:
    """Return what a study takes from the section."""
    general = draft.file.general
    return {} if general is None else dict(general)


def problems(draft: Draft) -> Iterator[Problem]:
    """Give studies that would not fit in memory, or take too many steps."""
    yield from _sizes(draft.file, draft.drives, draft.methods)


def _sizes(
    file: StudyFile, drives: Mapping[str, Drive], methods: Mapping[str, MethodPlan]
) -> Iterator[Problem]:
    if file.general is None:
        return
    contacts = sum(drive.vehicle.n_contacts for drive in drives.values())
    points = max(1, len(file.items("point")))
    # Histories are held for a batch at a time; of every run a few numbers a point are kept.
    per_step = 8 * LEAST_BATCH * (6 * points + 4 * max(1, contacts)) + 1200 * max(1, contacts)
    cells = len(methods) * max(1, len(file.items("road"))) * (len(drives) + 1)
    kept = 8 * cells * (24 * points + 2 * max(1, contacts))
    if file.general.runs * kept > _MAX_HISTORY:
        yield Problem(
            place="runs",
            value=str(file.general.runs),
            rule="what is kept of every run would not fit in memory",
            remedy=f"use at most {int(_MAX_HISTORY / kept)} runs, or fewer points",
        )
    ways = (_time_needed(drive) for drive in drives.values())
    duration = file.general.duration or max(ways, default=0.0) + 5.0
    before = max(map(_run_in_time, drives.values()), default=0.0)
    for method in methods.values():
        steps = (before + duration) / method.interaction.integration.dt
        if steps > _MAX_STEPS:
            yield Problem(
                place="duration",
                value=f"{duration:g} s",
                rule=f"method {method.name!r} would take {steps:.3g} steps, those of the "
                f"{before:.3g} s of run-in included; "
                f"the limit is {_MAX_STEPS}",
                remedy="shorten the duration or run_in, or lengthen dt",
            )
        elif steps * per_step > _MAX_HISTORY:
            yield Problem(
                place="duration",
                value=f"{duration:g} s",
                rule=f"the histories of method {method.name!r} would not fit in memory, even of "
                f"{LEAST_BATCH} runs at a time",
                remedy="use fewer points, a shorter record, or a longer dt",
            )


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

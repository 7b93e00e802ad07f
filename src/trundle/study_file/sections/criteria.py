"""Criteria: what the response is held against, and by which method."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Annotated, Any, Literal

from pydantic import Field

from trundle.criteria import Criterion, find_criterion, shaped
from trundle.errors import InputError, Problem
from trundle.signals import TOP_FREQUENCY
from trundle.study.plans import Assessment, MethodPlan
from trundle.study_file.attempt import attempted
from trundle.study_file.document import StudyFile
from trundle.study_file.draft import Draft, refer
from trundle.study_file.fields import (
    Line,
    Name,
    Number,
    Section,
)
from trundle.study_file.kinds import SectionKind
from trundle.study_file.user_criteria import read_criteria

__all__ = ["CRITERIA", "build", "fields", "problems"]


class CriteriaSection(Section):
    """What the response is held against, and by which method's result."""

    curves: Annotated[tuple[str, ...], Field(min_length=1)]
    method: Name
    percentile: Annotated[Number, Field(gt=0.0, le=100.0)] = 95.0
    averaging: Literal["max_1s", "slow", "fast", "event"] = "max_1s"
    events: Annotated[Number, Field(ge=1.0, le=1e6)] = 1.0
    files: tuple[Line, ...] = ()
    shape: Literal["rising", "flat"] = "rising"


CRITERIA = SectionKind(name="criteria", schema=CriteriaSection, form="table")


def build(draft: Draft) -> tuple[Draft, list[Problem]]:
    """Return the draft with what its response is held against."""
    section = draft.file.tables.get("criteria")
    if section is None:
        return draft, []
    own: list[Criterion] = []
    found: list[Problem] = []
    read: dict[str, bytes] = {}
    for i, name in enumerate(section.files):
        path = draft.files.get(name, draft.folder / name)
        curves, mistakes = attempted(f"criteria.files[{i + 1}]", lambda p=path: read_criteria(p))
        found += mistakes
        own += curves or ()
        if curves is not None:
            read[name] = path.read_bytes()
    if len(read) < len(set(section.files)):
        return draft, found  # a curve of a file that cannot be read is not a second mistake
    named: list[Criterion] = []
    for i, name in enumerate(section.curves):
        curve, mistakes = attempted(
            f"criteria.curves[{i + 1}]",
            lambda n=name: find_criterion(n, own),
            "see 'trundle criteria'",
        )
        found += mistakes
        named += [curve] if curve is not None else []
    assessment = Assessment(
        criteria=shaped(named, section.shape),
        method=section.method,
        percentile=section.percentile,
        averaging=section.averaging,
        events=section.events,
    )
    return replace(draft, assessment=assessment, read={**draft.read, **read}), found


def fields(draft: Draft) -> dict[str, Any]:
    """Return what a study takes from the section."""
    return {"assessment": draft.assessment, "files": draft.read}


def problems(draft: Draft) -> Iterator[Problem]:
    """Give curves that are named twice, a method that is not there, and steps too long."""
    section = draft.file.tables.get("criteria")
    if section is None:
        return
    for name in sorted({c for c in section.curves if section.curves.count(c) > 1}):
        yield Problem(
            place="criteria.curves",
            value=f"{name!r} {section.curves.count(name)} times",
            rule="each curve is held against once",
            remedy="name it once",
        )
    yield from refer("criteria.method", section.method, draft.file.declared["method"], "method")
    yield from _assessed_step(draft.file, draft.methods)


def _assessed_step(file: StudyFile, methods: Mapping[str, MethodPlan]) -> Iterator[Problem]:
    criteria = file.tables.get("criteria")
    if criteria is None or criteria.method not in methods:
        return
    top = 0.0
    for name in criteria.curves:
        try:
            curve = find_criterion(name)
        except InputError:
            continue  # reported where the curves are read, or the user's own
        top = max(top, min(float(curve.frequencies[-1]), TOP_FREQUENCY))
    dt = methods[criteria.method].interaction.integration.dt
    if top and dt > 1.0 / (2.5 * top) * (1 + 1e-9):
        yield Problem(
            place="criteria.method",
            value=f"{criteria.method!r} with dt = {1e3 * dt:g} ms",
            rule=f"curves that reach {top:g} Hz need a time step of at most {400.0 / top:g} ms",
            remedy="shorten dt, or assess by another method of this study",
        )

"""Criteria: what the response is held against, and by which method."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Annotated, Any, Literal

from pydantic import Field

from trundle.criteria import Criterion, find_criterion, shaped
from trundle.criteria.curve import told_apart
from trundle.errors import Problem
from trundle.signals import TOP_FREQUENCY
from trundle.study.plans import Assessment, MethodPlan
from trundle.study_file.attempt import attempted
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
    """Names of criteria, of the library or of files."""
    method: Name
    """The method whose result is held against them."""
    percentile: Annotated[Number, Field(gt=0.0, le=100.0)] = 95.0
    """The level that this share of the runs stays below."""
    averaging: Literal["max_1s", "slow", "fast", "event"] = "max_1s"
    """The largest RMS over 1 s, slow or fast averages, or one over the event."""
    events: Annotated[Number, Field(ge=1.0, le=1e6)] = 1.0
    """Passages that a vibration dose is for."""
    files: tuple[Line, ...] = ()
    """Your own curves, beside the study (TOML, CSV)."""
    shape: Literal["rising", "flat"] = "rising"
    """Generic curves below 8 Hz: rising, or flat to 1 Hz."""


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
    named: list[tuple[str, Criterion]] = []
    for i, name in enumerate(section.curves):
        curve, mistakes = attempted(
            f"criteria.curves[{i + 1}]",
            lambda n=name: find_criterion(n, own),
            "see 'trundle criteria'",
        )
        found += mistakes
        named += [(name, curve)] if curve is not None else []
    found += _twice(named)
    assessment = Assessment(
        criteria=told_apart(shaped((curve for _, curve in named), section.shape)),
        method=section.method,
        percentile=section.percentile,
        averaging=section.averaging,
        events=section.events,
    )
    return replace(draft, assessment=assessment, read={**draft.read, **read}), found


def _twice(named: Sequence[tuple[str, Criterion]]) -> Iterator[Problem]:
    """Give curves that are held against twice: verdicts are kept by their names.

    A curve is found in any case and by other names, so that one is looked for among those found.
    """
    given: dict[str, list[str]] = {}
    for name, curve in named:
        given.setdefault(curve.name.lower(), []).append(name)
    for names in given.values():
        if len(names) > 1:
            words = dict.fromkeys(repr(name) for name in names)
            yield Problem(
                place="criteria.curves",
                value=f"{' and '.join(words)}, one curve {len(names)} times",
                rule="each curve is held against once, by a name of its own",
                remedy="name it once",
            )


def fields(draft: Draft) -> dict[str, Any]:
    """Return what a study takes from the section."""
    return {"assessment": draft.assessment, "files": draft.read}


def problems(draft: Draft) -> Iterator[Problem]:
    """Give a method that is not there, and steps too long."""
    section = draft.file.tables.get("criteria")
    if section is None:
        return
    yield from refer("criteria.method", section.method, draft.file.declared["method"], "method")
    yield from _assessed_step(draft.assessment, draft.methods)


def _assessed_step(
    assessment: Assessment | None, methods: Mapping[str, MethodPlan]
) -> Iterator[Problem]:
    """Give a step that does not show the last band of a curve, the user's own among them."""
    if assessment is None or assessment.method not in methods:
        return
    ends = (float(curve.frequencies[-1]) for curve in assessment.criteria)
    top = min(max(ends, default=0.0), TOP_FREQUENCY)
    dt = methods[assessment.method].interaction.integration.dt
    if top and dt > 1.0 / (2.5 * top) * (1 + 1e-9):
        yield Problem(
            place="criteria.method",
            value=f"{assessment.method!r} with dt = {1e3 * dt:g} ms",
            rule=f"curves that reach {top:g} Hz need a time step of at most {400.0 / top:g} ms",
            remedy="shorten dt, or assess by another method of this study",
        )

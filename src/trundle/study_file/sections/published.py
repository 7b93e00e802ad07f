"""What a publication says: values to hold beside ours, numbers of figures, notes."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, Any, Literal

from pydantic import Field

from trundle.errors import Problem
from trundle.study.plans import Note, Printed, PrintedBound
from trundle.study_file.draft import Draft, refer
from trundle.study_file.fields import (
    Acceleration,
    Line,
    Name,
    Section,
    Speed,
)
from trundle.study_file.kinds import SectionKind
from trundle.study_file.sections.road import refer_road

__all__ = ["NOTE", "PRINTED", "PRINTED_BOUND", "PUBLICATION", "fields", "problems"]


class PrintedSection(Section):
    """A published pair of values to hold beside ours."""

    case: Name
    """Route or traffic that it is of."""
    road: str
    """Label of the road that it is of."""
    method: Name
    """Method that it is of."""
    peak_acceleration: Acceleration
    """The printed peak acceleration."""
    rms_velocity: Speed
    """The printed RMS velocity."""


class PrintedBoundSection(Section):
    """A published upper bound to hold beside ours."""

    bound: Literal["single", "absolute maximum", "multiple vehicles"]
    """What bound it is."""
    road: str
    """Label of the road that it is of."""
    method: Name
    """Method that it is of."""
    peak_acceleration: Acceleration
    """The printed peak acceleration."""
    rms_velocity: Speed
    """The printed RMS velocity."""


class PublicationSection(Section):
    """What a publication says of this study: numbers of its figures and tables, its sources."""

    numbers: dict[Name, Line] = Field(default_factory=dict[Name, Line])
    """Numbers of the publication's figures and tables, by what they show."""
    force_speeds: Annotated[tuple[Speed, ...], Field(max_length=10)] = ()
    """Speeds at which contact forces are drawn."""
    sources: tuple[Line, ...] = ()
    """References that the report lists."""


class NoteSection(Section):
    """A note that the report prints."""

    title: Annotated[Line, Field(max_length=200)]
    """Heading of the note."""
    text: Annotated[str, Field(min_length=1, max_length=5000)]
    """What it says."""


PRINTED = SectionKind(name="printed", schema=PrintedSection, form="list")
PRINTED_BOUND = SectionKind(name="printed_bound", schema=PrintedBoundSection, form="list")
PUBLICATION = SectionKind(name="publication", schema=PublicationSection, form="table")
NOTE = SectionKind(name="note", schema=NoteSection, form="list")


def fields(draft: Draft) -> dict[str, Any]:
    """Return what a study takes from the sections."""
    file = draft.file
    publication = file.tables.get("publication") or PublicationSection()
    return {
        "printed": tuple(Printed(**dict(p)) for p in file.items("printed")),
        "printed_bounds": tuple(PrintedBound(**dict(p)) for p in file.items("printed_bound")),
        "notes": tuple(Note(**dict(n)) for n in file.items("note")),
        "numbering": publication.numbers,
        "force_speeds": publication.force_speeds,
        "publications": publication.sources,
    }


def problems(draft: Draft) -> Iterator[Problem]:
    """Give values of a case, a road or a method that is not there."""
    file = draft.file
    names = {"case": draft.acting | file.declared["traffic"], "method": file.declared["method"]}
    for kind, keys in {
        "printed": ("case", "road", "method"),
        "printed_bound": ("road", "method"),
    }.items():
        for i, section in file.lists.get(kind, []):
            for key in keys:
                place, value = f"{kind}[{i + 1}].{key}", getattr(section, key)
                if key == "road":
                    yield from refer_road(draft, place, value)
                else:
                    yield from refer(place, value, names[key], key)

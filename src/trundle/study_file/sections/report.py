"""What stands on the front of a report, and the units that it is written in."""

from __future__ import annotations

import datetime as dt
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field

from trundle.errors import Problem
from trundle.study.report_plan import AccelerationUnit, ReportPlan, VelocityUnit
from trundle.study_file.draft import Draft
from trundle.study_file.fields import Line, Section
from trundle.study_file.kinds import SectionKind

__all__ = ["REPORT", "build", "fields"]

_LARGEST_LOGO = 1_000_000  # bytes
_PICTURES = {b"\x89PNG\r\n\x1a\n": "PNG", b"\xff\xd8\xff": "JPEG"}
"""How the pictures begin that every browser and printer shows."""
_UNITS = {"acceleration", "velocity", "displacement", "load"}


def _as_text(value: Any) -> Any:
    """Return a date of TOML's own kind as its words; anything else as it is."""
    return value.isoformat() if isinstance(value, dt.date) else value


Short = Annotated[Line, Field(max_length=100)]


class ReportSection(Section):
    """Who the report is for, who wrote it, and its units."""

    client: Short = ""
    """Whom the report is for."""
    job: Short = ""
    """Number or name of the job."""
    revision: Short = ""
    """Revision of the report."""
    date: Annotated[Short, BeforeValidator(_as_text)] = ""
    """Date of the report; as it is written here."""
    author: Short = ""
    """Who wrote it."""
    logo: Line = ""
    """Picture beside the study, PNG or JPEG, on the front."""
    acceleration: AccelerationUnit = "gal"
    """Unit of acceleration in the report."""
    velocity: VelocityUnit = "um/s"
    """Unit of velocity in the report."""
    displacement: Literal["um", "mm", "m", "mil", "in"] = "um"
    """Unit of displacement in the report."""
    load: Literal["t", "kN"] = "t"
    """Unit of axle loads in the report."""


REPORT = SectionKind(name="report", schema=ReportSection, form="table")


def build(draft: Draft) -> tuple[Draft, list[Problem]]:
    """Return the draft with the bytes of the logo among its files."""
    section = draft.file.tables.get("report")
    if section is None or not section.logo:
        return draft, []
    path = draft.files.get(section.logo, draft.folder / section.logo)
    data, problem = _picture(path)
    if problem is not None:
        return draft, [replace(problem, place="report.logo", value=section.logo)]
    return replace(draft, read={**draft.read, section.logo: data}), []


def _picture(path: Path) -> tuple[bytes, Problem | None]:
    """Return the bytes of a picture, or why they are not those of one."""
    wanted = "give a PNG or JPEG file of at most 1 MB beside the study file"
    try:
        size = path.stat().st_size
        if size > _LARGEST_LOGO:
            return b"", _wrong(f"this file has {size / 1e6:.1f} MB", wanted)
        data = path.read_bytes()
    except OSError as error:
        return b"", _wrong(f"cannot be read ({error.strerror})", wanted)
    if not any(data.startswith(head) for head in _PICTURES):
        return b"", _wrong("this is neither a PNG nor a JPEG picture", wanted)
    return data, None


def _wrong(rule: str, remedy: str) -> Problem:
    return Problem(place="", value="", rule=rule, remedy=remedy)


def fields(draft: Draft) -> dict[str, Any]:
    """Return what a study takes from the section."""
    section = draft.file.tables.get("report")
    if section is None:
        return {"report": ReportPlan()}
    chosen = frozenset(section.model_fields_set & _UNITS)
    return {"report": ReportPlan(**dict(section), chosen=chosen)}

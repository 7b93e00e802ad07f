"""Read times of the day, and timetables: a table of times and routes."""

from __future__ import annotations

import csv
import re
from pathlib import Path
from typing import Annotated, TypeAlias

from pydantic import BeforeValidator
from pydantic_core import PydanticCustomError

from trundle.errors import InputError
from trundle.study_file.lines import rows_of
from trundle.traffic import DAY
from trundle.units import to_si

__all__ = ["TimeOfDay", "read_timetable", "seconds_of"]

_LARGEST = 5_000_000  # bytes
_CLOCK = re.compile(r"^\s*(\d{1,2}):([0-5]\d)(?::([0-5]\d(?:\.\d{1,6})?))?\s*$")
_RULE = 'a time of the day is written as "8:30", "08:30:15", or as a time since midnight, "3600 s"'
_HEADINGS = ("time", "departure", "departs", "t")
_ROUTES = ("route", "vehicle", "name")


def seconds_of(value: object) -> float:
    """Return the seconds since midnight of a time of the day.

    Parameters
    ----------
    value : str
        ``8:30``, ``08:30:15``, ``24:00``, or a time since midnight with its unit.

    Raises
    ------
    InputError
        No such time.

    Examples
    --------
    >>> seconds_of("8:30")
    30600.0
    """
    if not isinstance(value, str):
        raise InputError(_RULE)
    match = _CLOCK.match(value)
    seconds = (
        3600.0 * int(match[1]) + 60.0 * int(match[2]) + float(match[3] or 0.0)
        if match
        else _since_midnight(value)
    )
    if not 0.0 <= seconds <= DAY:
        raise InputError(f"a time of the day lies between 0:00 and 24:00; got {value.strip()}")
    return seconds


def _since_midnight(value: str) -> float:
    try:
        return to_si(value, "time")
    except InputError:
        raise InputError(_RULE) from None


def _field(value: object) -> float:
    try:
        return seconds_of(value)
    except InputError as error:
        raise PydanticCustomError("rule", "{rule}", {"rule": str(error)}) from None


TimeOfDay: TypeAlias = Annotated[float, BeforeValidator(_field)]
"""A time of the day [s since midnight]."""


def read_timetable(path: Path) -> dict[str, list[float]]:
    """Read a timetable: times of departure by route.

    Parameters
    ----------
    path : Path
        A table in UTF-8, its columns parted by comma, semicolon or tab, with a heading: ``time``
        and ``route``. A line that begins with ``#`` is a note.

    Returns
    -------
    dict of str to list of float
        Times of the day [s], by route, as they stand in the file.

    Raises
    ------
    InputError
        A file that cannot be read, a row that is none, with its line.
    """
    text = _text_of(path)
    lines = [(i, one) for i, one in enumerate(rows_of(text), start=1) if one.strip()]
    lines = [(i, one) for i, one in lines if not one.lstrip().startswith("#")]
    if not lines:
        raise InputError(f"{path.name}: is empty; a timetable has columns time and route")
    head = lines[0][1]
    delimiter = next((mark for mark in ("\t", ";", ",") if mark in head), ",")
    names = [cell.strip().lower() for cell in head.split(delimiter)]
    time, route = _column(names, _HEADINGS, path), _column(names, _ROUTES, path)
    out: dict[str, list[float]] = {}
    for number, line in lines[1:]:
        row = _cells(line, delimiter, f"{path.name}, line {number}")
        if len(row) != len(names):
            raise InputError(
                f"{path.name}, line {number}: {len(row)} cells under {len(names)} headings"
            )
        try:
            seconds = seconds_of(row[time].strip())
        except InputError as error:
            raise InputError(f"{path.name}, line {number}: {row[time]!r}: {error}") from None
        out.setdefault(row[route].strip(), []).append(seconds)
    if not out:
        raise InputError(f"{path.name}: holds no departure below its heading")
    return out


def _cells(line: str, delimiter: str, place: str) -> list[str]:
    """Return the cells of a line; a quote that is not closed is a mistake."""
    try:
        return next(csv.reader([line], delimiter=delimiter, strict=True))
    except csv.Error as error:
        raise InputError(f"{place}: is no row of a table ({error})") from None


def _text_of(path: Path) -> str:
    try:
        if path.exists() and not path.is_file():
            raise InputError(f"{path.name}: is a folder, a device or a pipe, and no timetable")
        with path.open("rb") as opened:
            raw = opened.read(_LARGEST + 1)
        if len(raw) > _LARGEST:
            raise InputError(f"{path.name}: a timetable is at most 5 MB")
        return raw.decode("utf-8-sig")
    except FileNotFoundError:
        raise InputError(f"{path.name}: no such file; name one beside the study") from None
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, "strerror", None) or "it is not UTF-8 text"
        raise InputError(f"{path.name}: cannot be read ({reason})") from None


def _column(names: list[str], known: tuple[str, ...], path: Path) -> int:
    found = [i for i, name in enumerate(names) if name in known]
    if len(found) != 1:
        raise InputError(
            f"{path.name}: its heading needs one column called {known[0]!r}; got "
            f"{', '.join(map(repr, names))}"
        )
    return found[0]

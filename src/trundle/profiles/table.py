"""Read profiles from text: a column of stations, and one or more of heights."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
from jaxtyping import Float

from trundle._typing import Array
from trundle.errors import InputError
from trundle.profiles.survey import Survey
from trundle.records.headings import Heading, read_heading
from trundle.records.lines import Layout, cells_of, find_table, is_number, text_of

__all__ = ["read_table"]

_STATION = re.compile(
    r"^\s*(s|x|u|station\w*|dist\w*|chainage|kilomet\w*|milepost|position|length|abscissa|"
    r"weg|strecke)\b",
    re.IGNORECASE,
)
_IN_NAME = re.compile(
    r"(?:\bat\s+)?\b(?:v|y|offset|lateral)\s*=\s*(?P<v>[+-]?\d+(?:\.\d+)?(?:e[+-]?\d+)?)\s*"
    r"(?P<unit>mm|cm|m)\b",
    re.IGNORECASE,
)
_PLACE_UNIT = {"m": 1.0, "cm": 0.01, "mm": 0.001}
_MOST_BEHIND = 3  # lines of words behind a table
_UNIT_WORD = re.compile(r"^(?:mm|cm|dm|m|km|um|µm|in|inch|ft|mil|mi)$")


def read_table(data: bytes, path: Path) -> Survey:
    """Read columns such as ``station [m], left [mm], right [mm]``, or without a heading.

    Columns stand between commas, semicolons, tabs or blanks; numbers may have decimal commas.
    Stations stand in the column that is named so, or in the first.

    Parameters
    ----------
    data : bytes
        A text in UTF-8, UTF-16 or Windows-1252.
    path : Path
        The file, for messages.

    Raises
    ------
    InputError
        No text, no table, a cell that is no number, fewer than two columns.
    """
    text = text_of(data, path)
    layout = _table(text, path)
    _check_whole(text, layout, path)
    if layout.width < 2:
        raise InputError(
            f"{path}: has one column; a profile needs a station and a height on every line"
        )
    numbers = _numbers(layout, path)
    headings = _headings(layout)
    named = [i for i, one in enumerate(headings) if layout.heading and _STATION.match(one.name)]
    at = named[0] if named else 0
    others = [i for i in range(layout.width) if i != at]
    places = [_place(headings[i].name) for i in others]
    known = [one for one in places if one is not None]
    return Survey(
        station=numbers[:, at],
        elevation=numbers[:, others].T.copy(),
        names=tuple(headings[i].name for i in others),
        station_unit=headings[at].unit,
        units=tuple(headings[i].unit for i in others),
        lateral=tuple(known) if len(known) == len(others) else None,
        lines=np.asarray(layout.numbers, dtype=np.int64),
        notes=tuple(
            f"line {number} behind the table is passed over: {line.strip()[:40]!r}"
            for number, line in layout.left_out[:1]
        ),
    )


def _table(text: str, path: Path) -> Layout:
    """Return where the table stands; a cell in it that is no number is told by its line."""
    try:
        return find_table(text, path)
    except InputError:
        begun = False
        for number, line in enumerate(text.splitlines(), start=1):
            kinds = [is_number(cell) for cell in re.split(r"[;,\s]+", line.strip()) if cell]
            if begun and len(kinds) > 1 and not all(kinds) and any(kinds):
                raise InputError(
                    f"{path}: line {number} must hold numbers; got {line.strip()[:40]!r}"
                ) from None
            begun = begun or (len(kinds) > 1 and all(kinds))
        raise


def _check_whole(text: str, layout: Layout, path: Path) -> None:
    """Refuse lines that the table would lose: among its rows, before its first, behind its last."""
    taken = set(np.asarray(layout.numbers).tolist())
    first, last = min(taken), max(taken)
    behind = 0
    for number, line in enumerate(text.splitlines(), start=1):
        if number in taken or not line.strip():
            continue
        cells = cells_of(line, layout.mark)
        before = number < first and len(cells) == layout.width and is_number(cells[0])
        behind += number > last
        if before or first < number < last or behind > _MOST_BEHIND:
            raise InputError(
                f"{path}: line {number} must hold numbers; got {line.strip()[:40]!r}: mend it, or "
                "take it off"
            )


def _headings(layout: Layout) -> list[Heading]:
    """Return names and units of all columns; a line of units may stand below that of names."""
    words = [cell.strip().strip("()[]") for cell in layout.heading]
    if words and all(_UNIT_WORD.match(word) for word in words):
        above = cells_of(layout.above[-1], layout.mark) if layout.above else []
        names = above if len(above) == layout.width else [""] * layout.width
        return [
            Heading(name=name.strip() or f"track {i}", unit=unit)
            for i, (name, unit) in enumerate(zip(names, words, strict=True))
        ]
    return [_heading(layout, i) for i in range(layout.width)]


def _heading(layout: Layout, column: int) -> Heading:
    if not layout.heading:
        return Heading(name=f"track {column}" if column else "station")
    # the unit of the place across the road is not that of the heights
    bare = re.sub(r"\s{2,}", " ", _IN_NAME.sub("", layout.heading[column])).strip(" ,;:")
    one = read_heading(bare, column)
    if place := _IN_NAME.search(layout.heading[column]):
        one = replace(one, name=f"{one.name} {place[0]}")
    unit = one.unit
    if not unit and layout.units:
        unit = layout.units[column].strip().strip("()[]").strip()
    if not unit and (tail := re.search(r"[_ ](\w+)$", bare)) and _UNIT_WORD.match(tail[1]):
        unit = tail[1]  # elevation_mm
    return Heading(name=one.name, unit=unit)


def _place(name: str) -> float | None:
    """Return where across the road a track lies, if its name says so [m]."""
    found = _IN_NAME.search(name)
    return None if found is None else float(found["v"]) * _PLACE_UNIT[found["unit"].lower()]


def _numbers(layout: Layout, path: Path) -> Float[Array, "rows columns"]:
    """Return all cells as numbers; the first that is none is told with its line."""
    comma = layout.mark != "," and not any("." in line for line in layout.lines[:50])
    rows: list[list[float]] = []
    for number, line in zip(layout.numbers, layout.lines, strict=True):
        cells = [cell.strip() for cell in cells_of(line, layout.mark)]
        if len(cells) == layout.width + 1 and not cells[-1]:
            cells.pop()
        if len(cells) != layout.width:
            raise InputError(
                f"{path}: line {number} has {len(cells)} columns, the table has {layout.width}"
            )
        rows.append([_number(cell, int(number), path, comma=comma) for cell in cells])
    return np.array(rows)


def _number(cell: str, line: int, path: Path, *, comma: bool) -> float:
    try:
        value = float(cell.replace(",", ".") if comma else cell)
    except ValueError:
        shown = repr(cell[:30]) if cell else "an empty cell"
        raise InputError(f"{path}: line {line} must hold numbers; got {shown}") from None
    if not np.isfinite(value):
        raise InputError(
            f"{path}: line {line} holds {cell!r}: fill the gap, or cut the profile there"
        )
    return value

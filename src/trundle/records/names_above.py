"""Find the names and units of columns in what stands above a table."""

from __future__ import annotations

import re
from pathlib import Path

from trundle.errors import InputError
from trundle.records.cells import cells_of, is_comment, is_number, trimmed
from trundle.records.headings import is_fact, is_unit, tells_unit

__all__ = ["DECIMAL", "TWO_OR_ONE", "Line", "names_above", "refuse_other_names"]

Line = tuple[int, str]
"""Number of a line in its file, and its text."""

TWO_OR_ONE = re.compile(r"\s*[+-]?\d+,\d+,?\s*")
"""A row that is two whole numbers, or one with a decimal comma: its heading must say which."""

DECIMAL = re.compile(r"\s*(?:[+-]?\d+,0\d+|-0,\d+)\s*")
"""A number with a decimal comma, for two whole numbers are not written so."""

_NEAR = 3  # lines above a table in which its names are looked for


def names_above(
    above: list[Line], mark: str, width: int
) -> tuple[list[str], list[str], list[Line]]:
    """Return names, units and the other lines, of what stands above a table."""
    lines = list(above)
    while lines and not lines[-1][1].strip():
        lines.pop()
    units: list[str] = []
    for at in range(len(lines) - 1, max(-1, len(lines) - 1 - _NEAR), -1):
        cells = _named(lines[at][1], mark, width)
        if not cells:
            continue
        of_units = not units and at > 0 and all(is_unit(c) or not c.strip() for c in cells)
        if of_units and _named(lines[at - 1][1], mark, width):
            units = cells
            continue
        return cells, units, lines[:at] + [x for x in lines[at + 1 :] if not units]
    return [], [], lines


def _named(line: str, mark: str, width: int) -> list[str]:
    """Return a line's cells if it can be a heading of so many columns."""
    cells = _cells(line, mark)
    comment = is_comment(line)
    if not comment and len(cells) > width >= 2:
        cells = cells[:width]  # a column of comments that the rows leave out
    if len(cells) != width or all(is_number(cell) for cell in cells) or is_fact(line):
        return []
    return [] if comment and width == 1 and any(sign in cells[0] for sign in "=:") else cells


def _cells(line: str, mark: str) -> list[str]:
    """Return the cells of a line, without what makes a comment or a heading of it."""
    text = line.lstrip("#%;!/' \t") if is_comment(line) else line
    cells = [cell.strip() for cell in trimmed(cells_of(text, mark), mark)]
    begins = cells[0].lower().rstrip(":") if cells else ""
    return cells[1:] if begins in {"headers", "header", "columns"} else cells


def refuse_other_names(above: list[Line], row: str, mark: str, width: int, path: Path) -> None:
    """Refuse names with units above a first row of another number of columns.

    Decimal commas between commas make two columns of one, and a name too few or too many gives
    samples to another channel: neither shows in the numbers.

    Raises
    ------
    InputError
        With the line, and how many columns it names.
    """
    widths = {width, len(cells_of(row, mark))}
    for number, line in reversed(above[-_NEAR:]):
        cells = _cells(line, mark)
        if len(cells) not in widths and not is_fact(line) and _are_names(line, cells, row, width):
            raise InputError(
                f"{path}: line {number} names {len(cells)} column{'s' * (len(cells) > 1)}, and the "
                f"rows below it have {width}; give each a name"
                + ("; decimal commas need another delimiter between columns" * (mark == ","))
            )
        if _named(line, mark, width):
            return


def _are_names(line: str, cells: list[str], row: str, width: int) -> bool:
    """Return whether cells are names with units, too many or too few for a row."""
    told = [tells_unit(cell) for cell in cells]
    if is_comment(line):  # prose may speak of units
        return len(cells) > 1 and all(told)
    if len(cells) > width:  # what rows leave out may be comments, which have no unit
        return any(told[width:])
    return any(told) and (len(cells) > 1 or TWO_OR_ONE.fullmatch(row) is not None)

"""Read text of any usual encoding, and find the table in it."""

from __future__ import annotations

import csv
import re
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Int

from trundle._typing import Array
from trundle.errors import InputError
from trundle.records.headings import is_fact, is_unit
from trundle.records.stamps import is_stamp

__all__ = ["Layout", "cells_of", "find_table", "is_number", "text_of"]

_MARKS = (";", "\t", ",", " ")  # between columns
_COMMENTS = ("#", "%", ";", "//", "!", "'")
_LOOKED_AT = 400  # lines in which a table must begin
_WORDS = re.compile(r"[^\s\[\(]+\s*[\[\(][^\]\)]*[\]\)]|\S+")  # name [unit], or a word


@dataclass(frozen=True, kw_only=True)
class Layout:
    """Say where in a text the table stands.

    Attributes
    ----------
    mark : str
        Delimiter between columns; a blank stands for any white space.
    width : int
        Number of columns.
    heading : tuple of str
        Cells above the columns; empty where there are none.
    units : tuple of str
        Cells of a second line with units; empty where there is none.
    above : tuple of str
        All lines above the table that are not its heading.
    lines : list of str
        Lines of the table.
    numbers : ndarray of int, shape (n_lines,)
        Their numbers in the file.
    left_out : list of tuple of (int, str)
        Lines behind it that hold words, with their numbers.
    """

    mark: str
    width: int
    heading: tuple[str, ...]
    units: tuple[str, ...]
    above: tuple[str, ...]
    lines: list[str]
    numbers: Int[Array, " lines"]
    left_out: list[tuple[int, str]]


def text_of(data: bytes, path: Path) -> str:
    """Return a file's text; spreadsheets and loggers write one of three encodings."""
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        encodings = ("utf-16",)
    elif b"\0" in data:
        encodings = ()
    else:
        encodings = ("utf-8-sig", "cp1252")
    for encoding in encodings:
        with suppress(UnicodeDecodeError):
            return data.decode(encoding)
    raise InputError(f"{path}: is not text; records are CSV, WAV, UFF 58 or miniSEED files")


def cells_of(line: str, mark: str) -> list[str]:
    """Return the cells of a line; none where it cannot be read."""
    if mark == " ":
        return _WORDS.findall(line)
    try:
        cells = next(csv.reader([line], delimiter=mark, skipinitialspace=True))
    except (csv.Error, StopIteration):
        return []
    return cells


def is_number(cell: str) -> bool:
    """Return whether a cell holds a number, with a decimal point or comma."""
    try:
        float(cell.strip().replace(",", "."))
    except ValueError:
        return False
    return True


def find_table(text: str, path: Path) -> Layout:
    """Find delimiter, heading and rows: the longest run of lines with equally many numbers.

    Parameters
    ----------
    text : str
        The file's text.
    path : Path
        The file, for messages.

    Raises
    ------
    InputError
        No run of two lines of numbers, or a line in the table that is not like it.
    """
    every = text.splitlines()
    numbers = np.array([i for i, s in enumerate(every, 1) if s.strip() and not _is_comment(s)])
    plain = [every[i - 1] for i in numbers]
    head = plain[:_LOOKED_AT]
    (length, width, first), mark = _best(head)
    if length < 1 or len(plain) - first < 2:
        raise InputError(f"{path}: holds no samples: no two lines of numbers stand together")
    _refuse_numbers_above(plain[:first], numbers, (mark, width), path)
    end = _end_of_numbers(plain, mark)
    above = [(i, s) for i, s in enumerate(every[: numbers[first] - 1], 1) if s.strip()]
    heading, units, rest = _heading(above, mark, width)
    if not heading and above and length < 2:
        raise InputError(f"{path}: holds no samples: no two lines of numbers stand together")
    return Layout(
        mark=mark,
        width=width,
        heading=tuple(heading),
        units=tuple(units),
        above=tuple(line for _, line in rest),
        lines=plain[first:end],
        numbers=numbers[first:end],
        left_out=[(int(numbers[i]), plain[i]) for i in range(end, len(plain))],
    )


def _refuse_numbers_above(
    lines: list[str], numbers: Array, table: tuple[str, int], path: Path
) -> None:
    """Refuse rows of numbers before the table: they are samples that would be lost."""
    mark, width = table
    for number, line in zip(numbers, lines, strict=False):
        here = _width(line, mark, 1.0)
        if here > 1:
            raise InputError(
                f"{path}: line {number} has {here} columns of numbers, and the table below it "
                f"{width}; mend it, or put # before it"
            )


def _best(head: Sequence[str]) -> tuple[tuple[int, int, int], str]:
    """Return the longest run of rows and its delimiter; rows may hold words only if they must."""
    for share in (1.0, 0.5):
        found = [(_run(head, mark, share), mark) for mark in _MARKS]
        best = max(found, key=lambda one: one[0][:2])
        if best[0][0] > 1 or len(head) < 2:
            return best
    return max(((_run(head, mark, 1.0), mark) for mark in _MARKS), key=lambda one: one[0][:2])


def _is_comment(line: str) -> bool:
    return line.lstrip().startswith(_COMMENTS)


def _run(lines: Sequence[str], mark: str, share: float) -> tuple[int, int, int]:
    """Return length, width and first line of the longest run of like rows of numbers."""
    best, start, width = (0, 0, 0), 0, 0
    for i, line in enumerate(lines):
        here = _width(line, mark, share)
        if here == 0 or here != width:
            start, width = i, here
        if width and i + 1 - start > best[0]:
            best = (i + 1 - start, width, start)
    return best


def _width(line: str, mark: str, share: float) -> int:
    """Return the number of columns of a row, 0 where less than a share of it is numbers."""
    cells = _trimmed(cells_of(line, mark), mark)
    kinds = [is_number(cell) or not cell.strip() or is_stamp(cell) for cell in cells]
    some = any(is_number(cell) for cell in cells)
    return len(cells) if some and sum(kinds) >= share * len(kinds) else 0


def _trimmed(cells: list[str], mark: str) -> list[str]:
    """Take off the empty cell behind a delimiter that some loggers put at the end of a line."""
    return cells[:-1] if mark != " " and len(cells) > 1 and not cells[-1].strip() else cells


def _end_of_numbers(lines: list[str], mark: str) -> int:
    """Return where the words behind a table begin."""
    end = len(lines)
    while end > 1 and not any(is_number(c) or is_stamp(c) for c in cells_of(lines[end - 1], mark)):
        end -= 1
    return end


def _heading(
    above: list[tuple[int, str]], mark: str, width: int
) -> tuple[list[str], list[str], list[tuple[int, str]]]:
    """Return names, units and the other lines, of what stands above a table."""
    lines = list(above)
    while lines and not lines[-1][1].strip():
        lines.pop()
    units: list[str] = []
    for at in range(len(lines) - 1, max(-1, len(lines) - 4), -1):
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
    comment = _is_comment(line)
    cells = _trimmed(cells_of(line.lstrip("#%;!/' \t") if comment else line, mark), mark)
    cells = [cell.strip() for cell in cells]
    if cells and cells[0].lower().rstrip(":") in {"headers", "header", "columns"}:
        cells = cells[1:]
    if not comment and len(cells) > width >= 2:
        cells = cells[:width]  # a column of comments that the rows leave out
    if len(cells) != width or all(is_number(cell) for cell in cells) or is_fact(line):
        return []
    return [] if comment and width == 1 and any(sign in cells[0] for sign in "=:") else cells


def as_array(rows: Sequence[Sequence[str]], comma: bool) -> np.ndarray:
    """Return cells as numbers; what is none becomes not-a-number."""
    out = np.full((len(rows), len(rows[0])), np.nan)
    for i, row in enumerate(rows):
        for j, cell in enumerate(row):
            with suppress(ValueError):
                out[i, j] = float(cell.replace(",", ".") if comma else cell)
    return out

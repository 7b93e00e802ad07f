"""Read text of any usual encoding, and find the table in it."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Int

from trundle._typing import Array
from trundle.errors import InputError
from trundle.records.cells import cells_of, is_comment, is_number, trimmed
from trundle.records.headings import is_unit, tells_unit
from trundle.records.names_above import DECIMAL, Line, names_above, refuse_other_names
from trundle.records.stamps import is_stamp

__all__ = ["Layout", "cells_of", "find_table", "is_number", "text_of"]

_MARKS = (";", "\t", ",", " ")  # between columns
_LOOKED_AT = 400  # lines in which a table must begin


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
    empty : tuple of int
        Numbers of empty lines among its rows; none where one follows every row.
    """

    mark: str
    width: int
    heading: tuple[str, ...]
    units: tuple[str, ...]
    above: tuple[str, ...]
    lines: list[str]
    numbers: Int[Array, " lines"]
    left_out: list[tuple[int, str]]
    empty: tuple[int, ...]


@dataclass(frozen=True, kw_only=True)
class _Run:
    """Say where most rows of numbers stand together by a delimiter, and of how many columns."""

    mark: str
    length: int = 0
    width: int = 0
    first: int = 0


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
    numbers = _numbers_of_rows(every, "")
    run = _best([every[i - 1] for i in numbers[:_LOOKED_AT]])
    if run.mark == ";":  # which begins comments too
        numbers = _numbers_of_rows(every, ";")
        run = _best([every[i - 1] for i in numbers[:_LOOKED_AT]])
    plain = [every[i - 1] for i in numbers]
    run = _as_named(run, every, numbers)
    mark, width, first = run.mark, run.width, run.first
    if run.length < 1 or len(plain) - first < 2:
        raise InputError(f"{path}: holds no samples: no two lines of numbers stand together")
    _refuse_numbers_above(plain[: first + 1], numbers, run, path)
    end = _end_of_numbers(plain, mark)
    above = _above(every, int(numbers[first]))
    refuse_other_names(above, plain[first], mark, width, path)
    heading, units, rest = names_above(above, mark, width)
    if not heading and above and run.length < 2:
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
        empty=_empty(every, numbers[first:end]),
    )


def _numbers_of_rows(every: list[str], mark: str) -> Int[Array, " lines"]:
    """Return the numbers of lines that are neither empty nor comments."""
    return np.array([i for i, s in enumerate(every, 1) if s.strip() and not is_comment(s, mark)])


def _above(every: list[str], number: int) -> list[Line]:
    """Return what stands above a line, with its numbers."""
    return [(i, s) for i, s in enumerate(every[: number - 1], 1) if s.strip()]


def _empty(every: list[str], numbers: Int[Array, " lines"]) -> tuple[int, ...]:
    """Return the numbers of empty lines among rows; some programs put one behind every row."""
    inside = range(int(numbers[0]), int(numbers[-1]))
    found = tuple(i for i in inside if not every[i - 1].strip())
    return found if len(found) != len(numbers) - 1 else ()


def _as_named(run: _Run, every: list[str], numbers: Int[Array, " lines"]) -> _Run:
    """Return the rows that a heading means where a comma may be decimal or between two columns."""
    head = [every[i - 1] for i in numbers[:_LOOKED_AT]]
    two, one = _run(head, ",", 1.0), _run(head, ";", 1.0)
    if (run not in {two, one}) or two.width != 2 or one.width != 1 or two.length < 2:
        return run
    above = _above(every, int(numbers[min(two.first, one.first)]))
    names, _, _ = names_above(above, ",", 2)
    if names and not is_unit(names[1]):
        return two
    name, _, _ = names_above(above, ";", 1)
    return one if any(map(tells_unit, name)) or any(map(DECIMAL.fullmatch, head)) else run


def _refuse_numbers_above(
    lines: list[str], numbers: Int[Array, " lines"], run: _Run, path: Path
) -> None:
    """Refuse rows of numbers before the table: they are samples that would be lost."""
    widths = [_widths(line, run.mark, 1.0)[0] for line in lines[:-1]]
    at = next((i for i, here in enumerate(widths) if here > 1 or here == run.width), None)
    if at is None:
        return
    odd = next((i for i in range(at, len(widths)) if widths[i] != run.width), at)
    if widths[odd]:
        raise InputError(
            f"{path}: line {numbers[odd]} has {widths[odd]} columns of numbers, and the table "
            f"below it {run.width}; mend it, or put # before it"
        )
    raise InputError(
        f"{path}: line {numbers[odd]}, {lines[odd].strip()[:40]!r}, is no row of numbers, and line "
        f"{numbers[at]} above it is one; write nan for a sample that is missing, or put # before "
        "what is none"
    )


def _best(head: Sequence[str]) -> _Run:
    """Return the longest run of rows; rows may hold words only if they must."""
    for share in (1.0, 0.5):
        best = _longest(head, share)
        if best.length > 1 or len(head) < 2:
            return best
    return _longest(head, 1.0)


def _longest(head: Sequence[str], share: float) -> _Run:
    return max((_run(head, m, share) for m in _MARKS), key=lambda one: (one.length, one.width))


def _run(lines: Sequence[str], mark: str, share: float) -> _Run:
    """Return the longest run of like rows of numbers; a last cell may be empty in some of them."""
    widths = [_widths(line, mark, share) for line in lines]
    best, start, width = _Run(mark=mark), 0, 0
    for i, (here, whole) in enumerate(widths):
        if here == 0 or width not in (here, whole):
            start, width = i, here
            while width and start and widths[start - 1][1] == width:
                start -= 1
        if width and i + 1 - start > best.length:
            best = _Run(mark=mark, length=i + 1 - start, width=width, first=start)
    return best


def _widths(line: str, mark: str, share: float) -> tuple[int, int]:
    """Return the number of columns of a row, without and with an empty one at its end.

    Both are 0 where less than a share of it is numbers.
    """
    whole = cells_of(line, mark)
    cells = trimmed(whole, mark)
    kinds = [is_number(cell) or not cell.strip() or is_stamp(cell) for cell in cells]
    some = any(is_number(cell) for cell in cells)
    return (len(cells), len(whole)) if some and sum(kinds) >= share * len(kinds) else (0, 0)


def _end_of_numbers(lines: list[str], mark: str) -> int:
    """Return where the words behind a table begin."""
    end = len(lines)
    while end > 1 and not any(is_number(c) or is_stamp(c) for c in cells_of(lines[end - 1], mark)):
        end -= 1
    return end

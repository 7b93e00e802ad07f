"""Cut lines of text into cells, and tell numbers, comments and holes among them."""

from __future__ import annotations

import csv
import re
from collections.abc import Sequence
from contextlib import suppress

import numpy as np

__all__ = ["as_array", "cells_of", "is_comment", "is_number", "trimmed"]

_COMMENTS = ("#", "%", ";", "//", "!", "'")
_WORDS = re.compile(r"[^\s\[\(]+\s*[\[\(][^\]\)]*[\]\)]|\S+")  # name [unit], or a word
_NO_VALUE = re.compile(r"\s*#(?:N/?A|NV|[A-Z][A-Z/0-9]*[!?])(?!\w)")
"""What spreadsheets write where they have no number: #N/A, #NV, #VALUE!, #DIV/0!."""


def cells_of(line: str, mark: str) -> list[str]:
    """Return the cells of a line; none where it cannot be read."""
    if mark == " ":
        return _WORDS.findall(line)
    try:
        cells = next(csv.reader([line], delimiter=mark, skipinitialspace=True))
    except (csv.Error, StopIteration):
        return []
    return cells


def trimmed(cells: list[str], mark: str) -> list[str]:
    """Take off the empty cell behind a delimiter that some loggers put at the end of a line."""
    return cells[:-1] if mark != " " and len(cells) > 1 and not cells[-1].strip() else cells


def is_number(cell: str) -> bool:
    """Return whether a cell holds a number, with a decimal point or comma."""
    return _number(cell.strip(), comma=True) is not None


def is_comment(line: str, mark: str = "") -> bool:
    """Return whether a line is a comment, and not a row whose first cell holds no value.

    Between semicolons, a row whose first cell is empty begins as comments of some loggers do: it
    is none where a number stands in it, or nothing at all.
    """
    begins = line.lstrip()
    if not begins.startswith(_COMMENTS) or _NO_VALUE.match(begins):
        return False
    if mark != ";" or not begins.startswith(";"):
        return True
    cells = [cell for cell in cells_of(line, mark) if cell.strip()]
    return bool(cells) and not any(map(is_number, cells))


def as_array(rows: Sequence[Sequence[str]], comma: bool) -> np.ndarray:
    """Return cells as numbers; what is none becomes not-a-number."""
    out = np.full((len(rows), len(rows[0])), np.nan)
    for i, row in enumerate(rows):
        for j, cell in enumerate(row):
            number = _number(cell, comma=comma)
            if number is not None:
                out[i, j] = number
    return out


def _number(cell: str, *, comma: bool) -> float | None:
    """Return a cell's number; Python's own underscores between digits are damage in a record."""
    with suppress(ValueError):
        return None if "_" in cell else float(cell.replace(",", ".") if comma else cell)
    return None

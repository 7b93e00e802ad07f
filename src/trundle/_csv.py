"""Write tables that a spreadsheet opens without running what stands in them."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Sequence
from contextlib import suppress
from pathlib import Path

__all__ = ["write_csv"]

_RUN = ("=", "+", "-", "@", "\t", "\r")  # what a spreadsheet takes for the beginning of a formula


def write_csv(file: Path, heading: Sequence[str], rows: Iterable[Sequence[object]]) -> None:
    """Write a table in UTF-8; texts that would be formulas begin with an apostrophe.

    Parameters
    ----------
    file : Path
        Where it goes.
    heading : sequence of str
        Names of the columns.
    rows : iterable of sequence
        Numbers and texts, as many as there are columns.
    """
    with file.open("w", newline="", encoding="utf-8") as opened:
        writer = csv.writer(opened)
        for row in (heading, *rows):
            writer.writerow([_harmless(cell) for cell in row])


def _harmless(cell: object) -> object:
    if not isinstance(cell, str) or not cell.startswith(_RUN):
        return cell
    with suppress(ValueError):
        float(cell)
        return cell
    return f"'{cell}"

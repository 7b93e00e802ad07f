"""Write the tables of a study as a workbook of a spreadsheet program (extra ``xlsx``)."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from trundle.errors import InputError
from trundle.results.store import csv_rows
from trundle.results.study_result import StudyResult
from trundle.signals import nominal_frequency
from trundle.views.conclusions import concluded, lights
from trundle.views.words import shown

if TYPE_CHECKING:
    from openpyxl.worksheet._write_only import WriteOnlyWorksheet

__all__ = ["check_workbooks", "write_workbook"]

Cell: TypeAlias = str | float | int | None
Rows: TypeAlias = Iterable[Sequence[Cell]]

_LONGEST = 32_000  # letters of a cell


def check_workbooks() -> None:
    """Refuse workbooks where the library that writes them is not installed, before any work.

    Raises
    ------
    InputError
        With what installs it.
    """
    try:
        import_module("openpyxl")
    except ImportError:
        raise InputError("--xlsx needs an extra: pip install 'trundle[xlsx]'") from None


def write_workbook(result: StudyResult, file: Path) -> Path:
    """Write conclusions, lights, verdicts, levels and bands, a sheet each; return the file.

    Parameters
    ----------
    result : StudyResult
        A finished study.
    file : Path
        The workbook; no cell of it is a formula, whatever names hold.
    """
    check_workbooks()
    from openpyxl import Workbook  # noqa: PLC0415 - an extra

    book = Workbook(write_only=True)
    for title, rows in _sheets(result):
        _fill(book.create_sheet(title), rows)
    aside = file.with_name(f".{file.name}.part")
    try:
        book.save(aside)
        aside.replace(file)
    finally:
        aside.unlink(missing_ok=True)
    return file


def _fill(sheet: WriteOnlyWorksheet, rows: Rows) -> None:
    """Write rows under a heading that stays in sight."""
    from openpyxl.cell import WriteOnlyCell  # noqa: PLC0415 - an extra
    from openpyxl.styles import Font  # noqa: PLC0415

    sheet.freeze_panes = "A2"
    for number, row in enumerate(rows):
        cells = []
        for value in row:
            cell = WriteOnlyCell(sheet, value=_finite(value))
            if isinstance(value, str):
                cell.data_type = "s"  # a text that begins with = is no formula
            if number == 0:
                cell.font = Font(bold=True)
            cells.append(cell)
        sheet.append(cells)


def _finite(value: Cell) -> Cell:
    """Return what a cell can hold: nothing for what is not a number."""
    if isinstance(value, str):
        return "".join(c for c in value if c.isprintable() or c == "\n")[:_LONGEST]
    if value is None or not np.isfinite(value):
        return None
    return value


def _sheets(result: StudyResult) -> Iterator[tuple[str, Rows]]:
    yield "About", _about(result)
    if result.verdicts:
        yield "Conclusion", _conclusions(result)
        yield "Lights", _lights(result)
        yield "Verdicts", _verdicts(result)
    yield "Levels", _levels(result)
    yield "Bands", _bands(result)


def _about(result: StudyResult) -> Iterator[Sequence[Cell]]:
    yield "what", "value"
    yield "title", result.study.title
    yield from result.study.report.heading
    for name, value in result.provenance.items():
        if name != "methods":
            yield name.replace("_", " "), str(value)


def _conclusions(result: StudyResult) -> Iterator[Sequence[Cell]]:
    yield "point", "status", "conclusion"
    for one in concluded(result):
        yield one.point, one.status, one.words


def _lights(result: StudyResult) -> Iterator[Sequence[Cell]]:
    yield (
        "point",
        "criterion",
        "status",
        "margin",
        "lowest",
        "highest",
        "governing case",
        "band [Hz]",
    )
    for point, row in lights(result).items():
        for one in row.values():
            verdict = one.verdict
            status = one.status if one.applies else "for other motion"
            low, high = verdict.interval
            yield (
                point,
                verdict.criterion.title,
                status + (", not surely" if verdict.uncertain else ""),
                verdict.margin,
                low,
                high,
                one.where,
                _band(verdict.governing_band),
            )


def _verdicts(result: StudyResult) -> Iterator[Sequence[Cell]]:
    heading = ("case", "road", "method", "point", "criterion", "status", "margin", "lowest")
    more = ("highest", "band [Hz]", "value [SI]", "limit [SI]", "runs above [%]", "reasons")
    yield (*heading, *more)
    for key, verdicts in result.verdicts.items():
        for v in verdicts:
            low, high = v.interval
            reasons = "; ".join(v.reasons) if v.status == "not assessed" else ""
            numbers = (v.margin, low, high, _band(v.governing_band), v.value, v.limit)
            share = 100.0 * v.share_exceeding
            cell = (key.case, key.road, key.method, v.point, v.criterion.title, v.status)
            yield (*cell, *numbers, share, reasons)


def _band(f: float) -> float:
    return nominal_frequency(f) if np.isfinite(f) else np.nan


def _levels(result: StudyResult) -> Iterator[Sequence[Cell]]:
    """Give what ``summary.csv`` holds."""
    for number, row in enumerate(csv_rows(result)):
        if number == 0:
            yield list(row)
        yield list(row.values())


def _bands(result: StudyResult) -> Iterator[Sequence[Cell]]:
    """Give the band levels of every cell and point that are resolved."""
    unit, size = shown("m/s", result.study.report)
    shares = (5.0, 50.0, 95.0)
    yield "case", "road", "method", "point", "band [Hz]", *(f"v {p:g} % [{unit}]" for p in shares)
    for key, cell in result.cells.items():
        levels = np.stack([cell.spectra.percentile(p) for p in shares]) / size
        for i, point in enumerate(result.study.points):
            for b, f in enumerate(cell.spectra.mid_band):
                if cell.spectra.resolved[b]:
                    numbers = (float(v) for v in levels[:, i, b])
                    yield key.case, key.road, key.method, point, _band(float(f)), *numbers

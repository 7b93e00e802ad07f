"""Write results aside and put them in place in one step."""

from __future__ import annotations

import json
import os
import platform
import shutil
import signal
import tempfile
import threading
from collections.abc import Generator, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from trundle import __version__
from trundle._csv import write_csv
from trundle.errors import InputError
from trundle.response import percentile_interval
from trundle.study.cells import Cell
from trundle.study.datasets import plain, result_groups
from trundle.study.owned import check_owned, record_owned
from trundle.study.run import StudyResult, positions_at

__all__ = [
    "check_target",
    "new_results_folder",
    "provenance",
    "uninterrupted",
    "write_results",
]


def check_target(folder: Path, kind: str = "study") -> None:
    """Refuse a results folder that cannot be written, before any work starts.

    Parameters
    ----------
    folder : Path
        The folder.
    kind : str
        What will be written there: results of a study, of a record, or of changes.

    Raises
    ------
    InputError
        A file in its place, a folder that holds something else, or no permission.
    """
    folder = _normal(folder)
    try:
        _check_place(folder, kind)
    except OSError as error:
        raise InputError(
            f"results folder {folder}: {error.strerror or error}; choose another with --out"
        ) from None
    parent = _nearest_folder(folder)
    if not parent.is_dir():
        raise InputError(f"results folder {folder}: {parent} is not a folder; choose another")
    try:
        with tempfile.TemporaryDirectory(dir=parent, prefix=".trundle-"):
            pass
    except OSError as error:
        raise InputError(
            f"results folder {folder} cannot be written ({error.strerror}); "
            "choose another with --out"
        ) from None


def _check_place(folder: Path, kind: str) -> None:
    if folder.is_symlink():
        raise InputError(f"results folder {folder} is a link; name the folder itself with --out")
    if folder.exists() and not folder.is_dir():
        raise InputError(
            f"results folder {folder}: a file has this name; choose another with --out"
        )
    if not folder.is_dir():
        return
    if folder.resolve() == Path.cwd():
        raise InputError("the results folder must not be the current folder; name one with --out")
    check_owned(folder, kind)


def _normal(folder: Path) -> Path:
    """Return an absolute path without steps back: ``o/../o`` is ``o``."""
    return Path(os.path.normpath(folder.absolute()))


def _nearest_folder(folder: Path) -> Path:
    parent = folder.absolute().parent
    while not parent.exists() and parent != parent.parent:
        parent = parent.parent
    return parent


@contextmanager
def new_results_folder(
    folder: Path, *, within: Path | None = None, kind: str = "study"
) -> Generator[Path]:
    """Give a folder to fill; it takes its place only when all went well.

    It is filled beside its place, or `within` a folder of the same file system. What is written is
    recorded; of an earlier result nothing goes that is not on its own list, and of the same kind.

    An earlier result of that name is replaced at the end; after an error or an interrupt it
    still stands, and the half-filled folder is gone.
    """
    folder = _normal(folder)
    made = [parent for parent in folder.parents if not parent.exists()]
    folder.parent.mkdir(parents=True, exist_ok=True)
    aside = Path(tempfile.mkdtemp(dir=within or folder.parent, prefix=".trundle-"))
    try:
        aside.chmod(0o755)
        yield aside
        with uninterrupted():
            record_owned(aside, kind)
            _swap(aside, folder, kind)
    finally:
        with uninterrupted():
            shutil.rmtree(aside, ignore_errors=True)
            if not folder.exists():
                for parent in made:
                    with suppress(OSError):
                        parent.rmdir()


@contextmanager
def uninterrupted() -> Generator[None]:
    """Hold back Ctrl-C and termination until the block is done.

    Writers with threads of their own would go on writing behind an interrupted main thread.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    held: list[int] = []
    numbers = (signal.SIGINT, signal.SIGTERM)
    old = [signal.signal(number, lambda n, _frame: held.append(n)) for number in numbers]
    try:
        yield
    finally:
        for number, handler in zip(numbers, old, strict=True):
            signal.signal(number, handler)
    if held:
        raise KeyboardInterrupt


def _swap(new: Path, place: Path, kind: str) -> None:
    """Put new results in the place of earlier ones; if those hold more by now, beside them."""
    if not place.exists():
        os.rename(new, place)
        return
    try:
        check_owned(place, kind)
    except InputError as error:
        beside = Path(tempfile.mkdtemp(dir=place.parent, prefix=f"{place.name}-"))
        os.rename(new, beside)
        raise InputError(f"{error}; the new results are in {beside}") from None
    old = Path(tempfile.mkdtemp(dir=place.parent, prefix=".trundle-old-"))
    os.rename(place, old / "old")
    os.rename(new, place)
    shutil.rmtree(old, ignore_errors=True)


def provenance(result: StudyResult) -> dict[str, Any]:
    """Return all that is needed to run the study again and get the same bits."""
    study = result.study
    return {
        "program": "trundle",
        "version": __version__,
        "study": study.title,
        "study_hash": study.content_hash,
        "floor_hash": study.floor.content_hash,
        "seed": study.seed,
        "runs": study.runs,
        "python": platform.python_version(),
        "numpy": np.__version__,
        "methods": {method.name: str(method.interaction) for method in study.methods},
    }


def write_results(result: StudyResult, folder: Path) -> None:
    """Write `results.zarr`, `summary.json`, `summary.csv` and the study file into a folder."""
    (folder / "study.toml").write_text(result.study.text, encoding="utf-8")
    with uninterrupted():
        _write_zarr(result, folder / "results.zarr")
    rows, verdicts = list(summary_rows(result)), list(_verdict_rows(result))
    _write_rows(folder / "summary.csv", rows)
    if verdicts:
        _write_rows(folder / "verdicts.csv", [_flat(row) for row in verdicts])
    summary = {
        "provenance": provenance(result),
        "cells": rows,
        "verdicts": verdicts,
        "warnings": {
            method: [str(warning) for warning in found]
            for method, found in result.warnings().items()
        },
    }
    text = json.dumps(plain(summary), indent=1, allow_nan=False)
    (folder / "summary.json").write_text(text + "\n", encoding="utf-8")


def _write_rows(file: Path, rows: Sequence[Mapping[str, Any]]) -> None:
    write_csv(file, list(rows[0]), [list(row.values()) for row in rows])


def _flat(row: Mapping[str, Any]) -> dict[str, Any]:
    """Return a row whose lists are text, without what has no place in a table."""
    return {
        name: "; ".join(map(str, value)) if isinstance(value, list) else value
        for name, value in row.items()
        if not isinstance(value, dict)
    }


def summary_rows(result: StudyResult) -> Iterator[dict[str, Any]]:
    """Return one row a cell and point: percentiles in SI."""
    for key, cell in result.cells.items():
        for i, point in enumerate(result.study.points):
            row: dict[str, Any] = {
                "case": key.case,
                "road": key.road,
                "method": key.method,
                "point": point,
                "runs": len(cell.peak_acceleration),
            }
            for name, unit, values in (
                ("peak_acceleration", "m_s2", cell.peak_acceleration[:, i]),
                ("rms_velocity", "m_s", cell.rms_velocity[:, i]),
            ):
                for share in (5, 50, 95):
                    row[f"{name}_p{share:02d}_{unit}"] = float(np.percentile(values, share))
                low, high = percentile_interval(values, 95.0)
                row[f"{name}_p95_low_{unit}"], row[f"{name}_p95_high_{unit}"] = low, high
            row |= _exact_columns(cell, i) | _truncation_columns(cell, i)
            yield row


def _exact_columns(cell: Cell, point: int) -> dict[str, float]:
    """Return the exact statistics of a cell at a point; not-a-number without any."""
    exact, peaks = cell.exact, cell.exact_peaks
    return {
        "exact_rms_velocity_m_s": np.nan if exact is None else float(exact.rms()[point]),
        "exact_rms_acceleration_m_s2": (
            np.nan if exact is None else float(exact.rms("acceleration")[point])
        ),
        "exact_peak_acceleration_p50_m_s2": (np.nan if peaks is None else float(peaks[0, point])),
        "exact_peak_acceleration_p95_m_s2": (np.nan if peaks is None else float(peaks[1, point])),
        "exact_quadrature_error": np.nan if exact is None else exact.quadrature_error,
    }


def _truncation_columns(cell: Cell, point: int) -> dict[str, float]:
    """Return what the highest octave of modes changes; not-a-number without modes."""
    change = cell.truncation
    return {
        "truncation_change_velocity": np.nan if change is None else float(change.velocity[point]),
        "truncation_change_acceleration": (
            np.nan if change is None else float(change.acceleration[point])
        ),
    }


def _verdict_rows(result: StudyResult) -> Iterator[dict[str, Any]]:
    for key, verdicts in result.verdicts.items():
        for verdict in verdicts:
            yield {
                "case": key.case,
                "road": key.road,
                "method": key.method,
                "point": verdict.point,
                "criterion": verdict.criterion.name,
                "verdict": verdict.status,
                "percentile": verdict.percentile,
                "averaging": verdict.averaging,
                "axis": verdict.axis,
                "margin": verdict.margin,
                "margin_low": verdict.interval[0],
                "margin_high": verdict.interval[1],
                "governing_band_hz": verdict.governing_band,
                "value_si": verdict.value,
                "limit_si": verdict.limit,
                "share_exceeding": verdict.share_exceeding,
                "time_s": verdict.time,
                "front_axles_m": positions_at(result, key, verdict.time),
                "unresolved_bands_hz": list(verdict.unresolved),
                "unexcited_bands_hz": list(verdict.unexcited),
                "reasons": list(verdict.reasons) if verdict.status == "not assessed" else [],
            }


def _write_zarr(result: StudyResult, path: Path) -> None:
    attributes = {**plain(provenance(result)), "study_text": result.study.text}
    attributes["methods"] = json.dumps(attributes["methods"])
    groups = result_groups(result)
    groups["/"] = groups["/"].assign_attrs(attributes)
    # Format 2: fixed-length text and consolidated metadata are part of its specification.
    xr.DataTree.from_dict(groups).to_zarr(path, mode="w", consolidated=True, zarr_format=2)

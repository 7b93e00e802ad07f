"""Write results aside and put them in place in one step."""

from __future__ import annotations

import csv
import json
import os
import platform
import shutil
import signal
import tempfile
import threading
from collections.abc import Callable, Generator, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
import xarray as xr

from trundle import __version__
from trundle.errors import InputError
from trundle.response import ExactStatistics, percentile_interval
from trundle.study.cells import Cell, CellKey
from trundle.study.run import StudyResult

__all__ = ["check_target", "new_results_folder", "provenance", "uninterrupted", "write_results"]

Variable: TypeAlias = tuple[tuple[str, ...], np.ndarray, dict[str, Any]]
"""Dimensions, data and attributes, as xarray takes them."""

_METHOD = "method_name"  # xarray's own selections have an argument called method
_MARK = ".trundle-results"
_OURS = {
    _MARK,
    "figures",
    "report.html",
    "results.zarr",
    "study.toml",
    "summary.csv",
    "summary.json",
}


def check_target(folder: Path) -> None:
    """Refuse a results folder that cannot be written, before any work starts.

    Raises
    ------
    InputError
        A file in its place, a folder that holds something else, or no permission.
    """
    try:
        _check_place(folder)
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


def _check_place(folder: Path) -> None:
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
    foreign = {entry.name for entry in folder.iterdir()} - _OURS
    if foreign or (any(folder.iterdir()) and not (folder / _MARK).is_file()):
        raise InputError(
            f"results folder {folder} holds files that trundle did not write"
            + (f" ({', '.join(sorted(foreign)[:3])})" if foreign else "")
            + "; choose another with --out, or empty it"
        )


def _nearest_folder(folder: Path) -> Path:
    parent = folder.absolute().parent
    while not parent.exists() and parent != parent.parent:
        parent = parent.parent
    return parent


@contextmanager
def new_results_folder(folder: Path, *, within: Path | None = None) -> Generator[Path]:
    """Give a folder to fill; it takes its place only when all went well.

    It is filled beside its place, or `within` a folder of the same file system.

    An earlier result of that name is replaced at the end; after an error or an interrupt it
    still stands, and the half-filled folder is gone.
    """
    folder = folder.absolute()
    made = [parent for parent in folder.parents if not parent.exists()]
    folder.parent.mkdir(parents=True, exist_ok=True)
    aside = Path(tempfile.mkdtemp(dir=within or folder.parent, prefix=".trundle-"))
    try:
        aside.chmod(0o755)
        yield aside
        with uninterrupted():
            _swap(aside, folder)
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


def _swap(new: Path, place: Path) -> None:
    if not place.exists():
        os.rename(new, place)
        return
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
    rows = list(summary_rows(result))
    with (folder / "summary.csv").open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, fieldnames=list(rows[0]))
        writer.writeheader()
        writer.writerows(rows)
    summary = {
        "provenance": provenance(result),
        "cells": rows,
        "verdicts": list(_verdict_rows(result)),
        "warnings": {
            method: [str(warning) for warning in found]
            for method, found in result.warnings().items()
        },
    }
    text = json.dumps(_plain(summary), indent=1, allow_nan=False)
    (folder / "summary.json").write_text(text + "\n", encoding="utf-8")
    (folder / _MARK).write_text("A later run of trundle may replace this folder.\n")


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
                "margin": verdict.margin,
                "governing_band_hz": verdict.governing_band,
                "value_si": verdict.value,
                "limit_si": verdict.limit,
                "share_exceeding": verdict.share_exceeding,
                "unresolved_bands_hz": list(verdict.unresolved),
            }


def _plain(value: Any) -> Any:
    """Turn not-a-number into null, which JSON has."""
    if isinstance(value, dict):
        return {key: _plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(item) for item in value]
    if isinstance(value, float) and not np.isfinite(value):
        return None
    return value


def _write_zarr(result: StudyResult, path: Path) -> None:
    study = result.study
    attributes = {**_plain(provenance(result)), "study_text": study.text}
    attributes["methods"] = json.dumps(attributes["methods"])
    groups: dict[str, xr.Dataset] = {"/": _summary_dataset(result).assign_attrs(attributes)}
    for method in study.methods:
        groups[f"/histories/{method.name}"] = _history_dataset(result, method.name)
    for case in study.cases:
        groups[f"/contacts/{case.name}"] = _contact_dataset(result, case.name)
        for method in study.methods:
            groups[f"/contacts/{case.name}/{method.name}"] = _force_dataset(
                result, case.name, method.name
            )
    # Format 2: fixed-length text and consolidated metadata are part of its specification.
    xr.DataTree.from_dict(groups).to_zarr(path, mode="w", consolidated=True, zarr_format=2)


def _grid(result: StudyResult) -> tuple[list[str], list[str], list[str]]:
    study = result.study
    return (
        [case.name for case in study.cases],
        list(study.roads),
        [method.name for method in study.methods],
    )


def _stack(result: StudyResult, pick: Callable[[Cell], np.ndarray]) -> np.ndarray:
    cases, roads, methods = _grid(result)
    return np.stack(
        [
            np.stack(
                [np.stack([pick(result.cells[CellKey(c, r, m)]) for m in methods]) for r in roads]
            )
            for c in cases
        ]
    )


def _summary_dataset(result: StudyResult) -> xr.Dataset:
    cases, roads, methods = _grid(result)
    cell = ("case", "road", _METHOD, "run", "point")
    first = next(iter(result.cells.values()))
    first_bands = len(first.spectra.mid_band)

    def variable(
        dims: tuple[str, ...],
        pick: Callable[[Cell], np.ndarray],
        units: str,
        long_name: str,
    ) -> Variable:
        return (dims, _stack(result, pick), {"units": units, "long_name": long_name})

    return xr.Dataset(
        {
            "peak_acceleration": variable(
                cell, lambda c: c.peak_acceleration, "m/s2", "largest absolute acceleration"
            ),
            "rms_velocity": variable(
                cell, lambda c: c.rms_velocity, "m/s", "RMS velocity over the record"
            ),
            "band_velocity": variable(
                (*cell, "band"),
                lambda c: c.spectra.values,
                "m/s",
                f"one-third-octave RMS velocity, {first.spectra.averaging}",
            ),
            "exact_rms_velocity": variable(
                (*cell[:3], "point"),
                lambda c: _exact(c, lambda e: e.rms(), len(result.study.points)),
                "m/s",
                "root of the mean square velocity over record and all roads, without sampling",
            ),
            "exact_band_velocity": variable(
                (*cell[:3], "point", "band"),
                lambda c: _exact(
                    c, lambda e: e.band_event(), (len(result.study.points), first_bands)
                ),
                "m/s",
                "one-third-octave RMS velocity, whole event, over all roads, without sampling",
            ),
        },
        coords={
            "case": cases,
            "road": roads,
            _METHOD: methods,
            "run": np.arange(result.study.runs),
            "point": list(result.study.points),
            "band": ("band", first.spectra.mid_band, {"units": "Hz"}),
            "point_x": ("point", [p[0] for p in result.study.points.values()], {"units": "m"}),
            "point_y": ("point", [p[1] for p in result.study.points.values()], {"units": "m"}),
        },
    )


def _exact(
    cell: Cell, pick: Callable[[ExactStatistics], np.ndarray], shape: int | tuple[int, int]
) -> np.ndarray:
    return np.full(shape, np.nan) if cell.exact is None else pick(cell.exact)


def _history_dataset(result: StudyResult, method: str) -> xr.Dataset:
    cases, roads, _ = _grid(result)

    def variable(name: str, units: str) -> Variable:
        data = np.stack(
            [
                np.stack(
                    [getattr(result.cells[CellKey(c, r, method)].history, name) for r in roads]
                )
                for c in cases
            ]
        )
        return (("case", "road", "time", "point"), data, {"units": units, "run": 0})

    time = result.cells[CellKey(cases[0], roads[0], method)].history.time
    return xr.Dataset(
        {
            "displacement": variable("displacement", "m"),
            "velocity": variable("velocity", "m/s"),
            "acceleration": variable("acceleration", "m/s2"),
        },
        coords={
            "case": cases,
            "road": roads,
            "time": ("time", time, {"units": "s"}),
            "point": list(result.study.points),
        },
    )


def _contact_dataset(result: StudyResult, case: str) -> xr.Dataset:
    _, roads, methods = _grid(result)

    def cell(road: str, method: str) -> Cell:
        return result.cells[CellKey(case, road, method)]

    peaks = np.stack([np.stack([cell(r, m).peak_contact_force for m in methods]) for r in roads])
    return xr.Dataset(
        {
            "peak_contact_force": (
                ("road", _METHOD, "run", "contact"),
                peaks,
                {"units": "N", "long_name": "largest contact force, static load included"},
            )
        },
        coords={
            "road": roads,
            _METHOD: methods,
            "run": np.arange(result.study.runs),
            "contact": list(cell(roads[0], methods[0]).contact_names),
        },
    )


def _force_dataset(result: StudyResult, case: str, method: str) -> xr.Dataset:
    _, roads, _ = _grid(result)
    cells = [result.cells[CellKey(case, road, method)] for road in roads]
    forces = np.stack([cell.history.contact_forces for cell in cells])
    attributes = {"units": "N", "run": 0, "long_name": "contact force, positive when pressing"}
    return xr.Dataset(
        {"contact_force": (("road", "time", "contact"), forces, attributes)},
        coords={
            "road": roads,
            "time": ("time", cells[0].history.time, {"units": "s"}),
            "contact": list(cells[0].contact_names),
        },
    )

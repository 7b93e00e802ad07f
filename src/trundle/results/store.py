"""Write what a study gave into a folder: arrays, tables, and where they come from."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from trundle._csv import write_csv
from trundle._json import plain
from trundle.response import percentile_interval, tabled
from trundle.results.cells import Cell
from trundle.results.datasets import result_groups
from trundle.results.day_tables import day_table, dose_table, hour_table, together_table
from trundle.results.folder import keep_result
from trundle.results.results_folder import uninterrupted
from trundle.results.study_result import StudyResult, positions_at

__all__ = ["csv_rows", "write_results"]


def write_results(result: StudyResult, folder: Path) -> None:
    """Write `results.zarr`, `summary.json`, `summary.csv`, and what `read_result` reads back."""
    keep_result(result, folder)
    with uninterrupted():
        _write_zarr(result, folder / "results.zarr")
    rows, verdicts = list(csv_rows(result)), list(_verdict_rows(result))
    _write_rows(folder / "summary.csv", rows)
    more = {
        "verdicts": verdicts,
        "together": list(together_table(result)),
        "days": list(day_table(result)),
        "day_hours": list(hour_table(result)),
        "day_doses": list(dose_table(result)),
    }
    for name, some in more.items():
        if some:
            _write_rows(folder / f"{name}.csv", [_flat(row) for row in some])
    summary = {
        "provenance": dict(result.provenance),
        "cells": rows,
        **more,
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


def csv_rows(result: StudyResult) -> Iterator[dict[str, Any]]:
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
            for quantity in tabled():
                name, values = quantity.name, cell.reduced.numbers[quantity.name][:, i]
                unit = quantity.units.replace("/", "_")
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
    attributes = {**plain(dict(result.provenance)), "study_text": result.study.text}
    attributes["methods"] = json.dumps(attributes["methods"])
    groups = result_groups(result)
    groups["/"] = groups["/"].assign_attrs(attributes)
    # Format 2: fixed-length text and consolidated metadata are part of its specification.
    xr.DataTree.from_dict(groups).to_zarr(path, mode="w", consolidated=True, zarr_format=2)

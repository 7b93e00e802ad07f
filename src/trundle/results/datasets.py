"""Arrange a study's results as labelled datasets with units."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeAlias

import numpy as np
import xarray as xr

from trundle.response import QUANTITIES, ExactStatistics
from trundle.results.cells import Cell, CellKey
from trundle.results.map_datasets import map_groups
from trundle.results.study_result import StudyResult

__all__ = ["result_groups"]

Variable: TypeAlias = tuple[tuple[str, ...], np.ndarray, dict[str, Any]]
"""Dimensions, data and attributes, as xarray takes them."""

_METHOD = "method_name"  # xarray's own selections have an argument called method


def result_groups(result: StudyResult) -> dict[str, xr.Dataset]:
    """Return the datasets of a result by the path of their group."""
    study = result.study
    groups: dict[str, xr.Dataset] = {"/": _summary_dataset(result)}
    for method in study.methods:
        groups[f"/histories/{method.name}"] = _history_dataset(result, method.name)
    for case in study.cases:
        groups[f"/contacts/{case.name}"] = _contact_dataset(result, case.name)
        for method in study.methods:
            groups[f"/contacts/{case.name}/{method.name}"] = _force_dataset(
                result, case.name, method.name
            )
    return groups | map_groups(result)


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
            **{
                q.name: variable(
                    cell, lambda c, name=q.name: c.reduced.numbers[name], q.units, q.long_name
                )
                for q in QUANTITIES
                if q.stored and q.per == "point"
            },
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
            "point_x": ("point", [spot.x for spot in result.study.points.values()], {"units": "m"}),
            "point_y": ("point", [spot.y for spot in result.study.points.values()], {"units": "m"}),
        },
    )


def _exact(
    cell: Cell, pick: Callable[[ExactStatistics], np.ndarray], shape: int | tuple[int, int]
) -> np.ndarray:
    return np.full(shape, np.nan) if cell.exact is None else pick(cell.exact)


def _history_dataset(result: StudyResult, method: str) -> xr.Dataset:
    """Return the first runs of a method; behind the end of a shorter record stands no number."""
    cases, roads, _ = _grid(result)
    histories = [[result.cells[CellKey(c, r, method)].history for r in roads] for c in cases]
    time = max((row[0].time for row in histories), key=len)

    def variable(name: str, units: str) -> Variable:
        data = np.full((len(cases), len(roads), len(time), len(result.study.points)), np.nan)
        for i, row in enumerate(histories):
            for j, history in enumerate(row):
                values = getattr(history, name)
                data[i, j, : len(values)] = values
        return (("case", "road", "time", "point"), data, {"units": units, "run": 0})

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

    return xr.Dataset(
        {
            q.name: (
                ("road", _METHOD, "run", "contact"),
                np.stack(
                    [np.stack([cell(r, m).reduced.numbers[q.name] for m in methods]) for r in roads]
                ),
                {"units": q.units, "long_name": q.long_name},
            )
            for q in QUANTITIES
            if q.stored and q.per == "contact"
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

"""Arrange a study's results as labelled datasets with units."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeAlias

import numpy as np
import xarray as xr

from trundle.response import ExactStatistics
from trundle.study.cells import Cell, CellKey
from trundle.study.run import StudyResult

__all__ = ["plain", "result_groups"]

Variable: TypeAlias = tuple[tuple[str, ...], np.ndarray, dict[str, Any]]
"""Dimensions, data and attributes, as xarray takes them."""

_METHOD = "method_name"  # xarray's own selections have an argument called method


def plain(value: Any) -> Any:
    """Turn not-a-number into null, which JSON has."""
    if isinstance(value, dict):
        return {key: plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    if isinstance(value, float) and not np.isfinite(value):
        return None
    return value


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
        if any(key.case == case.name for key in result.maps):
            groups[f"/maps/{case.name}"] = _map_dataset(result, case.name)
    return groups


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


def _map_dataset(result: StudyResult, case: str) -> xr.Dataset:
    """Return the maps of a case on every road, on the grid of its places."""
    study = result.study
    plan, assessment = study.map, study.assessment
    assert plan is not None  # there are maps
    assert assessment is not None  # a map is held against criteria
    roads = list(study.roads)
    maps = [result.maps[CellKey(case, road, assessment.method)] for road in roads]
    classes = maps[0].classes
    grid = (len(plan.y), len(plan.x))

    def by_place(values: list[np.ndarray], units: str, long_name: str) -> Variable:
        data = np.stack(values).reshape(len(roads), *grid)
        return (("road", "y", "x"), data, {"units": units, "long_name": long_name})

    def by_criterion(name: str, units: str, long_name: str) -> Variable:
        data = np.stack([getattr(one.classes, name) for one in maps])
        shape = (len(roads), len(classes.criteria), *grid)
        attributes = {"units": units, "long_name": long_name}
        return (("road", "criterion", "y", "x"), data.reshape(shape), attributes)

    share = f"that {plan.percentile:g} % of {plan.runs} runs stay below"
    return xr.Dataset(
        {
            "margin": by_criterion("margin", "1", "smallest limit over level"),
            "share_exceeding": by_criterion("share_exceeding", "1", "share of runs above it"),
            "governing_band": by_criterion("governing_band", "Hz", "band of the smallest margin"),
            "class_index": by_place(
                [one.classes.classes().astype(float) for one in maps], "1",
                "strictest velocity criterion passed, -1 for none",
            ),
            "rms_velocity": by_place(
                [one.rms_velocity for one in maps], "m/s", f"record RMS velocity {share}"
            ),
            "peak_acceleration": by_place(
                [one.peak_acceleration for one in maps], "m/s2", f"peak acceleration {share}"
            ),
        },
        coords={
            "road": roads,
            "criterion": [criterion.name for criterion in classes.criteria],
            "x": ("x", plan.x, {"units": "m"}),
            "y": ("y", plan.y, {"units": "m"}),
        },
    )  # fmt: skip

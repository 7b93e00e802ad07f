"""Arrange a study's maps as labelled datasets with units."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, TypeAlias

import numpy as np
import xarray as xr

from trundle.criteria import ClassMap, envelope_of
from trundle.response.quantities import mapped
from trundle.results.maps import MapKey, StudyMap
from trundle.results.study_result import StudyResult
from trundle.study.map_plan import MapGrid, MapPlan

__all__ = ["known_forces", "map_groups", "single_maps"]

Variable: TypeAlias = tuple[tuple[str, ...], np.ndarray, dict[str, Any]]
"""Dimensions, data and attributes, as xarray takes them."""

_BY_CRITERION = {
    "margin": ("1", "smallest limit over level"),
    "share_exceeding": ("1", "share of runs above it"),
    "governing_band": ("Hz", "band of the smallest margin"),
}


def map_groups(result: StudyResult) -> dict[str, xr.Dataset]:
    """Return the datasets of maps by the path of their group.

    ``/maps/CASE`` at the study's speeds, ``/map_speeds/CASE`` at those that the map names, and
    ``/map_envelope``, the worst of all single vehicles' maps; where several surfaces are mapped,
    each ends with the name of its surface, and maps of level motion with ``along x`` or ``y``.
    """
    plan = result.study.map
    if plan is None or not result.maps:
        return {}
    groups: dict[str, xr.Dataset] = {}
    for grid, part in plan.parts():
        parts = (grid.on, None if grid.axis == "z" else f"along {grid.axis}")
        on = "".join(f"/{part}" for part in parts if part) if len(plan.grids) > 1 else ""
        of_grid = {key: one.part(part) for key, one in result.maps.items()}
        for path, dataset in _groups_of(result, plan, grid, of_grid).items():
            dataset.attrs["motion"] = "vertical" if grid.axis == "z" else f"along {grid.axis}"
            if grid.on is not None:
                dataset.attrs["surface"] = grid.on
            groups[path + on] = dataset
    return groups


def _groups_of(
    result: StudyResult, plan: MapPlan, grid: MapGrid, maps: Mapping[MapKey, StudyMap]
) -> dict[str, xr.Dataset]:
    """Return the datasets of the maps of one surface."""
    groups: dict[str, xr.Dataset] = {}
    laid, roads = (plan, grid), list(result.study.roads)
    for case in result.study.cases:
        if MapKey(case.name, roads[0]) not in maps:
            continue
        own = [maps[MapKey(case.name, road)] for road in roads]
        groups[f"/maps/{case.name}"] = _dataset(laid, own, {"road": roads})
        if plan.speeds:
            keys = [MapKey(case.name, road, v) for v in plan.speeds for road in roads]
            dataset = _dataset(
                laid, [maps[key] for key in keys], {"speed": plan.speeds, "road": roads}
            )
            dataset["speed"].attrs["units"] = "m/s"
            groups[f"/map_speeds/{case.name}"] = dataset
    single = {key: maps[key] for key in single_maps(result)}
    if single:
        known = known_forces(result, single)
        groups["/map_envelope"] = _envelope(grid, list(single.values()), known)
    return groups


def single_maps(result: StudyResult) -> dict[MapKey, StudyMap]:
    """Return the maps of single vehicles, at all speeds."""
    alone = {case.name for case in result.study.cases if len(case.routes) == 1}
    return {key: one for key, one in result.maps.items() if key.case in alone}


def known_forces(result: StudyResult, keys: Iterable[MapKey]) -> list[bool]:
    """Return which maps are of sources whose forces are known altogether."""
    sources = result.study.sources
    return [key.case in sources and sources[key.case].complete for key in keys]


def _dataset(
    laid: tuple[MapPlan, MapGrid], maps: Sequence[StudyMap], ways: dict[str, Sequence[Any]]
) -> xr.Dataset:
    """Return maps on their grid, along the ways in which they differ."""
    plan, grid = laid
    share = f"that {plan.percentile:g} % of {plan.runs} runs stay below"

    classes = [one.classes for one in maps]
    dataset = _of_classes(grid, classes, ways)
    for quantity, _ in mapped():
        dataset[quantity.name] = _variable(
            grid,
            ways,
            lambda i, name=quantity.name: maps[i].numbers[name],
            quantity.units,
            f"{quantity.heading or quantity.long_name} {share}",
        )
    return dataset


def _envelope(grid: MapGrid, maps: Sequence[StudyMap], known: Sequence[bool]) -> xr.Dataset:
    """Return the worst of maps at every place."""
    dataset = _of_classes(grid, [envelope_of([one.classes for one in maps], known)], {})
    dataset.attrs["description"] = f"worst of {len(maps)} maps of single vehicles at every place"
    return dataset


def _of_classes(
    grid: MapGrid, classes: Sequence[ClassMap], ways: dict[str, Sequence[Any]]
) -> xr.Dataset:
    names = [criterion.name for criterion in classes[0].criteria]
    return xr.Dataset(
        {
            **{
                name: _variable(
                    grid,
                    {**ways, "criterion": names},
                    lambda i, name=name: getattr(classes[i], name),
                    units,
                    long_name,
                )
                for name, (units, long_name) in _BY_CRITERION.items()
            },
            "class_index": _variable(
                grid,
                ways,
                lambda i: classes[i].classes().astype(float),
                "1",
                "strictest velocity criterion passed, -1 for none met, -2 for not assessed",
            ),
        },
        coords={
            **{name: list(values) for name, values in ways.items()},
            "criterion": names,
            "x": ("x", grid.x, {"units": "m"}),
            "y": ("y", grid.y, {"units": "m"}),
        },
    )


def _variable(
    grid: MapGrid,
    ways: dict[str, Sequence[Any]],
    pick: Callable[[int], np.ndarray],
    units: str,
    long_name: str,
) -> Variable:
    """Return what is picked of every map in order, the grid last."""
    outer = [len(values) for name, values in ways.items() if name != "criterion"]
    data = np.stack([pick(i) for i in range(int(np.prod(outer)))])
    out = np.full((*data.shape[:-1], *grid.there.shape), np.nan)
    out[..., grid.there] = data
    shape = (*(len(values) for values in ways.values()), *grid.there.shape)
    return ((*ways, "y", "x"), out.reshape(shape), {"units": units, "long_name": long_name})

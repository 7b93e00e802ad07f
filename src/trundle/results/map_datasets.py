"""Arrange a study's maps as labelled datasets with units."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, TypeAlias

import numpy as np
import xarray as xr

from trundle.criteria import ClassMap, envelope_of
from trundle.response.quantities import mapped
from trundle.results.maps import MapKey, StudyMap
from trundle.results.study_result import StudyResult
from trundle.study.map_plan import MapPlan

__all__ = ["map_groups", "single_maps"]

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
    ``/map_envelope``, the worst of all single vehicles' maps.
    """
    study, plan = result.study, result.study.map
    if plan is None or not result.maps:
        return {}
    groups: dict[str, xr.Dataset] = {}
    roads = list(study.roads)
    for case in study.cases:
        if MapKey(case.name, roads[0]) not in result.maps:
            continue
        own = [result.maps[MapKey(case.name, road)] for road in roads]
        groups[f"/maps/{case.name}"] = _dataset(plan, own, {"road": roads})
        if plan.speeds:
            keys = [MapKey(case.name, road, v) for v in plan.speeds for road in roads]
            dataset = _dataset(
                plan, [result.maps[key] for key in keys], {"speed": plan.speeds, "road": roads}
            )
            dataset["speed"].attrs["units"] = "m/s"
            groups[f"/map_speeds/{case.name}"] = dataset
    single = list(single_maps(result).values())
    if single:
        groups["/map_envelope"] = _envelope(plan, single)
    return groups


def single_maps(result: StudyResult) -> dict[MapKey, StudyMap]:
    """Return the maps of single vehicles, at all speeds."""
    alone = {case.name for case in result.study.cases if len(case.routes) == 1}
    return {key: one for key, one in result.maps.items() if key.case in alone}


def _dataset(plan: MapPlan, maps: Sequence[StudyMap], ways: dict[str, Sequence[Any]]) -> xr.Dataset:
    """Return maps on their grid, along the ways in which they differ."""
    share = f"that {plan.percentile:g} % of {plan.runs} runs stay below"

    classes = [one.classes for one in maps]
    dataset = _of_classes(plan, classes, ways)
    for quantity, _ in mapped():
        dataset[quantity.name] = _variable(
            plan,
            ways,
            lambda i, name=quantity.name: maps[i].numbers[name],
            quantity.units,
            f"{quantity.heading} {share}",
        )
    return dataset


def _envelope(plan: MapPlan, maps: Sequence[StudyMap]) -> xr.Dataset:
    """Return the worst of maps at every place."""
    dataset = _of_classes(plan, [envelope_of([one.classes for one in maps])], {})
    dataset.attrs["description"] = f"worst of {len(maps)} maps of single vehicles at every place"
    return dataset


def _of_classes(
    plan: MapPlan, classes: Sequence[ClassMap], ways: dict[str, Sequence[Any]]
) -> xr.Dataset:
    names = [criterion.name for criterion in classes[0].criteria]
    return xr.Dataset(
        {
            **{
                name: _variable(
                    plan,
                    {**ways, "criterion": names},
                    lambda i, name=name: getattr(classes[i], name),
                    units,
                    long_name,
                )
                for name, (units, long_name) in _BY_CRITERION.items()
            },
            "class_index": _variable(
                plan,
                ways,
                lambda i: classes[i].classes().astype(float),
                "1",
                "strictest velocity criterion passed, -1 for none met, -2 for not assessed",
            ),
        },
        coords={
            **{name: list(values) for name, values in ways.items()},
            "criterion": names,
            "x": ("x", plan.x, {"units": "m"}),
            "y": ("y", plan.y, {"units": "m"}),
        },
    )


def _variable(
    plan: MapPlan,
    ways: dict[str, Sequence[Any]],
    pick: Callable[[int], np.ndarray],
    units: str,
    long_name: str,
) -> Variable:
    """Return what is picked of every map in order, the grid last."""
    outer = [len(values) for name, values in ways.items() if name != "criterion"]
    data = np.stack([pick(i) for i in range(int(np.prod(outer)))])
    shape = (*(len(values) for values in ways.values()), len(plan.y), len(plan.x))
    return ((*ways, "y", "x"), data.reshape(shape), {"units": units, "long_name": long_name})

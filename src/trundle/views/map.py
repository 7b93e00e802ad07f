"""Arrange maps for figures and for the interactive page: views, names and colours."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from jaxtyping import Int

from trundle._typing import Array
from trundle.criteria import ClassMap, envelope_of
from trundle.response.quantities import mapped
from trundle.results.map_datasets import single_maps
from trundle.results.maps import StudyMap
from trundle.results.study_result import StudyResult
from trundle.signals import nominal_frequency
from trundle.units import KMH
from trundle.views.words import shown

__all__ = ["MapView", "class_names", "class_ranks", "map_payload", "map_views"]


@dataclass(frozen=True, kw_only=True, eq=False)
class MapView:
    """Hold one map to look at: of a case on a road, or the worst of several.

    Attributes
    ----------
    title : str
        What it is of.
    classes : ClassMap
        Margins, exceedance and classes.
    routes : tuple of str
        Names of the routes driven.
    numbers : mapping of str to ndarray, shape (n_places,)
        Levels that the share of runs stays below [m/s], [m/s2]; peaks NaN if not asked for.
    printed : bool
        Whether it is drawn among the pictures; at other speeds only the worst is.
    """

    title: str
    classes: ClassMap
    routes: tuple[str, ...]
    numbers: Mapping[str, Array]
    printed: bool


def map_views(result: StudyResult) -> list[MapView]:
    """Return the map of every case, road and speed, and last the worst of all single vehicles'.

    At speeds other than the study's, the worst of all single vehicles' maps follows those of each.
    """
    plan = result.study.map
    if plan is None or not result.maps:
        return []
    drives = result.study.drives
    driven = {
        case.name: tuple(name for name in case.routes if name in drives)
        for case in result.study.cases
    }
    single = single_maps(result)
    views: list[MapView] = []
    for speed in (None, *plan.speeds):
        at = "" if speed is None else f" at {speed / KMH:.3g} km/h"
        views += [
            MapView(
                title=f"{key.case}, class {key.road}{at}",
                classes=one.classes,
                routes=driven[key.case],
                numbers=one.numbers,
                printed=speed is None,
            )
            for key, one in result.maps.items()
            if key.speed == speed
        ]
        here = [one for key, one in single.items() if key.speed == speed]
        if speed is not None and here:
            views.append(_worst(result, here, f"worst{at}"))
    if len(single) > 1:
        views.append(_worst(result, list(single.values()), "worst of all single routes"))
    return views


def _worst(result: StudyResult, maps: list[StudyMap], title: str) -> MapView:
    return MapView(
        title=title,
        classes=envelope_of([one.classes for one in maps]),
        routes=tuple(result.study.drives),
        numbers={
            name: np.max([one.numbers[name] for one in maps], axis=0) for name in maps[0].numbers
        },
        printed=True,
    )


def class_names(classes: ClassMap) -> list[str]:
    """Return what each rank of `class_ranks` is called."""
    return ["not assessed", "none", *(classes.criteria[i].title for i in classes.order())]


def class_ranks(classes: ClassMap) -> Int[Array, " places"]:
    """Return 0 where nothing is assessed, 1 for none, then criteria from the widest on."""
    order = {-2: 0, -1: 1, **{index: rank + 2 for rank, index in enumerate(classes.order())}}
    return np.array([order[int(k)] for k in classes.classes()])


def map_payload(result: StudyResult) -> dict[str, Any]:
    """Return what the interactive map shows, as plain lists; empty without maps."""
    plan = result.study.map
    if plan is None or not result.maps:
        return {}
    views = map_views(result)
    shape = (len(plan.y), len(plan.x))
    return {
        "x": _short(plan.x),
        "y": _short(plan.y),
        "names": class_names(views[0].classes),
        "criterion": plan.criterion,
        "levels": [[how.word, shown(quantity.units)[0]] for quantity, how in mapped()],
        "views": [_view(result, view, shape) for view in views],
        "routes": [
            {"name": name, "x": _short(d.route.points[:, 0]), "y": _short(d.route.points[:, 1])}
            for name, d in result.study.drives.items()
        ],
        "points": [
            {"name": name, "x": spot.x, "y": spot.y} for name, spot in result.study.points.items()
        ],
    }


def _view(result: StudyResult, view: MapView, shape: tuple[int, int]) -> dict[str, Any]:
    plan = result.study.map
    assert plan is not None  # the caller has looked
    classes = view.classes
    i = classes.index(plan.criterion)
    ranks = class_ranks(classes)
    return {
        "title": view.title,
        "routes": list(view.routes),
        "ranks": ranks.reshape(shape).tolist(),
        "readings": [
            _readings(values, shape)
            for values in (
                classes.margin[i],
                _named(classes.governing_band[i]),
                100.0 * classes.share_exceeding[i],
                *(view.numbers[q.name] / shown(q.units)[1] for q, _ in mapped()),
            )
        ],
    }


def _readings(values: np.ndarray, shape: tuple[int, int]) -> list[list[float | None]]:
    """Return three digits of every value by row; nothing for what is not a number."""
    short = [float(f"{v:.3g}") if np.isfinite(v) else None for v in values]
    return [short[start : start + shape[1]] for start in range(0, len(short), shape[1])]


def _named(frequencies: np.ndarray) -> np.ndarray:
    """Return mid-band frequencies by their names."""
    return np.array([nominal_frequency(f) if np.isfinite(f) else np.nan for f in frequencies])


def _short(values: np.ndarray) -> list[float]:
    return [float(f"{v:.6g}") for v in values]

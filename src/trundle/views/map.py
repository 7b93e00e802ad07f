"""Arrange maps for figures and for the interactive page: views, names and colours."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from jaxtyping import Int

from trundle._typing import Array
from trundle.criteria import ClassMap, envelope_of
from trundle.response.quantities import mapped
from trundle.results.map_datasets import known_forces, single_maps
from trundle.results.maps import MapKey, StudyMap
from trundle.results.study_result import StudyResult
from trundle.signals import nominal_frequency
from trundle.study.map_plan import MapGrid, MapPlan
from trundle.units import KMH
from trundle.views.plan_lines import PlanLines, plan_lines
from trundle.views.words import shown

_MOST_READINGS = 400_000  # of a page: some 2 MB

__all__ = [
    "MapView",
    "class_limits_of",
    "class_names",
    "class_ranks",
    "map_payload",
    "map_views",
    "worst_place",
]


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
        Names of the routes driven, and of other sources.
    numbers : mapping of str to ndarray, shape (n_places,)
        Levels that the share of runs stays below [m/s], [m/s2]; peaks NaN if not asked for.
    printed : bool
        Whether it is drawn among the pictures; at other speeds only the worst is.
    grid : MapGrid
        Its places.
    """

    title: str
    classes: ClassMap
    routes: tuple[str, ...]
    numbers: Mapping[str, Array]
    printed: bool
    grid: MapGrid


def map_views(result: StudyResult) -> list[MapView]:
    """Return the map of every case, road and speed, and last the worst of all single vehicles'.

    At speeds other than the study's, the worst of all single vehicles' maps follows those of each.
    Where several surfaces are mapped, each has all of these.
    """
    plan = result.study.map
    if plan is None or not result.maps:
        return []
    return [view for grid, part in plan.parts() for view in _views_on(result, plan, grid, part)]


def _views_on(result: StudyResult, plan: MapPlan, grid: MapGrid, part: slice) -> list[MapView]:
    maps = {key: one.part(part) for key, one in result.maps.items()}
    on = f", {_label(grid)}" if len(plan.grids) > 1 else ""
    driven = {case.name: tuple(dict.fromkeys(case.routes)) for case in result.study.cases}
    single = {key: maps[key] for key in single_maps(result)}
    views: list[MapView] = []
    for speed in (None, *plan.speeds):
        at = "" if speed is None else f" at {speed / KMH:.3g} km/h"
        views += [
            MapView(
                title=f"{key.case}, class {key.road}{at}{on}",
                classes=one.classes,
                routes=driven[key.case],
                numbers=one.numbers,
                printed=speed is None,
                grid=grid,
            )
            for key, one in maps.items()
            if key.speed == speed
        ]
        here = {key: one for key, one in single.items() if key.speed == speed}
        if speed is not None and here:
            views.append(_worst(result, here, f"worst{at}{on}", grid))
    if len(single) > 1:
        words = f"worst of all single routes{on}"
        views.append(_worst(result, single, words, grid))
    return views


def _label(grid: MapGrid) -> str:
    """Say which of several maps of a study it is: its surface, and its axis."""
    return grid.label or "vertical"


def _worst(
    result: StudyResult, single: Mapping[MapKey, StudyMap], title: str, grid: MapGrid
) -> MapView:
    maps = list(single.values())
    return MapView(
        title=title,
        classes=envelope_of([one.classes for one in maps], known_forces(result, single)),
        routes=(*result.study.drives, *result.study.sources),
        numbers={
            name: np.max([one.numbers[name] for one in maps], axis=0) for name in maps[0].numbers
        },
        printed=True,
        grid=grid,
    )


def class_names(classes: ClassMap) -> list[str]:
    """Return what each rank of `class_ranks` is called."""
    return ["not assessed", "none", *(classes.criteria[i].title for i in classes.order())]


def class_limits_of(classes: ClassMap) -> list[float]:
    """Return the smallest limit of each criterion that is ranked, from the widest on [m/s]."""
    return [float(classes.criteria[i].limits.min()) for i in classes.order()]


def class_ranks(classes: ClassMap) -> Int[Array, " places"]:
    """Return 0 where nothing is assessed, 1 for none, then criteria from the widest on."""
    order = {-2: 0, -1: 1, **{index: rank + 2 for rank, index in enumerate(classes.order())}}
    return np.array([order[int(k)] for k in classes.classes()])


def map_payload(result: StudyResult) -> dict[str, Any]:
    """Return what the interactive map shows, as plain lists; empty without maps."""
    plan = result.study.map
    if plan is None or not result.maps:
        return {}
    views = _fitting(map_views(result))
    storeys = list(dict.fromkeys(view.grid.on for view in views))
    told = [_view(result, view) | {"plan": storeys.index(view.grid.on)} for view in views]
    with_points = [i for i, one in enumerate(told) if one["points"]]
    return {
        "chosen": with_points[-1] if with_points else len(told) - 1,
        "names": class_names(views[0].classes),
        "limits": class_limits_of(views[0].classes),
        "criterion": plan.criterion,
        "levels": [
            [how.word, shown(quantity.units, result.study.report)[0]] for quantity, how in mapped()
        ],
        "views": told,
        "plans": [_plan(plan_lines(result.study, on)) for on in storeys],
        "routes": [
            {"name": name, "x": _short(line[:, 0]), "y": _short(line[:, 1])}
            for name, line in _lines(result).items()
        ],
        "points": [
            {"name": name, "x": float(x), "y": float(y)} for name, (x, y) in _places(result).items()
        ],
    }


def _view(result: StudyResult, view: MapView) -> dict[str, Any]:
    study, plan = result.study, result.study.map
    assert plan is not None  # the caller has looked
    classes = view.classes
    i = classes.index(plan.criterion)
    ranks = class_ranks(classes)
    return {
        "title": view.title,
        "x": _short(view.grid.x),
        "y": _short(view.grid.y),
        "routes": _on(result, view.routes, view.grid.on),
        "points": [
            name
            for name, spot in study.points.items()
            if study.is_on(spot.on, view.grid.on) and spot.axis == view.grid.axis
        ],
        "ranks": [
            [None if np.isnan(r) else int(r) for r in row] for row in view.grid.filled(ranks)
        ],
        "fields": _fields(view),
        "complete": [bool(classes.complete[k]) for k in classes.order()],
        "worst": _worst_of(view, plan.criterion),
        "readings": [
            _readings(view.grid.filled(values))
            for values in (
                classes.margin[i],
                _named(classes.governing_band[i]),
                100.0 * classes.share_exceeding[i],
                *(view.numbers[q.name] / shown(q.units, study.report)[1] for q, _ in mapped()),
            )
        ],
    }


def _fitting(views: list[MapView]) -> list[MapView]:
    """Return as many of some views as a page can carry, the last of them, which is the worst."""
    kept: list[MapView] = []
    room = _MOST_READINGS
    for view in reversed(views):
        room -= view.grid.there.size * (len(view.classes.order()) + 3 + len(mapped()))
        if room < 0 and kept:
            break
        kept.append(view)
    return kept[::-1]


def _fields(view: MapView) -> list[list[list[int | None]]]:
    """Return 100 log10 of the margin to each class at every place, from the widest class on.

    Where the field of a class is not below 0 the class is met: what is drawn between places follows
    from their margins, not from the nearest place.
    """
    classes = view.classes
    found: list[list[list[int | None]]] = []
    for i in classes.order():
        grid = view.grid.filled(100.0 * np.log10(np.clip(classes.margin[i], 1e-4, 1e4)))
        # rounded down, no place comes into another class
        found.append([[None if np.isnan(v) else int(np.floor(v)) for v in row] for row in grid])
    return found


def worst_place(view: MapView, criterion: str) -> tuple[float, float, float] | None:
    """Return where the margin to a criterion is smallest [m], and how small; None if unknown."""
    margin = view.classes.margin[view.classes.index(criterion)]
    if np.isnan(margin).all():
        return None
    at = int(np.nanargmin(margin))
    x, y = view.grid.xy[at]
    return float(x), float(y), float(margin[at])


def _worst_of(view: MapView, criterion: str) -> dict[str, float] | None:
    """Return the worst place as the page takes it."""
    found = worst_place(view, criterion)
    if found is None:
        return None
    x, y, margin = found
    return {"x": float(f"{x:.6g}"), "y": float(f"{y:.6g}"), "margin": float(f"{margin:.3g}")}


def _plan(lines: PlanLines) -> dict[str, Any]:
    """Return the lines of a storey as plain lists."""
    return {
        **{
            name: [[_short(place) for place in line] for line in getattr(lines, name)]
            for name in ("rings", "beams", "walls", "columns")
        },
        "grid": [[one.name, one.axis, one.at] for one in lines.grid],
        "north": lines.north,
    }


def _lines(result: StudyResult) -> dict[str, Array]:
    """Return routes, and ways of other sources, in plan [m]."""
    study = result.study
    lines = {name: study.way_in_plan(drive.route) for name, drive in study.drives.items()}
    for name, source in study.sources.items():
        places = np.concatenate([place for place, _ in source.way()])
        lines[name] = study.in_plan(places[:: max(1, len(places) // 40)], source.on)
    return lines


def _places(result: StudyResult) -> dict[str, Array]:
    """Return points in plan [m]."""
    study = result.study
    return {
        name: study.in_plan(np.array([[spot.x, spot.y]]), spot.on)[0]
        for name, spot in study.points.items()
    }


def _on(result: StudyResult, routes: Sequence[str], on: str | None) -> list[str]:
    """Return the routes and other sources that lie on a surface."""
    study = result.study
    return [
        name
        for name in routes
        if (
            any(study.is_on(one, on) for one in study.drives[name].route.visited)
            if name in study.drives
            else study.is_on(study.sources[name].on, on)
        )
    ]


def _readings(rows: np.ndarray) -> list[list[float | None]]:
    """Return three digits of every value by row; nothing for what is not a number."""
    return [[float(f"{v:.3g}") if np.isfinite(v) else None for v in row] for row in rows]


def _named(frequencies: np.ndarray) -> np.ndarray:
    """Return mid-band frequencies by their names."""
    return np.array([nominal_frequency(f) if np.isfinite(f) else np.nan for f in frequencies])


def _short(values: np.ndarray) -> list[float]:
    return [float(f"{v:.6g}") for v in values]

"""Arrange maps for figures and for the interactive page: views, names and colours."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from jaxtyping import Float
from matplotlib import colormaps
from matplotlib.colors import to_hex

from trundle._typing import Array
from trundle.criteria import ClassMap, envelope_of
from trundle.study.run import StudyResult
from trundle.units import GAL, MICROMETRE_PER_SECOND

__all__ = ["MapView", "class_scale", "map_payload", "map_views"]


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
    rms_velocity, peak_acceleration : ndarray of float, shape (n_places,)
        Levels that the share of runs stays below [m/s], [m/s2]; peaks NaN if not asked for.
    """

    title: str
    classes: ClassMap
    routes: tuple[str, ...]
    rms_velocity: Float[Array, " places"]
    peak_acceleration: Float[Array, " places"]


def map_views(result: StudyResult) -> list[MapView]:
    """Return the map of every case and road, and last the worst of all single vehicles' cases."""
    driven = {case.name: case.routes for case in result.study.cases}
    views = [
        MapView(
            title=f"{key.case}, class {key.road}",
            classes=one.classes,
            routes=driven[key.case],
            rms_velocity=one.rms_velocity,
            peak_acceleration=one.peak_acceleration,
        )
        for key, one in result.maps.items()
    ]
    single = [view for view in views if len(view.routes) == 1]
    if len(single) > 1:
        views.append(
            MapView(
                title="worst of all single routes",
                classes=envelope_of([view.classes for view in single]),
                routes=tuple(result.study.drives),
                rms_velocity=np.max([view.rms_velocity for view in single], axis=0),
                peak_acceleration=np.max([view.peak_acceleration for view in single], axis=0),
            )
        )
    return views


def class_scale(classes: ClassMap) -> tuple[list[str], list[str]]:
    """Return names and colours from none to the strictest criterion; dark where little stands."""
    names = ["none", *(classes.criteria[i].title for i in classes.order())]
    shades = colormaps["cividis"](np.linspace(0.0, 1.0, len(names)))
    return names, [to_hex(shade) for shade in shades]


def map_payload(result: StudyResult) -> dict[str, Any]:
    """Return what the interactive map shows, as plain lists; empty without maps."""
    plan = result.study.map
    if plan is None or not result.maps:
        return {}
    views = map_views(result)
    names, colours = class_scale(views[0].classes)
    shape = (len(plan.y), len(plan.x))
    return {
        "x": _short(plan.x),
        "y": _short(plan.y),
        "names": names,
        "colours": colours,
        "criterion": plan.criterion,
        "views": [_view(result, view, shape) for view in views],
        "routes": [
            {"name": name, "x": _short(d.route.points[:, 0]), "y": _short(d.route.points[:, 1])}
            for name, d in result.study.drives.items()
        ],
        "points": [
            {"name": name, "x": place[0], "y": place[1]}
            for name, place in result.study.points.items()
        ],
    }


def _view(result: StudyResult, view: MapView, shape: tuple[int, int]) -> dict[str, Any]:
    plan = result.study.map
    assert plan is not None  # the caller has looked
    classes = view.classes
    i = classes.index(plan.criterion)
    order = {-1: 0, **{index: rank + 1 for rank, index in enumerate(classes.order())}}
    ranks = np.array([order[int(k)] for k in classes.classes()])
    names, _ = class_scale(classes)
    texts = [
        f"{names[rank]}<br>margin to {plan.criterion} {margin:.2f}"
        + (f" at {band:.3g} Hz" if np.isfinite(band) else "")
        + f"<br>{100 * share:.0f} % of the runs above it"
        + f"<br>record RMS {rms / MICROMETRE_PER_SECOND:.3g} um/s"
        + (f", peak {peak / GAL:.3g} gal" if np.isfinite(peak) else "")
        for rank, margin, band, share, rms, peak in zip(
            ranks, classes.margin[i], classes.governing_band[i], classes.share_exceeding[i],
            view.rms_velocity, view.peak_acceleration, strict=True,
        )
    ]  # fmt: skip
    return {
        "title": view.title,
        "routes": list(view.routes),
        "ranks": ranks.reshape(shape).tolist(),
        "texts": np.array(texts, dtype=object).reshape(shape).tolist(),
    }


def _short(values: np.ndarray) -> list[float]:
    return [float(f"{v:.6g}") for v in values]

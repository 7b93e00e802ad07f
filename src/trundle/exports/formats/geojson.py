"""GeoJSON: the maps of a study as polygons with classes and levels.

Coordinates are those of the plan in metres, or longitude and latitude where the place of its origin
is given.

Reference: H. Butler et al., The GeoJSON Format, RFC 7946 (2016).
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from trundle._typing import Array
from trundle.exports.export_format import ExportFormat, Subject
from trundle.study.map_plan import MapGrid
from trundle.views.map import MapView, class_names, class_ranks, map_views

__all__ = ["EXPORT"]

_EARTH = 6371008.8  # m, mean radius (IUGG)


def write(subject: Subject, stem: str) -> Mapping[str, bytes]:
    """Return the cells of all maps.

    Parameters
    ----------
    subject : Subject
        With the results of a study that maps its floor.
    stem : str
        Name of the collection.
    """
    assert subject.result is not None  # the format needs it
    views = map_views(subject.result)
    features = [one for view in views for one in _features(subject, view)]
    whole: dict[str, Any] = {"type": "FeatureCollection", "name": stem, "features": features}
    if subject.origin is None:
        whole["coordinates"] = "plan of the study [m], not longitude and latitude"
    return {".geojson": json.dumps(whole, allow_nan=False).encode()}


def _features(subject: Subject, view: MapView) -> Iterator[dict[str, Any]]:
    grid = view.grid
    called, ranks = class_names(view.classes), class_ranks(view.classes)
    surface = subject.structure.surface(grid.on)
    ends = surface.frame.to_plan(np.array(surface.extent))
    for i, corners in enumerate(_cells(grid, ends)):
        told = {
            name: _plain(values[i]) for name, values in view.numbers.items() if np.ndim(values) == 1
        }
        yield {
            "type": "Feature",
            "geometry": {"type": "Polygon", "coordinates": [_placed(subject, corners)]},
            "properties": {
                "map": view.title,
                "storey": grid.on,
                "class": called[ranks[i]],
                **told,
            },
        }


def _plain(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None


def _cells(grid: MapGrid, ends: Array) -> Iterator[Array]:
    """Give the cell round each place, closed, counterclockwise; `ends` are of the floor."""
    x, y = (_edges(lines, *ends[:, axis]) for axis, lines in enumerate((grid.x, grid.y)))
    for row, column in np.argwhere(grid.there):
        west, east, south, north = x[column], x[column + 1], y[row], y[row + 1]
        yield np.array([[west, south], [east, south], [east, north], [west, north], [west, south]])


def _edges(lines: Array, low: float, high: float) -> Array:
    """Return where cells end: between the lines of a grid, and where the floor does."""
    if len(lines) == 1:
        return np.array([low, high])
    between = 0.5 * (lines[1:] + lines[:-1])
    first, last = between[:1] - lines[:1], lines[-1:] - between[-1:]
    return np.concatenate(
        [np.maximum(lines[:1] - first, low), between, np.minimum(lines[-1:] + last, high)]
    )


def _placed(subject: Subject, corners: Array) -> list[list[float]]:
    if subject.origin is None:
        return np.round(corners, 4).tolist()
    longitude, latitude = subject.origin
    c, s = np.cos(subject.north), np.sin(subject.north)
    x, y = corners.T
    north, east = y * c - x * s, x * c + y * s
    up = latitude + np.degrees(north / _EARTH)
    along = longitude + np.degrees(east / (_EARTH * np.cos(np.radians(latitude))))
    return np.round(np.column_stack([along, up]), 8).tolist()


EXPORT = ExportFormat(
    kind="geojson", name="GeoJSON of maps", suffix=".geojson", needs=("result",), write=write
)

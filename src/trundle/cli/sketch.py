"""Sketch a floor plan in characters, so that a slip in a coordinate is seen at once."""

from __future__ import annotations

import numpy as np

from trundle.study.model import Study

__all__ = ["plan_sketch"]

_WIDTH = 66
_ASPECT = 0.5  # a character is about twice as tall as wide


def _along(line: np.ndarray, *, closed: bool = True) -> np.ndarray:
    """Return many places along a line [m], closed or not."""
    ends = np.roll(line, -1, axis=0)
    starts, ends = (line, ends) if closed else (line[:-1], ends[:-1])
    shares = np.linspace(0.0, 1.0, 200)[:, None, None]
    return (starts + shares * (ends - starts)).reshape(-1, 2)


def plan_sketch(study: Study) -> str:
    """Return the plan with columns (+), routes (letters) and points (1, 2, ...), y upwards."""
    (x0, x1), (y0, y1) = study.extent
    height = int(np.clip(_WIDTH * _ASPECT * (y1 - y0) / (x1 - x0), 8, 48))
    grid = np.full((height, _WIDTH), " ")

    def _put(places: np.ndarray, mark: str) -> None:
        column = np.clip((places[:, 0] - x0) / (x1 - x0) * (_WIDTH - 1), 0, _WIDTH - 1)
        row = np.clip((places[:, 1] - y0) / (y1 - y0) * (height - 1), 0, height - 1)
        grid[np.round(row).astype(int), np.round(column).astype(int)] = mark

    if study.plan is not None and study.plan.column:
        lines = np.meshgrid(study.plan.x_lines, study.plan.y_lines)
        _put(np.stack([line.ravel() for line in lines], axis=1), "+")
    if study.building is not None:
        for slab in (*study.building.slabs, *study.building.ramps):
            for ring in (slab.outline, *getattr(slab, "openings", ())):
                _put(_along(ring), ".")
        if study.building.columns:
            _put(np.array([column.at for column in study.building.columns]), "+")
    legend = []
    for i, (name, drive) in enumerate(study.drives.items()):
        letter = chr(ord("a") + i % 26)
        way = study.way_in_plan(drive.route)
        _put(_along(way, closed=False), letter)
        speed = 3.6 * drive.route.law.fastest
        _put(way[-1:], ">")
        names = ", ".join(one for one in drive.route.visited if one is not None)
        on = f" on {names}" if names else ""
        legend.append(f"  {letter}  route {name}{on}: {speed:g} km/h, ends at >")
    for i, (name, source) in enumerate(study.sources.items()):
        letter = chr(ord("z") - i % 26)
        places = np.concatenate([place for place, _ in source.way()])
        _put(study.in_plan(places, source.on), letter)
        on = "" if source.on is None else f" on {source.on}"
        legend.append(f"  {letter}  {type(source).__name__.lower()} {name}{on}")
    for i, (name, spot) in enumerate(study.points.items()):
        place = study.in_plan(np.array([[spot.x, spot.y]]), spot.on)
        _put(place, str((i + 1) % 10))
        on = "" if spot.on is None else f" on {spot.on}"
        legend.append(f"  {(i + 1) % 10}  point {name} at ({place[0, 0]:g}, {place[0, 1]:g}) m{on}")
    border = "." + "-" * _WIDTH + "."
    rows = ["|" + "".join(row) + "|" for row in grid[::-1]]
    size = f"x {x0:g} to {x1:g} m across, y {y0:g} to {y1:g} m up; + column"
    return "\n".join(["", border, *rows, border, size, *legend])

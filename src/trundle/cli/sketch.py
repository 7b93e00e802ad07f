"""Sketch a floor plan in characters, so that a slip in a coordinate is seen at once."""

from __future__ import annotations

import numpy as np

from trundle.study.model import Study

__all__ = ["plan_sketch"]

_WIDTH = 66
_ASPECT = 0.5  # a character is about twice as tall as wide


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
    legend = []
    for i, (name, drive) in enumerate(study.drives.items()):
        letter = chr(ord("a") + i % 26)
        stations = np.linspace(0.0, drive.route.length, 400)
        _put(drive.route.locate(stations)[0], letter)
        speed = 3.6 * float(drive.route.law.speed(0.0))
        _put(drive.route.points[-1:], ">")
        legend.append(f"  {letter}  route {name}: {speed:g} km/h, ends at >")
    for i, (name, spot) in enumerate(study.points.items()):
        place = study.in_plan(np.array([[spot.x, spot.y]]), spot.on)
        _put(place, str((i + 1) % 10))
        on = "" if spot.on is None else f" on {spot.on}"
        legend.append(f"  {(i + 1) % 10}  point {name} at ({place[0, 0]:g}, {place[0, 1]:g}) m{on}")
    border = "." + "-" * _WIDTH + "."
    rows = ["|" + "".join(row) + "|" for row in grid[::-1]]
    size = f"x {x0:g} to {x1:g} m across, y {y0:g} to {y1:g} m up; + column"
    return "\n".join(["", border, *rows, border, size, *legend])

"""Give what a plan shows of a storey: outlines, beams, columns, walls, grid, as plain lines.

Pictures and the interactive map draw the same lines.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
from jaxtyping import Float

from trundle._typing import Array
from trundle.structure import FloorPlan
from trundle.structure.building import Building
from trundle.study.model import Study

__all__ = ["GridLine", "PlanLines", "dimensions", "plan_lines"]

Line = Float[Array, "places 2"]


@dataclass(frozen=True, kw_only=True, eq=False)
class GridLine:
    """Hold a named line of the building's grid.

    Attributes
    ----------
    name : str
        Its name.
    axis : int
        0 where it stands at an x and runs along y, 1 where it stands at a y.
    at : float
        Where [m].
    """

    name: str
    axis: int
    at: float


@dataclass(frozen=True, kw_only=True, eq=False)
class PlanLines:
    """Hold the lines of one storey or ramp in plan [m].

    Attributes
    ----------
    rings : list of ndarray, shape (n, 2)
        Outlines of slabs and openings, closed by whoever draws them.
    beams, walls : list of ndarray, shape (n, 2)
        Along their middle.
    columns : list of ndarray, shape (n, 2)
        Their footprints.
    grid : list of GridLine
        Named lines across or along.
    north : float or None
        Angle of north from the y axis, counterclockwise [degrees].
    """

    rings: list[Line] = field(default_factory=list[Line])
    beams: list[Line] = field(default_factory=list[Line])
    walls: list[Line] = field(default_factory=list[Line])
    columns: list[Line] = field(default_factory=list[Line])
    grid: list[GridLine] = field(default_factory=list[GridLine])
    north: float | None = None


def plan_lines(study: Study, on: str | None) -> PlanLines:
    """Return the lines of a surface; of a model that came as a mesh the edge of its elements.

    Parameters
    ----------
    study : Study
        Has the building.
    on : str or None
        Name of the surface; None for the only one.
    """
    if study.plan is not None:
        return _of_bays(study.plan)
    if study.building is not None:
        return _of_building(study.building, on or next(iter(study.floor.surfaces)))
    return PlanLines(rings=list(_borders(study, on)))


def _of_bays(plan: FloorPlan) -> PlanLines:
    (x0, x1), (y0, y1) = plan.x_extent, plan.y_extent
    along_x = [np.array([[x0, y], [x1, y]]) for y in plan.y_lines] if plan.beams_x else []
    along_y = [np.array([[x, y0], [x, y1]]) for x in plan.x_lines] if plan.beams_y else []
    columns = []
    if plan.column is not None:
        half = 0.5 * np.array([plan.column.depth, plan.column.width])
        corners = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * half
        columns = [corners + np.array([x, y]) for x in plan.x_lines for y in plan.y_lines]
    return PlanLines(
        rings=[np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]])],
        beams=along_x + along_y,
        columns=columns,
        grid=[
            *(GridLine(name=str(i + 1), axis=0, at=float(x)) for i, x in enumerate(plan.x_lines)),
            *(GridLine(name=_letter(i), axis=1, at=float(y)) for i, y in enumerate(plan.y_lines)),
        ],
    )


def _letter(i: int) -> str:
    """Name the lines of a plan without names: A to Z, then AA."""
    return chr(65 + i) if i < 26 else _letter(i // 26 - 1) + chr(65 + i % 26)


def _of_building(building: Building, on: str) -> PlanLines:
    storeys = {storey.name for storey in building.storeys}
    there = {
        id(part): on in storeys & {s.name for s in building.between(part.bottom, part.top)}
        for part in (*building.columns, *building.walls)
    }
    rings = [ring for s in building.slabs if s.on == on for ring in (s.outline, *s.openings)]
    rings += [ramp.outline for ramp in building.ramps if ramp.name == on]
    return PlanLines(
        rings=rings,
        beams=[beam.along for beam in building.beams if beam.on == on],
        walls=[wall.along for wall in building.walls if there[id(wall)]],
        columns=[column.footprint for column in building.columns if there[id(column)]],
        grid=[
            GridLine(name=name, axis=axis, at=float(ends[0, axis]))
            for name, ends in building.grid.items()
            for axis in (0, 1)
            if abs(ends[0, axis] - ends[1, axis]) < 1e-9
        ],
        north=building.north,
    )


def _borders(study: Study, on: str | None) -> Iterator[Line]:
    """Give the edges that only one element of a surface has, as lines of two places."""
    if not study.floor.surfaces:
        return
    surface = study.floor.surface(on)
    edges = [
        np.stack([elements[:, i], elements[:, (i + 1) % elements.shape[1]]], axis=1)
        for _, elements in surface.parts
        if elements.shape[1] > 2
        for i in range(elements.shape[1])
    ]
    if not edges:
        return
    every = np.concatenate(edges)
    _, first, times = np.unique(
        np.sort(every, axis=1), axis=0, return_index=True, return_counts=True
    )
    yield from surface.nodes[every[first[times == 1]]][:, :, :2]


def dimensions(lines: PlanLines) -> list[tuple[int, float, float]]:
    """Return what grid lines are apart: axis, middle and distance [m], one a pair."""
    found = []
    for axis in (0, 1):
        places = sorted({one.at for one in lines.grid if one.axis == axis})
        found += [(axis, 0.5 * (a + b), b - a) for a, b in pairwise(places)]
    return found

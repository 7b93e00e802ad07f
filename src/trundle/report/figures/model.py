"""Draw models that came as a mesh: a plan of each surface, and modes surface by surface."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.figure import Figure

from trundle._typing import Array
from trundle._words import in_kmh
from trundle.report.canvas import Drawing, new_figure
from trundle.report.figures.building import storey_modes_figure
from trundle.report.figures.routes import draw_route
from trundle.report.figures.sources import draw_sources
from trundle.results.study_result import StudyResult
from trundle.structure import Surface
from trundle.study.model import Study

__all__ = ["drawings"]

_SLAB, _BEAM, _COLUMN = "#E8E8E8", "#9A9A9A", "#222222"
_UPRIGHT = 0.9  # of a member's direction along z: a column
_NEAR = 0.6  # m above or below a surface within which a level member is its beam
_MARGIN = 0.12


def drawings(result: StudyResult) -> Iterator[Drawing]:
    """Give a plan of each surface, and the first modes.

    Yields
    ------
    Drawing
        One after the other; none for floors and buildings that were built here.
    """
    study, modes = result.study, result.modes
    if study.plan is not None or study.building is not None:
        return
    for i, name in enumerate(study.floor.surfaces, start=1):
        several = len(study.floor.surfaces) > 1
        yield Drawing(
            name=f"plan_{i}" if several else "plan",
            title=f"Plan of {name}" if several else "Plan with routes and points",
            caption="Plates (grey) and their ends, members at them (dark grey), columns that meet "
            "them (black), routes with their direction and speed, and points where the response "
            "is read.",
            draw=lambda name=name: plan_figure(study, name),
        )
    if modes is not None:
        yield Drawing(
            name="modes",
            title="First modes of the model",
            caption="Vertical motion of every surface, red up and blue down, on one scale a mode.",
            draw=lambda: storey_modes_figure(study, modes),
        )


def plan_figure(study: Study, name: str) -> Figure:
    """Draw the plan of one surface."""
    surface = study.floor.surfaces[name]
    nodes = study.floor.nodes
    used = np.concatenate([elements.ravel() for _, elements in surface.parts])
    low, high = nodes[used, :2].min(axis=0), nodes[used, :2].max(axis=0)
    size = np.maximum(high - low, 1.0)
    figure, (axes,) = new_figure(6.8, float(np.clip(1.0 + 6.0 * size[1] / size[0], 2.6, 8.5)))
    _draw_plates(axes, surface)
    _draw_members(axes, study, surface)
    for i, (route, drive) in enumerate(study.drives.items()):
        line = study.way_in_plan(drive.route, name)
        if len(line):
            draw_route(axes, line, f"{route}, {in_kmh(drive.route.law.fastest)}", i)
    draw_sources(axes, study, study.sources, on=name, labels=True)
    for point, spot in study.points.items():
        if spot.on in {name, None}:
            place = study.in_plan(np.array([[spot.x, spot.y]]), spot.on)[0]
            axes.plot(*place, marker="X", markersize=9, color="black", linestyle="none", zorder=6)
            axes.annotate(
                point, place, xytext=(7, 6), textcoords="offset points", weight="bold", zorder=6
            )
    margin = _MARGIN * float(size.max())
    axes.set(xlim=(low[0] - margin, high[0] + margin), ylim=(low[1] - margin, high[1] + margin))
    axes.set(aspect="equal", xlabel="x [m]", ylabel="y [m]", title=name)
    axes.grid(visible=False)
    return figure


def _draw_plates(axes: Axes, surface: Surface) -> None:
    """Fill the elements of a surface, and draw its ends: sides that one element alone has."""
    flat, sides = surface.nodes[:, :2], list[Array]()
    for _, elements in surface.parts:
        if elements.shape[1] > 2 and len(elements):
            axes.add_collection(
                PolyCollection(list(flat[elements]), facecolor=_SLAB, edgecolor="none", zorder=1)
            )
            sides.append(np.stack([elements, np.roll(elements, -1, axis=1)], axis=2).reshape(-1, 2))
    if sides:
        found, times = np.unique(np.sort(np.concatenate(sides), axis=1), axis=0, return_counts=True)
        ends = LineCollection(list(flat[found[times == 1]]), color="black", linewidth=1.0, zorder=2)
        axes.add_collection(ends)


def _draw_members(axes: Axes, study: Study, surface: Surface) -> None:
    """Draw members at a surface: level ones as lines, upright ones as squares."""
    nodes = study.floor.nodes
    for group in study.floor.elements:
        ends = group.connectivity
        if ends.shape[1] != 2 or (ends < 0).any():
            continue
        xyz = nodes[ends]
        height = surface.frame.coordinates(xyz.reshape(-1, 3))[:, 2].reshape(-1, 2)
        along = xyz[:, 1] - xyz[:, 0]
        upright = np.abs(along[:, 2]) > _UPRIGHT * np.linalg.norm(along, axis=1)
        beams = ~upright & (np.abs(height) < _NEAR).all(axis=1)
        lines = LineCollection(list(xyz[beams][:, :, :2]), color=_BEAM, linewidth=1.8, zorder=2)
        axes.add_collection(lines)
        columns = upright & (height.min(axis=1) < _NEAR) & (height.max(axis=1) > -_NEAR)
        at = xyz[columns].mean(axis=1)
        axes.plot(at[:, 0], at[:, 1], "s", markersize=5, color=_COLUMN, linestyle="none", zorder=3)

"""Draw a class map as a plan: filled contours, building, grid, routes, points, the worst place."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Patch, Polygon

from trundle._typing import Array
from trundle.report.canvas import Drawing, class_colours, legend_below, new_figure
from trundle.report.figures.routes import draw_route
from trundle.report.figures.sources import draw_sources
from trundle.results.study_result import StudyResult
from trundle.study.map_plan import MapGrid
from trundle.study.model import Study
from trundle.views.map import (
    MapView,
    class_limits_of,
    class_names,
    class_ranks,
    map_views,
    worst_place,
)
from trundle.views.plan_lines import PlanLines, dimensions, plan_lines

__all__ = ["draw_plan_lines", "drawings", "fill_classes"]

_MARGIN = 0.09  # of the larger side, round a plan, for names and dimensions


def drawings(result: StudyResult) -> Iterator[Drawing]:
    """Give the worst map of every storey, as large as a page.

    Yields
    ------
    Drawing
        One a storey and axis that is mapped.
    """
    plan = result.study.map
    if plan is None or not result.maps:
        return
    last: dict[tuple[str | None, str], MapView] = {}
    for view in map_views(result):
        last[view.grid.on, view.grid.axis] = view  # the worst comes last
    for i, view in enumerate(last.values()):
        yield Drawing(
            name=f"class_plan{f'_{i + 1}' if i else ''}",
            title=f"Where what may stand: {view.title}",
            caption=f"Strictest criterion that {plan.percentile:g} % of {plan.runs} runs keep "
            f"within, averaging {plan.averaging}; between {plan.n_places} places by their margins. "
            f"The ring is where the margin to {plan.criterion} is smallest.",
            draw=lambda view=view: class_plan_figure(result.study, view),
        )


def class_plan_figure(study: Study, view: MapView) -> Figure:
    """Draw one map on the plan of its storey."""
    (x0, x1), (y0, y1) = study.extent
    figure, (axes,) = new_figure(7.2, float(np.clip(1.9 + 6.0 * (y1 - y0) / (x1 - x0), 3.4, 9.0)))
    fill_classes(axes, view)
    lines = plan_lines(study, view.grid.on)
    draw_plan_lines(axes, lines)
    margin = _MARGIN * max(x1 - x0, y1 - y0)
    _draw_grid(axes, lines, ((x0, x1), (y0, y1)), margin)
    for i, (name, drive) in enumerate(study.drives.items()):
        way = study.way_in_plan(drive.route, view.grid.on)
        if name in view.routes and len(way):
            draw_route(axes, way, name, i)
    draw_sources(axes, study, view.routes, on=view.grid.on, labels=True)
    _draw_points(axes, study, view.grid)
    _draw_worst(axes, study, view)
    axes.set(xlim=(x0 - margin, x1 + margin), ylim=(y0 - margin, y1 + margin), aspect="equal")
    axes.set(xlabel="x [m]", ylabel="y [m]")
    axes.grid(visible=False)
    names, colours = class_names(view.classes), class_colours(class_limits_of(view.classes))
    seen = [k for k in range(len(names)) if k in set(class_ranks(view.classes))][::-1]
    handles = [Patch(facecolor=colours[k], edgecolor="#7F7F7F") for k in seen]
    legend_below(figure, handles, [names[k] for k in seen], columns=6)
    return figure


def fill_classes(axes: Axes, view: MapView, *, ground: bool = True) -> None:
    """Fill the classes of a map: between places by their margins, beyond them by the nearest.

    A class reaches as far as its margin, straight between places on a logarithmic scale, is 1 or
    more. Where a margin is not known the nearest place says what there is, which is drawn below
    unless `ground` says that it is there.
    """
    grid, classes = view.grid, view.classes
    colours = class_colours(class_limits_of(classes))
    if ground:
        axes.pcolormesh(
            grid.x,
            grid.y,
            grid.filled(class_ranks(classes).astype(float)),
            shading="nearest",
            rasterized=True,
            cmap=ListedColormap(colours),
            norm=BoundaryNorm(np.arange(len(colours) + 1) - 0.5, len(colours)),
        )
    if min(len(grid.x), len(grid.y)) < 2:
        return
    known = grid.filled(np.where(class_ranks(classes) > 0, 1.0, np.nan))
    x, y = _to_the_edge(grid.x), _to_the_edge(grid.y)
    for rank, i in enumerate(classes.order(), start=2):
        field = np.pad(np.log(grid.filled(classes.margin[i])) * known, 1, mode="edge")
        if np.isfinite(field).sum() < 4:
            continue
        if rank == 2:  # where the widest is known, nothing is met unless it is drawn over
            axes.contourf(x, y, field, levels=[-1e9, 1e9], colors=[colours[1]])
        if classes.complete[i]:
            axes.contourf(x, y, field, levels=[0.0, 1e9], colors=[colours[rank]])


def _to_the_edge(line: Array) -> Array:
    """Return a line of places with half a step more at both ends, theirs to fill."""
    steps = np.diff(line)
    return np.concatenate([[line[0] - 0.5 * steps[0]], line, [line[-1] + 0.5 * steps[-1]]])


def draw_plan_lines(axes: Axes, lines: PlanLines) -> None:
    """Draw outlines of slab and openings, beams, walls and columns."""
    for beam in lines.beams:
        axes.plot(*beam.T, color="#555555", linewidth=0.5, alpha=0.7)
    for ring in lines.rings:
        axes.plot(*np.vstack([ring, ring[:1]]).T, color="#222222", linewidth=1.0)
    for wall in lines.walls:
        axes.plot(*wall.T, color="#222222", linewidth=2.0)
    for column in lines.columns:
        axes.add_patch(Polygon(column, facecolor="#222222", zorder=3))


def _draw_grid(
    axes: Axes, lines: PlanLines, extent: tuple[tuple[float, float], ...], margin: float
) -> None:
    """Draw names of grid lines above and on the left, what they are apart, and north."""
    look = {"boxstyle": "circle,pad=0.2", "facecolor": "white", "edgecolor": "#7F7F7F"}
    (x0, x1), (y0, y1) = extent
    for one in lines.grid:
        at = (one.at, y1 + 0.6 * margin) if one.axis == 0 else (x0 - 0.6 * margin, one.at)
        axes.text(*at, one.name, ha="center", va="center", fontsize=7, bbox=look, zorder=5)
    room = (x1 - x0, y1 - y0)
    for axis, middle, apart in dimensions(lines):
        if apart < 0.05 * room[axis]:
            continue
        at = (middle, y1 + 0.35 * margin) if axis == 0 else (x0 - 0.3 * margin, middle)
        turn = 0 if axis == 0 else 90
        axes.text(*at, f"{apart:.4g} m", ha="center", va="center", fontsize=6.5, rotation=turn)
    if lines.north is not None:
        angle = np.deg2rad(90.0 + lines.north)
        dx, dy = 0.05 * float(np.cos(angle)), 0.05 * float(np.sin(angle))
        axes.annotate(
            "N",
            (0.95 - dx, 0.93 - dy),
            xytext=(0.95 + dx, 0.93 + dy),
            xycoords="axes fraction",
            textcoords="axes fraction",
            arrowprops={"arrowstyle": "<|-", "color": "black"},
            ha="center",
            va="center",
            fontsize=8,
        )


def _draw_points(axes: Axes, study: Study, grid: MapGrid) -> None:
    for name, spot in study.points.items():
        if not study.is_on(spot.on, grid.on) or spot.axis != grid.axis:
            continue
        place = study.in_plan(np.array([[spot.x, spot.y]]), spot.on)[0]
        axes.plot(
            *place, marker="X", markersize=8, color="black", markeredgecolor="white", zorder=6
        )
        _label(axes, name, (float(place[0]), float(place[1])), (6, 5))


def _draw_worst(axes: Axes, study: Study, view: MapView) -> None:
    plan = study.map
    assert plan is not None  # there is a view
    found = worst_place(view, plan.criterion)
    if found is None:
        return
    x, y, margin = found
    axes.plot(x, y, "o", markersize=11, markerfacecolor="none", markeredgecolor="white", zorder=6)
    axes.plot(x, y, "o", markersize=9, markerfacecolor="none", markeredgecolor="#CC0000", zorder=6)
    words = f"worst: ({x:.1f}, {y:.1f}) m, {margin:.3g} of {plan.criterion}"
    _label(axes, words, (x, y), (7, -12))


def _label(axes: Axes, words: str, place: tuple[float, float], shift: tuple[int, int]) -> None:
    axes.annotate(
        words,
        place,
        xytext=shift,
        textcoords="offset points",
        fontsize=7.5,
        weight="bold",
        bbox={"facecolor": "white", "edgecolor": "none", "pad": 1.0, "alpha": 0.85},
        zorder=7,
    )

"""Draw floors: plan with routes, section, mesh, mode shapes."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator
from matplotlib.tri import Triangulation
from mpl_toolkits.mplot3d.art3d import Line3DCollection

from trundle._typing import Array
from trundle._words import in_kmh
from trundle.report.canvas import COLOURS, Drawing, new_figure
from trundle.report.figures.routes import draw_wheel_tracks
from trundle.report.figures.sources import draw_sources
from trundle.results.modes import FirstModes
from trundle.results.study_result import StudyResult
from trundle.structure import FloorPlan, Structure
from trundle.study.doubts_mesh import quality_of_mesh
from trundle.study.model import Study

__all__ = ["drawings"]


_LABELS = (0.72, 0.4, 0.88, 0.56)  # where names stand along routes


def drawings(result: StudyResult) -> Iterator[Drawing]:
    """Give the plan, the section, the mesh, and the first modes where there are any.

    Yields
    ------
    Drawing
        One after the other, as they stand on the page.
    """
    study, modes = result.study, result.modes
    plan = study.plan
    if plan is not None:
        yield Drawing(
            name="plan",
            title="Plan with routes and points",
            caption=_plan_words(plan),
            draw=lambda: plan_figure(study, plan),
        )
    if plan is not None:
        yield Drawing(
            name="section",
            title="Section",
            caption="Section along y: slab, beams"
            + (", columns above and below." if plan.column else "."),
            draw=lambda: section_figure(plan),
        )
    yield Drawing(
        name="mesh",
        title="Finite-element model",
        caption="Shells (blue), beams at their centroids (dark)"
        + (", columns (orange)." if _columns(study.floor) else ".")
        + _quality_words(study),
        draw=lambda: mesh_figure(study.floor),
    )
    if modes is not None and plan is not None:
        yield Drawing(
            name="modes",
            title="First modes of the floor",
            caption="Vertical motion of the slab, red up and blue down.",
            draw=lambda: modes_figure(study.floor, modes),
        )


def _plan_words(plan: FloorPlan) -> str:
    """Say what is drawn on a plan."""
    columns = " columns (squares)," if plan.column else ""
    return (
        f"Beams (grey), secondary beams (dashed),{columns} routes with their direction and speed, "
        "and the points where the response is read."
    )


def _columns(floor: Structure) -> bool:
    return any(group.name == "column" for group in floor.elements)


def _quality_words(study: Study) -> str:
    """Say how well elements are shaped, where a mesher made them."""
    if study.building is None:
        return ""
    found = quality_of_mesh(study)
    return (
        f" {found.n_quads} quadrilaterals and {found.n_triangles} triangles, corners of "
        f"{found.least_angle:.0f} to {found.largest_angle:.0f} degrees, sides up to "
        f"{found.largest_aspect:.1f} to 1. Wheels roll over a surface whose slope is continuous "
        f"between rectangles, {100.0 * found.share_of_rectangles:.0f} % of the area; between other "
        "elements it is continuous itself, and its slope across their border steps by what the "
        "mesh leaves."
    )


def plan_figure(study: Study, plan: FloorPlan) -> Figure:
    """Draw the plan with beams, columns, routes and points."""
    (x0, x1), (y0, y1) = study.extent
    figure, (axes,) = new_figure(5.6, 1.2 + 5.0 * (y1 - y0) / (x1 - x0))
    _draw_beams(axes, plan)
    for i, (name, drive) in enumerate(study.drives.items()):
        route, colour = drive.route, COLOURS[i % 6]
        draw_wheel_tracks(axes, study, drive, colour)
        axes.plot(*route.line.T, color=colour, linewidth=2.0)
        axes.annotate(
            "",
            route.line[-1],
            xytext=route.line[-2],
            arrowprops={"arrowstyle": "-|>", "color": colour, "linewidth": 2.0},
        )
        speed = in_kmh(route.law.fastest)
        at = _LABELS[i % len(_LABELS)]  # ways may lie on each other
        middle, direction = route.locate(np.array([at * route.length]))
        angle = float(np.degrees(np.arctan2(direction[0, 1], direction[0, 0])))
        angle = angle if -90.0 < angle <= 90.0 else angle + 180.0  # readable from below
        axes.annotate(
            f"{name}, {speed}",
            middle[0],
            rotation=angle,
            rotation_mode="anchor",
            xytext=(0, 0),
            textcoords="offset points",
            ha="center",
            va="bottom",
            color=colour,
            bbox={"facecolor": "white", "edgecolor": "none", "pad": 1.0, "alpha": 0.8},
        )
    draw_sources(axes, study, study.sources, on=None, labels=True)
    for name, spot in study.points.items():
        place = study.in_plan(np.array([[spot.x, spot.y]]), spot.on)[0]
        axes.plot(*place, marker="X", markersize=9, color="black", linestyle="none")
        axes.annotate(name, place, xytext=(8, 6), textcoords="offset points", weight="bold")
    _draw_edges(axes, plan)
    axes.set(aspect="equal", xlabel="x [m]", ylabel="y [m]")
    axes.set(xlim=(x0 - 3.0, x1 + 3.0), ylim=(y0 - 3.0, y1 + 3.0))
    axes.grid(visible=False)
    return figure


def _draw_beams(axes: Axes, plan: FloorPlan) -> None:
    (x0, x1), (y0, y1) = plan.x_extent, plan.y_extent
    if plan.beams_x:
        axes.hlines(plan.y_lines, x0, x1, color="#9A9A9A", linewidth=2.2)
    if plan.beams_y:
        axes.vlines(plan.x_lines, y0, y1, color="#9A9A9A", linewidth=1.6)
    axes.vlines(plan.secondary_lines, y0, y1, color="#BDBDBD", linewidth=0.8, linestyle="--")
    if plan.column:
        x, y = np.meshgrid(plan.x_lines, plan.y_lines)
        axes.plot(x.ravel(), y.ravel(), marker="s", markersize=5, color="black", linestyle="none")


def _draw_edges(axes: Axes, plan: FloorPlan) -> None:
    (x0, x1), (y0, y1) = plan.x_extent, plan.y_extent
    sides = {
        "x_min": ([x0, x0], [y0, y1]),
        "x_max": ([x1, x1], [y0, y1]),
        "y_min": ([x0, x1], [y0, y0]),
        "y_max": ([x0, x1], [y1, y1]),
    }
    looks = {
        "free": ("-", 1.0),
        "symmetry": ("-.", 1.4),
        "simple": (":", 1.8),
        "pinned": ("--", 1.4),
        "clamped": ("-", 2.6),
    }
    shown: set[str] = set()
    for edge, (x, y) in sides.items():
        kind = plan.edges.get(edge, "free")
        line, width = looks[kind]
        label = None if kind in shown else f"{kind} edge"
        axes.plot(x, y, color="black", linestyle=line, linewidth=width, label=label, zorder=1.5)
        shown.add(kind)
    figure = axes.get_figure()
    assert figure is not None  # it was made with these axes
    figure.legend(loc="outside lower center", ncols=3)


def section_figure(plan: FloorPlan) -> Figure:
    """Draw the section along y with slab, beams and columns."""
    figure, (axes,) = new_figure(7.2, 2.9)
    y0, y1 = plan.y_extent
    half = 0.5 * plan.slab.thickness
    axes.fill_between([y0, y1], -half, half, color="#7F7F7F")
    if plan.beams_y:
        axes.fill_between([y0, y1], -half - plan.beams_y.depth, -half, color="#D0D0D0")
    for y in plan.y_lines:
        if plan.beams_x:
            w = 0.5 * plan.beams_x.width
            axes.fill_between([y - w, y + w], -half - plan.beams_x.depth, -half, color="#5A5A5A")
        if plan.column:
            w = 0.5 * plan.column.width
            axes.fill_between(
                [y - w, y + w], -plan.storey_below, plan.storey_above, color="#B0B0B0", zorder=0.5
            )
    marks = np.unique(np.concatenate([[y0], plan.y_lines, [y1]]))
    level = -plan.storey_below - 1.0
    for low, high in pairwise(marks):
        axes.annotate("", (low, level), xytext=(high, level), arrowprops={"arrowstyle": "<->"})
        axes.text(0.5 * (low + high), level - 0.3, f"{high - low:g} m", ha="center", va="top")
    axes.set(xlabel="y [m]", ylabel="z [m]", ylim=(level - 2.5, plan.storey_above + 1.0))
    if plan.column:
        axes.set_title("columns are fixed at both far ends", fontsize=9)
    axes.grid(visible=False)
    return figure


def _edges(elements: Array) -> Array:
    """Return each edge of the elements once, as pairs of node numbers."""
    around = np.stack([elements, np.roll(elements, -1, axis=1)], axis=2).reshape(-1, 2)
    return np.unique(np.sort(around, axis=1), axis=0)


def mesh_figure(floor: Structure) -> Figure:
    """Draw the finite-element mesh in perspective."""
    figure = Figure(figsize=(7.2, 5.4), layout="constrained")
    axes = figure.add_subplot(projection="3d")
    for group in floor.elements:
        numbers = group.connectivity
        if numbers.shape[1] > 2:
            lines, look = floor.nodes[_edges(numbers)], ("#8FB8D6", 0.25)
        elif numbers.shape[1] == 2 and not group.stands_on_ground:
            offset = getattr(group, "offset", np.zeros(3))
            lines = floor.nodes[numbers] + offset
            look = (COLOURS[1] if group.name == "column" else "#333333", 0.9)
        else:
            continue
        axes.add_collection(
            Line3DCollection(lines, colors=look[0], linewidths=look[1], rasterized=True)
        )
    low, high = floor.nodes.min(axis=0), floor.nodes.max(axis=0)
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2] + 1e-3))
    axes.set(xlabel="x [m]", ylabel="y [m]", zlabel="z [m]")
    axes.set_box_aspect(np.maximum(high - low, 1.0))
    axes.zaxis.set_major_locator(FixedLocator(sorted({float(low[2]), 0.0, float(high[2])})))
    axes.view_init(elev=24.0, azim=-122.0)
    axes.text2D(
        0.02,
        0.97,
        f"{len(floor.nodes)} nodes, {floor.n_dofs} degrees of freedom",
        transform=axes.transAxes,
    )
    return figure


def _triangles(floor: Structure) -> np.ndarray:
    """Return the faces of all surfaces as triangles, by node numbers."""
    faces = [
        elements[:, [0, i, i + 1]]
        for surface in floor.surfaces.values()
        for _, elements in surface.parts
        for i in range(1, elements.shape[1] - 1)
    ]
    return np.vstack(faces)


def modes_figure(floor: Structure, modes: FirstModes, *, n_shown: int = 8) -> Figure:
    """Draw the vertical motion of the slab in the first modes."""
    n_shown = min(n_shown, modes.n_modes)
    columns = min(4, n_shown)
    figure, axes = new_figure(
        7.2,
        2.7 * int(np.ceil(n_shown / columns)),
        rows=int(np.ceil(n_shown / columns)),
        columns=columns,
        share="xy",
    )
    mesh = Triangulation(floor.nodes[:, 0], floor.nodes[:, 1], _triangles(floor))
    for i, panel in enumerate(axes):
        if i >= n_shown:
            panel.set_visible(False)
            continue
        w = modes.vertical[:, i] / np.abs(modes.vertical[:, i]).max()
        panel.tripcolor(mesh, w, cmap="RdBu_r", vmin=-1, vmax=1, shading="gouraud", rasterized=True)
        panel.set(aspect="equal", title=f"{i + 1}: {modes.frequencies[i]:.2f} Hz")
        panel.grid(visible=False)
    figure.supxlabel("x [m]", fontsize=9)
    figure.supylabel("y [m]", fontsize=9)
    return figure

"""Draw what a study maps over its floor: classes, margins, shares of runs above a limit."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.colorbar import Colorbar
from matplotlib.colors import BoundaryNorm, ListedColormap, LogNorm
from matplotlib.figure import Figure
from matplotlib.patches import Patch, Polygon
from matplotlib.ticker import StrMethodFormatter

from trundle._typing import Array
from trundle.report.canvas import COLOURS, Drawing, class_colours, legend_below, new_figure
from trundle.report.figures.class_plan import fill_classes
from trundle.report.figures.sources import draw_sources
from trundle.response.quantities import Quantity, mapped
from trundle.results.study_result import StudyResult
from trundle.structure.building import Building
from trundle.study.map_plan import MapGrid
from trundle.study.model import Study
from trundle.views.map import MapView, class_limits_of, class_names, class_ranks, map_views
from trundle.views.words import shown, written

__all__ = ["draw_building", "draw_image", "draw_panels", "drawings"]

_COLUMNS = 4


def drawings(result: StudyResult) -> Iterator[Drawing]:
    """Give the maps of a result; those of single vehicles at other speeds stand on the page.

    Yields
    ------
    Drawing
        One after the other, as they stand on the page.
    """
    plan, study = result.study.map, result.study
    if plan is None or not result.maps:
        return
    views = [view for view in map_views(result) if view.printed]
    about = (
        f"{plan.n_places} places, level that {plan.percentile:g} % of {plan.runs} runs stay "
        f"below, averaging {plan.averaging}; a cell shows the place at its middle. "
        "Routes dashed, points crossed" + (", columns grey." if _has_columns(study) else ".")
    )
    yield Drawing(
        name="map_classes",
        title="Class map",
        caption=f"Strictest criterion met. {about}",
        draw=lambda: class_map_figure(study, views),
    )
    yield Drawing(
        name="map_margin",
        title=f"Margin to {plan.criterion}",
        caption=about,
        draw=lambda: criterion_map_figure(study, views),
    )
    yield Drawing(
        name="map_share",
        title=f"Share of runs above {plan.criterion}",
        caption=about,
        draw=lambda: share_map_figure(study, views),
    )
    for quantity, how in mapped():
        if {"velocity": True, "acceleration": plan.peaks, "felt": plan.people}[how.of]:
            yield Drawing(
                name=how.figure,
                title=how.title,
                caption=f"{_worst_words(study, views, quantity)} {about}",
                draw=lambda quantity=quantity: level_map_figure(study, views, quantity),
            )


def _has_columns(study: Study) -> bool:
    """Return whether columns are drawn on maps."""
    return bool(
        (study.plan is not None and study.plan.column)
        or (study.building is not None and study.building.columns)
    )


def _worst_words(study: Study, views: list[MapView], quantity: Quantity) -> str:
    """Say where a quantity is largest, and under what."""
    unit, scale = shown(quantity.units, study.report)
    best = max(views, key=lambda view: _largest(view.numbers[quantity.name]))
    values = best.numbers[quantity.name]
    if not np.isfinite(values).any():
        return ""
    at = int(np.nanargmax(values))
    x, y = best.grid.xy[at]
    named = written(values[at] / scale) + (f" {unit}" if unit != "1" else "")
    return f"Largest: {named} at ({x:.1f}, {y:.1f}) m, {best.title}."


def _largest(values: Array) -> float:
    return float(np.nanmax(values)) if np.isfinite(values).any() else -np.inf


def class_map_figure(study: Study, views: list[MapView]) -> Figure:
    """Draw the strictest velocity criterion that is passed at every place of every view."""
    plan = study.map
    assert plan is not None  # there are views
    names = class_names(views[0].classes)
    colours = class_colours(class_limits_of(views[0].classes))
    figure, panels = draw_panels(study, [view.title for view in views])
    norm = BoundaryNorm(np.arange(len(names) + 1) - 0.5, len(names))
    for panel, view in zip(panels, views, strict=True):
        levels = class_ranks(view.classes)
        _image(panel, study, view, levels, cmap=ListedColormap(colours), norm=norm)
        fill_classes(panel, view, ground=False)
    shown = sorted({int(r) for view in views for r in class_ranks(view.classes)})
    ranks = shown[::-1]
    legend_below(
        figure,
        [Patch(facecolor=colours[i], edgecolor="#7F7F7F") for i in ranks],
        [names[i] for i in ranks],
        columns=6,
        title=f"strictest criterion met, {plan.motion}",
    )
    return figure


def criterion_map_figure(study: Study, views: list[MapView]) -> Figure:
    """Draw the margin to one criterion at every place of every view; below 1 it fails."""
    plan = study.map
    assert plan is not None  # there are views
    figure, panels = draw_panels(study, [view.title for view in views])
    image = None
    for panel, view in zip(panels, views, strict=True):
        margin = view.classes.margin[view.classes.index(plan.criterion)]
        image = _image(
            panel,
            study,
            view,
            np.clip(margin, 0.1, 10.0),
            cmap="PuOr",
            norm=LogNorm(0.1, 10.0),
        )
        grid = view.grid.filled(margin)
        if (grid < 1.0).any() and (grid > 1.0).any():
            panel.contour(
                view.grid.x, view.grid.y, grid, levels=[1.0], colors="black", linewidths=1.2
            )
    if image is not None:
        bar = _bar(figure, image, panels)
        bar.set_label(f"margin to {plan.criterion} = limit / level (below 1 fails; line at 1)")
        bar.set_ticks([0.1, 0.3, 1.0, 3.0, 10.0])
        bar.ax.xaxis.set_major_formatter(StrMethodFormatter("{x:g}"))
    return figure


def share_map_figure(study: Study, views: list[MapView]) -> Figure:
    """Draw the share of runs above one criterion at every place of every view."""
    plan = study.map
    assert plan is not None  # there are views
    figure, panels = draw_panels(study, [view.title for view in views])
    image = None
    for panel, view in zip(panels, views, strict=True):
        share = 100.0 * view.classes.share_exceeding[view.classes.index(plan.criterion)]
        look = {"cmap": "cividis_r", "vmin": 0.0, "vmax": 100.0}
        image = _image(panel, study, view, share, **look)
    if image is not None:
        _bar(figure, image, panels).set_label(f"runs above {plan.criterion} [%]")
    return figure


def level_map_figure(study: Study, views: list[MapView], quantity: Quantity) -> Figure:
    """Draw a quantity at every place of every view, on one logarithmic scale."""
    unit, scale = shown(quantity.units, study.report)
    levels = [view.numbers[quantity.name] / scale for view in views]
    plan = study.map
    assert plan is not None  # there are views
    figure, panels = draw_panels(study, [view.title for view in views])
    # Where nothing moves, as on a held edge, there is no place on a logarithmic scale.
    levels = [np.where(level > 0.0, level, np.nan) for level in levels]
    seen = np.concatenate([level[np.isfinite(level)] for level in levels])
    low, high = (float(seen.min()), float(seen.max())) if seen.size else (0.1, 1.0)
    low, high = (low, high) if low < high else (0.9 * low, 1.1 * low)
    norm = LogNorm(low, high)
    image = None
    for panel, view, level in zip(panels, views, levels, strict=True):
        image = _image(panel, study, view, level, cmap="cividis_r", norm=norm)
    if image is not None:
        bar = _bar(figure, image, panels)
        unit = f" [{unit}]" if unit != "1" else ""
        bar.set_label(f"{quantity.heading or quantity.long_name}{unit}")
        ticks = [float(f"{v:.2g}") for v in np.geomspace(low, high, 6)[1:-1]]
        bar.set_ticks(ticks, labels=[f"{tick:g}" for tick in ticks])
        bar.ax.minorticks_off()
    return figure


def draw_panels(
    study: Study, titles: list[str], *, columns: int = _COLUMNS
) -> tuple[Figure, list[Axes]]:
    """Return a figure with a panel for each of several maps of a study's floor."""
    (x0, x1), (y0, y1) = study.extent
    n, columns = len(titles), min(columns, _COLUMNS, len(titles))
    rows = -(-n // columns)
    width = 8.4 / columns
    height = min(max(width * (y1 - y0) / (x1 - x0), 1.0), 5.0)
    figure, panels = new_figure(
        8.8, rows * (height + 0.45) + 1.3, rows=rows, columns=columns, share="xy"
    )
    engine = figure.get_layout_engine()
    if engine is not None:
        engine.set(h_pad=0.1)  # pyright: ignore[reportCallIssue] - titles of the first row fit
    for panel in panels[n:]:
        panel.set_visible(False)
    for panel, title in zip(panels, titles, strict=False):
        panel.set_title(title, fontsize=9)
        panel.grid(visible=False)
    for i, panel in enumerate(panels[:n]):
        panel.set(xlabel="x [m]" if i + columns >= n else "")
        panel.set(ylabel="y [m]" if i % columns == 0 else "")
        panel.tick_params(labelbottom=i + columns >= n)
    return figure, panels[:n]


def _bar(figure: Figure, image: QuadMesh, panels: list[Axes]) -> Colorbar:
    return figure.colorbar(image, ax=panels, location="bottom", shrink=0.5, aspect=40)


def _image(panel: Axes, study: Study, view: MapView, values: Array, **look: object) -> QuadMesh:
    return draw_image(panel, study, (view.grid, view.routes), values, **look)


def draw_image(
    panel: Axes,
    study: Study,
    what: tuple[MapGrid, tuple[str, ...]],
    values: Array,
    **look: object,
) -> QuadMesh:
    """Draw values on the places of a grid, with routes, other sources, points and the building."""
    grid, routes = what
    image = panel.pcolormesh(
        grid.x,
        grid.y,
        grid.filled(values),
        shading="nearest",
        rasterized=True,
        **look,  # pyright: ignore[reportArgumentType] - colours, as matplotlib takes them
    )
    panel.set(xlim=study.extent[0], ylim=study.extent[1], aspect="equal")
    panel.set_facecolor("#D9D9D9")  # where nothing is assessed
    if not grid.there.all():
        _draw_nothing(panel, grid)
    for name in routes:
        drive = study.drives.get(name)
        if drive is None or not any(study.is_on(on, grid.on) for on in drive.route.visited):
            continue
        line = study.way_in_plan(drive.route, grid.on).T
        panel.plot(*line, color="white", linewidth=2.4)
        panel.plot(*line, color="black", linewidth=1.0, linestyle="--")
    draw_sources(panel, study, routes, on=grid.on)
    for spot in study.points.values():
        if not study.is_on(spot.on, grid.on) or spot.axis != grid.axis:
            continue
        place = study.in_plan(np.array([[spot.x, spot.y]]), spot.on)[0]
        panel.plot(*place, marker="X", markersize=6, color="black", markeredgecolor="white")
    if study.building is not None:
        draw_building(panel, study.building, grid.on or next(iter(study.floor.surfaces)))
    if study.plan is not None and study.plan.column:
        x, y = np.meshgrid(study.plan.x_lines, study.plan.y_lines)
        panel.plot(x.ravel(), y.ravel(), "s", markersize=2, color=COLOURS[7])
    return image


def draw_building(panel: Axes, building: Building, on: str) -> None:
    """Draw the outlines of slabs and openings, columns and walls of a storey."""
    for slab in building.slabs:
        if slab.on == on:
            for ring in (slab.outline, *slab.openings):
                panel.plot(*np.vstack([ring, ring[:1]]).T, color="#555555", linewidth=0.7)
    for ramp in building.ramps:
        if ramp.name == on:
            panel.plot(*np.vstack([ramp.outline, ramp.outline[:1]]).T, color="#555555")
    levels = {storey.name for storey in building.storeys}
    for wall in building.walls:
        if on in levels & {s.name for s in building.between(wall.bottom, wall.top)}:
            panel.plot(*wall.along.T, color="#333333", linewidth=1.6)
    for column in building.columns:
        if on in levels & {s.name for s in building.between(column.bottom, column.top)}:
            panel.add_patch(Polygon(column.footprint, facecolor=COLOURS[7]))


def _draw_nothing(panel: Axes, grid: MapGrid) -> None:
    """Leave white where there is no floor, for grey is where nothing is assessed."""
    panel.set_facecolor("white")
    panel.pcolormesh(
        grid.x,
        grid.y,
        np.where(grid.there, 0.0, np.nan),
        shading="nearest",
        cmap=ListedColormap(["#D9D9D9"]),
        zorder=0.5,
        rasterized=True,
    )

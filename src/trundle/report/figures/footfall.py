"""Draw what people who walk give a floor, storey by storey."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.patheffects import AbstractPathEffect, withStroke

from trundle._typing import Array
from trundle.report.canvas import Drawing, new_figure
from trundle.report.figures.map import draw_building
from trundle.run.footfall import StudyFootfall
from trundle.study.map_plan import MapGrid
from trundle.views.footfall import level_unit, level_words

__all__ = ["drawings"]

_HALO: list[AbstractPathEffect] = [withStroke(linewidth=2.4, foreground="black")]
_STEPS = np.array([1.0, 2.0, 4.0, 8.0])  # response factors drawn as lines, and times 10


def drawings(found: StudyFootfall) -> Iterator[Drawing]:
    """Give a map of every storey.

    Yields
    ------
    Drawing
        One a storey, in the order of the floor's surfaces.
    """
    several = len(found.grids) > 1
    for number, (grid, part) in enumerate(found.parts(), start=1):
        on = f", {grid.label}" if grid.label else ""
        yield Drawing(
            name=f"footfall_map_{number}" if several else "footfall_map",
            title=f"Footfall by {found.response.load.title}{on}",
            caption="The worst pace and walker at every place; a cell shows the place at its "
            "middle. Cross: worst place; circle: who walks there.",
            draw=lambda grid=grid, part=part: map_figure(found, grid, part),
        )


def map_figure(found: StudyFootfall, grid: MapGrid, part: slice) -> Figure:
    """Draw levels on one surface, on the scale of the whole floor."""
    governing = found.response.governing
    (x0, x1), (y0, y1) = found.study.extent
    height = min(max(7.2 * (y1 - y0) / (x1 - x0), 1.2), 8.0)
    figure, (panel,) = new_figure(8.0, height + 1.6)
    _, size = level_unit(found)
    levels = np.where(governing.level > 0.0, governing.level / size, np.nan)
    low, high = _scale(levels)
    shown = grid.filled(levels[part])
    image = panel.pcolormesh(
        grid.x, grid.y, shown, shading="nearest", cmap="cividis_r", norm=LogNorm(low, high),
        rasterized=True,
    )  # fmt: skip
    lines = [v for scale in (1.0, 10.0) for v in scale * _STEPS if low < v < high]
    if found.response.quantity == "response_factor" and lines and min(shown.shape) > 1:
        drawn = panel.contour(grid.x, grid.y, shown, levels=lines, colors="white", linewidths=1.2)
        drawn.set_path_effects(_HALO)
        for text in panel.clabel(drawn, fmt="%g", fontsize=8):
            text.set_path_effects(_HALO)
    worst = part.start + int(governing.level[part].argmax())
    _mark(panel, found, grid, worst)
    if found.study.building is not None:
        draw_building(
            panel, found.study.building, grid.on or next(iter(found.study.floor.surfaces))
        )
    panel.set(xlim=(x0, x1), ylim=(y0, y1), aspect="equal", xlabel="x [m]", ylabel="y [m]")
    panel.grid(visible=False)
    x, y, _ = found.where(worst)
    on = f"{grid.label}: " if grid.label else ""
    panel.set_title(f"{on}largest {governing.level[worst] / size:.3g} at ({x:.2f}, {y:.2f}) m")
    bar = figure.colorbar(image, ax=panel, location="bottom", shrink=0.6, aspect=40)
    bar.set_label(f"{level_words(found)}, {found.response.load.name}")
    ticks = [v * 10.0**k for k in range(-6, 6) for v in (1.0, 2.0, 5.0) if low < v * 10.0**k < high]
    bar.set_ticks(ticks, labels=[f"{tick:g}" for tick in ticks])
    bar.ax.minorticks_off()
    return figure


def _mark(panel: Axes, found: StudyFootfall, grid: MapGrid, worst: int) -> None:
    """Mark the worst place, and who walks there if it is on the same surface."""
    x, y, _ = found.where(worst)
    at_x, at_y, on = found.where(int(found.response.governing.walker[worst]))
    if on == grid.label:
        panel.plot(
            at_x, at_y, marker="o", markersize=11, color="none", markeredgecolor="#D55E00",
            markeredgewidth=1.6,
        )  # fmt: skip
    panel.plot(x, y, marker="X", markersize=7, color="black", markeredgecolor="white")


def _scale(levels: Array) -> tuple[float, float]:
    """Return the ends of a logarithmic scale: of two decades at most, for edges hardly move."""
    high = float(np.nanmax(levels)) if np.isfinite(levels).any() else 1.0
    low = max(float(np.nanmin(levels)) if np.isfinite(levels).any() else 0.1, 1e-2 * high)
    return (low, high) if low < high else (0.9 * high, 1.1 * high)

"""Draw buildings: a plan of each storey, elevations, and the first modes storey by storey."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch, Polygon
from matplotlib.path import Path
from matplotlib.tri import Triangulation

from trundle._typing import Array
from trundle._words import in_kmh
from trundle.report.canvas import COLOURS, Drawing, new_figure
from trundle.report.figures.routes import draw_route, draw_wheel_tracks
from trundle.report.figures.sources import draw_sources
from trundle.results.modes import FirstModes
from trundle.results.study_result import StudyResult
from trundle.structure.building import Building, Column, Slab, Wall
from trundle.structure.building.sheets import plane_of
from trundle.study.model import Study

__all__ = ["drawings", "storey_modes_figure"]

_SLAB, _PANEL, _BEAM, _WALL, _COLUMN = "#E8E8E8", "#CFCFCF", "#9A9A9A", "#5A5A5A", "#222222"
_MODES = 4  # drawn side by side
_MARGIN = 0.12  # of the larger side, round a plan, for names of grid lines and dimensions


def drawings(result: StudyResult) -> Iterator[Drawing]:
    """Give the plan of each storey and ramp, two elevations, and the first modes.

    Yields
    ------
    Drawing
        One after the other, as they stand on the page; none for a floor that is no building.
    """
    study, modes, building = result.study, result.modes, result.study.building
    if building is None:
        return
    for i, name in enumerate(study.floor.surfaces, start=1):
        yield Drawing(
            name=f"plan_{i}",
            title=f"Plan of {name}",
            caption="Slabs (grey, panels darker), beams under them, columns (black), walls, "
            "routes with their direction and speed, and points where the response is read.",
            draw=lambda name=name: storey_figure(study, building, name),
        )
    yield Drawing(
        name="elevation",
        title="Elevations",
        caption="The whole building seen along y and along x: slabs, ramps, columns and walls.",
        draw=lambda: elevation_figure(building),
    )
    if modes is not None:
        yield Drawing(
            name="storey_modes",
            title="First modes of the building",
            caption="Vertical motion of every storey, red up and blue down, on one scale a mode.",
            draw=lambda: storey_modes_figure(study, modes),
        )


def storey_figure(study: Study, building: Building, name: str) -> Figure:
    """Draw the plan of one storey or ramp."""
    low, high = _range(building, name)
    size = high - low
    figure, (axes,) = new_figure(6.8, float(np.clip(1.0 + 6.0 * size[1] / size[0], 2.6, 8.5)))
    for slab in _slabs(building, name):
        axes.add_patch(_area(slab))
    _draw_members(axes, building, name)
    _draw_grid(axes, building, low, high)
    for i, (route, drive) in enumerate(study.drives.items()):
        line = study.way_in_plan(drive.route, name)
        if len(line):
            draw_wheel_tracks(axes, study, drive, COLOURS[i % 6], on=name)
            draw_route(axes, line, f"{route}, {in_kmh(drive.route.law.fastest)}", i)
    draw_sources(axes, study, study.sources, on=name, labels=True)
    for point, spot in study.points.items():
        if spot.on in (name, None):
            place = study.in_plan(np.array([[spot.x, spot.y]]), spot.on)[0]
            axes.plot(*place, marker="X", markersize=9, color="black", linestyle="none", zorder=6)
            axes.annotate(
                point, place, xytext=(7, 6), textcoords="offset points", weight="bold", zorder=6
            )
    if building.north is not None:
        _draw_north(axes, building.north)
    margin = _MARGIN * float(size.max())
    axes.set(xlim=(low[0] - margin, high[0] + margin), ylim=(low[1] - margin, high[1] + margin))
    axes.set(aspect="equal", xlabel="x [m]", ylabel="y [m]", title=_level_words(building, name))
    axes.grid(visible=False)
    return figure


def _slabs(building: Building, name: str) -> list[Slab]:
    """Return what is to be seen of a storey's slabs, or a ramp, panels last."""
    some = [slab for slab in building.slabs if slab.on == name]
    ramps = [
        Slab(on=name, section=r.section, outline=r.outline)
        for r in building.ramps
        if r.name == name
    ]
    return sorted([*some, *ramps], key=lambda slab: slab.panel)


def _range(building: Building, name: str) -> tuple[Array, Array]:
    """Return the lowest and the highest x and y of a storey [m]."""
    corners = [slab.outline for slab in _slabs(building, name)]
    corners += [beam.along for beam in building.beams if beam.on == name]
    places = np.concatenate(corners)
    return places.min(axis=0), places.max(axis=0)


def _area(slab: Slab) -> PathPatch:
    """Return a slab with its openings cut out."""
    rings = [_turned(slab.outline, 1.0), *(_turned(hole, -1.0) for hole in slab.openings)]
    places = np.concatenate([np.vstack([ring, ring[:1]]) for ring in rings])
    codes = [
        code
        for ring in rings
        for code in (Path.MOVETO, *[Path.LINETO] * (len(ring) - 1), Path.CLOSEPOLY)
    ]
    colour = _PANEL if slab.panel else _SLAB
    return PathPatch(Path(places, codes), facecolor=colour, edgecolor="black", linewidth=0.9)


def _turned(ring: Array, sense: float) -> Array:
    """Return a ring in the sense asked for: counterclockwise if positive."""
    x, y = ring.T
    area = float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))
    return ring if area * sense > 0.0 else ring[::-1]


def _draw_members(axes: Axes, building: Building, name: str) -> None:
    for beam in building.beams:
        if beam.on == name:
            for pair in pairwise(beam.along):
                axes.add_patch(_bar(np.stack(pair), beam.profile.width, _BEAM, alpha=0.75))
    for wall in building.walls:
        if _stands_on(building, wall, name):
            axes.add_patch(_bar(wall.along, wall.section.thickness, _WALL))
    for column in building.columns:
        if _stands_on(building, column, name):
            axes.add_patch(Polygon(column.footprint, facecolor=_COLUMN, zorder=3))
    _draw_edges(axes, building, name)
    for ramp in building.ramps:
        if name in (ramp.bottom, ramp.top):
            axes.add_patch(
                Polygon(ramp.outline, fill=False, edgecolor="#7F7F7F", hatch="//", linewidth=0.5)
            )
            axes.annotate(
                f"{ramp.name}, up",
                ramp.outline[2:].mean(axis=0),
                xytext=ramp.outline[:2].mean(axis=0),
                bbox={"facecolor": "white", "edgecolor": "none", "pad": 1.0},
                arrowprops={"arrowstyle": "-|>", "color": "#555555"},
                color="#555555",
                fontsize=7,
                ha="center",
            )


def _draw_edges(axes: Axes, building: Building, name: str) -> None:
    """Draw supports dotted, joints dashed."""
    lines = [(s.along, "#B22222", ":") for s in building.supports if s.on == name]
    for joint in building.joints:
        lines += [(line, "#7B3294", "--") for line in (joint.along, joint.to) if joint.on == name]
    for line, colour, dashes in lines:
        axes.plot(*line.T, color=colour, linewidth=2.0, linestyle=dashes, zorder=4)


def _stands_on(building: Building, part: Column | Wall, name: str) -> bool:
    return name in {storey.name for storey in building.between(part.bottom, part.top)}


def _bar(line: Array, width: float, colour: str, alpha: float = 1.0) -> Polygon:
    """Return a member in plan, as wide as it is."""
    along = (line[1] - line[0]) / np.linalg.norm(line[1] - line[0])
    aside = 0.5 * width * np.array([-along[1], along[0]])
    corners = [line[0] - aside, line[1] - aside, line[1] + aside, line[0] + aside]
    return Polygon(np.array(corners), facecolor=colour, alpha=alpha, linewidth=0.0, zorder=2)


def _draw_grid(axes: Axes, building: Building, low: Array, high: Array) -> None:
    """Draw grid lines with their names, and what they are apart."""
    gap = 0.45 * _MARGIN * float((high - low).max())
    for axis in (0, 1):
        level = {
            name: float(ends[0, axis])
            for name, ends in building.grid.items()
            if abs(ends[0, axis] - ends[1, axis]) < 1e-9
            and low[axis] - 1e-6 <= ends[0, axis] <= high[axis] + 1e-6
        }
        for name, at in level.items():
            ends = np.array([low - gap, high + gap])
            ends[:, axis] = at
            axes.plot(*ends.T, color="#7F7F7F", linewidth=0.5, linestyle="-.", zorder=1)
            look = {"boxstyle": "circle,pad=0.25", "facecolor": "white", "edgecolor": "#7F7F7F"}
            axes.text(
                ends[1, 0],
                ends[1, 1],
                name,
                ha="center",
                va="center",
                fontsize=7,
                bbox=look,
                zorder=5,
            )
        for start, end in pairwise(sorted(level.values())):
            middle = low - 0.7 * gap
            middle[axis] = 0.5 * (start + end)
            turn = 90 if axis else 0
            axes.text(
                middle[0],
                middle[1],
                f"{end - start:g}",
                ha="center",
                va="center",
                fontsize=7,
                rotation=turn,
            )


def _draw_north(axes: Axes, north: float) -> None:
    angle = np.deg2rad(90.0 + north)
    tail, length = np.array([0.95, 0.93]), 0.05
    tip = tail + length * np.array([np.cos(angle), np.sin(angle)])
    axes.annotate(
        "N",
        (2.0 * tail[0] - tip[0], 2.0 * tail[1] - tip[1]),
        xytext=(tip[0], tip[1]),
        xycoords="axes fraction",
        textcoords="axes fraction",
        arrowprops={"arrowstyle": "<|-", "color": "black"},
        ha="center",
        va="center",
        fontsize=8,
    )


def _level_words(building: Building, name: str) -> str:
    for storey in building.storeys:
        if storey.name == name:
            return f"{name}, level {storey.level:+g} m"
    ramp = next(r for r in building.ramps if r.name == name)
    return f"{name}, from {ramp.bottom} to {ramp.top}"


def elevation_figure(building: Building) -> Figure:
    """Draw the building seen along y and along x, everything in one plane."""
    figure, panels = new_figure(7.6, 3.4, columns=2)
    for axis, panel in enumerate(panels):
        _elevation(panel, building, axis)
    return figure


def _elevation(axes: Axes, building: Building, axis: int) -> None:
    for wall in building.walls:
        low, high = building.level(wall.bottom), building.level(wall.top)
        x = sorted(wall.along[:, axis])
        axes.fill_between(x, low, high, color=_WALL, alpha=0.25, linewidth=0.6)
    for column in building.columns:
        x = column.footprint[:, axis]
        low, high = building.level(column.bottom), building.level(column.top)
        axes.fill_between([x.min(), x.max()], low, high, color="#B0B0B0", linewidth=0.0)
    for brace in building.braces:
        z = [_height(building, *end) for end in zip(brace.on, brace.ends, strict=True)]
        axes.plot(brace.ends[:, axis], z, color=_BEAM, linewidth=1.2)
    for beam in building.beams:
        if beam.on in {s.name for s in building.storeys}:
            top = building.level(beam.on)
            x = beam.along[:, axis]
            axes.fill_between(
                [x.min(), max(x.max(), x.min() + beam.profile.width)],
                top - beam.profile.depth, top, color=_BEAM, alpha=0.4, linewidth=0.0,
            )  # fmt: skip
    for slab in building.slabs:
        half, level = 0.5 * slab.section.thickness, building.level(slab.on)
        x = slab.outline[:, axis]
        axes.fill_between([x.min(), x.max()], level - half, level + half, color="#555555")
    for ramp in building.ramps:
        z = np.repeat([building.level(ramp.bottom), building.level(ramp.top)], 2)
        places = np.column_stack([ramp.outline[:, axis], z])
        look = {"facecolor": COLOURS[1], "edgecolor": COLOURS[1], "alpha": 0.6}
        axes.add_patch(Polygon(places, linewidth=2.0, **look))  # pyright: ignore[reportArgumentType]
    right = axes.get_xlim()[1]
    for storey in building.storeys:
        axes.axhline(storey.level, color="#B0B0B0", linewidth=0.5, linestyle=":", zorder=0.5)
        words = f"{storey.name} {storey.level:+g} m"
        axes.text(right, storey.level, f" {words}", ha="left", va="center", fontsize=7)
    axes.set(xlabel=f"{'xy'[axis]} [m]", ylabel="z [m]", title=f"seen along {'yx'[axis]}")
    axes.margins(y=0.12)
    axes.grid(visible=False)


def _height(building: Building, on: str, place: Array) -> float:
    """Return how high a storey or ramp is at a place [m]."""
    for ramp in building.ramps:
        if ramp.name == on:
            return float(plane_of(building, ramp) @ [1.0, *place])
    return building.level(on)


def storey_modes_figure(study: Study, modes: FirstModes) -> Figure:
    """Draw the vertical motion of every storey in the first modes."""
    names, n = list(study.floor.surfaces), min(_MODES, modes.n_modes)
    rise = [np.ptp(study.floor.surfaces[name].extent, axis=0) for name in names]
    heights = [float(np.clip(1.7 * r[1] / r[0], 0.5, 3.0)) + 0.25 for r in rise]
    figure = Figure(figsize=(7.6, 0.6 + sum(heights)), layout="constrained")
    grid = figure.subplots(len(names), n, squeeze=False, height_ratios=heights)
    panels: list[Axes] = list(grid.ravel())
    for row, name in enumerate(names):
        surface = study.floor.surfaces[name]
        faces = _faces([elements for _, elements in surface.parts])
        mesh = Triangulation(surface.nodes[:, 0], surface.nodes[:, 1], faces)
        for i in range(n):
            panel = panels[row * n + i]
            w = modes.vertical[:, i] / max(np.abs(modes.vertical[:, i]).max(), 1e-300)
            panel.tripcolor(
                mesh, w, cmap="RdBu_r", vmin=-1, vmax=1, shading="gouraud", rasterized=True
            )
            used = surface.nodes[np.unique(faces)]
            panel.set(aspect="equal", xlim=_padded(used[:, 0]), ylim=_padded(used[:, 1]))
            panel.set_title(f"{i + 1}: {modes.frequencies[i]:.2f} Hz" if row == 0 else "")
            panel.set_ylabel(name if i == 0 else "")
            panel.tick_params(labelbottom=row == len(names) - 1, labelleft=i == 0)
            panel.grid(visible=False)
    figure.supxlabel("x [m]", fontsize=9)
    return figure


def _padded(values: Array) -> tuple[float, float]:
    return float(values.min()) - 0.5, float(values.max()) + 0.5


def _faces(parts: Sequence[Array]) -> Array:
    """Return elements as triangles, by node numbers."""
    return np.vstack(
        [
            elements[:, [0, i, i + 1]]
            for elements in parts
            for i in range(1, max(2, elements.shape[1] - 1))
            if elements.shape[1] > 2
        ]
    )

"""Draw vehicles: where they stand, how they vibrate, how hard they press."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from trundle._typing import Array
from trundle._words import in_kmh
from trundle.report.canvas import COLOURS, Drawing, legend_below, line_look, new_figure
from trundle.results.study_result import StudyResult
from trundle.road import FeaturedRoad, Road, RoadClass, RoughnessBand
from trundle.route import Ramp, Route
from trundle.simulate import Crossing, Modal, contact_forces
from trundle.simulate.step_limits import longest_step
from trundle.vehicle import GRAVITY, Vehicle

__all__ = ["drawings"]

_LABEL = 0.18  # of a vehicle's length: the width of an axle's label in its picture
_ROW = 1.7  # height of a row of labels there
_MOST_STEPS = 50_000  # drawn: of a very stiff vehicle the beginning


def drawings(result: StudyResult) -> Iterator[Drawing]:
    """Give every vehicle, its natural motions, and how hard it presses at its speeds.

    Yields
    ------
    Drawing
        One after the other, as they stand on the page.
    """
    study = result.study
    road = _random_road(study.roads.values())
    speeds: dict[str, set[float]] = {}
    vehicles: dict[str, Vehicle] = {}
    for drive in study.drives.values():
        vehicles.setdefault(drive.vehicle.name, drive.vehicle)
        speeds.setdefault(drive.vehicle.name, set()).add(drive.route.law.fastest)
    for number, (name, vehicle) in enumerate(vehicles.items()):
        end = f"_{number + 1}" if number else ""
        at = sorted({*speeds[name], *study.force_speeds})
        yield Drawing(
            name=f"vehicle{end}",
            title=f"Vehicle: {name}",
            caption=f"Contacts with static loads, springs and dampers. Source: {vehicle.source}.",
            draw=lambda one=vehicle: vehicle_figure(one, study.report.load),
        )
        yield Drawing(
            name=f"vehicle_modes{end}",
            title=f"Natural frequencies: {name}",
            caption="Motion over each axle on rigid ground, largest set to 1.",
            draw=lambda one=vehicle: vehicle_modes_figure(one),
        )
        if not vehicle.is_linear:
            continue  # its forces by exact steps would be another's
        yield Drawing(
            name=f"axle_forces{end}",
            title=f"Dynamic axle forces: {name}",
            caption="Contact forces on rigid ground without the static load, one realisation of a "
            f"road of {road}.",
            draw=lambda one=vehicle, at=at: axle_forces_figure(
                one, road, study.band, at, seed=study.seed, unit=study.report.load
            ),
        )


def _random_road(roads: Iterable[Road]) -> Road:
    """Return the first road that is random, without joints; class A where none is."""
    bare = (one.base if isinstance(one, FeaturedRoad) else one for one in roads)
    return next((one for one in bare if not one.is_given), RoadClass("A"))


def vehicle_figure(vehicle: Vehicle, unit: str = "t") -> Figure:
    """Draw contacts, springs and static loads of a vehicle; these in t or kN."""
    size = _load(unit)
    length = max(vehicle.length, 1.0)
    rows = _label_rows(vehicle.setback, _LABEL * length)
    low = -1.9 - _ROW * max(rows)
    figure, (axes,) = new_figure(7.2, 2.8 * (2.8 - low) / 4.7)
    axes.add_patch(_box(-0.06 * length, 1.2, 1.12 * length, 1.0))
    axes.text(
        0.5 * length,
        1.7,
        f"{vehicle.name}\n{vehicle.total_mass / 1e3:.2f} t",
        ha="center",
        va="center",
    )
    for i, place in enumerate(vehicle.setback):
        _spring(axes, float(place))
        load = vehicle.static_forces[i] / size
        text = (
            f"{vehicle.contact_names[i]}\n{load:.2f} {unit}\n"
            f"k = {vehicle.contact_stiffness[i] / 1e6:.3g} MN/m\n"
            f"c = {vehicle.contact_damping[i] / 1e3:.3g} kN s/m"
        )
        axes.text(place, -0.25 - _ROW * rows[i], text, ha="center", va="top", fontsize=8)
    axes.axhline(0.0, color="black", linewidth=1.0)
    axes.annotate(
        "direction of travel",
        (-0.10 * length, 2.55),
        xytext=(0.35 * length, 2.55),
        arrowprops={"arrowstyle": "->"},
        va="center",
    )
    axes.set(
        xlim=(-0.18 * length, 1.18 * length),
        ylim=(low, 2.8),
        xlabel="distance behind the front axle [m]",
        yticks=[],
    )
    axes.grid(visible=False)
    axes.spines["left"].set_visible(False)
    return figure


def _load(unit: str) -> float:
    """Return the size of a unit of loads, t or kN [N]."""
    return {"t": 1e3 * GRAVITY, "kN": 1e3}[unit]


def _label_rows(places: Array, width: float) -> list[int]:
    """Return in which row the label at each place stands, so that none covers another."""
    rows: list[int] = []
    ends: list[float] = []  # of the last label in each row
    for place in places:
        row = next((i for i, end in enumerate(ends) if place - end >= width), len(ends))
        ends[row : row + 1] = [float(place)]
        rows.append(row)
    return rows


def _box(x: float, y: float, width: float, height: float) -> Rectangle:
    return Rectangle((x, y), width, height, facecolor="#EFEFEF", edgecolor="black")


def _spring(axes: Axes, place: float) -> None:
    z = np.linspace(0.0, 1.2, 13)
    side = 0.16 * np.where(np.arange(13) % 2 == 0, -1.0, 1.0)
    side[[0, 1, -2, -1]] = 0.0
    axes.plot(place + side, z, color=COLOURS[0])
    axes.plot([place], [0.0], marker="o", color="black")


def vehicle_modes_figure(vehicle: Vehicle) -> Figure:
    """Draw the natural frequencies with the motion over each axle."""
    frequencies, shapes = vehicle.mode_shapes()
    n_shown = min(len(frequencies), 6)
    figure, axes = new_figure(7.2, 2.6, columns=n_shown, share="y")
    for i, panel in enumerate(axes):
        panel.axhline(0.0, color="black", linewidth=0.8)
        panel.bar(range(1, vehicle.n_contacts + 1), shapes[:, i], color=COLOURS[i], width=0.5)
        panel.set(
            title=f"{frequencies[i]:.2f} Hz",
            xlabel="axle",
            xticks=range(1, vehicle.n_contacts + 1),
            ylim=(-1.15, 1.15),
        )
    axes[0].set_ylabel("relative motion")
    return figure


def axle_forces_figure(
    vehicle: Vehicle,
    road: Road,
    band: RoughnessBand,
    speeds: Sequence[float],
    *,
    seed: int,
    duration: float = 25.0,
    unit: str = "t",
) -> Figure:
    """Draw the dynamic axle forces of one run at several speeds [m/s]."""
    figure, axes = new_figure(7.2, 1.9 * len(speeds) + 0.3, rows=len(speeds), share="xy")
    for panel, speed in zip(axes, speeds, strict=True):
        route = Route.straight((0.0, 0.0), (1.0, 0.0), speed=speed, name="force")
        crossing = Crossing(
            vehicle=vehicle, route=route, road=road, band=band, entry=Ramp(length=1.0)
        )
        dt = min(0.005, 0.4 / (band.n_max * speed), longest_step(vehicle))
        time, forces = contact_forces(
            crossing,
            integration=Modal(f_max=100.0, dt=dt),
            n_runs=1,
            seed=seed,
            duration=min(duration, _MOST_STEPS * dt),
        )
        for i in reversed(range(vehicle.n_contacts)):
            dynamic = (forces[0, :, i] - vehicle.static_forces[i]) / _load(unit)
            colour, dashes = line_look(i)
            name = vehicle.contact_names[i]
            panel.plot(time, dynamic, color=colour, linestyle=dashes, linewidth=0.8, label=name)
        panel.set(ylabel=f"force [{unit}]", title=f"{in_kmh(speed)}, {road}", xlim=(0.0, duration))
    handles, labels = axes[0].get_legend_handles_labels()
    legend_below(figure, handles[::-1], labels[::-1], columns=6)
    axes[-1].set_xlabel("time [s]")
    return figure

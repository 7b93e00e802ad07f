"""Draw a vehicle's sheet: to scale with its loads, its modes, its forces on a class A road."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.patches import Circle, FancyBboxPatch

from trundle.report.canvas import COLOURS, make_logarithmic
from trundle.road import FITTED_RANGE, RoadClass
from trundle.vehicle import Description, Vehicle

__all__ = ["vehicle_sheet"]

_HEAVY = 30e3  # N on an axle, from which its wheels are drawn as a truck's
_SMALL = 8e3  # N, below which they are an AGV's
_F = np.geomspace(0.5, 80.0, 800)
_MODES = 6


def vehicle_sheet(described: Description, vehicle: Vehicle, speed: float) -> Figure:
    """Draw a vehicle from the side, its modes, and its dynamic forces.

    Parameters
    ----------
    described : Description
        Its parts.
    vehicle : Vehicle
        The same, built.
    speed : float
        At which it is driven over the road [m/s].
    """
    figure = Figure(figsize=(8.2, 7.6), layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.subplot_mosaic(
        [["side", "side"], ["modes", "force"]], height_ratios=(1.0, 1.1), width_ratios=(1.0, 1.25)
    )
    _side(axes["side"], described, vehicle)
    _modes(axes["modes"], vehicle)
    _forces(axes["force"], vehicle, speed)
    return figure


def _side(axes: Axes, described: Description, vehicle: Vehicle) -> None:
    """Draw bodies over their axles, wheels and axle loads, as long as high."""
    places, loads, names = _axles(vehicle)
    apart = float(np.diff(np.sort(places)).min(initial=2.0))
    radius = [min(_radius(load), 0.22 * apart) for load in loads]
    top = 2.0 * max(radius)
    front = min(
        *(a.setback for a in described.axles), *(b.setback for b in described.bogies), 1e9, 1e9
    )
    for number, body in enumerate(described.bodies):
        at = [a.setback - front for a in described.axles if a.body == number]
        at += [b.setback - front for b in described.bogies if b.body == number]
        at += [h.setback - front for h in described.hinges if number in h.bodies]
        if not at:
            continue
        over = 1.4 * max(radius)
        low, high = min(at) - over, max(at) + over
        height = 0.16 * max(vehicle.length, 3.0)
        axes.add_patch(
            FancyBboxPatch(
                (low, 0.8 * top), high - low, height, boxstyle="round,pad=0,rounding_size=0.08",
                facecolor="#EAF1F7", edgecolor="black", alpha=0.9,
            )
        )  # fmt: skip
        axes.plot([body.centre - front], [0.8 * top + 0.5 * height], marker="+", color="black")
        axes.annotate(
            f"{body.mass / 1e3:.3g} t", (body.centre - front, 0.8 * top + 0.5 * height),
            xytext=(0, 7), textcoords="offset points", ha="center", fontsize=8,
        )  # fmt: skip
    width = (max(places) - min(places) + 2.0) or 3.0
    rows = _rows(places, 0.13 * width)
    for place, load, name, r, row in zip(places, loads, names, radius, rows, strict=True):
        axes.add_patch(Circle((place, r), r, facecolor="#4D4D4D", edgecolor="black"))
        axes.add_patch(Circle((place, r), 0.5 * r, facecolor="#BFBFBF", edgecolor="none"))
        axes.annotate(
            f"{name}\n{load / 1e3:.4g} kN", (place, 0.0), xytext=(0, -7 - 24 * row),
            textcoords="offset points", ha="center", va="top", fontsize=8,
        )  # fmt: skip
    axes.axhline(0.0, color="black", linewidth=1.0)
    for hinge in described.hinges:
        axes.plot([hinge.setback - front], [0.9 * top], marker="o", color=COLOURS[1], zorder=5)
    axes.set_title(f"{vehicle.name} ({vehicle.total_mass / 1e3:.4g} t)")
    axes.set_xlabel("behind the front axle [m]; travels to the left")
    axes.spines["bottom"].set_position(("outward", 34 + 24 * max(rows)))
    axes.set_aspect("equal")
    margin = 0.12 * width + 2.0 * max(radius)
    axes.set_xlim(min(places) - margin, max(places) + margin)
    axes.set_ylim(0.0, 0.8 * top + 0.2 * max(vehicle.length, 3.0))
    axes.set_yticks([])
    axes.spines["left"].set_visible(False)
    axes.grid(visible=False)


def _axles(vehicle: Vehicle) -> tuple[list[float], list[float], list[str]]:
    """Return places, loads [N] and names of axles: both wheels of one together."""
    places: dict[float, tuple[float, str]] = {}
    for x, load, name in zip(
        vehicle.setback, vehicle.static_forces, vehicle.contact_names, strict=True
    ):
        before, _ = places.get(float(x), (0.0, ""))
        places[float(x)] = (before + float(load), name.removesuffix(" left").removesuffix(" right"))
    return list(places), [load for load, _ in places.values()], [n for _, n in places.values()]


def _radius(load: float) -> float:
    if load < _SMALL:
        return 0.13
    return 0.5 if load > _HEAVY else 0.3


def _rows(places: list[float], width: float) -> list[int]:
    """Return in which row the label at each place stands, so that none covers another."""
    rows: list[int] = []
    ends: list[float] = []
    for place in places:
        row = next((i for i, end in enumerate(ends) if place - end >= width), len(ends))
        ends[row : row + 1] = [place]
        rows.append(row)
    return rows


def _modes(axes: Axes, vehicle: Vehicle) -> None:
    """Draw the motion over each contact in each mode, its largest set to 1."""
    frequencies, shapes = vehicle.mode_shapes()
    count = min(len(frequencies), _MODES)
    wide = 0.8 / max(vehicle.n_contacts, 1)
    for i in range(vehicle.n_contacts):
        at = np.arange(count) + (i - 0.5 * (vehicle.n_contacts - 1)) * wide
        axes.bar(at, shapes[i, :count], width=0.9 * wide, color=COLOURS[i % len(COLOURS)])
    axes.axhline(0.0, color="black", linewidth=0.8)
    axes.set_xticks(range(count), [f"{f:.3g}" for f in frequencies[:count]])
    axes.set(xlabel="natural frequency [Hz]", ylabel="motion over each wheel", ylim=(-1.1, 1.1))
    axes.set_title("modes on rigid ground")


def _forces(axes: Axes, vehicle: Vehicle, speed: float) -> None:
    """Draw the amplitude spectral density of each contact's force on a road of class A."""
    transfer = vehicle.contact_force_transfer(_F, speed=speed)
    road = RoadClass("A").displacement_psd(_F / speed) / speed
    road = road * np.sinc(_F / speed * vehicle.contact_patch) ** 2
    for i, name in enumerate(vehicle.contact_names):
        axes.plot(
            _F, np.sqrt(road) * np.abs(transfer[:, i]) / 1e3, color=COLOURS[i % len(COLOURS)],
            label=f"{name}, {_share(road, transfer[:, i], vehicle.static_forces[i]):.1%} of static",
        )  # fmt: skip
    top = FITTED_RANGE[1] * speed
    if top < _F[-1]:
        axes.axvspan(top, _F[-1], color="#EEEEEE", zorder=0)
        axes.annotate(
            "class A extrapolated", (np.sqrt(top * _F[-1]), 0.02), ha="center", fontsize=7,
            xycoords=("data", "axes fraction"),
        )  # fmt: skip
    make_logarithmic(axes, "xy")
    axes.set(xlabel="frequency [Hz]", ylabel="dynamic force [kN/rtHz]", xlim=(_F[0], _F[-1]))
    patch = f", patch {vehicle.contact_patch:g} m" if vehicle.contact_patch else ", point contact"
    axes.set_title(f"class A at {3.6 * speed:.3g} km/h{patch}; RMS to 80 Hz")
    if vehicle.n_contacts <= 6:
        axes.legend(loc="lower left", fontsize=7, bbox_to_anchor=(0.0, 0.06), frameon=True)


def _share(road: np.ndarray, transfer: np.ndarray, static: float) -> float:
    """Return the RMS of a contact's dynamic force over its static one."""
    return float(np.sqrt(np.trapezoid(road * np.abs(transfer) ** 2, _F))) / float(static)

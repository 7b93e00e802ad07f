"""Draw routes in plan, and where wheels go if that is elsewhere than along the middle."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from trundle._typing import Array
from trundle.report.canvas import COLOURS
from trundle.route import Footprint, wheel_places
from trundle.study.model import Study
from trundle.study.plans import Drive

__all__ = ["draw_route", "draw_wheel_tracks"]

_A_METRE = 4  # places


def draw_wheel_tracks(
    axes: Axes, study: Study, drive: Drive, colour: str, *, on: str | None = None
) -> None:
    """Draw the track of every wheel in plan, thin.

    Parameters
    ----------
    axes : Axes
        A plan.
    study : Study
        Has the surfaces.
    drive : Drive
        Who drives where.
    colour : str
        That of the route.
    on : str, optional
        The surface that is drawn; a route on another is passed over.
    """
    route = drive.route
    vehicle = drive.vehicle.backwards() if route.reverse else drive.vehicle
    aside = np.any(vehicle.lateral) or (route.radius > 0.0 and route.steering == "tractrix")
    if not aside or route.surfaces or (on is not None and route.on not in (on, None)):
        return
    units = vehicle.units if route.steering == "tractrix" else ()
    footprint = Footprint(setback=vehicle.setback, lateral=vehicle.lateral, units=units)
    way = route.length + vehicle.length
    front = np.linspace(0.0, way, max(2, int(_A_METRE * way)))
    wheels = wheel_places(route, footprint, front)
    station = front[:, None] - vehicle.setback
    for contact in range(vehicle.n_contacts):
        there = (station[:, contact] >= 0.0) & (station[:, contact] <= route.length)
        line = study.in_plan(wheels.place[there, contact], route.on)
        axes.plot(*line.T, color=colour, linewidth=0.5, alpha=0.6, zorder=4)


def draw_route(axes: Axes, line: Array, name: str, i: int) -> None:
    """Draw a route in plan with an arrow at its end, and its name along its longest leg."""
    colour = COLOURS[i % 6]
    axes.plot(*line.T, color=colour, linewidth=2.0, zorder=4)
    look = {"arrowstyle": "-|>", "color": colour, "linewidth": 2.0}
    axes.annotate("", line[-1], xytext=line[-2], arrowprops=look, zorder=4)
    lengths = np.linalg.norm(np.diff(line, axis=0), axis=1)
    leg = int(lengths.argmax())
    along = line[leg + 1] - line[leg]
    angle = np.degrees(np.arctan2(along[1], along[0]))
    axes.annotate(
        name,
        line[leg] + 0.6 * along,
        rotation=angle if -90.0 < angle <= 90.0 else angle + 180.0,
        rotation_mode="anchor",
        ha="center",
        va="bottom",
        color=colour,
        bbox={"facecolor": "white", "edgecolor": "none", "pad": 1.0, "alpha": 0.8},
        zorder=5,
    )

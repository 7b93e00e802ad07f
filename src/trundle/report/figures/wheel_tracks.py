"""Draw where wheels go, if that is elsewhere than along the middle of their route."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from trundle.route import Footprint, wheel_places
from trundle.study.model import Study
from trundle.study.plans import Drive

__all__ = ["draw_wheel_tracks"]

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

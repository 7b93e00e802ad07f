"""Say where every contact of a source is: along its way, and from there on a surface."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from trundle._typing import Array
from trundle.route.entry import Entry
from trundle.route.path import Route
from trundle.route.steering import Footprint, wheel_places

__all__ = ["Along", "Track", "follow"]


@dataclass(frozen=True, kw_only=True, eq=False)
class Along:
    """Hold how far contacts have come along a way.

    Attributes
    ----------
    time : ndarray of float, shape (n_times,)
        Times [s].
    station : ndarray of float, shape (n_times, n_contacts)
        Station of each contact [m].
    speed : ndarray of float, shape (n_times, n_contacts)
        Its speed [m/s].
    """

    time: Float[Array, " times"]
    station: Float[Array, "times contacts"]
    speed: Float[Array, "times contacts"]


@dataclass(frozen=True, kw_only=True, eq=False)
class Track:
    """Hold where contacts are: what stands on a structure reads only this.

    Attributes
    ----------
    on : str or None
        Name of the surface; None for the only one.
    place, direction : ndarray of float, shape (n_times, n_contacts, 2)
        Places on it [m], and unit directions of travel; in plan where there are several.
    speed : ndarray of float, shape (n_times, n_contacts)
        Speed along the direction [m/s].
    share, share_slope : ndarray of float, shape (n_times, n_contacts)
        Share of a contact's force that the structure carries, and its slope along the way [1/m].
    surfaces : tuple of str
        Names of the surfaces of a way through several; empty of a way on one.
    which : ndarray of int or None, shape (n_times, n_contacts)
        On which of these each contact is.
    """

    on: str | None
    place: Float[Array, "times contacts 2"]
    direction: Float[Array, "times contacts 2"]
    speed: Float[Array, "times contacts"]
    share: Float[Array, "times contacts"]
    share_slope: Float[Array, "times contacts"]
    surfaces: tuple[str, ...] = ()
    which: Int[Array, "times contacts"] | None = None


def follow(
    route: Route, entry: Entry, footprint: Footprint, along: Along, *, leaves: bool = True
) -> Track:
    """Follow a route with every contact.

    Parameters
    ----------
    route : Route
        The way.
    entry : Entry
        How wheels come onto the floor, and leave it.
    footprint : Footprint
        Where contacts are on the vehicle.
    along : Along
        How far they have come.
    leaves : bool
        Whether the way ends at the floor's edge, where wheels leave; not where it ends inside.
    """
    station = along.station
    front = station[:, 0] + footprint.setback[0]
    wheels = wheel_places(route, footprint, front)
    share, share_slope = entry.share(station, route.length if leaves else np.inf)
    # a wheel that cuts a corner comes less far than the station says: slopes are along its own way
    stretch = np.where(wheels.stretch > 0.0, wheels.stretch, 1.0)
    return Track(
        on=route.on,
        place=wheels.place,
        direction=wheels.direction,
        speed=along.speed * wheels.stretch,
        share=share,
        share_slope=share_slope / stretch,
        surfaces=tuple(str(one) for one in route.visited) if route.surfaces else (),
        which=route.leg_of(station) if route.surfaces else None,
    )

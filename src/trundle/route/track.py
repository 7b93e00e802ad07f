"""Say where every contact of a source is: along its way, and from there on a surface."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from trundle._typing import Array
from trundle.route.entry import Entry
from trundle.route.path import Route

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
        Places on it [m], and unit directions of travel.
    speed : ndarray of float, shape (n_times, n_contacts)
        Speed along the direction [m/s].
    share, share_slope : ndarray of float, shape (n_times, n_contacts)
        Share of a contact's force that the structure carries, and its slope along the way [1/m].
    """

    on: str | None
    place: Float[Array, "times contacts 2"]
    direction: Float[Array, "times contacts 2"]
    speed: Float[Array, "times contacts"]
    share: Float[Array, "times contacts"]
    share_slope: Float[Array, "times contacts"]


def follow(route: Route, entry: Entry, lateral: Float[Array, " contacts"], along: Along) -> Track:
    """Follow a route with every contact, each at its distance to the left of the line [m]."""
    station = along.station
    place, direction = np.empty((*station.shape, 2)), np.empty((*station.shape, 2))
    for i, aside in enumerate(lateral):
        place[:, i], direction[:, i] = route.locate(station[:, i], aside)
    share, share_slope = entry.share(station, route.length)
    return Track(
        on=route.on,
        place=place,
        direction=direction,
        speed=along.speed,
        share=share,
        share_slope=share_slope,
    )

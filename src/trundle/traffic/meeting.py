"""Say what is left out where two vehicles on a floor are added up instead of run together."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import pairwise

import numpy as np

from trundle._typing import Array
from trundle.simulate import Layout, PreparedFloor, batches, lay_out
from trundle.simulate.sources.crossing import TAIL
from trundle.structure import Spot
from trundle.traffic.timetable import Departures

__all__ = ["closest_meeting", "lay_out_meeting", "meeting_error"]


def closest_meeting(
    layouts: Mapping[str, Layout], departures: Departures
) -> tuple[str, str, float] | None:
    """Return the two vehicles that depart closest after each other and meet on the floor.

    Parameters
    ----------
    layouts : mapping of str to Layout
        One passage on each route.
    departures : Departures
        Who departs when.

    Returns
    -------
    tuple or None
        Route of the first and of the second, and how much later that departs [s].
    """
    leaves = {name: max(s.leaves for s in one.sources) for name, one in layouts.items()}
    vehicles = {
        name for name, one in layouts.items() if all(s.oscillator is not None for s in one.sources)
    }
    found: tuple[str, str, float] | None = None
    names = [departures.route[i] for i in departures.which]
    driving = [(t, n) for t, n in zip(departures.time, names, strict=True) if n in vehicles]
    for (earlier, first), (later, second) in pairwise(driving):
        gap = float(later - earlier)
        if gap < leaves[first] and (found is None or gap < found[2]):
            found = (first, second, gap)
    return found


def lay_out_meeting(
    floor: PreparedFloor,
    layouts: Mapping[str, Layout],
    departures: Departures,
    points: Mapping[str, Spot],
) -> Layout | None:
    """Lay out the closest meeting of a day, both vehicles at once.

    Parameters
    ----------
    floor : PreparedFloor
        The floor.
    layouts : mapping of str to Layout
        One passage on each route.
    departures : Departures
        Who departs when.
    points : mapping of str to Spot
        Where the response is read.

    Returns
    -------
    Layout or None
        None where nobody meets, or vehicles do not feel the floor.
    """
    met = closest_meeting(layouts, departures)
    if met is None or not layouts[met[0]].method.moves:
        return None
    first, second, gap = met
    method = layouts[first].method
    dt = method.integration.dt
    both = (layouts[first].sources[0], layouts[second].sources[0].later(round(gap / dt) * dt))
    length = both[0].leaves + TAIL
    return lay_out(floor, both, method=method, points=points, duration=length)


def meeting_error(
    layouts: Mapping[str, Layout], departures: Departures, meeting: Layout | None, *, seed: int
) -> float:
    """Return by how much the closest meeting differs if both are run together.

    Parameters
    ----------
    layouts : mapping of str to Layout
        One passage on each route.
    departures : Departures
        Who departs when.
    meeting : Layout or None
        Both at once, from `lay_out_meeting`.
    seed : int
        Seed of all roads.

    Returns
    -------
    float
        RMS of the difference over RMS of the velocity at a point, the largest of all; 0 where
        vehicles do not feel the floor, NaN where none meet.
    """
    met = closest_meeting(layouts, departures)
    if met is None:
        return np.nan
    if meeting is None:
        return 0.0
    first, second, gap = met
    late = round(gap / meeting.integration.dt)
    together = _velocity(meeting, seed)
    alone = {name: _velocity(layouts[name], seed) for name in dict.fromkeys((first, second))}
    n = len(together)
    other = np.concatenate([np.zeros((late, together.shape[1])), alone[second]])[:n]
    n = min(n, len(alone[first]), len(other))
    left_out = together[:n] - alone[first][:n] - other[:n]
    return float(np.max(_rms(left_out) / np.maximum(_rms(together[:n]), 1e-300)))


def _velocity(layout: Layout, seed: int) -> Array:
    """Return what the first run of a layout gives at the points."""
    return next(batches(layout, runs=range(1), seed=seed)).velocity[0]


def _rms(values: Array) -> Array:
    return np.sqrt(np.mean(values**2, axis=0))

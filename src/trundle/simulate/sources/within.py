"""Put in what a vehicle brings itself: wheels that are not round, forces on bodies, braking."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from trundle._typing import Array
from trundle.route import Along
from trundle.simulate.sources.crossing import Crossing

__all__ = ["forces_within", "lifts_of_wheels"]


def lifts_of_wheels(crossing: Crossing, along: Along) -> Float[Array, "2 times contacts"] | None:
    """Return by how much wheels that are not round lift [m], and its slope; None where all are."""
    vehicle = crossing.vehicle
    if not vehicle.rounds:
        return None
    out = np.zeros((2, *along.station.shape))
    for one in vehicle.rounds:
        contacts = range(vehicle.n_contacts - vehicle.inner) if one.axle is None else [one.axle]
        for i in contacts:
            height, slope = one.lift(along.station[:, i])
            out[0, :, i] += height
            out[1, :, i] += slope
    return out


def forces_within(crossing: Crossing, along: Along) -> Float[Array, "times inner"]:
    """Return what acts within a vehicle at each of its inner contacts: up on a body [N].

    An acceleration is told by its amount [m/s2]: the contact's row holds the masses and heights.
    """
    vehicle = crossing.vehicle
    if not vehicle.inner:
        return np.zeros((len(along.time), 0))
    front = along.station[:, 0] + vehicle.setback[0]
    # friction and stops are no known forces: who steps the vehicle finds them
    columns = [np.zeros(len(front)) for _ in vehicle.laws]
    columns += [force.force(along.time, front) for force in vehicle.forces]
    if len(columns) < vehicle.inner:
        # its mean over each step: where it jumps within one, its impulse stays
        law, clock = crossing.route.law, along.time - crossing.depart
        half = 0.5 * float(along.time[1] - along.time[0])
        columns.append((law.speed(clock + half) - law.speed(clock - half)) / (2.0 * half))
    return np.stack(columns, axis=1)

"""Put in what a vehicle brings itself: wheels that are not round, forces on bodies, braking."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from trundle._typing import Array
from trundle.errors import InputError
from trundle.route import Along
from trundle.simulate.sources.crossing import Crossing

__all__ = ["check_within", "forces_within", "lifts_of_wheels"]

_SHOWN = 0.4  # of the sampling frequency, up to which a step shows a wave


def check_within(crossing: Crossing, dt: float) -> None:
    """Refuse engines and wheels that shake faster than a step shows: they would look slow.

    Raises
    ------
    InputError
        A frequency above 0.4 of the steps a second.
    """
    vehicle, speed = crossing.driven, crossing.fastest
    turning = speed / (2.0 * np.pi)
    shaken = [(f"force {f.name!r}", f.frequency) for f in vehicle.forces if f.frequency]
    shaken += [
        (f"force {f.name!r}", turning * f.order / f.radius) for f in vehicle.forces if f.radius
    ]
    shaken += [("out_of_round", turning * r.order / r.radius) for r in vehicle.rounds]
    for what, frequency in shaken:
        if frequency > _SHOWN / dt:
            raise InputError(
                f"route {crossing.route.name!r}: {what} shakes at {frequency:.4g} Hz, and steps of "
                f"{1e3 * dt:g} ms show {_SHOWN / dt:.4g} Hz at most: shorten dt to "
                f"{1e3 * _SHOWN / frequency:.2g} ms"
            )


def lifts_of_wheels(crossing: Crossing, along: Along) -> Float[Array, "2 times contacts"] | None:
    """Return by how much wheels that are not round lift [m], and its slope; None where all are."""
    vehicle = crossing.driven
    if not vehicle.rounds:
        return None
    out = np.zeros((2, *along.station.shape))
    for one in vehicle.rounds:
        for i in vehicle.contacts_of(one.axle):
            height, slope = one.lift(along.station[:, i])
            out[0, :, i] += height
            out[1, :, i] += slope
    return out


def forces_within(crossing: Crossing, along: Along) -> Float[Array, "times inner"]:
    """Return what acts within a vehicle at each of its inner contacts: up on a body [N].

    An acceleration is told by its amount [m/s2]: the contact's row holds the masses and heights.
    """
    vehicle = crossing.driven
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

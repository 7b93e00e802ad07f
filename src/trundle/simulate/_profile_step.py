"""See whether a time step shows what a given profile does to a wheel."""

from __future__ import annotations

import numpy as np
from scipy import signal

from trundle._typing import Array
from trundle.errors import InputError
from trundle.road import Profile
from trundle.simulate.crossing import Crossing

__all__ = ["check_profile_step"]

_MISSED = 0.02  # of a wheel's static force, what a step may hide
_SPARSE = 4.0  # steps between two points of a profile, above which nothing is hidden
_FINE = 8  # samples a step on which the road is looked at
_STOP = 0.6  # waves a step at which the filter stops; half a wave is the most that a step shows
_TAPS = 18 * _FINE + 1  # 60 dB from half a wave to 0.7 waves a step
_CHUNK = 200_000  # samples looked at together
_AROUND = 40.0  # steps on either side of the worst place, tried with shorter steps
_HALVINGS = 8


def check_profile_step(
    crossing: Crossing, profile: Profile, needed: tuple[float, float], *, speed: float, dt: float
) -> None:
    """Refuse a time step between whose ends a profile rises and falls unseen.

    Parameters
    ----------
    crossing : Crossing
        Who drives.
    profile : Profile
        The road, averaged over the contact patch, and known everywhere.
    needed : tuple of float
        First and last station driven over [m].
    speed : float
        Largest speed [m/s].
    dt : float
        Time step [s].

    Notes
    -----
    The road is split at half a wave a step, the shortest that samples can hold (as with random
    roads). What is left above it, times a contact's stiffness, is a force that no step sees:
    2 % of the static force is allowed. For a damper, a tenth of what it would add within a step
    counts: kinks are within its reach, for the slope over them is a mean.
    """
    stride = speed * dt
    spacing = np.diff(profile.station)
    low, high = needed
    driven = (profile.station[1:] >= low) & (profile.station[:-1] <= high) & (spacing > 0.0)
    # a mirror image has its points at the same distances
    counted = spacing[spacing > 0.0] if profile.beyond == "mirror" else spacing[driven]
    if stride == 0.0 or counted.min(initial=np.inf) > _SPARSE * stride:
        return
    hidden, at = _hidden(profile, low, high, stride)
    if (force := _force(crossing, hidden, dt)) <= _MISSED:
        return
    area = (max(low, at - _AROUND * stride), min(high, at + _AROUND * stride))
    enough = dt
    for _ in range(_HALVINGS):
        enough *= 0.5
        if _force(crossing, _hidden(profile, *area, speed * enough)[0], enough) <= _MISSED:
            remedy = f"shorten the time step to {1e3 * enough:.2g} ms"
            break
    else:
        remedy = "draw the step's two stations apart by its chamfer"
    raise InputError(
        f"route {crossing.route.name!r}: near station {at:.6g} m the given profile rises or falls "
        f"by {1e3 * hidden:.2g} mm within the {1e3 * stride:.3g} mm that a wheel moves in a step "
        f"(dt = {1e3 * dt:g} ms at {speed:.3g} m/s), which hides {100 * force:.2g} % of a static "
        f"wheel force where at most {100 * _MISSED:g} % is allowed: {remedy}, or let the tyre "
        "average the road, RoughnessBand(contact_patch=0.2) or what it stands on"
    )


def _force(crossing: Crossing, hidden: float, dt: float) -> float:
    """Return the largest force of a hidden height, over the static force."""
    vehicle = crossing.vehicle
    stiff = np.maximum(vehicle.contact_stiffness, 0.1 * vehicle.contact_damping / dt)
    static = np.abs(vehicle.static_forces)
    carried = np.where(static > 0.0, static, max(float(static.mean()), 1e-300))
    return float((stiff / carried).max() * hidden)


def _hidden(profile: Profile, low: float, high: float, stride: float) -> tuple[float, float]:
    """Return the largest height above half a wave a step [m], and its station [m]."""
    step = stride / _FINE
    count = int(np.ceil((high - low) / step)) + 1
    most, where = 0.0, low
    for start in range(0, count, _CHUNK):
        inside = low + step * np.arange(start, min(start + _CHUNK, count) + 1)
        height, at = _hidden_in(profile, inside, step)
        if height > most:
            most, where = height, at
    return most, where


def _hidden_in(profile: Profile, inside: Array, step: float) -> tuple[float, float]:
    margin = step * np.arange(1, _TAPS // 2 + 1)
    wide = np.concatenate([inside[0] - margin[::-1], inside, inside[-1] + margin])
    z = profile.at(wide)[0]
    taps = signal.firwin(_TAPS, 2.0 * _STOP / _FINE, window=("kaiser", 5.65))
    shown = z[0] + signal.oaconvolve(z - z[0], taps, "valid")
    # a spike between two samples stands at a point of its own
    own = profile.station[(profile.station >= inside[0]) & (profile.station <= inside[-1])]
    s = np.concatenate([inside, own])
    above = np.abs(profile.at(s)[0] - np.concatenate([shown, np.interp(own, inside, shown)]))
    worst = int(np.argmax(above))
    return float(above[worst]), float(s[worst])

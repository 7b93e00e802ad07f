"""See whether a time step shows what a given profile does to a wheel."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import ndimage, signal

from trundle._typing import Array
from trundle.errors import InputError
from trundle.road import Profile
from trundle.simulate.sources.crossing import Crossing

__all__ = ["Hidden", "check_profile_step", "hidden_by_step"]

_MOST = 0.03  # of a wheel's static force, what a step may hide
_SPARSE = 4.0  # steps between two points of a profile, above which nothing is hidden
_FINE = 8  # samples a step on which the road is looked at
_STOP = 0.6  # waves a step at which the filter stops; half a wave is the most that a step shows
_TAPS = 18 * _FINE + 1  # 60 dB from half a wave to 0.7 waves a step
_MEAN = 100  # steps over which the mean of the hidden steepness is taken
_CHUNK = 200_000  # samples looked at together
_AROUND = 40.0  # steps on either side of the worst place, tried with shorter steps
_HALVINGS = 8


@dataclass(frozen=True, kw_only=True)
class Hidden:
    """Hold the most that a profile does to a wheel between the ends of a step.

    Attributes
    ----------
    height : float
        Height that no step sees [m].
    station : float
        Where that is [m].
    force : float
        Force of it, over the static force of a wheel.
    """

    height: float
    station: float
    force: float

    def __str__(self) -> str:
        """Describe it for a message."""
        return (
            f"near station {self.station:.6g} m the given profile rises or falls by "
            f"{1e3 * self.height:.2g} mm unseen between two steps, "
            f"{100 * self.force:.2g} % of a static wheel force"
        )


def hidden_by_step(
    crossing: Crossing, profile: Profile, needed: tuple[float, float], *, speed: float, dt: float
) -> Hidden:
    """Return the most that a profile does to a wheel between the ends of a step.

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
    roads). What is left above it, times a contact's stiffness, is a force that no step sees. Of
    a damper, a tenth of what it would add within a step counts: its impulse is kept by
    `given_road`, which takes the mean slope over kinks. Texture finer than a step is steep,
    though low: samples of its slope would take it for waves that the step can hold; so what the
    damper makes of the hidden slope, in the mean of its size over 100 steps, is added.
    """
    stride = speed * dt
    spacing = np.diff(profile.station)
    low, high = needed
    driven = (profile.station[1:] >= low) & (profile.station[:-1] <= high) & (spacing > 0.0)
    # a mirror image has its points at the same distances
    counted = spacing[spacing > 0.0] if profile.beyond == "mirror" else spacing[driven]
    if stride == 0.0 or counted.min(initial=np.inf) > _SPARSE * stride:
        return Hidden(height=0.0, station=low, force=0.0)
    return _hidden(crossing, profile, (low, high), speed=speed, dt=dt)


def check_profile_step(
    crossing: Crossing, profile: Profile, needed: tuple[float, float], *, speed: float, dt: float
) -> None:
    """Refuse a time step between whose ends a profile does much to a wheel.

    Parameters are those of `hidden_by_step`.

    Raises
    ------
    InputError
        A step that hides more than 3 % of a static wheel force; with a step that would not.
    """
    hidden = hidden_by_step(crossing, profile, needed, speed=speed, dt=dt)
    if hidden.force <= _MOST:
        return
    around = _AROUND * speed * dt
    area = (max(needed[0], hidden.station - around), min(needed[1], hidden.station + around))
    finer = (dt * 0.5**i for i in range(1, _HALVINGS + 1))
    enough = next((f for f in finer if _shows(crossing, profile, area, speed=speed, dt=f)), None)
    remedy = (
        "draw the two ends of a vertical step apart by its chamfer"
        if enough is None
        else f"shorten the time step to {1e3 * enough:.3g} ms"
    )
    raise InputError(
        f"route {crossing.route.name!r}: {hidden}, where at most {100 * _MOST:g} % is allowed; a "
        f"wheel at {speed:.3g} m/s moves {1e3 * speed * dt:.3g} mm in a step of {1e3 * dt:g} ms: "
        f"{remedy}, or let the tyre average the road over what it stands on, "
        "RoughnessBand(contact_patch=0.2)"
    )


def _shows(
    crossing: Crossing, profile: Profile, area: tuple[float, float], *, speed: float, dt: float
) -> bool:
    return _hidden(crossing, profile, area, speed=speed, dt=dt).force <= _MOST


def _hidden(
    crossing: Crossing, profile: Profile, area: tuple[float, float], *, speed: float, dt: float
) -> Hidden:
    low, high = area
    step = speed * dt / _FINE
    count = int(np.ceil((high - low) / step)) + 1
    pieces = [
        _hidden_in(profile, low + step * np.arange(start, min(start + _CHUNK, count) + 1), step)
        for start in range(0, count, _CHUNK)
    ]
    height, station, _ = max(pieces)
    steepness = max(steep for _, _, steep in pieces)
    vehicle = crossing.driven
    stiffness = np.maximum(vehicle.contact_stiffness, 0.1 * vehicle.contact_damping / dt)
    force = stiffness * height + vehicle.contact_damping * speed * steepness
    static = np.abs(vehicle.static_forces)
    carried = np.where(static > 0.0, static, max(float(static.mean()), 1e-300))
    return Hidden(height=height, station=station, force=float((force / carried).max()))


def _hidden_in(profile: Profile, inside: Array, step: float) -> tuple[float, float, float]:
    """Return the largest height [m], its station [m], and the mean steepness."""
    margin = step * np.arange(1, _TAPS // 2 + 1)
    wide = np.concatenate([inside[0] - margin[::-1], inside, inside[-1] + margin])
    z, slope = profile.at(wide)
    shown, shown_slope = z[0] + _below(z - z[0]), _below(slope)
    # a spike between two samples stands at a point of its own
    own = profile.station[(profile.station >= inside[0]) & (profile.station <= inside[-1])]
    s = np.concatenate([inside, own])
    above = np.abs(profile.at(s)[0] - np.concatenate([shown, np.interp(own, inside, shown)]))
    worst = int(np.argmax(above))
    steep = np.abs(profile.at(inside)[1] - shown_slope)
    steepness = ndimage.uniform_filter1d(steep, _MEAN * _FINE, mode="constant").max()
    return float(above[worst]), float(s[worst]), float(steepness)


def _below(values: Array) -> Array:
    """Return what lies below half a wave a step, without the margins."""
    taps = signal.firwin(_TAPS, 2.0 * _STOP / _FINE, window=("kaiser", 5.65))
    return signal.oaconvolve(values, taps, "valid")

"""Place the waves that stand for a random road, and send them to the wheels of a crossing."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from trundle._typing import Array
from trundle.errors import InputError
from trundle.road import RoughnessBand, Spectrum, track_coherence, wave_power
from trundle.route import Along
from trundle.simulate.sources.crossing import Crossing
from trundle.simulate.sources.source import WaveSet

__all__ = ["Waves", "place_waves", "waves_under"]


@dataclass(frozen=True, kw_only=True, eq=False)
class Waves:
    """Hold the waves that stand for a random road.

    Attributes
    ----------
    n : ndarray of float, shape (n_waves,)
        Spatial frequencies, rising [cycle/m].
    power : ndarray of float, shape (n_waves,)
        Variance of the elevation that each stands for [m2].
    coarse_power : ndarray of float, shape (n_waves,)
        The same if only every other wave stood for the road, 0 for the rest [m2].
    """

    n: Float[Array, " waves"]
    power: Float[Array, " waves"]
    coarse_power: Float[Array, " waves"]


def place_waves(
    road: Spectrum,
    band: RoughnessBand,
    n_waves: int,
    *,
    resonances: Float[Array, "modes 2"],
) -> Waves:
    """Place waves over a band, dense where what they excite is narrow.

    Parameters
    ----------
    road : Spectrum
        Spectrum.
    band : RoughnessBand
        Spatial frequencies.
    n_waves : int
        How many, odd numbers being made even.
    resonances : ndarray of float, shape (n_modes, 2)
        Resonances of the vehicle: spatial frequency at its speed [cycle/m], damping ratio.

    Notes
    -----
    Waves lie evenly in the integral of the density ``1 / n + sum 1 / |n - n_i + i zeta_i n_i|``:
    a floor's bandwidth grows with its frequency, a vehicle's few resonances are sharp. Each wave
    stands for the whole power between the middles of its neighbours, so none is lost.
    """
    fine = np.geomspace(band.n_min, band.n_max, 20001)
    density = 2.0 / fine
    for n_i, zeta in resonances:
        density += 0.5 / np.hypot(fine - n_i, max(zeta, 0.01) * n_i)
    steps = 0.5 * (density[1:] + density[:-1]) * np.diff(fine)
    inside = np.concatenate([[0.0], np.cumsum(steps)])
    wanted = (np.arange(n_waves + n_waves % 2) + 0.5) / (n_waves + n_waves % 2) * inside[-1]
    n = np.interp(wanted, inside, fine)
    coarse = np.zeros_like(n)
    coarse[::2] = wave_power(road, band, n[::2])
    return Waves(n=n, power=wave_power(road, band, n), coarse_power=coarse)


def waves_under(
    crossing: Crossing, road: Spectrum, along: Along, n_waves: int
) -> Iterator[WaveSet]:
    """Send the waves of a crossing's road to its wheels, one independent source at a time.

    Parameters
    ----------
    crossing : Crossing
        Who drives.
    road : Spectrum
        The random part of its road.
    along : Along
        Where its wheels are.
    n_waves : int
        Waves of the road.

    Yields
    ------
    WaveSet
        Waves that are independent of those of the other sets.
    """
    speed = float(along.speed.max())
    dt = float(along.time[1] - along.time[0])
    waves = place_waves(road, crossing.band, n_waves, resonances=_resonances(crossing, speed))
    shortest = 2.0 * waves.n[-1] * speed * dt
    if shortest > 1.0 + 1e-9:
        raise InputError(
            f"route {crossing.route.name!r}: waves of {waves.n[-1]:g} cycle/m at {speed:.3g} m/s "
            f"need a time step of at most {dt / shortest:.3g} s"
        )
    vehicle = crossing.driven
    tracks, which = np.unique(vehicle.lateral, return_inverse=True)
    mixing = _mixing(waves.n, np.abs(tracks[:, None] - tracks))
    for source in range(len(tracks)):
        yield WaveSet(
            along=along,
            n=waves.n,
            power=waves.power,
            coarse_power=waves.coarse_power,
            share=mixing[:, which, source],
            stiffness=vehicle.contact_stiffness,
            damping=vehicle.contact_damping,
            level=crossing.start == "level",
        )


def _mixing(n: Array, distance: Array) -> Array:
    """Return each track's part of independent waves, (n_waves, tracks, sources)."""
    ratio = np.sqrt(track_coherence(n[:, None, None], distance))
    return np.linalg.cholesky(ratio + 1e-10 * np.eye(len(distance)))


def _resonances(crossing: Crossing, speed: float) -> Array:
    poles = crossing.driven.poles()
    frequency = np.abs(poles)
    keep = (np.imag(poles) > 0.0) & (frequency > 0.0)
    return np.column_stack(
        [frequency[keep] / (2.0 * np.pi * speed), -np.real(poles)[keep] / frequency[keep]]
    )

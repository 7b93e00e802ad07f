"""Turn spatial roughness spectra into the spectra that a moving wheel feels."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from trundle._checks import count, positive
from trundle._typing import Array, ArrayLike
from trundle.road.iso8608 import RoadClass

__all__ = ["temporal_psd", "temporal_psd_two_sided"]


def temporal_psd(
    road: RoadClass, f: ArrayLike, *, speed: float, derivative: int = 0
) -> Float[Array, ...]:
    """Return the one-sided PSD in f of ground motion under a wheel at constant speed.

    Parameters
    ----------
    road : RoadClass
        Roughness.
    f : array_like of float
        Frequency [Hz], above 0.
    speed : float
        Speed V [m/s].
    derivative : int
        0 displacement [m2/Hz], 1 velocity [(m/s)2/Hz], 2 acceleration [(m/s2)2/Hz].

    Returns
    -------
    ndarray of float
        ``G(f) = (2 pi f)^(2 d) Gd(f / V) / V``.

    References
    ----------
    Pan, Mita and Li (2001), equations 2 and 3.
    """
    speed = positive("speed", speed)
    order = count("derivative", derivative, at_least=0)
    frequency = np.asarray(f, float)
    spatial = road.displacement_psd(frequency / speed) / speed
    return (2.0 * np.pi * frequency) ** (2 * order) * spatial


def temporal_psd_two_sided(
    road: RoadClass, omega: ArrayLike, *, speed: float, derivative: int = 0
) -> Float[Array, ...]:
    """Return the two-sided PSD in omega, the form printed in the paper's equation 3.

    Half of the one-sided power lies at negative frequencies and df = domega / (2 pi), so
    ``S(omega) = G(f) / (4 pi)`` at ``f = |omega| / (2 pi)``.

    Parameters
    ----------
    road : RoadClass
        Roughness.
    omega : array_like of float
        Circular frequency [rad/s], not 0.
    speed : float
        Speed V [m/s].
    derivative : int
        0 displacement, 1 velocity, 2 acceleration.

    Returns
    -------
    ndarray of float
        PSD per rad/s, defined on both signs of omega.
    """
    frequency = np.abs(np.asarray(omega, float)) / (2.0 * np.pi)
    return temporal_psd(road, frequency, speed=speed, derivative=derivative) / (4.0 * np.pi)

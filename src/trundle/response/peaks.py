"""Find the distribution of the largest value of a non-stationary Gaussian process."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy import special

from trundle._typing import Array, ArrayLike

__all__ = ["Process", "peak_levels"]

_LEVELS = 160  # levels at which the distribution is formed


@dataclass(frozen=True, kw_only=True, eq=False)
class Process:
    """Hold what decides the peaks of Gaussian processes at some points.

    Attributes
    ----------
    time : ndarray of float, shape (n_steps,)
        Time [s].
    mean, variance : ndarray of float, shape (n_steps, n_points)
        Of the process itself.
    rate_variance, covariance : ndarray of float, shape (n_steps, n_points)
        Of its rate, and between the two.
    turning : ndarray of float, shape (n_steps, n_points)
        First spectral moment: covariance of the rate with the process a quarter turn ahead.
    """

    time: Float[Array, " steps"]
    mean: Float[Array, "steps points"]
    variance: Float[Array, "steps points"]
    rate_variance: Float[Array, "steps points"]
    covariance: Float[Array, "steps points"]
    turning: Float[Array, "steps points"]

    def rougher(self, factor: float) -> Process:
        """Return the process on a road whose elevation is so many times larger."""
        square = factor**2
        return Process(
            time=self.time,
            mean=self.mean,
            variance=square * self.variance,
            rate_variance=square * self.rate_variance,
            covariance=square * self.covariance,
            turning=square * self.turning,
        )

    def at(self, point: int) -> Process:
        """Return the process at one point."""
        one = slice(point, point + 1)
        return Process(
            time=self.time,
            mean=self.mean[:, one],
            variance=self.variance[:, one],
            rate_variance=self.rate_variance[:, one],
            covariance=self.covariance[:, one],
            turning=self.turning[:, one],
        )


def peak_levels(process: Process, shares: ArrayLike) -> Float[Array, " shares"]:
    """Return levels that the largest absolute value stays below in given shares of all runs.

    Parameters
    ----------
    process : Process
        One point.
    shares : array_like of float
        Shares [%], 0 to 100.

    Notes
    -----
    Rice's rate of outcrossings of the two levels ``+-a`` about the moving mean, times
    Vanmarcke's factor for crossings that come in clumps, in a Poisson law over the record; and
    never more than the share of runs that is inside at any one time. The moments are exact; the
    law is within a few per cent for oscillators and broad bands, within 10 % for the responses of
    floors, and low by a fifth where a very narrow band lasts only a few of its own beats.

    References
    ----------
    E. H. Vanmarcke, On the distribution of the first-passage time for normal stationary random
    processes, J. Appl. Mech. 42 (1975) 215-220. R. B. Corotis, E. H. Vanmarcke, C. A. Cornell,
    First passage of nonstationary random processes, J. Eng. Mech. Div. ASCE 98 (1972) 401-414.
    """
    sigma = np.sqrt(process.variance[:, 0])
    mean = process.mean[:, 0]
    largest = float(np.max(np.abs(mean) + 7.0 * sigma))
    if largest == 0.0:
        return np.zeros(np.size(shares))
    levels = np.linspace(0.0, largest, _LEVELS + 1)[1:]
    inside = _share_below(process, levels)
    return np.interp(np.asarray(shares, float).ravel() / 100.0, inside, levels)


def _share_below(process: Process, levels: Array) -> Array:
    """Return the probability that no crossing of +-level occurs, rising with the level."""
    t = process.time
    variance = np.maximum(process.variance[:, 0], 0.0)
    live = variance > 1e-10 * variance.max()
    s = np.sqrt(np.where(live, variance, 1.0))
    rate = np.sqrt(np.where(live, np.maximum(process.rate_variance[:, 0], 0.0), 0.0))
    product = np.maximum(s * rate, 1e-300)
    rho = np.clip(process.covariance[:, 0] / product, -0.999999, 0.999999)
    turn = np.clip(np.abs(process.turning[:, 0]) / product, 0.0, 1.0)
    bandwidth = np.sqrt(1.0 - turn**2) ** 1.2
    mean, drift = process.mean[:, 0], np.gradient(process.mean[:, 0], t)
    total = np.zeros((len(levels), len(t)))
    held = np.ones((len(levels), len(t)))
    for side in (1.0, -1.0):
        r = (levels[:, None] - side * mean) / s
        toward = rho * rate * r + side * drift
        spread = rate * np.sqrt(1.0 - rho**2)
        z = np.clip(toward / np.maximum(spread, 1e-300), -38.0, 38.0)
        flux = spread * np.exp(-0.5 * z**2) / np.sqrt(2.0 * np.pi) + toward * special.ndtr(z)
        crossings = np.exp(-0.5 * r**2) / (np.sqrt(2.0 * np.pi) * s) * flux
        far = np.maximum(r, 1e-3)
        clump = -np.expm1(-np.sqrt(np.pi / 2.0) * bandwidth * far) / -np.expm1(-0.5 * far**2)
        total += np.where(live, crossings * np.minimum(clump, 1e3), 0.0)
        held -= np.where(live, special.ndtr(-r), (r < 0.0) * 1.0)
    expected = np.trapezoid(total, t, axis=1)
    share = np.minimum(np.exp(-expected), np.clip(held.min(axis=1), 0.0, 1.0))
    return np.maximum.accumulate(share)

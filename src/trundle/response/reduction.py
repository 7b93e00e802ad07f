"""Reduce batches of runs to what is kept of each, so that histories can go."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float
from scipy import stats

from trundle._checks import within
from trundle._typing import Array, ArrayLike
from trundle.response.spectra import BandSpectra, velocity_spectra
from trundle.signals import Averaging
from trundle.simulate import MeanResponse, Runs

__all__ = ["Reduced", "join", "percentile_interval", "reduce_rougher", "reduce_runs"]

_TOGETHER = 64  # runs whose filtered histories are held at once


@dataclass(frozen=True, kw_only=True, eq=False)
class Reduced:
    """Hold what is kept of every run.

    Attributes
    ----------
    peak_acceleration, peak_time : ndarray of float, shape (n_runs, n_points)
        Largest absolute acceleration [m/s2], and when it was [s].
    rms_velocity : ndarray of float, shape (n_runs, n_points)
        RMS velocity over the record [m/s].
    spectra : BandSpectra
        One-third-octave velocity levels [m/s].
    peak_contact_force : ndarray of float, shape (n_runs, n_contacts)
        Largest contact force, static load included [N].
    tension : ndarray of bool, shape (n_runs, n_contacts)
        Whether a contact would have had to pull: it would have left the floor.
    """

    peak_acceleration: Float[Array, "runs points"]
    peak_time: Float[Array, "runs points"]
    rms_velocity: Float[Array, "runs points"]
    spectra: BandSpectra
    peak_contact_force: Float[Array, "runs contacts"]
    tension: Bool[Array, "runs contacts"]


def reduce_runs(runs: Runs, *, averaging: Averaging = "max_1s") -> Reduced:
    """Reduce the histories of some runs.

    Parameters
    ----------
    runs : Runs
        Runs with histories.
    averaging : {"max_1s", "slow", "fast", "event"}
        Averaging rule of the band levels.
    """
    size = np.abs(runs.acceleration)
    return Reduced(
        peak_acceleration=size.max(axis=1),
        peak_time=runs.time[size.argmax(axis=1)],
        rms_velocity=runs.record_rms_velocity(),
        spectra=velocity_spectra(runs, averaging=averaging),
        peak_contact_force=runs.contact_forces.max(axis=1),
        tension=np.any(runs.contact_forces < 0.0, axis=1),
    )


def reduce_rougher(
    runs: Runs, mean: MeanResponse, factors: Sequence[float], *, averaging: Averaging = "max_1s"
) -> list[Reduced]:
    """Reduce some runs as they are on roads of other roughness.

    Parameters
    ----------
    runs : Runs
        Runs with histories.
    mean : MeanResponse
        Response without roughness.
    factors : sequence of float
        How many times larger the elevations are on each road.
    averaging : {"max_1s", "slow", "fast", "event"}
        Averaging rule of the band levels.

    Returns
    -------
    list of Reduced
        One for each factor.
    """
    found: list[list[Reduced]] = [[] for _ in factors]
    for start in range(0, runs.n_runs, _TOGETHER):
        some = runs.part(slice(start, start + _TOGETHER))
        for kept, factor in zip(found, factors, strict=True):
            kept.append(reduce_runs(some.rougher(mean, factor), averaging=averaging))
    return [join(parts) for parts in found]


def join(parts: Sequence[Reduced]) -> Reduced:
    """Put the runs of several parts behind each other."""
    first = parts[0].spectra
    return Reduced(
        peak_acceleration=_stack(parts, "peak_acceleration"),
        peak_time=_stack(parts, "peak_time"),
        rms_velocity=_stack(parts, "rms_velocity"),
        spectra=BandSpectra(
            mid_band=first.mid_band,
            values=np.concatenate([part.spectra.values for part in parts]),
            resolved=first.resolved,
            averaging=first.averaging,
            point_names=first.point_names,
        ),
        peak_contact_force=_stack(parts, "peak_contact_force"),
        tension=_stack(parts, "tension"),
    )


def _stack(parts: Sequence[Reduced], name: str) -> Array:
    return np.concatenate([getattr(part, name) for part in parts])


def percentile_interval(
    values: ArrayLike, share: float, *, confidence: float = 0.95
) -> tuple[float, float]:
    """Return an interval that holds the true percentile with some confidence.

    Parameters
    ----------
    values : array_like of float, shape (n_runs,)
        Independent values.
    share : float
        Percentile, 0 to 100.
    confidence : float
        Probability that the interval holds it.

    Returns
    -------
    tuple of float
        Two of the values in their order; infinite where there are too few of them.

    Notes
    -----
    Whatever the distribution, the number of values below the percentile is binomial.

    References
    ----------
    H. A. David, H. N. Nagaraja, Order Statistics, 3rd ed. (2003), section 7.1.
    """
    ordered = np.sort(np.asarray(values, float).ravel())
    n, p = len(ordered), within("share", share, 0.0, 100.0) / 100.0
    low = int(stats.binom.ppf(0.5 * (1.0 - confidence), n, p))
    high = int(stats.binom.ppf(0.5 * (1.0 + confidence), n, p)) + 1
    bounds = np.concatenate([[-np.inf], ordered, [np.inf]])
    return float(bounds[max(low, 0)]), float(bounds[min(high, n + 1)])

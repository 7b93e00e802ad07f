"""Reduce an ensemble to one-third-octave velocity spectra at its points."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from trundle._typing import Array
from trundle.signals import Averaging, band_edges, band_levels, mid_band_frequencies, usable_bands
from trundle.simulate import Runs

__all__ = ["BandSpectra", "velocity_spectra"]


@dataclass(frozen=True, kw_only=True, eq=False)
class BandSpectra:
    """Hold RMS velocity in one-third-octave bands for every run and point.

    Attributes
    ----------
    mid_band : ndarray of float, shape (n_bands,)
        Exact mid-band frequencies [Hz].
    values : ndarray of float, shape (n_runs, n_points, n_bands)
        RMS velocity [m/s]; NaN in bands that the computation cannot show.
    resolved : ndarray of bool, shape (n_bands,)
        True where time step and modes reach over the whole band.
    averaging : {"max_1s", "slow", "fast", "event"}
        Averaging rule of every value.
    point_names : tuple of str
        Names of the points.
    """

    mid_band: Float[Array, " bands"]
    values: Float[Array, "runs points bands"]
    resolved: Bool[Array, " bands"]
    averaging: Averaging
    point_names: tuple[str, ...]

    def percentile(self, share: float) -> Float[Array, "points bands"]:
        """Return the level that a share (0 to 100) of the runs stays below [m/s]."""
        return np.percentile(self.values, share, axis=0)


def velocity_spectra(runs: Runs, *, averaging: Averaging = "max_1s") -> BandSpectra:
    """Filter the velocities of an ensemble into bands from 1 to 80 Hz.

    Parameters
    ----------
    runs : Runs
        The ensemble.
    averaging : {"max_1s", "slow", "fast", "event"}
        Averaging rule.

    Returns
    -------
    BandSpectra
        Bands that reach beyond the last mode or the time step are not resolved.
    """
    mid_band = mid_band_frequencies()
    fs = runs.sampling_frequency
    resolved = usable_bands(mid_band, fs) & (band_edges(mid_band)[:, 1] <= runs.f_max)
    velocity = np.moveaxis(runs.velocity, 1, -1)
    values = np.full((*velocity.shape[:2], len(mid_band)), np.nan)
    if resolved.any():
        levels = band_levels(velocity, fs, mid_band[resolved], averaging=averaging)
        values[:, :, resolved] = np.moveaxis(levels, 0, -1)
    return BandSpectra(
        mid_band=mid_band,
        values=values,
        resolved=resolved,
        averaging=averaging,
        point_names=runs.point_names,
    )

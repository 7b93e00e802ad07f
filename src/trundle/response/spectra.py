"""Reduce an ensemble to spectra at its points: levels in one-third octaves, or narrow lines."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np
from jaxtyping import Bool, Float

from trundle._typing import Array
from trundle.signals import (
    Averaging,
    amplitude_spectrum,
    band_edges,
    band_maxima,
    band_peaks,
    mid_band_frequencies,
    usable_bands,
)
from trundle.simulate import Runs

__all__ = ["BandSpectra", "SpectrumQuantity", "spectra_of", "velocity_spectra"]

SpectrumQuantity: TypeAlias = Literal[
    "band_rms_velocity",
    "band_rms_acceleration",
    "band_rms_displacement",
    "band_peak_acceleration",
    "narrow_band_acceleration",
]
"""What a spectrum shows: RMS in one-third octaves, 0-peak in them, or 0-peak on lines of 1 Hz."""


@dataclass(frozen=True, kw_only=True, eq=False)
class BandSpectra:
    """Hold a level in every band, or on every line, for every run and point.

    Attributes
    ----------
    mid_band : ndarray of float, shape (n_bands,)
        Exact mid-band frequencies, or lines [Hz].
    values : ndarray of float, shape (n_runs, n_points, n_bands)
        Levels in SI units; NaN in bands that the computation cannot show.
    times : ndarray of float, shape (n_runs, n_points, n_bands)
        Middle of the time over which the largest level was taken [s]; NaN where there is none.
    resolved : ndarray of bool, shape (n_bands,)
        True where time step and modes reach over the whole band.
    averaging : {"max_1s", "slow", "fast", "event"}
        Averaging rule of every RMS value.
    point_names : tuple of str
        Names of the points.
    quantity : SpectrumQuantity
        What the levels are of.
    """

    mid_band: Float[Array, " bands"]
    values: Float[Array, "runs points bands"]
    times: Float[Array, "runs points bands"]
    resolved: Bool[Array, " bands"]
    averaging: Averaging
    point_names: tuple[str, ...]
    quantity: SpectrumQuantity = "band_rms_velocity"

    def percentile(self, share: float) -> Float[Array, "points bands"]:
        """Return the level that a share (0 to 100) of the runs stays below."""
        return np.percentile(self.values, share, axis=0)


def velocity_spectra(runs: Runs, *, averaging: Averaging = "max_1s") -> BandSpectra:
    """Filter the velocities of an ensemble into bands from 1 to 80 Hz, see `spectra_of`."""
    return spectra_of(runs, "band_rms_velocity", averaging=averaging)


def spectra_of(
    runs: Runs,
    quantity: SpectrumQuantity,
    *,
    averaging: Averaging = "max_1s",
    record: slice | None = None,
    goes_on: tuple[bool, bool] = (False, False),
) -> BandSpectra:
    """Form a spectrum of every run at every point.

    Parameters
    ----------
    runs : Runs
        The ensemble.
    quantity : SpectrumQuantity
        What is asked for.
    averaging : {"max_1s", "slow", "fast", "event"}
        Averaging rule of RMS values.
    record : slice, optional
        Steps that are looked at, see `signals.band_maxima`.
    goes_on : tuple of two bool
        Whether the record goes on before and behind them.

    Returns
    -------
    BandSpectra
        Bands that reach beyond the last mode or the time step are not resolved.
    """
    signal = np.moveaxis(getattr(runs, quantity.rpartition("_")[2]), 1, -1)
    fs = runs.sampling_frequency
    if quantity == "narrow_band_acceleration":
        lines, values = amplitude_spectrum(signal[..., record or slice(None)], fs, goes_on=goes_on)
        frequencies, resolved = lines[1:], lines[1:] <= min(runs.f_max, 0.4 * fs)
        values, times = values[..., 1:], np.full_like(values[..., 1:], np.nan)
    else:
        frequencies = mid_band_frequencies()
        resolved = usable_bands(frequencies, fs) & (band_edges(frequencies)[:, 1] <= runs.f_max)
        values = np.full((*signal.shape[:2], len(frequencies)), np.nan)
        times = values.copy()
        if resolved.any():
            bands = frequencies[resolved]
            levels, when = (
                band_peaks(signal, fs, bands, record=record, goes_on=goes_on[1])
                if quantity == "band_peak_acceleration"
                else band_maxima(
                    signal, fs, bands, averaging=averaging, record=record, goes_on=goes_on[1]
                )
            )
            values[:, :, resolved] = np.moveaxis(levels, 0, -1)
            times[:, :, resolved] = np.moveaxis(when, 0, -1)
    return BandSpectra(
        mid_band=frequencies,
        values=values,
        times=times,
        resolved=resolved,
        averaging=averaging,
        point_names=runs.point_names,
        quantity=quantity,
    )

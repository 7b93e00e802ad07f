"""Hold how a record runs: levels over time, spectra, doses, its outline; of any length."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from trundle._typing import Array
from trundle.signals import Averaging

__all__ = ["Outline", "RunningLevels", "Spectrogram", "Spectrum", "Survey"]


@dataclass(frozen=True, kw_only=True, eq=False)
class RunningLevels:
    """Hold running RMS velocity, sampled several times a second.

    Attributes
    ----------
    time : ndarray of float, shape (n_times,)
        Middle of the averaging time, filters' delay taken off [s].
    bands : ndarray of float32, shape (n_channels, n_bands, n_times)
        In one-third octaves from 1 to 80 Hz [m/s]; NaN in bands that are not shown.
    whole : ndarray of float32, shape (n_channels, n_times)
        Of all motion above the high-pass [m/s].
    mid_band : ndarray of float, shape (n_bands,)
        Exact mid-band frequencies [Hz].
    shown : ndarray of bool, shape (n_bands,)
        Bands that the record shows.
    averaging : {"max_1s", "slow", "fast", "event"}
        Rule; of ``event``, which does not run, linear over 1 s.
    """

    time: Float[Array, " times"]
    bands: Float[Array, "channels bands times"]
    whole: Float[Array, "channels times"]
    mid_band: Float[Array, " bands"]
    shown: Bool[Array, " bands"]
    averaging: Averaging

    @property
    def step(self) -> float:
        """Time between levels [s]."""
        return float(self.time[1] - self.time[0]) if len(self.time) > 1 else 0.0

    def exceeded(self, share: float) -> Float[Array, "channels bands"]:
        """Return the level in each band that is exceeded for a share of the time, 0 to 1 [m/s].

        L10 is that of 0.1, L50 that of 0.5.
        """
        return np.quantile(self.bands, 1.0 - share, axis=-1).astype(float)


@dataclass(frozen=True, kw_only=True, eq=False)
class Spectrum:
    """Hold the one-sided PSD of velocity by Welch's method: Hann windows, half overlapping.

    Attributes
    ----------
    frequencies : ndarray of float, shape (n_lines,)
        Lines, from 0 to half the sampling frequency [Hz].
    psd : ndarray of float, shape (n_channels, n_lines)
        Its integral is the variance [(m/s)2/Hz].
    n_windows : int
        Windows that it is the mean of.
    width : float
        Length of a window [s].
    """

    frequencies: Float[Array, " lines"]
    psd: Float[Array, "channels lines"]
    n_windows: int
    width: float

    @property
    def resolution(self) -> float:
        """Distance of lines [Hz]; a Hann window spreads a tone over 1.5 times as much."""
        return float(self.frequencies[1])


@dataclass(frozen=True, kw_only=True, eq=False)
class Spectrogram:
    """Hold the PSD of velocity over time.

    Attributes
    ----------
    frequencies : ndarray of float, shape (n_lines,)
        Lines above 0, up to what bands contain [Hz].
    edges : ndarray of float, shape (n_columns + 1,)
        Where columns begin and end [s].
    psd : ndarray of float32, shape (n_channels, n_lines, n_columns)
        The largest of a column's windows on each line [(m/s)2/Hz].
    width : float
        Length of a window [s].
    per_column : int
        Windows in a column.
    """

    frequencies: Float[Array, " lines"]
    edges: Float[Array, " edges"]
    psd: Float[Array, "channels lines columns"]
    width: float
    per_column: int


@dataclass(frozen=True, kw_only=True, eq=False)
class Outline:
    """Hold the smallest and largest value of motion in columns of time, as a screen shows it.

    Attributes
    ----------
    time : ndarray of float, shape (n_columns,)
        Where columns begin [s].
    velocity, acceleration : ndarray of float, shape (n_channels, n_columns, 2)
        Smallest and largest [m/s], [m/s2].
    per_column : int
        Samples in a column; 1 where motion is shown as it is.
    """

    time: Float[Array, " columns"]
    velocity: Float[Array, "channels columns 2"]
    acceleration: Float[Array, "channels columns 2"]
    per_column: int


@dataclass(frozen=True, kw_only=True, eq=False)
class Survey:
    """Hold how a record runs.

    Attributes
    ----------
    running : RunningLevels
        Levels over time.
    spectrum : Spectrum
        PSD of the whole.
    spectrogram : Spectrogram
        PSD over time.
    outline : Outline
        Velocity and acceleration over time.
    dose : ndarray of float, shape (n_channels, n_seconds)
        Fourth power of weighted acceleration, integrated over each second [m4/s7].
    crest_factor : ndarray of float, shape (n_channels,)
        Largest absolute acceleration over its RMS.
    mean_levels : ndarray of float, shape (n_channels, n_bands)
        RMS velocity in bands over the whole record [m/s]; NaN in bands that are not shown.
    """

    running: RunningLevels
    spectrum: Spectrum
    spectrogram: Spectrogram
    outline: Outline
    dose: Float[Array, "channels seconds"]
    crest_factor: Float[Array, " channels"]
    mean_levels: Float[Array, "channels bands"]

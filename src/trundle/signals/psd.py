"""Estimate power spectral densities, with the scaling in one place."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float
from scipy import signal

from trundle._checks import positive
from trundle._typing import Array

__all__ = ["amplitude_spectrum", "welch_psd"]


def welch_psd(
    samples: Float[Array, "... steps"], sampling_frequency: float, *, resolution: float
) -> tuple[Float[Array, " lines"], Float[Array, "... lines"]]:
    """Return frequencies and the one-sided PSD by Welch's method.

    Hann windows, half overlapping, mean removed; the integral over frequency is the
    variance.

    Parameters
    ----------
    samples : ndarray of float, shape (..., n_steps)
        Signals in time, or profiles along the road.
    sampling_frequency : float
        Samples per second, or per metre.
    resolution : float
        Distance of spectral lines [Hz], or [cycle/m].
    """
    width = round(positive("sampling_frequency", sampling_frequency) / resolution)
    width = min(max(width, 8), samples.shape[-1])
    return signal.welch(samples, fs=sampling_frequency, nperseg=width, detrend="constant", axis=-1)


def amplitude_spectrum(
    samples: Float[Array, "... steps"], sampling_frequency: float, *, resolution: float = 1.0
) -> tuple[Float[Array, " lines"], Float[Array, "... lines"]]:
    """Return frequencies and the largest 0-peak amplitude that a narrow-band analyser holds.

    Hann windows of ``1 / resolution`` seconds, overlapping by three quarters, scaled so that a
    steady sine on a line shows its amplitude; the largest of all windows is kept for each line.

    Parameters
    ----------
    samples : ndarray of float, shape (..., n_steps)
        Signals in time.
    sampling_frequency : float
        Samples per second [Hz].
    resolution : float
        Distance of spectral lines [Hz].
    """
    fs = positive("sampling_frequency", sampling_frequency)
    width = min(max(round(fs / positive("resolution", resolution)), 8), samples.shape[-1])
    f, _, lines = signal.stft(
        samples, fs=fs, window="hann", nperseg=width, noverlap=width - max(1, width // 4),
        boundary="zeros", padded=True, scaling="spectrum", axis=-1,
    )  # fmt: skip
    return f, 2.0 * np.abs(lines).max(axis=-1)

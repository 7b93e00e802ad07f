"""Estimate power spectral densities, with the scaling in one place."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from jaxtyping import Float, Int
from scipy import fft, signal

from trundle._checks import positive
from trundle._typing import Array

__all__ = ["amplitude_spectrum", "welch_psd", "window_psds"]

_TOGETHER = 2**21  # samples in windows that are held at once


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


def window_psds(
    samples: Float[Array, "channels steps"],
    sampling_frequency: float,
    *,
    width: int,
    starts: Int[Array, " windows"],
) -> Iterator[tuple[slice, Float[Array, "channels windows lines"]]]:
    """Give the one-sided PSD of single windows, some of them at a time.

    Hann windows, mean removed; the mean of half overlapping ones is `welch_psd`. Lines are
    ``sampling_frequency / width`` apart, from 0.

    Parameters
    ----------
    samples : ndarray of float, shape (n_channels, n_steps)
        Signals in time.
    sampling_frequency : float
        Samples per second [Hz].
    width : int
        Samples in a window.
    starts : ndarray of int, shape (n_windows,)
        First sample of each window.

    Yields
    ------
    part : slice
        Which windows.
    psds : ndarray of float, shape (n_channels, n_windows, n_lines)
        Theirs.
    """
    hann = signal.get_window("hann", width)
    scale = np.full(width // 2 + 1, 2.0 / (sampling_frequency * float(hann @ hann)))
    scale[0] *= 0.5
    if width % 2 == 0:
        scale[-1] *= 0.5
    every = np.lib.stride_tricks.sliding_window_view(samples, width, axis=-1)
    some = max(1, _TOGETHER // (width * len(samples)))
    for at in range(0, len(starts), some):
        part = slice(at, at + some)
        windows = every[:, starts[part]]
        windows = (windows - windows.mean(axis=-1, keepdims=True)) * hann
        yield part, scale * np.abs(fft.rfft(windows, axis=-1)) ** 2


def amplitude_spectrum(
    samples: Float[Array, "... steps"],
    sampling_frequency: float,
    *,
    resolution: float = 1.0,
    goes_on: tuple[bool, bool] = (False, False),
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
    goes_on : tuple of two bool
        Whether the record goes on before and behind the samples; where it does, no window reaches
        beyond them, and where it ends, what lies beyond is rest.
    """
    fs = positive("sampling_frequency", sampling_frequency)
    width = min(max(round(fs / positive("resolution", resolution)), 8), samples.shape[-1])
    if any(goes_on):
        rest = [(0, 0)] * (samples.ndim - 1)
        samples = np.pad(samples, [*rest, tuple(0 if on else width // 2 for on in goes_on)])
    f, _, lines = signal.stft(
        samples, fs=fs, window="hann", nperseg=width, noverlap=width - max(1, width // 4),
        boundary=None if any(goes_on) else "zeros", padded=not goes_on[1], scaling="spectrum",
        axis=-1,
    )  # fmt: skip
    return f, 2.0 * np.abs(lines).max(axis=-1)

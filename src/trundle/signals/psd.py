"""Estimate power spectral densities, with the scaling in one place."""

from __future__ import annotations

from jaxtyping import Float
from scipy import signal

from trundle._checks import positive
from trundle._typing import Array

__all__ = ["welch_psd"]


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

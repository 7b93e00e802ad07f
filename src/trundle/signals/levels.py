"""Turn a signal into single numbers: RMS by a stated averaging rule, and band levels."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from functools import partial
from typing import Literal, TypeAlias, get_args

import numpy as np
from jaxtyping import Float
from scipy import signal

from trundle._checks import one_of, positive
from trundle._threads import n_threads
from trundle._typing import Array
from trundle.signals.bands import band_filter

__all__ = ["Averaging", "averaged_rms", "band_levels", "running_rms"]

Averaging: TypeAlias = Literal["max_1s", "slow", "fast", "event"]
"""How a band's RMS is taken over time: the largest 1 s linear average, the largest
exponential average with a time constant of 1 s (slow) or 0.125 s (fast), or one average
over the whole event."""

_WINDOW = 1.0  # s
_TIME_CONSTANT = {"slow": 1.0, "fast": 0.125}  # s, IEC 61672-1


def running_rms(
    samples: Float[Array, "... steps"], sampling_frequency: float, *, window: float = _WINDOW
) -> Float[Array, "... steps"]:
    """Return the linear RMS over the window that ends at each sample.

    Before the first sample the signal is taken as zero. A window longer than the record
    averages over the window, not the record.
    """
    width = max(1, round(positive("window", window) * sampling_frequency))
    return np.sqrt(_energy(samples, width) / width)


def _energy(samples: Array, width: int) -> Array:
    """Return the sum of squares over the window that ends at each sample."""
    energy = np.cumsum(samples**2, axis=-1)
    energy[..., width:] = energy[..., width:] - energy[..., :-width]
    return np.maximum(energy, 0.0, out=energy)


def averaged_rms(
    samples: Float[Array, "... steps"], sampling_frequency: float, averaging: Averaging
) -> Float[Array, ...]:
    """Return one RMS value of each signal by an averaging rule.

    Parameters
    ----------
    samples : ndarray of float, shape (..., n_steps)
        Signals in time.
    sampling_frequency : float
        Samples per second [Hz].
    averaging : {"max_1s", "slow", "fast", "event"}
        Rule, see `Averaging`.
    """
    one_of("averaging", averaging, get_args(Averaging))
    if averaging == "event":
        return np.sqrt(np.mean(samples**2, axis=-1))
    if averaging == "max_1s":
        width = max(1, round(_WINDOW * sampling_frequency))
        return np.sqrt(_energy(samples, width).max(axis=-1) / width)
    decay = np.exp(-1.0 / (_TIME_CONSTANT[averaging] * sampling_frequency))
    weighted = signal.lfilter([1.0 - decay], [1.0, -decay], samples**2, axis=-1)
    return np.sqrt(weighted.max(axis=-1))


def band_levels(
    samples: Float[Array, "... steps"],
    sampling_frequency: float,
    mid_band: Float[Array, " bands"],
    *,
    averaging: Averaging = "max_1s",
) -> Float[Array, "bands ..."]:
    """Return the RMS of each signal in each one-third-octave band.

    The signal must start near rest. Except for ``event``, which averages over the record
    alone, the filters ring on into a second that fades out the record's end; a sudden end
    would be a broadband event of its own.
    """
    if averaging != "event":
        samples = _faded_out(samples, round(_WINDOW * sampling_frequency))

    level = partial(_band_level, samples, sampling_frequency, averaging)
    with ThreadPoolExecutor(n_threads()) as pool:
        return np.stack(list(pool.map(level, mid_band)))


def _band_level(
    samples: Array, sampling_frequency: float, averaging: Averaging, mid_band: float
) -> Array:
    sos = band_filter(mid_band, sampling_frequency)
    filtered = signal.sosfilt(sos, samples, axis=-1)
    return np.asarray(averaged_rms(filtered, sampling_frequency, averaging))


def _faded_out(samples: Array, n_steps: int) -> Array:
    """Add the mirrored end of the record under half a cosine."""
    n = min(n_steps, samples.shape[-1] - 1)
    fade = 0.5 * (1.0 + np.cos(np.pi * np.arange(1, n + 1) / n))
    tail = samples[..., -2 : -2 - n : -1] * fade
    rest = np.zeros((*samples.shape[:-1], n_steps - n))
    return np.concatenate([samples, tail, rest], axis=-1)

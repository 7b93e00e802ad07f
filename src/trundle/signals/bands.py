"""Define one-third-octave bands and the filters that cut them out."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from jaxtyping import Bool, Float
from scipy import fft, signal

from trundle._checks import positive
from trundle._typing import Array
from trundle.errors import InputError

__all__ = [
    "FILTER_ORDER",
    "HIGHEST_BAND",
    "LOWEST_BAND",
    "TOP_FREQUENCY",
    "band_delay",
    "band_edges",
    "band_filter",
    "band_limit",
    "filter_bands",
    "filter_zero_phase",
    "mid_band_frequencies",
    "nominal_frequency",
    "usable_bands",
]

LOWEST_BAND, HIGHEST_BAND = 0, 19
"""Numbers k of the 1 Hz and 80 Hz bands; the exact mid-band frequency is 10^(k/10)."""

TOP_FREQUENCY = 80.0
"""Nominal frequency of the highest band [Hz]: how far anything is asked to reach."""

_BENT = 0.08  # of the sampling frequency: above, the bilinear transform bends a band's skirts
_FLOOR = 0.1  # of a filter's passband: what passes less is fitted less closely
FILTER_ORDER = 4  # meets class 1 of IEC 61260-1 from 1 to 80 Hz at 200 Hz and more; 3 does not
_SAMPLES = 2.5  # sampling frequency over the highest mid-band frequency
_NOMINAL = (1.0, 1.25, 1.6, 2.0, 2.5, 3.15, 4.0, 5.0, 6.3, 8.0)


def band_limit(sampling_frequency: float) -> float:
    """Return the highest mid-band frequency that a sampling frequency shows [Hz]."""
    return sampling_frequency / _SAMPLES


def mid_band_frequencies(
    lowest: int = LOWEST_BAND, highest: int = HIGHEST_BAND
) -> Float[Array, " bands"]:
    """Return exact base-10 mid-band frequencies 10^(k/10) [Hz] (IEC 61260-1, 5.4).

    Examples
    --------
    >>> len(mid_band_frequencies())
    20
    """
    return 10.0 ** (np.arange(lowest, highest + 1) / 10.0)


def nominal_frequency(mid_band: float) -> float:
    """Return the rounded name of a band [Hz]: 3.15 for 3.162, 31.5 for 31.62."""
    decade, step = divmod(round(10.0 * np.log10(mid_band)), 10)
    return float(_NOMINAL[step] * 10.0**decade)


def band_edges(mid_band: Float[Array, " bands"]) -> Float[Array, "bands 2"]:
    """Return lower and upper band edges, ``f_m 10^(-/+ 1/20)`` [Hz]."""
    return np.stack([mid_band * 10.0**-0.05, mid_band * 10.0**0.05], axis=-1)


def usable_bands(
    mid_band: Float[Array, " bands"], sampling_frequency: float
) -> Bool[Array, " bands"]:
    """Return True for bands that the sampling frequency can resolve within class 1."""
    return mid_band <= sampling_frequency / _SAMPLES * (1.0 + 1e-9)


def band_filter(mid_band: float, sampling_frequency: float) -> Float[Array, "sections 6"]:
    """Return the second-order sections of one band's causal Butterworth filter.

    It passes what the analogue filter passes, also close to half the sampling frequency.

    Raises
    ------
    InputError
        A band too high for the sampling frequency.
    """
    fs = positive("sampling_frequency", sampling_frequency)
    if mid_band > fs / _SAMPLES * (1.0 + 1e-9):
        raise InputError(
            f"the {nominal_frequency(mid_band):g} Hz band needs a sampling frequency of at least "
            f"{_SAMPLES * mid_band:g} Hz; got {fs:g} Hz"
        )
    return _sections(float(mid_band), fs).copy()


@lru_cache(maxsize=256)  # designing takes longer than filtering a short record
def _sections(mid_band: float, fs: float) -> Float[Array, "sections 6"]:
    edges = band_edges(np.array([mid_band]))[0]
    if mid_band <= _BENT * fs:
        return signal.butter(FILTER_ORDER, edges, btype="bandpass", fs=fs, output="sos")
    return _like_analogue(edges, fs)


def _like_analogue(edges: Float[Array, " 2"], fs: float) -> Float[Array, "sections 6"]:
    """Design a filter that passes what the analogue Butterworth filter passes.

    The bilinear transform squeezes all frequencies up to infinity below half the sampling
    frequency: at 200 Hz the skirts of the 80 Hz band were bent so far that bands where motion
    falls read up to a fifth too high. Here the poles are the analogue filter's own, four zeros
    stay at frequency 0, and the other four are fitted to its response, with a delay of less than
    a sample or two that fits best: within 0.5 % of its level for motion that falls or rises by any
    power of frequency up to the fourth.
    """
    b, a = signal.butter(FILTER_ORDER, 2.0 * np.pi * edges / fs, btype="bandpass", analog=True)
    omega = 2.0 * np.pi * np.linspace(0.02, 0.495, 400)  # times the sampling frequency
    wanted = np.asarray(signal.freqs(b, a, omega)[1])
    digital, back = np.exp(np.roots(a)), np.exp(-1j * omega)[:, None]
    free = (1.0 - back) ** FILTER_ORDER / np.prod(1.0 - back * digital, axis=1, keepdims=True)
    weight = 1.0 / (np.abs(wanted)[:, None] + _FLOOR)
    columns = free * back ** np.arange(FILTER_ORDER + 1) * weight
    both = np.concatenate([columns.real, columns.imag])
    best, least = np.zeros(FILTER_ORDER + 1), np.inf
    for delay in np.linspace(-1.0, 2.0, 61):
        target = (wanted * np.exp(-1j * omega * delay))[:, None] * weight
        right = np.concatenate([target.real, target.imag])[:, 0]
        numerator = np.linalg.lstsq(both, right, rcond=None)[0]
        left_over = float(np.linalg.norm(both @ numerator - right))
        if left_over < least:
            best, least = numerator, left_over
    return signal.zpk2sos(np.concatenate([np.ones(FILTER_ORDER), np.roots(best)]), digital, best[0])


def filter_bands(
    samples: Float[Array, "... steps"],
    sampling_frequency: float,
    mid_band: Float[Array, " bands"],
) -> Float[Array, "bands ... steps"]:
    """Return the signal in each band; the filter starts at rest."""
    return np.stack(
        [signal.sosfilt(band_filter(f, sampling_frequency), samples, axis=-1) for f in mid_band]
    )


@lru_cache(maxsize=256)
def band_delay(mid_band: float, sampling_frequency: float) -> float:
    """Return the delay of a band's causal filter at its mid-band frequency [s]."""
    nearby = mid_band * np.array([1.0 - 1e-4, 1.0 + 1e-4])
    sos = band_filter(mid_band, sampling_frequency)
    _, response = signal.freqz_sos(sos, worN=nearby, fs=sampling_frequency)
    turn = float(np.angle(response[1] / response[0]))
    return -turn / (2.0 * np.pi * (nearby[1] - nearby[0]))


def filter_zero_phase(
    sos: Float[Array, "sections 6"], samples: Float[Array, "... steps"], *, padding: int
) -> Float[Array, "... steps"]:
    """Filter without delay, with the magnitude of a causal filter: the energy is the same.

    Filtering forwards and backwards would apply that magnitude twice.

    Parameters
    ----------
    sos : ndarray of float, shape (n_sections, 6)
        Second-order sections.
    samples : ndarray of float, shape (..., n_steps)
        Signals.
    padding : int
        Samples of rest put before and behind the record while it is filtered.
    """
    n = samples.shape[-1]
    size = fft.next_fast_len(n + 2 * padding, real=True)
    turns = np.exp(-2j * np.pi * np.arange(size // 2 + 1) / size)[:, None] ** np.arange(3)
    sections = (turns @ sos[:, :3].T) / (turns @ sos[:, 3:].T)
    magnitude = np.abs(np.prod(sections, axis=1))
    spectrum = fft.rfft(samples, size, axis=-1) * magnitude
    return np.asarray(fft.irfft(spectrum, size, axis=-1)[..., :n])

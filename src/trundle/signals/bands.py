"""Define one-third-octave bands and the filters that cut them out."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from jaxtyping import Bool, Float
from scipy import signal

from trundle._checks import positive
from trundle._typing import Array
from trundle.errors import InputError

__all__ = [
    "HIGHEST_BAND",
    "LOWEST_BAND",
    "band_edges",
    "band_filter",
    "filter_bands",
    "mid_band_frequencies",
    "nominal_frequency",
    "usable_bands",
]

LOWEST_BAND, HIGHEST_BAND = 0, 19
"""Numbers k of the 1 Hz and 80 Hz bands; the exact mid-band frequency is 10^(k/10)."""

_ORDER = 4  # meets class 1 of IEC 61260-1 from 1 to 80 Hz at 200 Hz and more; 3 does not
_SAMPLES = 2.5  # sampling frequency over the highest mid-band frequency
_NOMINAL = (1.0, 1.25, 1.6, 2.0, 2.5, 3.15, 4.0, 5.0, 6.3, 8.0)


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
    return signal.butter(_ORDER, edges, btype="bandpass", fs=fs, output="sos")


def filter_bands(
    samples: Float[Array, "... steps"],
    sampling_frequency: float,
    mid_band: Float[Array, " bands"],
) -> Float[Array, "bands ... steps"]:
    """Return the signal in each band; the filter starts at rest."""
    return np.stack(
        [signal.sosfilt(band_filter(f, sampling_frequency), samples, axis=-1) for f in mid_band]
    )

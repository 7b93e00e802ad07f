"""Weight acceleration as people feel it, and form the measures of human comfort."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal, TypeAlias, get_args

import numpy as np
from jaxtyping import Complex, Float
from scipy import fft

from trundle._checks import one_of, positive
from trundle._typing import Array, ArrayLike
from trundle.signals.levels import running_rms

__all__ = [
    "BASE_ACCELERATION",
    "BASE_SIDEWAYS",
    "Weighting",
    "crest_factor",
    "estimated_dose_value",
    "mtvv",
    "response_factor",
    "vibration_dose_value",
    "weight",
    "weighting_response",
]

Weighting: TypeAlias = Literal["Wb", "Wd", "Wk", "Wm"]
"""Wb vertical (BS 6472-1), Wk vertical and Wd horizontal (ISO 2631-1), Wm any (ISO 2631-2)."""

BASE_ACCELERATION = 0.005
"""Weighted RMS acceleration at which a response factor is 1 [m/s2] (ISO 10137, SCI P354)."""

BASE_SIDEWAYS = 0.00357
"""The same of horizontal motion, weighted by Wd [m/s2] (BS 6841, SCI P354)."""


@dataclass(frozen=True, kw_only=True)
class _Parameters:
    """Corner frequencies [Hz], quality factors and gain of a weighting (ISO 8041-1, table)."""

    f1: float
    f2: float
    f3: float
    f4: float
    q4: float
    f5: float = np.inf
    q5: float = 1.0
    f6: float = np.inf
    q6: float = 1.0
    gain: float = 1.0


_TABLE: Mapping[str, _Parameters] = {
    "Wb": _Parameters(
        f1=0.4, f2=100.0, f3=16.0, f4=16.0, q4=0.55, f5=2.5, q5=0.90, f6=4.0, q6=0.95, gain=1.024
    ),
    "Wk": _Parameters(
        f1=0.4, f2=100.0, f3=12.5, f4=12.5, q4=0.63, f5=2.37, q5=0.91, f6=3.35, q6=0.91
    ),
    "Wd": _Parameters(f1=0.4, f2=100.0, f3=2.0, f4=2.0, q4=0.63),
    "Wm": _Parameters(f1=10.0**-0.1, f2=100.0, f3=5.684, f4=5.684, q4=0.5),
}
_EVDV = 1.4
_Q = 1.0 / np.sqrt(2.0)  # of the two band-limiting filters


def weighting_response(name: Weighting, f: Float[Array, " lines"]) -> Complex[Array, " lines"]:
    """Return the complex frequency response of a weighting.

    ``H = Hh Hl Ht Hs``: band limits, transition from acceleration to velocity, upward step.

    Parameters
    ----------
    name : {"Wb", "Wd", "Wk", "Wm"}
        Which weighting.
    f : ndarray of float, shape (n_lines,)
        Frequencies [Hz]; 0 at 0.

    References
    ----------
    ISO 8041-1:2017, Annex C.

    Examples
    --------
    >>> round(float(abs(weighting_response("Wk", np.array([1.0]))[0])), 3)
    0.482
    """
    one_of("weighting", name, get_args(Weighting))
    p = _TABLE[name]
    f = np.asarray(f, dtype=float)
    s = 1j * np.maximum(f, np.finfo(float).tiny ** 0.25)
    high = 1.0 / (1.0 + p.f1 / (_Q * s) + (p.f1 / s) ** 2)
    low = 1.0 / (1.0 + s / (_Q * p.f2) + (s / p.f2) ** 2)
    transition = (1.0 + s / p.f3) / (1.0 + s / (p.q4 * p.f4) + (s / p.f4) ** 2)
    response = p.gain * high * low * transition
    if np.isfinite(p.f5):
        rise = 1.0 + s / (p.q5 * p.f5) + (s / p.f5) ** 2
        response *= rise / (1.0 + s / (p.q6 * p.f6) + (s / p.f6) ** 2) * (p.f5 / p.f6) ** 2
    return np.where(f > 0.0, response, 0.0)


def weight(
    acceleration: Float[Array, "... steps"], sampling_frequency: float, name: Weighting
) -> Float[Array, "... steps"]:
    """Return weighted acceleration.

    The response of the standard is applied to the record's spectrum, so that no digital filter
    bends it near the Nyquist frequency.

    Parameters
    ----------
    acceleration : ndarray of float, shape (..., n_steps)
        Acceleration, at rest before the record.
    sampling_frequency : float
        Samples per second [Hz].
    name : {"Wb", "Wd", "Wk", "Wm"}
        Which weighting.
    """
    n = acceleration.shape[-1]
    ringing = round(4.0 * sampling_frequency / _TABLE[name].f1)
    size = fft.next_fast_len(n + ringing, real=True)
    f = fft.rfftfreq(size, 1.0 / sampling_frequency)
    spectrum = fft.rfft(acceleration, size, axis=-1) * weighting_response(name, f)
    return np.asarray(fft.irfft(spectrum, size, axis=-1)[..., :n])


def mtvv(weighted: Float[Array, "... steps"], sampling_frequency: float) -> Float[Array, ...]:
    """Return the largest running 1 s RMS of weighted acceleration (ISO 2631-1, 6.3.1) [m/s2]."""
    return np.asarray(running_rms(weighted, sampling_frequency).max(axis=-1))


def response_factor(rms: Float[Array, ...]) -> Float[Array, ...]:
    """Return weighted RMS acceleration over the base value of 0.005 m/s2."""
    return np.asarray(rms) / BASE_ACCELERATION


def vibration_dose_value(
    weighted: Float[Array, "... steps"], sampling_frequency: float, *, events: float = 1.0
) -> Float[Array, ...]:
    """Return the fourth root of the time integral of the fourth power [m/s^1.75].

    Parameters
    ----------
    weighted : ndarray of float, shape (..., n_steps)
        Weighted acceleration [m/s2].
    sampling_frequency : float
        Samples per second [Hz].
    events : float
        How many such events the dose is for (BS 6472-1): it grows with their fourth root.
    """
    return np.asarray((events * np.sum(weighted**4, axis=-1) / sampling_frequency) ** 0.25)


def estimated_dose_value(weighted_rms: ArrayLike, duration: float) -> Float[Array, ...]:
    """Return the dose that an RMS value lets expect: ``1.4 a_rms T^0.25`` [m/s^1.75].

    Parameters
    ----------
    weighted_rms : array_like of float
        RMS of weighted acceleration over the time [m/s2].
    duration : float
        That time [s].

    Notes
    -----
    Meant for motion whose crest factor is below 6. The dose of Gaussian motion is 3^(1/4) = 1.316
    in place of 1.4, that of a sine 1.107; of a short burst in a long record it is larger.

    References
    ----------
    BS 6841:1987, Annex A; BS 6472-1:2008.
    """
    return np.asarray(_EVDV * np.asarray(weighted_rms, float) * positive("T", duration) ** 0.25)


def crest_factor(samples: Float[Array, "... steps"]) -> Float[Array, ...]:
    """Return the largest absolute value over the RMS of the record; 0 for rest."""
    rms = np.sqrt(np.mean(samples**2, axis=-1))
    return np.asarray(np.abs(samples).max(axis=-1) / np.maximum(rms, np.finfo(float).tiny))

"""Turn a measured record into displacement, velocity and acceleration without drift."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float
from scipy import fft
from scipy.interpolate import make_lsq_spline

from trundle._checks import within
from trundle._typing import Array
from trundle.signals.record import Record, is_steady

__all__ = ["lost_by_fading", "motion_of"]

_ORDER = 4  # of the high-pass filter
_PERIODS = 8.0  # of the high-pass frequency, of rest behind the record
_KNOTS = 2.5  # periods of the high-pass frequency between knots of the line that is taken off
_EVENT = (1.0, 1.0 / 20.0)  # s of fading at both ends of an event, and share of it at most
_STEADY = (12.0, 1.0 / 5.0)  # the same of steady motion: thrice what the lowest band takes
_LOUD = 1.25  # times the record's RMS: an end that is louder is not steady


def motion_of(record: Record, *, high_pass: float = 0.5) -> tuple[Array, Array, Array]:
    """Return displacement, velocity and acceleration of a record, without drift.

    A smooth line, of what is far slower than the high-pass, is taken off, and the record is faded
    in and out. Then all is done in one step on its spectrum: integration by
    ``1 / (i omega)``, and the magnitude of a Butterworth high-pass of order 4, without its delay.
    Nothing is integrated in time, so nothing drifts; and nothing is integrated that was not
    measured, as a record carried on beyond its ends would be.

    Parameters
    ----------
    record : Record
        The record.
    high_pass : float
        Frequency below which motion is taken for drift [Hz], 0.05 at least.

    Returns
    -------
    displacement, velocity, acceleration : ndarray of float, shape (n_channels, n_steps)
        Motion in SI units; displacement is the part above the high-pass alone.
    """
    fs, n = record.sampling_frequency, record.samples.shape[1]
    within("high_pass", high_pass, 0.05, fs)
    faded = _faded(record, high_pass)[1]
    size = fft.next_fast_len(n + round(_PERIODS / high_pass * fs), real=True)
    spectrum = fft.rfft(faded, size, axis=-1)
    f = fft.rfftfreq(size, 1.0 / fs)
    omega = 2j * np.pi * f
    passed = np.zeros_like(f)
    passed[1:] = 1.0 / np.sqrt(1.0 + (high_pass / f[1:]) ** (2 * _ORDER))
    inverse = np.zeros_like(omega)
    inverse[1:] = 1.0 / omega[1:]
    velocity = spectrum * passed * (inverse if record.quantity == "acceleration" else 1.0)
    acceleration = spectrum * passed * (1.0 if record.quantity == "acceleration" else omega)
    spectra = (velocity * inverse, velocity, acceleration)
    displacement, v, a = (fft.irfft(s, size, axis=-1)[..., :n] for s in spectra)
    return displacement, v, a


def lost_by_fading(
    record: Record, *, high_pass: float = 0.5
) -> tuple[Float[Array, " channels"], Float[Array, " channels"]]:
    """Return how many times larger RMS and dose of each channel are without its fading.

    Parameters
    ----------
    record : Record
        The record.
    high_pass : float
        Frequency below which motion is taken for drift [Hz].
    """
    whole, faded = _faded(record, high_pass)
    factors = (np.mean(whole**k, axis=1) / np.mean(faded**k, axis=1) for k in (2, 4))
    square, fourth = factors
    return square**0.5, fourth**0.25


def _faded(record: Record, high_pass: float) -> tuple[Array, Array]:
    """Return a record without what is slow, as it is and faded in and out.

    An event loses a second at both ends, which are at rest, or warned of. Steady motion loses more,
    so that no filter takes its beginning for an event; but no end that is louder than the rest.
    """
    fs, n = record.sampling_frequency, record.samples.shape[1]
    few, many = (max(2, min(round(t * fs), int(n * share))) for t, share in (_EVENT, _STEADY))
    whole = _without_line(record, high_pass)
    fades = np.ones_like(whole)
    for row, fade in zip(whole, fades, strict=True):
        steady, loud = is_steady(row, fs), _LOUD * float(np.std(row))
        for part, way in ((row[:many], fade), (row[::-1][:many], fade[::-1])):
            width = many if steady and np.std(part) < loud else few
            way[:width] = 0.5 * (1.0 - np.cos(np.pi * (np.arange(width) + 0.5) / width))
    return whole, whole * fades


def _without_line(record: Record, high_pass: float) -> Array:
    """Take off a cubic spline of least squares, which follows what is slow, and no end sample."""
    n = record.samples.shape[1]
    t = np.arange(n) / record.sampling_frequency
    inner = np.arange(1, int(record.duration * high_pass / _KNOTS)) * _KNOTS / high_pass
    inner = inner[inner < t[-1] - 0.5 * _KNOTS / high_pass]
    knots = np.concatenate([[t[0]] * 4, inner, [t[-1]] * 4])
    line = make_lsq_spline(t, record.samples.T, knots, k=3)(t)
    return record.samples - np.asarray(line).T

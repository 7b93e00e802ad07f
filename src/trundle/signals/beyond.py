"""Carry a record on beyond its two ends, so that filters do not take its beginning for an event.

A filter that starts at rest takes the first sample of a hum for a blow; a record that is faded in
loses what happens while it is. So what goes on at an end is predicted from the samples beside it,
by a linear prediction of high order, and faded out outside the record: tones go on as tones, noise
dies away within the reach of its own memory. Nothing within the record is touched, and no level is
read outside.

References
----------
J. P. Burg, Maximum entropy spectral analysis, PhD thesis, Stanford (1975): the predictor is stable.
P. Esquef, V. Valimaki et al., IEEE Trans. Speech Audio Process. 11 (2003) 391-401 (records carried
on by prediction).
"""

from __future__ import annotations

import numpy as np
from jaxtyping import Float
from scipy import signal

from trundle._typing import Array

__all__ = ["carried_on"]

_REACH = 0.5  # s of samples that a prediction rests on
_MOST = 1000  # samples that it rests on at most
_LEARNT = 20.0  # times as many are learnt from, at least this often the reach
_NOTHING_LEFT = 1e-12  # of the power: the prediction is exact, and further terms are rounding


def carried_on(
    samples: Float[Array, "channels steps"], sampling_frequency: float, length: float
) -> tuple[Float[Array, "channels before"], Float[Array, "channels after"]]:
    """Return what goes before and behind a record, faded in and out over its whole length.

    Parameters
    ----------
    samples : ndarray of float, shape (n_channels, n_steps)
        The record, without offset and drift.
    sampling_frequency : float
        Samples per second [Hz].
    length : float
        How far to carry it on at either end [s].
    """
    n = round(length * sampling_frequency)
    fade = 0.5 * (1.0 + np.cos(np.pi * (np.arange(n) + 0.5) / n))
    order = min(_MOST, round(_REACH * sampling_frequency), samples.shape[1] // 3)
    behind = np.array([_predicted(row, order, n) for row in samples]) * fade
    before = np.array([_predicted(row[::-1], order, n) for row in samples]) * fade
    return before[:, ::-1], behind


def _predicted(row: Array, order: int, n: int) -> Array:
    """Return the next n samples of a row, which is predicted by its own past."""
    known = row[-max(round(_LEARNT * order), 2 * order) :]
    coefficients = _burg(known, order)
    start = signal.lfiltic([1.0], coefficients, known[::-1][: len(coefficients) - 1])
    return signal.lfilter([1.0], coefficients, np.zeros(n), zi=start)[0]


def _burg(row: Array, order: int) -> Array:
    """Return the coefficients of the error filter, 1 first; its inverse is stable."""
    coefficients = np.ones(1)
    forward, backward = row[1:].copy(), row[:-1].copy()
    power = whole = float(row @ row) / len(row)
    for _ in range(order):
        scale = float(forward @ forward + backward @ backward)
        if scale == 0.0 or power <= _NOTHING_LEFT * whole:
            break
        k = -2.0 * float(forward @ backward) / scale
        longer = np.append(coefficients, 0.0)
        coefficients = longer + k * longer[::-1]
        forward, backward = (forward + k * backward)[1:], (backward + k * forward)[:-1]
        power *= 1.0 - k * k
    return coefficients

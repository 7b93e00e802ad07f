"""Turn a measured record into displacement, velocity and acceleration without drift."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float
from scipy import fft, sparse
from scipy.interpolate import BSpline
from scipy.sparse.linalg import splu

from trundle._checks import within
from trundle._typing import Array, SparseMatrix
from trundle.signals.beyond import carried_on
from trundle.signals.record import Record

__all__ = ["motion_of", "wide_motion_of"]

_ORDER = 4  # of the high-pass filter
_PERIODS = 8.0  # of the high-pass frequency, of rest behind the record
_KNOTS = 2.5  # periods of the high-pass frequency between knots of the line that is taken off
_PART = 2**18  # samples looked at together
_BEYOND = 4.0  # s that a record is carried on at either end: so long takes the lowest band's filter


def motion_of(
    record: Record, *, high_pass: float = 0.5
) -> tuple[
    Float[Array, "channels steps"], Float[Array, "channels steps"], Float[Array, "channels steps"]
]:
    """Return displacement, velocity and acceleration of a record, without drift.

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
    motion, seen = wide_motion_of(record, high_pass=high_pass)
    displacement, velocity, acceleration = (part[:, seen] for part in motion)
    return displacement, velocity, acceleration


def wide_motion_of(
    record: Record, *, high_pass: float = 0.5
) -> tuple[tuple[Array, Array, Array], slice]:
    """Return the motion of a record and of what it is carried on with, see `motion_of`.

    A smooth line, of what is far slower than the high-pass, is taken off, and the record is carried
    on at both ends (`carried_on`). Then all is done in one step on its spectrum: integration by
    ``1 / (i omega)``, and the magnitude of a Butterworth high-pass of order 4, without its delay.
    Nothing is integrated in time, so nothing drifts, and no event is faded.

    Parameters
    ----------
    record : Record
        The record.
    high_pass : float
        Frequency below which motion is taken for drift [Hz], 0.05 at least.

    Returns
    -------
    motion : tuple of three ndarray of float, shape (n_channels, n_before + n_steps + n_after)
        Displacement, velocity, acceleration in SI units.
    seen : slice
        The steps that were measured.
    """
    fs = record.sampling_frequency
    within("high_pass", high_pass, 0.05, fs)
    level = _without_line(record, high_pass)
    before, after = carried_on(level, fs, _BEYOND)
    wide = np.concatenate([before, level, after], axis=1)
    n = wide.shape[1]
    size = fft.next_fast_len(n + round(_PERIODS / high_pass * fs), real=True)
    spectrum = fft.rfft(wide, size, axis=-1)
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
    first = before.shape[1]
    return (displacement, v, a), slice(first, first + level.shape[1])


def _without_line(record: Record, high_pass: float) -> Array:
    """Take off a cubic spline of least squares, which follows what is slow, and no end sample."""
    n = record.samples.shape[1]
    t = np.arange(n) / record.sampling_frequency
    inner = np.arange(1, int(record.duration * high_pass / _KNOTS)) * _KNOTS / high_pass
    inner = inner[inner < t[-1] - 0.5 * _KNOTS / high_pass]
    knots = np.concatenate([[t[0]] * 4, inner, [t[-1]] * 4])
    # Normal equations, some samples at a time: knots are far apart, so they are as good as QR.
    m = len(knots) - 4
    gram, load = sparse.csr_array((m, m)), np.zeros((m, len(record.samples)))
    centred = record.samples - record.samples.mean(axis=1, keepdims=True)
    parts = [slice(at, at + _PART) for at in range(0, n, _PART)]
    for part in parts:
        basis: SparseMatrix = BSpline.design_matrix(t[part], knots, 3)
        gram = gram + basis.T @ basis
        load = load + basis.T @ centred[:, part].T
    line = BSpline(knots, splu(sparse.csc_array(gram)).solve(load), 3)
    for part in parts:
        centred[:, part] -= line(t[part]).T
    return centred

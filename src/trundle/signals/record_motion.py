"""Turn a measured record into displacement, velocity and acceleration without drift."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy import fft, sparse
from scipy.interpolate import BSpline
from scipy.sparse.linalg import splu

from trundle._checks import within
from trundle._typing import Array, SparseMatrix
from trundle.signals.beyond import carried_on
from trundle.signals.record import Record

__all__ = ["Section", "motion_of", "record_sections", "wide_motion_of"]

_ORDER = 4  # of the high-pass filter
_PERIODS = 8.0  # of the high-pass frequency, of rest behind the record
_KNOTS = 2.5  # periods of the high-pass frequency between knots of the line that is taken off
_PART = 2**18  # samples looked at together
_BEYOND = 4.0  # s that a record is carried on at either end: so long takes the lowest band's filter
_MOST = 2**21  # samples of all channels whose motion is held at once
_BESIDE = 7  # knots beside a section: what lies farther is not felt


@dataclass(frozen=True, kw_only=True, eq=False)
class Section:
    """Hold the motion of some of a record's samples, and of what lies beside them.

    Attributes
    ----------
    first : int
        Number of the first sample that is looked at.
    motion : tuple of three ndarray of float, shape (n_channels, n_steps)
        Displacement, velocity and acceleration [m], [m/s], [m/s2]; beside what is looked at, too.
    seen : slice
        The steps that are looked at.
    begins, ends : bool
        Whether the record begins, and ends, with this section.
    sampling_frequency : float
        Samples per second [Hz].
    """

    first: int
    motion: tuple[
        Float[Array, "channels wide"], Float[Array, "channels wide"], Float[Array, "channels wide"]
    ]
    seen: slice
    begins: bool
    ends: bool
    sampling_frequency: float

    @property
    def n_seen(self) -> int:
        """How many samples are looked at."""
        return self.seen.stop - self.seen.start


@dataclass(frozen=True, kw_only=True, eq=False)
class _Cut:
    """Some of a record's samples, which may well stand still, as a whole record may not."""

    samples: Float[Array, "channels steps"]
    sampling_frequency: float
    quantity: str

    @property
    def duration(self) -> float:
        """Length [s]."""
        return self.samples.shape[1] / self.sampling_frequency


def record_sections(
    record: Record, *, high_pass: float = 0.5, most: int = _MOST
) -> Iterator[Section]:
    """Give the motion of a record section by section, so that no more is held at once.

    Parameters
    ----------
    record : Record
        The record.
    high_pass : float
        Frequency below which motion is taken for drift [Hz], 0.05 at least.
    most : int
        Samples of all channels that a section holds about.

    Yields
    ------
    Section
        One behind the other; a short record is one section, and then exactly `wide_motion_of`.

    Notes
    -----
    What the magnitude of the high-pass spreads over time fades with its fourth power: the 17
    periods beside a section leave out less than 1e-6 of what lies beyond.
    """
    n_channels, n = record.samples.shape
    fs = record.sampling_frequency
    # Whole knots, so that the line that is taken off has them where it has them in the whole.
    knot = round(_KNOTS / within("high_pass", high_pass, 0.05, fs)) * round(fs)
    beside = _BESIDE * knot
    length = knot * (max(most // n_channels, 4 * beside) // knot)
    firsts = list(range(0, n, length))
    if len(firsts) > 1 and n - firsts[-1] < beside:
        firsts.pop()  # the last is as long as its neighbours' sides at least
    for first, stop in zip(firsts, [*firsts[1:], n], strict=True):
        low, high = max(0, first - beside), min(n, stop + beside)
        cut = _Cut(
            samples=record.samples[:, low:high], sampling_frequency=fs, quantity=record.quantity
        )
        motion, within_cut = _wide(cut, high_pass)
        start = within_cut.start + first - low
        yield Section(
            first=first,
            motion=motion,
            seen=slice(start, start + stop - first),
            begins=first == 0,
            ends=stop == n,
            sampling_frequency=fs,
        )


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
    within("high_pass", high_pass, 0.05, record.sampling_frequency)
    return _wide(record, high_pass)


def _wide(record: Record | _Cut, high_pass: float) -> tuple[tuple[Array, Array, Array], slice]:
    """Return the motion of a record, or of a part of one."""
    fs = record.sampling_frequency
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


def _without_line(record: Record | _Cut, high_pass: float) -> Array:
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

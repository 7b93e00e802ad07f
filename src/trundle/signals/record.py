"""Hold a measured record, find what is wrong with it, and turn it into motion without drift."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, TypeAlias, get_args

import numpy as np
from jaxtyping import Float
from scipy import fft

from trundle._checks import frozen_array, one_of, positive, set_frozen
from trundle._typing import Array
from trundle.errors import FitnessWarning, InputError

__all__ = ["Record", "RecordQuantity", "clipped_channels", "motion_of", "record_warnings"]

RecordQuantity: TypeAlias = Literal["acceleration", "velocity"]
"""What a sensor measured."""

_ORDER = 4  # of the high-pass filter
_TAPER = 1.0  # s at both ends, at most a twentieth of the record
_FLAT = 3  # equal samples in a row at an extreme that count as clipped
_QUIET = 0.2  # of the record's RMS: louder ends are not at rest
_PERIODS = 8.0  # of a band's mid-frequency, that a record must hold to show it


@dataclass(frozen=True, kw_only=True, eq=False)
class Record:
    """Hold what some sensors measured together.

    Attributes
    ----------
    samples : ndarray of float, shape (n_channels, n_steps)
        Acceleration [m/s2] or velocity [m/s].
    sampling_frequency : float
        Samples per second [Hz].
    quantity : {"acceleration", "velocity"}
        What they are.
    channel_names : tuple of str
        Names of the channels.
    source : str
        Where the record is from.
    """

    samples: Float[Array, "channels steps"]
    sampling_frequency: float
    quantity: RecordQuantity
    channel_names: tuple[str, ...]
    source: str = "record"

    def __post_init__(self) -> None:
        """Refuse samples that are no record: not finite, too few, a channel that never moves."""
        one_of("quantity", self.quantity, get_args(RecordQuantity))
        fs = positive("sampling_frequency", self.sampling_frequency)
        samples = np.asarray(self.samples, dtype=float)
        bad = np.argwhere(~np.isfinite(samples))
        if len(bad):
            channel, step = bad[0]
            raise InputError(
                f"{self.source}: {len(bad)} samples are not numbers; the first is in channel "
                f"{self.channel_names[channel]!r} at {step / fs:.4g} s; cut the gap out, or export "
                "the record again"
            )
        samples = frozen_array("samples", samples, shape=(len(self.channel_names), None))
        if samples.shape[1] < 2.0 * fs or samples.shape[1] < 32:
            raise InputError(
                f"{self.source}: {samples.shape[1] / fs:.3g} s is too short for a level over "
                "1 s; give 2 s or more"
            )
        for name, row in zip(self.channel_names, samples, strict=True):
            if np.ptp(row) == 0.0:
                raise InputError(
                    f"{self.source}: channel {name!r} never moves; leave it out, or mend its cable"
                )
        set_frozen(self, samples=samples, sampling_frequency=fs)

    @property
    def duration(self) -> float:
        """Length of the record [s]."""
        return self.samples.shape[1] / self.sampling_frequency

    @property
    def lowest_frequency(self) -> float:
        """Lowest mid-band frequency of which the record holds 8 periods [Hz]."""
        return _PERIODS / self.duration


def record_warnings(record: Record) -> tuple[FitnessWarning, ...]:
    """Return the doubts about a record: clipped, too slow, too short, not at rest at its ends."""
    found = [
        *(w for name, row in _rows(record) for w in _clipped(name, row)),
        *_range(record),
        *(w for name, row in _rows(record) for w in _ends(name, row, record.sampling_frequency)),
    ]
    return tuple(found)


def _rows(record: Record) -> zip[tuple[str, Array]]:
    return zip(record.channel_names, record.samples, strict=True)


def clipped_channels(record: Record) -> tuple[str, ...]:
    """Return the channels that were overloaded."""
    return tuple(name for name, row in _rows(record) if _held(row))


def _held(row: Array) -> int:
    """Return how many samples stand still at an extreme, where more do than nearby levels explain.

    A quantised crest stands still too: over about as many samples at the level below it.
    """
    levels = np.unique(row)
    total = 0
    for extreme, beside in ((levels[-1], levels[-2]), (levels[0], levels[1])):
        at = (row == extreme).astype(np.int8)
        edges = np.flatnonzero(np.diff(np.concatenate([[0], at, [0]])))
        lengths = edges[1::2] - edges[::2]
        held = int(lengths[lengths >= _FLAT].sum())
        if held > 3 * np.count_nonzero(row == beside):
            total += held
    return total


def _clipped(name: str, row: Array) -> list[FitnessWarning]:
    held = _held(row)
    if held == 0:
        return []
    return [
        FitnessWarning(
            subject=f"clipped, {name}",
            message=f"{held} samples stand still at the largest or smallest value: the sensor or "
            "its amplifier was overloaded, and the true levels are higher",
        )
    ]


def _range(record: Record) -> list[FitnessWarning]:
    found = []
    top = record.sampling_frequency / 2.5
    if top < 80.0 * (1 - 1e-9):
        found.append(
            FitnessWarning(
                subject="sampling rate",
                message=f"{record.sampling_frequency:g} Hz shows bands to {top:.3g} Hz; those "
                "above are not assessed; 200 Hz or more shows all",
            )
        )
    low = record.lowest_frequency
    if low > 1.0:
        found.append(
            FitnessWarning(
                subject="record length",
                message=f"{record.duration:.3g} s hold 8 periods of {low:.3g} Hz; bands below are "
                "not assessed; 8 s or more show all",
            )
        )
    return found


def _ends(name: str, row: Array, fs: float) -> list[FitnessWarning]:
    width = max(2, round(0.25 * fs))
    centred = row - row.mean()
    whole = float(np.sqrt(np.mean(centred**2)))
    energy = np.cumsum(np.concatenate([[0.0], centred**2]))
    peak = float(np.sqrt(np.max(energy[width:] - energy[:-width]) / width))
    if peak < 3.0 * whole:
        return []  # steady motion, of which any part is as good
    ends = (("starts", centred[:width]), ("ends", centred[-width:]))
    return [
        FitnessWarning(
            subject=f"record {what}, {name}",
            message=f"the record {what} in motion: an event cut off there has wrong low bands; "
            "give it some seconds of rest",
        )
        for what, part in ends
        if np.sqrt(np.mean(part**2)) > _QUIET * peak
    ]


def motion_of(record: Record, *, high_pass: float = 0.5) -> tuple[Array, Array, Array]:
    """Return displacement, velocity and acceleration of a record, without drift.

    Mean and trend are taken off, and the record is carried on beyond both ends with its own slope
    while it fades. Then all is done in one step on its spectrum: integration by ``1 / (i omega)``,
    and the magnitude of a Butterworth high-pass of order 4, without its delay. Nothing is
    integrated in time, so nothing drifts. The motion found is faded in and out within a second.

    Parameters
    ----------
    record : Record
        The record.
    high_pass : float
        Frequency below which motion is taken for drift [Hz].

    Returns
    -------
    displacement, velocity, acceleration : ndarray of float, shape (n_channels, n_steps)
        Motion in SI units; displacement is the part above the high-pass alone.
    """
    fs, n = record.sampling_frequency, record.samples.shape[1]
    positive("high_pass", high_pass)
    padding = round(_PERIODS / high_pass * fs)
    reach = min(padding, n - 1)
    extended = _carried_on(_level(record.samples), reach)
    size = fft.next_fast_len(n + 2 * reach + padding, real=True)
    spectrum = fft.rfft(extended, size, axis=-1)
    f = fft.rfftfreq(size, 1.0 / fs)
    omega = 2j * np.pi * f
    passed = np.zeros_like(f)
    passed[1:] = 1.0 / np.sqrt(1.0 + (high_pass / f[1:]) ** (2 * _ORDER))
    inverse = np.zeros_like(omega)
    inverse[1:] = 1.0 / omega[1:]
    velocity = spectrum * passed * (inverse if record.quantity == "acceleration" else 1.0)
    acceleration = spectrum * passed * (1.0 if record.quantity == "acceleration" else omega)
    spectra = (velocity * inverse, velocity, acceleration)
    fade = _fade(n, fs)
    inside = slice(reach, reach + n)
    displacement, v, a = (fft.irfft(s, size, axis=-1)[..., inside] * fade for s in spectra)
    return displacement, v, a


def _level(samples: Array) -> Array:
    """Take mean and trend off."""
    t = np.linspace(-1.0, 1.0, samples.shape[1])
    slope = (samples @ t) / (t @ t)
    return samples - samples.mean(axis=1, keepdims=True) - slope[:, None] * t


def _carried_on(samples: Array, reach: int) -> Array:
    """Turn the record about its first and its last sample, and fade what is added."""
    fade = 0.5 * (1.0 + np.cos(np.pi * np.arange(1, reach + 1) / (reach + 1)))
    before = (2.0 * samples[:, :1] - samples[:, 1 : reach + 1]) * fade
    after = (2.0 * samples[:, -1:] - samples[:, -2 : -2 - reach : -1]) * fade
    return np.concatenate([before[:, ::-1], samples, after], axis=1)


def _fade(n: int, fs: float) -> Array:
    """Return a second of fading in and out, at most a twentieth of the record each."""
    width = max(2, min(round(_TAPER * fs), n // 20))
    rise = 0.5 * (1.0 - np.cos(np.pi * (np.arange(width) + 0.5) / width))
    return np.concatenate([rise, np.ones(n - 2 * width), rise[::-1]])

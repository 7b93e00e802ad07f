"""Hold a measured record, and find what is wrong with it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, TypeAlias, get_args

import numpy as np
from jaxtyping import Float

from trundle._checks import frozen_array, one_of, positive, set_frozen
from trundle._typing import Array
from trundle.errors import FitnessWarning, InputError

__all__ = ["Record", "RecordQuantity", "doubtful_channels", "is_steady", "record_warnings"]

RecordQuantity: TypeAlias = Literal["acceleration", "velocity"]
"""What a sensor measured."""

_RAILS = 10  # samples at an extreme, that may be chance
_CREST = 5.0  # times as many as at the level beside it
_DROPOUT = 0.1  # s of one value in the middle of motion
_LEAST_HELD = 8  # samples
_SPIKE = 8.0  # times the RMS
_IMPLAUSIBLE = 1e4  # m/s2 or m/s
_FLAT = 3  # equal samples in a row at an extreme that count as clipped
_STEADY = 3.0  # times the record's RMS, that no quarter second of steady motion reaches
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
            if float(np.abs(row).max()) > _IMPLAUSIBLE:
                raise InputError(
                    f"{self.source}: channel {name!r} reaches {np.abs(row).max():.3g} in SI units, "
                    "which no floor does; mind its unit, scale or sensitivity"
                )
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
    """Return the doubts about a record: clipped, held, spiky, slow, short, not at rest."""
    fs = record.sampling_frequency
    found = [w for name, row in _rows(record) for w in _clipped(name, row)]
    for doubt in (_held, _spikes):
        found += [w for name, row in _rows(record) for w in doubt(name, row, fs)]
    found += _range(record)
    found += [w for name, row in _rows(record) for w in _ends(name, row, fs)]
    return tuple(found)


def _rows(record: Record) -> zip[tuple[str, Array]]:
    return zip(record.channel_names, record.samples, strict=True)


def doubtful_channels(record: Record) -> tuple[str, ...]:
    """Return the channels that were overloaded, or hide a gap: their true levels may be higher."""
    fs = record.sampling_frequency
    return tuple(name for name, row in _rows(record) if _on_the_rails(row) or _held(name, row, fs))


def _on_the_rails(row: Array) -> int:
    """Return how many samples stand at an extreme, where more do than nearby levels explain.

    A quantised crest stands still too: over about as many samples at the level below it, or, of a
    sine, 2.4 times as many.
    """
    levels = np.unique(row)
    total = 0
    for extreme, beside in ((levels[-1], levels[-2]), (levels[0], levels[1])):
        lengths = _run_lengths(row == extreme)
        below = int(np.count_nonzero(row == beside))
        held = int(lengths[lengths >= _FLAT].sum())
        if held > 3 * below:
            total += held
        elif lengths.sum() > max(_RAILS, _CREST * below):
            total += int(lengths.sum())
    return total


def _run_lengths(flags: Array) -> Array:
    """Return the lengths of the runs of True."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], flags.astype(np.int8), [0]])))
    return edges[1::2] - edges[::2]


def _held(name: str, row: Array, fs: float) -> list[FitnessWarning]:
    """Doubt values that stand still in the middle of motion, as loggers fill gaps with them."""
    same = np.concatenate([[False], np.diff(row) == 0.0, [False]])
    edges = np.flatnonzero(np.diff(same.astype(np.int8)))
    starts, lengths = edges[::2], edges[1::2] - edges[::2] + 1
    width, centred = _quarter(fs), row - np.median(row)
    usual = float(np.quantile(lengths, 0.9)) if len(lengths) > 10 else 1.0
    loud = _QUIET * float(np.std(row))
    for start, length in zip(starts, lengths, strict=True):
        if length < max(_DROPOUT * fs, 5.0 * usual) or length < _LEAST_HELD:
            continue
        before, after = centred[max(0, start - width) : start], centred[start + length :][:width]
        if min(len(before), len(after)) < 2 or min(np.std(before), np.std(after)) < loud:
            continue
        return [
            FitnessWarning(
                subject=f"held, {name}",
                message=f"one value stands for {length / fs:.3g} s at {start / fs:.4g} s in the "
                "middle of motion: a gap that the logger filled; cut the record there",
            )
        ]
    return []


def _spikes(name: str, row: Array, fs: float) -> list[FitnessWarning]:
    """Doubt single samples far above all beside them: nothing that moves does that."""
    size = np.abs(row - np.median(row))
    high = np.flatnonzero(size > _SPIKE * np.sqrt(np.mean(size**2)))
    high = high[(high >= 2) & (high < len(row) - 2)]
    beside = np.max([size[high + k] for k in (-2, -1, 1, 2)], axis=0) if len(high) else high
    at = high[beside < 0.1 * size[high]] if len(high) else high
    if len(at) == 0:
        return []
    return [
        FitnessWarning(
            subject=f"spikes, {name}",
            message=f"{len(at)} single samples stand far above all beside them, the first at "
            f"{at[0] / fs:.4g} s: a fault of cable or logger, which raises every band",
        )
    ]


def _clipped(name: str, row: Array) -> list[FitnessWarning]:
    held = _on_the_rails(row)
    if held == 0:
        return []
    return [
        FitnessWarning(
            subject=f"clipped, {name}",
            message=f"{held} samples stand at the largest or smallest value: the sensor or "
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


def is_steady(row: Float[Array, " steps"], fs: float) -> bool:
    """Return whether a channel moves alike throughout, so that any part of it is as good.

    Parameters
    ----------
    row : ndarray of float, shape (n_steps,)
        Samples of a channel.
    fs : float
        Samples per second [Hz].
    """
    return _loudest(row, fs) < _STEADY * float(np.std(row))


def _loudest(row: Array, fs: float) -> float:
    """Return the largest RMS over a quarter of a second."""
    width = _quarter(fs)
    energy = np.cumsum(np.concatenate([[0.0], (row - row.mean()) ** 2]))
    return float(np.sqrt(np.max(energy[width:] - energy[:-width]) / width))


def _quarter(fs: float) -> int:
    return max(2, round(0.25 * fs))


def _ends(name: str, row: Array, fs: float) -> list[FitnessWarning]:
    if is_steady(row, fs):
        return []
    width, centred, peak = _quarter(fs), row - row.mean(), _loudest(row, fs)
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

"""Find what is wrong with a measured record: clipped, held, spiky, slow, short, cut."""

from __future__ import annotations

import numpy as np

from trundle._typing import Array
from trundle.errors import FitnessWarning
from trundle.signals.bands import TOP_FREQUENCY, band_limit
from trundle.signals.record import Record

__all__ = ["doubtful_channels", "record_warnings"]

_RAILS = 10  # crests cut at one value, that may be chance
_CREST = 5.0  # times as many samples as just below it
_NEAR = 0.005  # of the range: just below an extreme
_STEEP = 12.0  # steps of the resolution: no crest falls so far beside three equal samples
_ALIKE = 0.02  # of the range: crests whose neighbours differ less are one crest, repeated
_ABOVE = 0.25  # of a crest's fall beside it: so far above an extreme a parabola must point
_FLAT = 3  # equal samples in a row at an extreme that count as clipped
_DROPOUT = 0.1  # s of one value in the middle of motion
_LEAST_HELD = 8  # samples
_SPIKE = 8.0  # times the RMS
_STEADY = 3.0  # times the record's RMS, that no quarter second of steady motion reaches
_QUIET = 0.2  # of the record's RMS: louder ends are not at rest
_FELT = (0.9, 90.0)  # Hz: what bands contain


def record_warnings(record: Record) -> tuple[FitnessWarning, ...]:
    """Return the doubts about a record: clipped, held, spiky, slow, short, not at rest."""
    fs = record.sampling_frequency
    found = [*record.notes, *_axes(record)]
    found += [w for name, row in _rows(record) for w in _clipped(name, row)]
    for doubt in (_held, _spikes):
        found += [w for name, row in _rows(record) for w in doubt(name, row, fs)]
    found += _range(record)
    for name, row in _rows(record):
        found += _ends(name, _felt(row, record), fs)
    return tuple(found)


def doubtful_channels(record: Record) -> tuple[str, ...]:
    """Return the channels that were overloaded, or hide a gap: their true levels may be higher."""
    fs = record.sampling_frequency
    return tuple(name for name, row in _rows(record) if _on_the_rails(row) or _held(name, row, fs))


def _rows(record: Record) -> zip[tuple[str, Array]]:
    return zip(record.channel_names, record.samples, strict=True)


def _axes(record: Record) -> list[FitnessWarning]:
    """Say which channels are taken for vertical without a word of theirs."""
    unsaid = [n for n, axis in zip(record.channel_names, record.axes, strict=True) if not axis]
    if not unsaid:
        return []
    names = ", ".join(unsaid[:4]) + (" ..." if len(unsaid) > 4 else "")
    return [
        FitnessWarning(
            subject="axis",
            message=f"{names}: the name says no direction; weighted and judged as vertical; name "
            "a channel z, or x, y, N, E",
        )
    ]


def _on_the_rails(row: Array) -> int:
    """Return how many samples stand at an extreme because the sensor could not follow.

    Equal samples are no proof: a tone whose period is a whole number of samples repeats its crest
    exactly, and quantised crests stand still. A crest is cut where three equal samples or more are
    left by a step that no parabola through them takes; or where one value ends many crests that
    are not alike, far more often than values just below occur, or that point above it.
    """
    return sum(_cut(sign * row) for sign in (1.0, -1.0))


def _cut(row: Array) -> int:
    """Return how many samples are cut off at the largest value."""
    levels = np.unique(row)
    if len(levels) < 3:
        return 0
    top = float(levels[-1])
    resolution = max(float(np.diff(levels).min()), 4.0 * float(np.spacing(abs(top))))
    at = row >= top - 1.5 * resolution
    edges = np.flatnonzero(np.diff(np.concatenate([[0], at.astype(np.int8), [0]])))
    starts, stops = edges[::2], edges[1::2]
    inside = (starts >= 2) & (stops <= len(row) - 2)
    starts, stops = starts[inside], stops[inside]
    if len(starts) == 0:
        return 0
    lengths = stops - starts
    steep = top - np.maximum(row[starts - 1], row[stops]) > _STEEP * resolution
    flat = int(lengths[(lengths >= _FLAT) & steep].sum())
    below = np.count_nonzero(row >= top - max(_NEAR * np.ptp(row), 2.5 * resolution))
    many = len(starts) > _RAILS and at.sum() > _CREST * (below - at.sum())
    return flat or (int(lengths.sum()) if many and _would_go_on(row, starts, stops) else 0)


def _would_go_on(row: Array, starts: Array, stops: Array) -> bool:
    """Return whether crests that end at one value differ beside it, or point above it."""
    top, size = float(row.max()), float(np.ptp(row))
    beside = np.minimum(row[starts - 1], row[stops])
    if float(np.std(beside)) > _ALIKE * size:
        return True
    # Through two samples on either side: at -1, -2 and 1, 2 steps of a symmetric parabola.
    first = 0.5 * (row[starts - 1] + row[stops])
    second = 0.5 * (row[starts - 2] + row[stops + 1])
    above = float(np.mean((4.0 * first - second) / 3.0 - top))
    return above > _ABOVE * float(np.mean(top - first))


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
    top = band_limit(record.sampling_frequency)
    if top < TOP_FREQUENCY * (1 - 1e-9):
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


def _felt(row: Array, record: Record) -> Array:
    """Return a channel's velocity within the bands: a hum above them hides no event."""
    fs, n = record.sampling_frequency, len(row)
    f = np.fft.rfftfreq(n, 1.0 / fs)
    passed = ((f >= _FELT[0]) & (f <= _FELT[1])).astype(float)
    if record.quantity == "acceleration":
        passed[1:] /= f[1:]
    return np.fft.irfft(np.fft.rfft(row - row.mean()) * passed, n)


def _loudest(row: Array, fs: float) -> float:
    """Return the largest RMS over a quarter of a second."""
    width = _quarter(fs)
    energy = np.cumsum(np.concatenate([[0.0], (row - row.mean()) ** 2]))
    return float(np.sqrt(np.max(energy[width:] - energy[:-width]) / width))


def _quarter(fs: float) -> int:
    return max(2, round(0.25 * fs))


def _ends(name: str, row: Array, fs: float) -> list[FitnessWarning]:
    """Doubt events that the record's ends cut; `row` is velocity within the bands."""
    peak = _loudest(row, fs)
    if peak < _STEADY * float(np.std(row)):
        return []
    width, centred = _quarter(fs), row - row.mean()
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

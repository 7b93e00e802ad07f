"""Find the events of a record: when its running level stands out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy import ndimage

from trundle._typing import Array
from trundle.criteria import Criterion, Verdict
from trundle.records.survey import RunningLevels

__all__ = ["ChannelEvents", "Event", "find_events"]

_STANDS_OUT = 2.0  # times the median, 6 dB: what a sound level meter's background is left by
_FALLS = np.sqrt(0.5)  # of the threshold, 3 dB: an event ends there
_PAUSE = 1.0  # s: shorter ones, an averaging time, do not end an event
_AT_ONCE = 2**16  # running levels held beside limits at once


@dataclass(frozen=True, kw_only=True, eq=False)
class Event:
    """Hold one event of a channel.

    Attributes
    ----------
    start, end : float
        When the running level rises above the threshold, and falls 3 dB below it [s].
    time : float
        Middle of the second that is loudest [s].
    level : float
        Running RMS velocity then, in that band [m/s].
    band : float
        Mid-band frequency that lies highest beside the curve [Hz]; NaN where no curve is read.
    ratio : float
        Level over limit, or without a curve over the median.
    begins_before, ends_after : bool
        Whether the record's beginning, or its end, cuts it off.
    """

    start: float
    end: float
    time: float
    level: float
    band: float
    ratio: float
    begins_before: bool
    ends_after: bool

    @property
    def duration(self) -> float:
        """How long it lasts [s]."""
        return self.end - self.start


@dataclass(frozen=True, kw_only=True, eq=False)
class ChannelEvents:
    """Hold the events of a channel, and by which rule they are found.

    Attributes
    ----------
    channel : str
        Its name.
    criterion : Criterion or None
        The curve that running levels are held against; None where all motion counts alike.
    exceeded : bool
        Whether that curve is exceeded at any time.
    threshold : float
        What an event exceeds: level over limit, or [m/s] without a curve.
    median : float
        Median of the same.
    share_above : float
        Share of the time above the curve, 0 to 1; NaN without one.
    events : tuple of Event
        In their order.
    """

    channel: str
    criterion: Criterion | None
    exceeded: bool
    threshold: float
    median: float
    share_above: float
    events: tuple[Event, ...]

    @property
    def rule(self) -> str:
        """Say by which rule they are found."""
        ends = "; an event ends 3 dB below that, and pauses of less than 1 s do not end it"
        if self.criterion is None:
            return f"running RMS velocity 6 dB above its median{ends}"
        title = self.criterion.title
        if not self.exceeded:
            return f"running level 6 dB above its median, beside {title}, not exceeded{ends}"
        if self.threshold > 1.0:
            return (
                f"running level above {title} and 6 dB above its median, for {title} is exceeded "
                f"{100 * self.share_above:.3g} % of the time{ends}"
            )
        return f"running level above {title}, the first curve that is exceeded{ends}"


def find_events(
    channel: int, running: RunningLevels, verdicts: Sequence[Verdict], name: str
) -> ChannelEvents:
    """Find the events of a channel.

    Parameters
    ----------
    channel : int
        Its number.
    running : RunningLevels
        Levels over time.
    verdicts : sequence of Verdict
        What it is held against; curves of velocity in bands are read.
    name : str
        Name of the channel.

    Notes
    -----
    An event stands above the widest curve that the record exceeds, for that keeps it from the next
    class; where a record exceeds none, or is never quiet, it stands out by 6 dB above the median
    of the running level, our choice: a steady hum is no event.
    """
    curve = _curve(verdicts)
    if curve is None:
        level = running.whole[channel].astype(float)
        band = np.full(len(level), -1)
        limits = np.ones(len(running.mid_band))
    else:
        limits = np.where(running.shown, curve.limit(running.mid_band), np.nan)
        level, band = _beside(running.bands[channel], limits)
    median = float(np.median(level)) if len(level) else 0.0
    exceeded = curve is not None and bool(np.any(level > 1.0))
    out = _STANDS_OUT * median
    threshold = max(1.0, out) if exceeded else out
    found = _events(level, threshold, running.step)
    return ChannelEvents(
        channel=name,
        criterion=curve,
        exceeded=exceeded,
        threshold=threshold,
        median=median,
        share_above=float(np.mean(level > 1.0)) if curve is not None else np.nan,
        events=tuple(
            _event(running, level, band, limits, part) for part in found if threshold > 0.0
        ),
    )


def _curve(verdicts: Sequence[Verdict]) -> Criterion | None:
    """Return the widest curve exceeded, or the strictest one where none is."""
    read = [
        v for v in verdicts if v.criterion.quantity == "band_rms_velocity" and np.isfinite(v.margin)
    ]
    if not read:
        return None
    failed = [v for v in read if v.status == "fail"]
    one = max(failed, key=lambda v: v.margin) if failed else min(read, key=lambda v: v.margin)
    return one.criterion


def _beside(
    bands: Float[Array, "bands times"], limits: Float[Array, " bands"]
) -> tuple[Float[Array, " times"], Array]:
    """Return the largest level over limit at each time, and in which band."""
    read = np.flatnonzero(np.isfinite(limits))
    ratio, band = np.zeros(bands.shape[1]), np.zeros(bands.shape[1], dtype=int)
    for at in range(0, bands.shape[1], _AT_ONCE):
        part = slice(at, at + _AT_ONCE)
        ratios = bands[read, part] / limits[read, None]
        band[part] = read[ratios.argmax(axis=0)]
        ratio[part] = ratios.max(axis=0)
    return ratio, band


def _events(level: Float[Array, " times"], threshold: float, step: float) -> list[slice]:
    """Return the times of events, from above the threshold to 3 dB below it."""
    above, labels = level > threshold, _FALLS * threshold < level
    numbers, n = ndimage.label(labels)
    if not n:
        return []
    starts, ends = [], []
    for part in ndimage.find_objects(numbers):
        hot = np.flatnonzero(above[part[0]])
        if not len(hot):
            continue
        start = part[0].start + int(hot[0])
        if ends and (start - ends[-1]) * step < _PAUSE:
            ends[-1] = part[0].stop
            continue
        starts.append(start)
        ends.append(part[0].stop)
    return [slice(a, b) for a, b in zip(starts, ends, strict=True)]


def _event(running: RunningLevels, level: Array, band: Array, limits: Array, part: slice) -> Event:
    loudest = part.start + int(level[part].argmax())
    k = int(band[loudest])
    value = float(level[loudest])
    last = len(level) - 1
    return Event(
        start=float(running.time[part.start]),
        end=float(running.time[min(part.stop, last)]),
        time=float(running.time[loudest]),
        level=value if k < 0 else value * float(limits[k]),
        band=np.nan if k < 0 else float(running.mid_band[k]),
        ratio=value,
        begins_before=part.start == 0,
        ends_after=part.stop > last,
    )

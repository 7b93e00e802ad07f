"""Turn time stamps into an even time: rounded, jittering, by the clock; refuse real gaps."""

from __future__ import annotations

import re
from contextlib import suppress
from datetime import datetime, timedelta
from pathlib import Path

import numpy as np
from jaxtyping import Float
from scipy.interpolate import CubicSpline

from trundle._typing import Array
from trundle.errors import InputError

__all__ = ["clock_begin", "clock_seconds", "even_rate", "is_stamp", "on_even_time"]

_CLOCK = re.compile(r"^\d{1,2}:\d{2}(?::\d{2}(?:[.,:]\d+)?)?\s*(?:[AP]M)?$", re.IGNORECASE)
_DATE = re.compile(r"^\d{1,4}[-./]\d{1,2}[-./]\d{1,4}$")
_BOTH = re.compile(
    r"^(?P<date>\d{1,4}[-./]\d{1,2}[-./]\d{1,4})[T\s]+"
    r"(?P<clock>\d{1,2}:\d{2}(?::\d{2}(?:[.,:]\d+)?)?\s*(?:[AP]M)?)\s*(?:Z|[+-]\d{2}:?\d{2})?$",
    re.IGNORECASE,
)
_ORDERS = ((2, 1, 0), (2, 0, 1), (0, 1, 2))  # of year, month and day: day, month or year first
_DAY = 86400.0
_GAP = 2.5  # usual steps: more is a hole that no curve between samples fills
_SHARED = 1.5  # steps: what stamps are written to, from which on samples share one
_DOUBT = 0.01  # relative, of the rate: a tenth of a third octave's width
_STRAY = 0.01  # of a step, that stamps may stray without a word
_CHANGE = 0.1  # of the rate from second to second: more is another rate


def is_stamp(text: str) -> bool:
    """Return whether a cell is a date, a time of day, or both."""
    cell = text.strip().strip('"')
    return any(pattern.match(cell) for pattern in (_CLOCK, _DATE, _BOTH))


def clock_seconds(columns: list[list[str]], path: Path) -> Float[Array, " steps"]:
    """Return seconds since the first of some stamps, in one column or a date and a time of day.

    Parameters
    ----------
    columns : list of list of str
        One column of stamps, or two.
    path : Path
        The file, for messages.

    Raises
    ------
    InputError
        A stamp that cannot be read.
    """
    whole = [" ".join(parts).strip() for parts in zip(*columns, strict=True)]
    matches = [_BOTH.match(text) for text in whole]
    dates = [both["date"] if both else "" for both in matches]
    days = _days(list(dict.fromkeys(dates)))
    out = np.empty(len(whole))
    for i, (text, date, both) in enumerate(zip(whole, dates, matches, strict=True)):
        try:
            # less the first day: a clock's digits would be lost beside 2000 years
            out[i] = days[date] - days[dates[0]] + _seconds(both["clock"] if both else text)
        except (KeyError, ValueError):
            raise InputError(f"{path}: time stamp {i + 1}, {text!r}, cannot be read") from None
    if not any(days.values()):  # times of day alone go back at midnight
        out += _DAY * np.cumsum(np.concatenate([[0.0], np.diff(out) < -0.5 * _DAY]))
    return out - out[0]


def clock_begin(columns: list[list[str]]) -> datetime | None:
    """Return the local time of the first of some stamps; None where it is not told.

    Parameters
    ----------
    columns : list of list of str
        One column of stamps, or two.

    Returns
    -------
    datetime or None
        Of year 1 where stamps are times of day alone; None for dates alone, and for times of
        Greenwich (``Z``), of which nobody says how late it is where the record is from.
    """
    first = " ".join(column[0] for column in columns).strip()
    both = _BOTH.match(first)
    clock = both["clock"] if both else first
    if first.upper().endswith("Z") or not _CLOCK.match(clock):
        return None
    with suppress(ValueError, KeyError):
        day = 2.0 * _DAY  # the second of year 1, for the night before it begins on the first
        if both:
            texts = dict.fromkeys(" ".join(parts).strip() for parts in zip(*columns, strict=True))
            dates = [found["date"] for found in map(_BOTH.match, texts) if found]
            day = _days(list(dict.fromkeys(dates)))[both["date"]]
        seconds = _seconds(clock)
        if seconds < _DAY:
            return datetime.fromordinal(round(day / _DAY)) + timedelta(seconds=seconds)
    return None


def _days(dates: list[str]) -> dict[str, float]:
    """Return the dates of a record in seconds, all read in one order of day, month and year.

    Of orders that give days of the calendar, that counts by which the record is shortest: 05/11 to
    05/12 is a night in May and no month from November on. Between points the day stands first.
    Where no order reads all, dates from the first one on that cannot be read are left out.
    """
    found = [_read_days(dates, order) for order in _ORDERS]
    most = max(map(len, found))
    whole = [days for days in found if len(days) == most]
    if "." in dates[0] or not most:
        return whole[0]
    return min(whole, key=lambda days: max(days.values()) - min(days.values()))


def _read_days(dates: list[str], order: tuple[int, int, int]) -> dict[str, float]:
    """Return dates in seconds, up to the first that is none in an order of year, month and day."""
    found: dict[str, float] = {}
    with suppress(ValueError):
        for date in dates:
            found[date] = _day(date, order) if date else 0.0
    return found


def _day(date: str, order: tuple[int, int, int]) -> float:
    parts = [int(part) for part in re.split(r"[-./]", date)]
    year, month, day = (parts[i] for i in order)
    return _DAY * datetime(year if year > 99 else 2000 + year, month, day).toordinal()


def _seconds(clock: str) -> float:
    text, half = clock.strip(), 0.0
    if text[-2:].upper() in {"AM", "PM"}:
        hour = int(text.split(":")[0])
        half = 12 * 3600.0 * ((text[-2:].upper() == "PM") - (hour == 12))
        text = text[:-2].strip()
    parts = text.replace(",", ".").split(":")
    if len(parts) == 4:  # 10:00:00:250 counts milliseconds
        parts = [*parts[:2], f"{parts[2]}.{parts[3]}"]
    hour, minute, second = [float(part) for part in (*parts, "0")][:3]
    return half + 3600.0 * hour + 60.0 * minute + second


def even_rate(
    time: Float[Array, " steps"], path: Path, *, stated: float | None = None
) -> float | None:
    """Return the sampling rate of time stamps [Hz]; None if they stray, and a curve must help.

    Parameters
    ----------
    time : ndarray of float, shape (n_steps,)
        Time stamps [s].
    path : Path
        The file, for messages.
    stated : float, optional
        Rate that is said elsewhere [Hz]: it counts where stamps are so coarse that they allow it.

    Raises
    ------
    InputError
        Stamps that are no numbers, do not rise, have gaps, change their rate, or are too coarse.
    """
    if not np.isfinite(time).all():
        at = int(np.argmin(np.isfinite(time)))
        raise InputError(f"{path}: time stamp {at + 1} is not a number")
    steps = np.diff(time)
    if np.any(steps < 0.0) or time[-1] <= time[0]:
        raise InputError(f"{path}: time does not rise; sort the record")
    step = float((time[-1] - time[0]) / (len(time) - 1))
    # Stamps are written with so many decimals: they stray by half of the last, and no more.
    exact = 4.0 * np.finfo(float).eps * max(1.0, float(np.abs(time).max()))
    decimals = next((k for k in range(10) if np.abs(time - np.round(time, k)).max() <= exact), 10)
    strays = float(np.abs(time - (time[0] + step * np.arange(len(time)))).max())
    if strays <= 10.0**-decimals + _STRAY * step:
        length = float(time[-1] - time[0])
        return _by_coarse_stamps(step, 10.0**-decimals, length, path, stated)
    usual, at = float(np.median(steps)), int(np.argmax(steps))
    if steps[at] > _GAP * usual + 2.0 * 10.0**-decimals:
        raise InputError(
            f"{path}: gaps in time; the widest after {time[at]:.6g} s ({steps[at]:.4g} s instead "
            f"of {usual:.4g} s); cut the record there"
        )
    per_second = np.diff(np.searchsorted(time, np.arange(time[0], time[-1], 1.0)))
    if len(per_second) > 1 and np.ptp(per_second) > _CHANGE * per_second.mean() + 4.0:
        raise InputError(
            f"{path}: its rate changes, from {per_second.min()} to {per_second.max()} samples a "
            "second; cut the record where it does"
        )
    return None


def _by_coarse_stamps(
    step: float, finest: float, length: float, path: Path, stated: float | None
) -> float:
    """Return the rate that stamps give, or the stated one where several samples share a stamp."""
    rate, doubt = 1.0 / step, finest / length
    if finest <= _SHARED * step or doubt <= _DOUBT:
        return rate
    if stated is not None and abs(stated / rate - 1.0) <= doubt:
        return stated
    raise InputError(
        f"{path}: its time stamps are so coarse that its rate, {rate:.3g} Hz, may be "
        f"{100 * doubt:.2g} % off; say it by --rate"
    )


def on_even_time(
    time: Float[Array, " steps"], samples: Float[Array, "channels steps"]
) -> tuple[float, Float[Array, "channels steps"], str]:
    """Return samples on an even time, by a cubic spline through what was measured.

    Returns
    -------
    rate : float
        Samples per second [Hz].
    samples : ndarray of float, shape (n_channels, n_steps)
        As many as there were.
    note : str
        By how much the stamps stray.
    """
    n = len(time)
    step = float((time[-1] - time[0]) / (n - 1))
    even = time[0] + step * np.arange(n)
    rising = np.concatenate([[True], np.diff(time) > 0.0])
    sound = np.isfinite(samples).all(axis=1)
    out = np.full(samples.shape, np.nan)
    if sound.any():
        curve = CubicSpline(time[rising], samples[sound][:, rising], axis=1)
        out[sound] = curve(even)
    off = float(np.std(np.diff(time)))
    note = (
        f"time stamps stray by {1e3 * off:.3g} ms from step to step ({100 * off / step:.2g} % of "
        f"one), and by {1e3 * np.abs(time - even).max():.3g} ms from an even time; taken to an "
        f"even {1.0 / step:.5g} Hz by a curve through the samples"
    )
    return 1.0 / step, out, note

"""Form vibration dose values of days and nights, where a record knows the time of day."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime, timedelta

import numpy as np
from jaxtyping import Float

from trundle._typing import Array

__all__ = ["PeriodDose", "doses"]

_MORNING, _EVENING = 7, 23  # h: the day of BS 6472-1
_NO_DATE = 1  # a year that says that only the time of day is known


@dataclass(frozen=True, kw_only=True, eq=False)
class PeriodDose:
    """Hold the dose of what was measured in one period.

    Attributes
    ----------
    period : str
        Day or night and its date, or the whole record.
    measured : float
        How much of it the record holds [s].
    length : float
        How long it is: 16 h, 8 h, or the record [s].
    values : ndarray of float, shape (n_channels,)
        Vibration dose values of what was measured, for no more than that [m/s^1.75].
    """

    period: str
    measured: float
    length: float
    values: Float[Array, " channels"]


def doses(
    dose: Float[Array, "channels seconds"], duration: float, begin: datetime | None
) -> tuple[PeriodDose, ...]:
    """Return the vibration dose values of each day (7 to 23 h) and night, or of the record.

    Parameters
    ----------
    dose : ndarray of float, shape (n_channels, n_seconds)
        Fourth power of weighted acceleration, integrated over each second [m4/s7].
    duration : float
        Length of the record [s].
    begin : datetime or None
        Local time of the first sample; of year 1 where no date is known.

    Notes
    -----
    The sum of fourth powers, not extended to hours that were not measured: a dose of a part of a
    period is a lower bound of that of the period.

    References
    ----------
    BS 6472-1:2008, 3.5 (day and night).
    """
    if begin is None:
        whole = np.sum(dose, axis=1) ** 0.25
        return (PeriodDose(period="record", measured=duration, length=duration, values=whole),)
    found = []
    at, end = 0.0, duration
    while at < end:
        name, until, length = _period(begin + timedelta(seconds=at), begin)
        stop = min((until - begin).total_seconds(), end)
        # A second in which one period ends and another begins counts for that it begins in.
        part = slice(int(np.ceil(at)), int(np.ceil(stop)))
        found.append(
            PeriodDose(
                period=name,
                measured=stop - at,
                length=length,
                values=np.sum(dose[:, part], axis=1) ** 0.25,
            )
        )
        at = stop
    return tuple(found)


def _period(now: datetime, begin: datetime) -> tuple[str, datetime, float]:
    """Return the period that a time is in: its name, its end and its length [s]."""
    midnight = now.replace(hour=0, minute=0, second=0, microsecond=0)
    morning, evening = midnight + timedelta(hours=_MORNING), midnight + timedelta(hours=_EVENING)
    if morning <= now < evening:
        what, first, end = "day, 7 to 23 h", midnight, evening
    else:
        late = now >= evening
        what, first = "night, 23 to 7 h", midnight if late else midnight - timedelta(days=1)
        end = morning + timedelta(days=1) if late else morning
    length = 3600.0 * (_EVENING - _MORNING if what.startswith("day") else 24 - _EVENING + _MORNING)
    if begin.year != _NO_DATE:
        return f"{what}, {first:%Y-%m-%d}", end, length
    number = (midnight - begin.replace(hour=0, minute=0, second=0, microsecond=0)).days
    return what + (f" ({number + 1})" if number else ""), end, length

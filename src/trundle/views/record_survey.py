"""Arrange how a record runs: events, doses, levels exceeded for shares of the time, spectra."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from datetime import datetime, timedelta
from typing import Any

import numpy as np

from trundle.records.assess import RecordResult
from trundle.signals import nominal_frequency
from trundle.study.report_plan import ReportPlan
from trundle.units import MICROMETRE_PER_SECOND
from trundle.views.words import USUAL, shown

__all__ = [
    "EVENT_HEADINGS",
    "PERCENTILE_HEADINGS",
    "SHARES",
    "csv_table",
    "dose_rows",
    "event_rows",
    "percentile_rows",
    "psd_table",
    "running_table",
    "shown_events",
]

EVENT_HEADINGS = (
    "channel",
    "start_s",
    "end_s",
    "duration_s",
    "clock",
    "level_um_s",
    "band_hz",
    "criterion",
    "margin",
    "cut",
)
"""Columns of the table of events."""

PERCENTILE_HEADINGS = ("channel", "band_hz", "max_um_s", "L10_um_s", "L50_um_s", "mean_um_s")
"""Columns of the table of levels exceeded for shares of the time."""

SHARES = {"L10": 0.1, "L50": 0.5}
"""Names of levels that are exceeded for a share of the time."""


def event_rows(result: RecordResult) -> list[dict[str, Any]]:
    """Return the events of all channels, for programs; the time of day where it is known."""
    return [
        {
            "channel": one.channel,
            "start_s": event.start,
            "end_s": event.end,
            "duration_s": event.duration,
            "clock": clock(result.record.begin, event.start),
            "level_um_s": event.level / MICROMETRE_PER_SECOND,
            "band_hz": np.nan if np.isnan(event.band) else nominal_frequency(event.band),
            "criterion": "" if one.criterion is None else one.criterion.name,
            "margin": np.nan if one.criterion is None else 1.0 / event.ratio,
            "cut": _cut(event.begins_before, event.ends_after),
        }
        for one in result.events
        for event in one.events
    ]


def shown_events(result: RecordResult, report: ReportPlan = USUAL) -> list[dict[str, Any]]:
    """Return the same for people: the level in the units of a report."""
    _, size = shown("m/s", report)
    levels = [event.level / size for one in result.events for event in one.events]
    rows = zip(event_rows(result), levels, strict=True)
    return [{**row, "level": level} for row, level in rows]


def _cut(before: bool, after: bool) -> str:
    """Say which ends of an event the record does not hold."""
    both = [word for word, is_cut in (("beginning", before), ("end", after)) if is_cut]
    return " and ".join(both)


def clock(begin: datetime | None, seconds: float) -> str:
    """Return the time of day so many seconds after a beginning; nothing where it is not known."""
    if begin is None:
        return ""
    now = begin + timedelta(seconds=round(seconds, 1))
    short = f"{now:%H:%M:%S}"
    return short if begin.year == 1 else f"{now:%Y-%m-%d} {short}"


def dose_rows(result: RecordResult) -> list[dict[str, Any]]:
    """Return vibration dose values by channel and period."""
    return [
        {
            "channel": name,
            "period": one.period,
            "measured_h": one.measured / 3600.0,
            "of_h": one.length / 3600.0,
            "vdv": float(one.values[i]),
        }
        for i, name in enumerate(result.record.channel_names)
        for one in result.doses
    ]


def percentile_rows(result: RecordResult) -> Iterator[dict[str, Any]]:
    """Give in each band the largest level, L10, L50 and the mean of every channel [um/s].

    Yields
    ------
    dict
        A row for each channel and band; what is not shown is NaN.
    """
    running = result.survey.running
    shares = {name: running.exceeded(share) for name, share in SHARES.items()}
    for i, channel in enumerate(result.record.channel_names):
        for k, f in enumerate(running.mid_band):
            levels = {
                "max": result.reduced.spectra.values[0, i, k],
                **{name: values[i, k] for name, values in shares.items()},
                "mean": result.survey.mean_levels[i, k],
            }
            yield {
                "channel": channel,
                "band_hz": nominal_frequency(float(f)),
                **{f"{n}_um_s": float(v) / MICROMETRE_PER_SECOND for n, v in levels.items()},
            }


def psd_table(result: RecordResult) -> tuple[list[str], Iterator[list[str]]]:
    """Return headings and rows of the PSD of velocity, a row a line [(um/s)2/Hz]."""
    spectrum = result.survey.spectrum
    headings = ["frequency_hz", *(f"{n} [(um/s)2/Hz]" for n in result.record.channel_names)]
    values = spectrum.psd.T / MICROMETRE_PER_SECOND**2
    return headings, _numbers(spectrum.frequencies, values)


def running_table(result: RecordResult) -> tuple[list[str], Iterator[list[str]]]:
    """Return headings and rows of the running RMS velocity, a row a time [um/s]."""
    running = result.survey.running
    headings = ["time_s", *(f"{n} [um/s]" for n in result.record.channel_names)]
    return headings, _numbers(running.time, running.whole.T / MICROMETRE_PER_SECOND)


def _numbers(first: np.ndarray, others: np.ndarray) -> Iterator[list[str]]:
    for at, values in zip(first, others, strict=True):
        yield [f"{at:.10g}", *(f"{v:.6g}" for v in values)]


def csv_table(
    rows: Iterator[dict[str, Any]] | Sequence[dict[str, Any]], headings: Sequence[str]
) -> tuple[list[str], Iterator[list[str]]]:
    """Return headings and cells as a file takes them; what is not a number is empty.

    Parameters
    ----------
    rows : iterator or sequence of dict
        The rows, with the same keys in each.
    headings : sequence of str
        Their keys, for a table without rows has headings too.
    """
    return list(headings), ([_cell(row[h]) for h in headings] for row in rows)


def _cell(value: object) -> str:
    if isinstance(value, float):
        return "" if np.isnan(value) else f"{value:.6g}"
    return str(value)

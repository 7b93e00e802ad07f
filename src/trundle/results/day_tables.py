"""Arrange days, and sources that act together, as rows of tables in SI."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from trundle.results.expected_days import DayRow, day_doses, day_rows
from trundle.results.study_result import StudyResult
from trundle.results.together import together_rows

__all__ = ["day_table", "dose_table", "hour_table", "together_table"]


def day_table(result: StudyResult) -> Iterator[dict[str, Any]]:
    """Give a row for every criterion of a day at a point.

    Parameters
    ----------
    result : StudyResult
        A finished study.

    Yields
    ------
    dict
        Columns with their units.
    """
    for row in day_rows(result):
        expected = row.expected
        yield {
            "schedule": row.key.schedule,
            "road": row.key.road,
            "point": row.point,
            "criterion": row.criterion.name,
            "bound": "" if row.complete or np.isnan(expected.events) else "lower",
            "events_per_day": expected.events,
            "events_low": expected.events_interval[0],
            "events_high": expected.events_interval[1],
            "events_on_95_percent_of_days_from": expected.events_on_days[0],
            "events_on_95_percent_of_days_to": expected.events_on_days[1],
            "chance_of_any": expected.any_event,
            "minutes_per_day": expected.minutes,
            "minutes_low": expected.minutes_interval[0],
            "minutes_high": expected.minutes_interval[1],
            "events_of_day_run": row.events_run,
            "minutes_of_day_run": row.minutes_run,
            **_loudest(row),
        }


def _loudest(row: DayRow) -> dict[str, Any]:
    """Return the largest level of the day that was run, and who was there."""
    found = None
    if row.day is not None:
        both = (row.criterion.name, row.point)
        found = next((x for x in row.day.loudest if (x.criterion, x.point) == both), None)
    return {
        "largest_level_over_limit": np.nan if found is None else found.ratio,
        "largest_in_band_hz": np.nan if found is None else found.band,
        "largest_at_s": np.nan if found is None else found.time,
        "present": []
        if found is None
        else [
            f"{one.route} departed {one.departed:.1f} s, "
            + ("leaving" if np.isnan(one.x) else f"at ({one.x:.2f}, {one.y:.2f}) m")
            + f", {one.rms_velocity:.3g} m/s"
            for one in found.present
        ],
    }


def hour_table(result: StudyResult) -> Iterator[dict[str, Any]]:
    """Give a row for every hour of a day beside every criterion at a point.

    Parameters
    ----------
    result : StudyResult
        A finished study.

    Yields
    ------
    dict
        Columns with their units.
    """
    for row in day_rows(result):
        for hour in range(24):
            run, seconds = np.nan, np.nan
            if row.day is not None:
                criterion, point = row.place
                seconds = float(row.day.seconds_above[hour, criterion, point])
                if np.isfinite(seconds):  # else it has no running level, and nobody counted
                    run = float(row.day.events[hour, criterion, point])
            yield {
                "schedule": row.key.schedule,
                "road": row.key.road,
                "point": row.point,
                "criterion": row.criterion.name,
                "hour": hour,
                "events_expected": float(row.expected.by_hour[hour]),
                "events_of_day_run": run,
                "seconds_of_day_run": seconds,
            }


def dose_table(result: StudyResult) -> Iterator[dict[str, Any]]:
    """Give a row for the vibration doses of every day at a point.

    Parameters
    ----------
    result : StudyResult
        A finished study.

    Yields
    ------
    dict
        Columns with their units.
    """
    for one in day_doses(result):
        yield {
            "schedule": one.key.schedule,
            "road": one.key.road,
            "point": one.point,
            "vdv_day_m_s1.75": one.vdv_day,
            "vdv_night_m_s1.75": one.vdv_night,
            "evdv_day_m_s1.75": one.evdv_day,
            "evdv_night_m_s1.75": one.evdv_night,
            "vdv_of_day_run_m_s1.75": one.run_day,
            "vdv_of_night_run_m_s1.75": one.run_night,
        }


def together_table(result: StudyResult) -> Iterator[dict[str, Any]]:
    """Give a row for every case of several sources beside a criterion at a point.

    Parameters
    ----------
    result : StudyResult
        A finished study.

    Yields
    ------
    dict
        Columns with their units.
    """
    for row in together_rows(result):
        yield {
            "case": row.case,
            "road": row.road,
            "point": row.point,
            "criterion": row.verdict.criterion.name,
            "margin_together": row.verdict.margin,
            "margin_by_energy": row.by_energy,
            "margin_by_sum": row.by_sum,
            "band_hz": row.band,
            "governed_by": row.governs,
            "share_of_energy": row.shares.get(row.governs, np.nan),
            "margins_alone": [f"{name} {margin:.4g}" for name, margin in row.alone.items()],
        }

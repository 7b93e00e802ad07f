"""Say in words and numbers what a day has above limits, and who governs where sources meet."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from trundle.results.cells import CellKey, DayKey
from trundle.results.expected_days import DayDoses, DayRow, day_doses, day_rows
from trundle.results.study_result import StudyResult
from trundle.results.together import Together, together_rows
from trundle.study.report_plan import ReportPlan
from trundle.traffic import Day, Loudest
from trundle.views.words import USUAL, hertz, shown

__all__ = ["DayLine", "DayView", "TogetherLine", "clock", "day_views", "together_lines"]


_OVERLAP = 0.3  # of an hour that passages fill, from which on many overlap


@dataclass(frozen=True, kw_only=True)
class DayLine:
    """Hold one row of a day's table, in words.

    Attributes
    ----------
    point, criterion : str
        Names.
    events, minutes : str
        Expected a day, with their intervals.
    days, chance : str
        Events on 95 % of days, and the chance of a day with any.
    run : str
        Events and minutes of the day that was run.
    loudest : str
        Largest level of that day, when it was, and who was there.
    quiet : bool
        Whether nothing is expected or was found above it.
    """

    point: str
    criterion: str
    events: str
    minutes: str
    days: str
    chance: str
    run: str
    loudest: str
    quiet: bool


@dataclass(frozen=True, kw_only=True, eq=False)
class DayView:
    """Hold what is shown of one day.

    Attributes
    ----------
    key : DayKey
        Schedule and road.
    passages : str
        How many drive, in the mean and on the day that was run.
    lines : tuple of DayLine
        The table.
    doses : tuple of DayDoses
        Vibration doses, by point.
    meeting : str
        What adding up leaves out.
    """

    key: DayKey
    passages: str
    lines: tuple[DayLine, ...]
    doses: tuple[DayDoses, ...]
    meeting: str


@dataclass(frozen=True, kw_only=True)
class TogetherLine:
    """Hold one row of the table of sources that act together, in words."""

    case: str
    road: str
    point: str
    criterion: str
    together: str
    energy: str
    total: str
    alone: str
    governs: str


def clock(seconds: float) -> str:
    """Write a time of the day."""
    whole = int(seconds)
    return f"{whole // 3600:02d}:{whole // 60 % 60:02d}:{whole % 60:02d}"


def day_views(result: StudyResult) -> list[DayView]:
    """Return every day of a result, as it is shown."""
    rows, doses = list(day_rows(result)), list(day_doses(result))
    found: list[DayView] = []
    for key in dict.fromkeys(row.key for row in rows):
        day = result.days.get(key)
        found.append(
            DayView(
                key=key,
                passages=_passages(result, key, day),
                lines=tuple(_line(row, result.study.report) for row in rows if row.key == key),
                doses=tuple(dose for dose in doses if dose.key == key),
                meeting=_meeting(day),
            )
        )
    return found


def _passages(result: StudyResult, key: DayKey, day: Day | None) -> str:
    schedule = result.study.schedules[key.schedule]
    each = ", ".join(f"{name} {n.sum():.4g}" for name, n in schedule.expected().items())
    said = f"{schedule.per_day:.4g} passages a day ({each})"
    filled = _filled(result, key)
    if filled > _OVERLAP:
        said += (
            f"; in the busiest hour they fill {100.0 * filled:.0f} % of it and overlap: what is "
            "expected counts each, and the day that was run counts what is felt"
        )
    if day is None:
        return said
    return (
        f"{said}; on the day that was run {day.n_passages}, up to {day.at_once} at once, somebody "
        f"there or the floor ringing for {_n(day.busy / 60.0)} min"
    )


def _filled(result: StudyResult, key: DayKey) -> float:
    """Return what part of the busiest hour passages fill, one after the other."""
    assessment, schedule = result.study.assessment, result.study.schedules[key.schedule]
    assert assessment is not None  # else there is no day
    seconds = np.zeros(24)
    for route, counts in schedule.expected().items():
        cell = result.cells[CellKey(route, key.road, assessment.method)]
        seconds += counts * float(cell.history.time[-1])
    return float(seconds.max()) / 3600.0


def _meeting(day: Day | None) -> str:
    if day is None or np.isnan(day.meeting_error):
        return "no two vehicles meet on the floor"
    if day.meeting_error == 0.0:
        return "vehicles do not feel the floor, so that their sum is exact"
    return (
        "passages are added up; the two that meet closest, run together, differ by "
        f"{100.0 * day.meeting_error:.2g} % of the RMS velocity"
    )


def _line(row: DayRow, report: ReportPlan) -> DayLine:
    expected = row.expected
    least = "" if row.complete else "at least "
    low, high = expected.events_on_days
    minutes = "no running level"
    if np.isfinite(expected.minutes):
        minutes = least + _between(expected.minutes, expected.minutes_interval)
    run = "" if np.isnan(row.events_run) else f"{row.events_run:.0f}, {_n(row.minutes_run)} min"
    known = bool(np.isfinite(expected.events))
    events = least + _between(expected.events, expected.events_interval)
    return DayLine(
        point=row.point,
        criterion=row.criterion.title,
        events=events if known else "not assessed",
        minutes=minutes if known else "",
        days=f"{low:.0f} to {high:.0f}" if known else "",
        chance=f"{100.0 * expected.any_event:.3g} %" if known else "",
        run=run,
        loudest=_loudest(row, report),
        quiet=expected.events == 0.0 and not row.events_run > 0.0,
    )


def _between(value: float, interval: tuple[float, float]) -> str:
    low, high = interval
    if value == 0.0:
        return "none" if np.isnan(high) else f"none (below {_n(high)})"
    return f"{_n(value)} ({f'from {_n(low)}' if np.isnan(high) else f'{_n(low)}-{_n(high)}'})"


def _n(value: float) -> str:
    """Write a number of three digits as people do."""
    return f"{value:.0f}" if abs(value) >= 100.0 else f"{value:.3g}"


def _loudest(row: DayRow, report: ReportPlan) -> str:
    if row.day is None:
        return ""
    both = (row.criterion.name, row.point)
    found = next((x for x in row.day.loudest if (x.criterion, x.point) == both), None)
    return "" if found is None or found.ratio == 0.0 else loudest_words(found, report)


def loudest_words(found: Loudest, report: ReportPlan = USUAL) -> str:
    """Say how large a level was, when, and who was there."""
    at = "" if np.isnan(found.band) else f" at {hertz(found.band)} Hz"
    unit, size = shown("m/s", report)
    who = []
    for one in found.present:
        where = "leaving" if np.isnan(one.x) else f"at ({one.x:.1f}, {one.y:.1f}) m"
        who.append(
            f"{one.route} of {clock(one.departed)} {where}, alone "
            f"{one.rms_velocity / size:.3g} {unit}"
        )
    return f"{found.ratio:.3g} times the limit{at}, {clock(found.time)}: {'; '.join(who)}"


def together_lines(result: StudyResult) -> list[TogetherLine]:
    """Return every case of several sources beside every criterion, as it is shown."""
    return [_together(row) for row in together_rows(result)]


def _together(row: Together) -> TogetherLine:
    at = "" if np.isnan(row.band) else f" at {hertz(row.band)} Hz"
    share = row.shares.get(row.governs, np.nan)
    return TogetherLine(
        case=row.case,
        road=row.road,
        point=row.point,
        criterion=row.verdict.criterion.title,
        together=f"{row.verdict.status} {row.verdict.margin:.3g}",
        energy=f"{row.by_energy:.3g}",
        total=f"{row.by_sum:.3g}",
        alone=", ".join(f"{name} {margin:.3g}" for name, margin in row.alone.items()),
        governs=f"{row.governs}, {100.0 * share:.0f} % of the energy{at}",
    )

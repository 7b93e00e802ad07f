"""Say what to expect of days, from the runs of their routes and the schedule's counts."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from trundle._typing import Array
from trundle.criteria import BY_FREQUENCY, Criterion
from trundle.results.cells import Cell, CellKey, DayKey
from trundle.results.study_result import StudyResult
from trundle.signals import TOP_FREQUENCY, estimated_dose_value
from trundle.traffic import Day, Expected, OnePassage, Schedule, expected_day

__all__ = ["DayDoses", "DayRow", "day_doses", "day_rows"]

_DAY = slice(7, 23)  # hours of BS 6472-1's day


@dataclass(frozen=True, kw_only=True, eq=False)
class DayRow:
    """Hold what a day has above one criterion at one point: expected, and of the day that was run.

    Attributes
    ----------
    key : DayKey
        Schedule and road.
    point : str
        Name of the point.
    criterion : Criterion
        The curve.
    expected : Expected
        Means with their intervals; NaN where nothing that the criterion asks for is known.
    complete : bool
        Whether everything that the criterion asks for was computed for every route; else what lies
        above it is a lower bound.
    day : Day or None
        The day that was run.
    """

    key: DayKey
    point: str
    criterion: Criterion
    expected: Expected
    complete: bool
    day: Day | None

    @property
    def place(self) -> tuple[int, int]:
        """Place of criterion and point among those of the day that was run."""
        assert self.day is not None  # the caller has looked
        return self.day.criteria.index(self.criterion.name), self.day.point_names.index(self.point)

    @property
    def events_run(self) -> float:
        """How often a level came to lie above on the day that was run; NaN without one."""
        if self.day is None or np.isnan(self.minutes_run):
            return np.nan
        criterion, point = self.place
        return float(self.day.events[:, criterion, point].sum())

    @property
    def minutes_run(self) -> float:
        """For how long on the day that was run [min]; NaN without one, or a running level."""
        if self.day is None:
            return np.nan
        criterion, point = self.place
        return float(self.day.seconds_above[:, criterion, point].sum()) / 60.0


@dataclass(frozen=True, kw_only=True)
class DayDoses:
    """Hold vibration doses of a day at one point [m/s^1.75], expected from single passages.

    Attributes
    ----------
    key : DayKey
        Schedule and road.
    point : str
        Name of the point.
    vdv_day, vdv_night : float
        Vibration dose values from 7 to 23 h, and of the other hours.
    evdv_day, evdv_night : float
        The same estimated from RMS values: ``1.4 a_rms T^0.25``, for motion without high crests.
    run_day, run_night : float
        Of the day that was run, in which passages add up in time; NaN without one.
    """

    key: DayKey
    point: str
    vdv_day: float
    vdv_night: float
    evdv_day: float
    evdv_night: float
    run_day: float
    run_night: float


def day_rows(result: StudyResult) -> Iterator[DayRow]:
    """Give what every day has above every criterion at every point.

    Parameters
    ----------
    result : StudyResult
        A finished study.

    Yields
    ------
    DayRow
        By schedule, road, point and criterion; limits on motion in another direction than a
        point's are left out.
    """
    assessment = result.study.assessment
    if assessment is None:
        return
    for name, schedule in result.study.schedules.items():
        for road in result.study.roads:
            cells = _cells(result, schedule, road)
            ways = result.study.point_ways or ("vertical",) * len(result.study.points)
            for i, (point, way) in enumerate(zip(result.study.points, ways, strict=True)):
                for criterion in assessment.criteria:
                    if criterion.axis not in {way, "each axis"} or criterion.quantity == "vdv":
                        continue  # doses of days are held by `day_doses`
                    found = {r: _passage(cell, criterion, i) for r, cell in cells.items()}
                    yield DayRow(
                        key=DayKey(name, road),
                        point=point,
                        criterion=criterion,
                        expected=_expected(schedule, found),
                        complete=all(whole for _, whole in found.values()),
                        day=result.days.get(DayKey(name, road)),
                    )


def _expected(schedule: Schedule, found: Mapping[str, tuple[OnePassage | None, bool]]) -> Expected:
    """Return what to expect; of a route of which nothing is known, what the others give."""
    passages = {route: one for route, (one, _) in found.items() if one is not None}
    counts = {
        r: hours for r, hours in schedule.expected().items() if r not in set(found) - set(passages)
    }
    if passages:
        return expected_day(passages, counts, random=schedule.is_random)
    nothing = (np.nan, np.nan)
    return Expected(
        events=np.nan,
        events_interval=nothing,
        events_on_days=nothing,
        any_event=np.nan,
        by_hour=np.full(24, np.nan),
        minutes=np.nan,
        minutes_interval=nothing,
    )


def _cells(result: StudyResult, schedule: Schedule, road: str) -> dict[str, Cell]:
    """Return the cell of every route by the assessed method."""
    assessment = result.study.assessment
    assert assessment is not None  # the caller has looked
    return {
        route: result.cells[CellKey(route, road, assessment.method)] for route in schedule.routes
    }


def _passage(cell: Cell, criterion: Criterion, point: int) -> tuple[OnePassage | None, bool]:
    """Return one passage beside a criterion, and whether all that this asks for is known.

    None stands for a passage of which nothing is known that the criterion asks for.
    """
    levels, reach = cell.reduced, cell.coverage
    seconds = levels.above[criterion.name][:, point]
    if criterion.quantity in BY_FREQUENCY:
        spectra = {"band_rms_velocity": levels.spectra, **levels.more}[criterion.quantity]
        limits = criterion.limit(spectra.mid_band)
        asked = np.isfinite(limits)
        known = asked & spectra.resolved & reach.excites(spectra.mid_band)
        lines = criterion.quantity == "narrow_band_acceleration"
        beyond = not lines and len(criterion.bands_beyond()) > 0
        whole = not (asked & ~known).any() and not beyond
        if not known.any():
            return None, False
        exceeds = (spectra.values[:, point, known] > limits[known]).any(axis=1)
        read = bool(np.isfinite(seconds).all())  # narrow lines have no running level
        if read and spectra.averaging != "max_1s":  # a day is read by that of 1 s
            exceeds = seconds > 0.0
    else:
        top = float(min(criterion.frequencies[-1], TOP_FREQUENCY)) * (1 - 1e-6)
        whole = min(cell.f_resolved, reach.excited_to) >= top
        exceeds = levels.numbers[criterion.quantity][:, point] > float(criterion.limits[0])
    return OnePassage(exceeds=np.asarray(exceeds), seconds=seconds), bool(whole and reach.left)


def day_doses(result: StudyResult) -> Iterator[DayDoses]:
    """Give the vibration doses of every day at every point.

    Parameters
    ----------
    result : StudyResult
        A finished study.

    Yields
    ------
    DayDoses
        By schedule, road and point.
    """
    if result.study.assessment is None:
        return
    for name, schedule in result.study.schedules.items():
        counts = schedule.expected()
        for road in result.study.roads:
            key = DayKey(name, road)
            cells, day = _cells(result, schedule, road), result.days.get(key)
            for i, point in enumerate(result.study.points):
                vdv, evdv = _doses(cells, counts, i)
                yield DayDoses(
                    key=key,
                    point=point,
                    vdv_day=vdv[0],
                    vdv_night=vdv[1],
                    evdv_day=evdv[0],
                    evdv_night=evdv[1],
                    run_day=np.nan if day is None else float(day.dose_day[i]),
                    run_night=np.nan if day is None else float(day.dose_night[i]),
                )


def _doses(
    cells: dict[str, Cell], counts: dict[str, Float[Array, " hours"]], point: int
) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return VDV and estimated VDV, by day and by night: fourth powers of passages add up."""
    vdv, evdv = np.zeros(2), np.zeros(2)
    for route, cell in cells.items():
        by_day = float(counts[route][_DAY].sum())
        number = np.array([by_day, float(counts[route].sum()) - by_day])
        numbers, length = cell.reduced.numbers, float(cell.history.time[-1])
        vdv += number * np.mean(numbers["vdv"][:, point] ** 4)
        estimate = estimated_dose_value(numbers["weighted_rms"][:, point], length)
        evdv += number * np.mean(estimate**4)
    day, night = (vdv**0.25).tolist()
    return (day, night), tuple((evdv**0.25).tolist())  # pyright: ignore[reportReturnType]

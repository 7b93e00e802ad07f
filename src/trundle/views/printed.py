"""Hold published values beside ours."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from trundle.response import percentile_rank, upper_bounds
from trundle.results.cells import CellKey
from trundle.results.study_result import StudyResult
from trundle.study.plans import PrintedBound
from trundle.views.words import Range, shown, spread

__all__ = ["BoundRow", "ComparisonRow", "bound_rows", "comparison_rows"]


@dataclass(frozen=True, kw_only=True)
class ComparisonRow:
    """Hold a printed cell beside ours, with the percentile at which it falls.

    Attributes
    ----------
    case, road, method : str
        The cell.
    peak, rms : tuple of float
        Our 5, 50 and 95 %, in the report's units.
    printed_peak, printed_rms : float
        Printed values.
    peak_rank, rms_rank : float
        Share of our runs below the printed value, 0 to 100.
    """

    case: str
    road: str
    method: str
    peak: Range
    rms: Range
    printed_peak: float
    printed_rms: float
    peak_rank: float
    rms_rank: float


@dataclass(frozen=True, kw_only=True)
class BoundRow:
    """Hold a printed upper bound beside ours, and the rule behind ours."""

    bound: str
    rule: str
    road: str
    method: str
    peak: float
    rms: float
    printed_peak: float
    printed_rms: float


def comparison_rows(result: StudyResult) -> list[ComparisonRow]:
    """Return the printed cells beside ours, at the study's first point."""
    rows = []
    a_unit, v_unit = (shown(unit, result.study.report)[1] for unit in ("m/s2", "m/s"))
    for printed in result.study.printed:
        cell = result.cells[CellKey(printed.case, printed.road, printed.method)]
        peak, rms = cell.peak_acceleration[:, 0], cell.rms_velocity[:, 0]
        rows.append(
            ComparisonRow(
                case=printed.case,
                road=printed.road,
                method=printed.method,
                peak=spread(peak, a_unit),
                rms=spread(rms, v_unit),
                printed_peak=printed.peak_acceleration / a_unit,
                printed_rms=printed.rms_velocity / v_unit,
                peak_rank=percentile_rank(printed.peak_acceleration, peak),
                rms_rank=percentile_rank(printed.rms_velocity, rms),
            )
        )
    return rows


def bound_rows(result: StudyResult) -> list[BoundRow]:
    """Return the printed upper bounds beside ours, from the medians of single routes.

    An absolute maximum is given twice, as the sum and as the root sum of squares: the
    printed accelerations are sums, the printed velocities nearer to the other.
    """
    study = result.study
    a_unit, v_unit = (shown(unit, study.report)[1] for unit in ("m/s2", "m/s"))
    named = {row.case for row in study.printed}
    # a bound is of the published vehicle, whatever else drives beside it
    theirs = {
        study.drives[route].vehicle.name
        for case in study.cases
        if case.name in named
        for route in case.routes
        if route in study.drives
    }
    singles = [
        case.name
        for case in study.cases
        if len(case.routes) == 1
        and case.routes[0] in study.drives
        and (not theirs or study.drives[case.routes[0]].vehicle.name in theirs)
    ]
    many = [case.name for case in study.cases if len(case.routes) > 1]
    rows = []
    for printed in study.printed_bounds:
        medians = {case: _medians(result, case, printed) for case in (*singles, *many)}
        peaks = upper_bounds([medians[case][0] for case in singles])
        rms = upper_bounds([medians[case][1] for case in singles])
        ours: list[tuple[str, float, float]] = []
        if printed.bound == "single":
            ours = [("largest single route", peaks.largest, rms.largest)]
        elif printed.bound == "absolute maximum":
            ours = [
                ("sum", peaks.absolute_sum, rms.absolute_sum),
                ("root sum of squares", peaks.root_sum_square, rms.root_sum_square),
            ]
        elif many:
            ours = [(f"simulated: {many[0]}", *medians[many[0]])]
        rows += [
            BoundRow(
                bound=printed.bound,
                rule=rule,
                road=printed.road,
                method=printed.method,
                peak=peak / a_unit,
                rms=velocity / v_unit,
                printed_peak=printed.peak_acceleration / a_unit,
                printed_rms=printed.rms_velocity / v_unit,
            )
            for rule, peak, velocity in ours
        ]
    return rows


def _medians(result: StudyResult, case: str, printed: PrintedBound) -> tuple[float, float]:
    cell = result.cells[CellKey(case, printed.road, printed.method)]
    peak, rms = cell.peak_acceleration[:, 0], cell.rms_velocity[:, 0]
    return float(np.median(peak)), float(np.median(rms))

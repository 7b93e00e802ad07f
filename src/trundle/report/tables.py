"""Arrange results in the tables of the screen and the report, in engineers' units."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from trundle.criteria import Verdict
from trundle.dynamics import Modal
from trundle.response import percentile_interval, percentile_rank, upper_bounds
from trundle.results.cells import CellKey
from trundle.results.study_result import StudyResult
from trundle.road import CLASS_NAMES, class_limits
from trundle.study.model import PrintedBound, Study
from trundle.units import GAL, MICROMETRE_PER_SECOND

__all__ = [
    "BoundRow",
    "ComparisonRow",
    "ExactRow",
    "SummaryRow",
    "TruncationRow",
    "bound_rows",
    "comparison_rows",
    "exact_rows",
    "road_words",
    "roughest_words",
    "summary_rows",
    "truncation_rows",
    "verdict_matrix",
    "written",
]

Range = tuple[float, float, float]
"""5 %, 50 % and 95 % of the runs."""


@dataclass(frozen=True, kw_only=True)
class SummaryRow:
    """Hold one cell's ranges: peak acceleration [gal], record RMS velocity [um/s]."""

    case: str
    road: str
    method: str
    point: str
    peak: Range
    rms: Range


@dataclass(frozen=True, kw_only=True)
class ExactRow:
    """Hold exact statistics of one cell beside those of its runs.

    Attributes
    ----------
    case, road, method, point : str
        The cell.
    rms, sampled_rms : float
        Root of the mean square velocity over record and roads, exact and of the runs [um/s].
    peak, sampled_peak : tuple of float
        50 and 95 % of the peak acceleration, by the exact moments and of the runs [gal].
    interval : tuple of float
        Where the runs' 95 % peak lies with 95 % confidence [gal].
    quadrature_error : float
        Of the exact statistics.
    """

    case: str
    road: str
    method: str
    point: str
    rms: float
    sampled_rms: float
    peak: tuple[float, float]
    sampled_peak: tuple[float, float]
    interval: tuple[float, float]
    quadrature_error: float

    @property
    def between(self) -> str:
        """Write the interval; few runs leave it open."""
        low, high = self.interval
        if np.isfinite(low) and np.isfinite(high):
            return f"{written(low)}-{written(high)}"
        return f"above {written(low)}" if np.isfinite(low) else "too few runs for limits"


@dataclass(frozen=True, kw_only=True)
class TruncationRow:
    """Hold what the highest octave of a method's modes changes, the largest of all points.

    Attributes
    ----------
    case, method : str
        The cells of all roads, whose relative changes hardly differ.
    f_max, fewer : float
        Highest frequency of the modes used, and of those compared with [Hz].
    velocity, acceleration : float
        RMS of the difference over that of the response.
    """

    case: str
    method: str
    f_max: float
    fewer: float
    velocity: float
    acceleration: float


@dataclass(frozen=True, kw_only=True)
class ComparisonRow:
    """Hold a printed cell beside ours, with the percentile at which it falls.

    Attributes
    ----------
    case, road, method : str
        The cell.
    peak, rms : tuple of float
        Our 5, 50 and 95 % [gal], [um/s].
    printed_peak, printed_rms : float
        Printed values [gal], [um/s].
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


def _range(values: np.ndarray, unit: float) -> Range:
    low, middle, high = np.percentile(values, [5.0, 50.0, 95.0]) / unit
    return float(low), float(middle), float(high)


def written(value: float, digits: int = 3) -> str:
    """Write a number with so many digits as people do: 1320, not 1.32e+03."""
    short = float(f"{value:.{digits}g}")
    return f"{short:.0f}" if 10.0**digits <= abs(short) < 1e6 else f"{value:.{digits}g}"


def summary_rows(result: StudyResult) -> list[SummaryRow]:
    """Return one row a cell and point."""
    return [
        SummaryRow(
            case=key.case,
            road=key.road,
            method=key.method,
            point=point,
            peak=_range(cell.peak_acceleration[:, i], GAL),
            rms=_range(cell.rms_velocity[:, i], MICROMETRE_PER_SECOND),
        )
        for key, cell in result.cells.items()
        for i, point in enumerate(result.study.points)
    ]


def exact_rows(result: StudyResult) -> list[ExactRow]:
    """Return exact statistics beside sampled ones, one row a cell and point that has them."""
    rows = []
    for key, cell in result.cells.items():
        if cell.exact is None or cell.exact_peaks is None:
            continue
        exact, (medians, highs) = cell.exact, cell.exact_peaks
        for i, point in enumerate(result.study.points):
            peaks = cell.peak_acceleration[:, i] / GAL
            low, high = percentile_interval(peaks, 95.0)
            rows.append(
                ExactRow(
                    case=key.case,
                    road=key.road,
                    method=key.method,
                    point=point,
                    rms=float(exact.rms()[i]) / MICROMETRE_PER_SECOND,
                    sampled_rms=float(np.sqrt(np.mean(cell.rms_velocity[:, i] ** 2)))
                    / MICROMETRE_PER_SECOND,
                    peak=(float(medians[i]) / GAL, float(highs[i]) / GAL),
                    sampled_peak=(float(np.median(peaks)), float(np.percentile(peaks, 95.0))),
                    interval=(low, high),
                    quadrature_error=exact.quadrature_error,
                )
            )
    return rows


def truncation_rows(result: StudyResult) -> list[TruncationRow]:
    """Return what the modes left out may change, one row a case and method that uses modes."""
    road = next(iter(result.study.roads))
    rows = []
    for method in result.study.methods:
        for case in result.study.cases:
            change = result.cells[CellKey(case.name, road, method.name)].truncation
            modal = method.interaction.integration
            if change is not None and isinstance(modal, Modal):
                rows.append(
                    TruncationRow(
                        case=case.name,
                        method=method.name,
                        f_max=modal.f_max,
                        fewer=change.f_max,
                        velocity=float(change.velocity.max()),
                        acceleration=float(change.acceleration.max()),
                    )
                )
    return rows


def comparison_rows(result: StudyResult) -> list[ComparisonRow]:
    """Return the printed cells beside ours, at the study's first point."""
    rows = []
    for printed in result.study.printed:
        cell = result.cells[CellKey(printed.case, printed.road, printed.method)]
        peak, rms = cell.peak_acceleration[:, 0], cell.rms_velocity[:, 0]
        rows.append(
            ComparisonRow(
                case=printed.case,
                road=printed.road,
                method=printed.method,
                peak=_range(peak, GAL),
                rms=_range(rms, MICROMETRE_PER_SECOND),
                printed_peak=printed.peak_acceleration / GAL,
                printed_rms=printed.rms_velocity / MICROMETRE_PER_SECOND,
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
    named = {row.case for row in study.printed}
    # a bound is of the published vehicle, whatever else drives beside it
    theirs = {
        study.drives[route].vehicle.name
        for case in study.cases
        if case.name in named
        for route in case.routes
    }
    singles = [
        case.name
        for case in study.cases
        if len(case.routes) == 1
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
                peak=peak / GAL,
                rms=velocity / MICROMETRE_PER_SECOND,
                printed_peak=printed.peak_acceleration / GAL,
                printed_rms=printed.rms_velocity / MICROMETRE_PER_SECOND,
            )
            for rule, peak, velocity in ours
        ]
    return rows


def _medians(result: StudyResult, case: str, printed: PrintedBound) -> tuple[float, float]:
    cell = result.cells[CellKey(case, printed.road, printed.method)]
    peak, rms = cell.peak_acceleration[:, 0], cell.rms_velocity[:, 0]
    return float(np.median(peak)), float(np.median(rms))


def road_words(study: Study) -> list[str]:
    """Return what each road is: its label, level and Gd(n0)."""
    return [
        f"{label}: {road.level.replace('_', ' ')} of class {road.name}, Gd(n0) = "
        f"{1e6 * road.roughness:.3g}e-6 m3"
        for label, road in study.roads.items()
    ]


def roughest_words(study: Study, road: str, verdict: Verdict) -> str:
    """Return up to what road a criterion is passed, as far as the margin tells."""
    if np.isnan(verdict.roughest) or verdict.criterion.quantity != "band_rms_velocity":
        return ""
    value = verdict.roughest * study.roads[road].roughness
    within = [name for name in CLASS_NAMES if class_limits(name)[2] <= value]
    name = f"all of class {within[-1]}" if within else "less than class A"
    bound = "at least" if verdict.margin >= 1.0 else "at most"
    return f"{bound} {1e6 * value:.3g}e-6 m3 ({name})"


def verdict_matrix(result: StudyResult) -> tuple[list[str], list[tuple[str, list[Verdict]]]]:
    """Return column titles (case, road, point) and one row of verdicts a criterion."""
    if result.study.assessment is None:
        return [], []
    many_points = len(result.study.points) > 1
    columns: list[str] = []
    rows: dict[str, list[Verdict]] = {}
    for key, verdicts in result.verdicts.items():
        for point in result.study.points:
            columns.append(f"{key.case}, {key.road}" + (f", {point}" if many_points else ""))
            for verdict in verdicts:
                if verdict.point == point:
                    rows.setdefault(verdict.criterion.title, []).append(verdict)
    return columns, list(rows.items())

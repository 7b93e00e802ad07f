"""Arrange results in the tables of the screen and the report, in engineers' units."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from trundle.response import percentile_interval, tabled
from trundle.results.cells import CellKey
from trundle.results.study_result import StudyResult
from trundle.study.report_plan import ReportPlan
from trundle.views.words import USUAL, Range, shown, spread, written

__all__ = [
    "ExactRow",
    "SummaryRow",
    "TruncationRow",
    "exact_rows",
    "summary_headings",
    "summary_rows",
    "truncation_rows",
]


@dataclass(frozen=True, kw_only=True)
class SummaryRow:
    """Hold the ranges of one cell at a point, in the order of `summary_headings`."""

    case: str
    road: str
    method: str
    point: str
    ranges: tuple[Range, ...]


@dataclass(frozen=True, kw_only=True)
class ExactRow:
    """Hold exact statistics of one cell beside those of its runs.

    Attributes
    ----------
    case, road, method, point : str
        The cell.
    rms, sampled_rms : float
        Root of the mean square velocity over record and roads, exact and of the runs, in the
        report's unit.
    peak, sampled_peak : tuple of float
        50 and 95 % of the peak acceleration, by the exact moments and of the runs.
    interval : tuple of float
        Where the runs' 95 % peak lies with 95 % confidence.
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


def summary_headings(report: ReportPlan = USUAL) -> list[str]:
    """Return what the ranges of a `SummaryRow` are of, with the units that they are in."""
    return [f"{quantity.heading} [{shown(quantity.units, report)[0]}]" for quantity in tabled()]


def summary_rows(result: StudyResult) -> list[SummaryRow]:
    """Return one row a cell and point."""
    report = result.study.report
    return [
        SummaryRow(
            case=key.case,
            road=key.road,
            method=key.method,
            point=point,
            ranges=tuple(
                spread(cell.reduced.numbers[quantity.name][:, i], shown(quantity.units, report)[1])
                for quantity in tabled()
            ),
        )
        for key, cell in result.cells.items()
        for i, point in enumerate(result.study.points)
    ]


def exact_rows(result: StudyResult) -> list[ExactRow]:
    """Return exact statistics beside sampled ones, one row a cell and point that has them."""
    rows = []
    a_unit, v_unit = (shown(unit, result.study.report)[1] for unit in ("m/s2", "m/s"))
    for key, cell in result.cells.items():
        if cell.exact is None or cell.exact_peaks is None:
            continue
        exact, (medians, highs) = cell.exact, cell.exact_peaks
        for i, point in enumerate(result.study.points):
            peaks = cell.peak_acceleration[:, i] / a_unit
            low, high = percentile_interval(peaks, 95.0)
            rows.append(
                ExactRow(
                    case=key.case,
                    road=key.road,
                    method=key.method,
                    point=point,
                    rms=float(exact.rms()[i]) / v_unit,
                    sampled_rms=float(np.sqrt(np.mean(cell.rms_velocity[:, i] ** 2))) / v_unit,
                    peak=(float(medians[i]) / a_unit, float(highs[i]) / a_unit),
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
            if change is not None and modal.f_max is not None:
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

"""Print the tables of a finished study."""

from __future__ import annotations

import numpy as np

from trundle.cli.saying import say
from trundle.cli.screen import print_table
from trundle.criteria import Verdict
from trundle.results.study_result import StudyResult
from trundle.views.days import day_views, together_lines
from trundle.views.printed import bound_rows, comparison_rows
from trundle.views.tables import exact_rows, summary_headings, summary_rows
from trundle.views.verdicts import verdict_matrix
from trundle.views.words import road_words, written

__all__ = ["print_result"]

_TOGETHER = 6  # columns of verdicts beside each other; more do not fit a screen


def print_result(result: StudyResult) -> None:
    """Print the tables of a finished study."""
    if result.study.printed:
        _print_comparison(result)
    else:
        _print_summary(result)
    bounds = bound_rows(result)
    a_unit, v_unit = _units(result)
    if bounds:
        headings = (
            "bound",
            "ours by",
            "class",
            "method",
            f"a printed [{a_unit}]",
            f"a ours [{a_unit}]",
        )
        print_table(
            _titled(result, "printed_bound", "upper bounds, ours from medians"),
            (*headings, f"v printed [{v_unit}]", f"v ours [{v_unit}]"),
            (
                (
                    row.bound,
                    row.rule,
                    row.road,
                    row.method,
                    f"{row.printed_peak:.3g}",
                    f"{row.peak:.3g}",
                    f"{row.printed_rms:.5g}",
                    f"{row.rms:.3g}",
                )
                for row in bounds
            ),
            text_columns=4,
        )
    _print_exact(result)
    _print_verdicts(result)
    _print_together(result)
    _print_days(result)


def _units(result: StudyResult) -> tuple[str, str]:
    """Return the units of acceleration and velocity that the study asks for."""
    report = result.study.report
    return report.acceleration, report.velocity


def _titled(result: StudyResult, name: str, title: str) -> str:
    """Return a table's title, behind the number that the study gives it."""
    number = result.study.numbering.get(name)
    return f"{number}: {title}" if number else title[0].upper() + title[1:]


def _print_exact(result: StudyResult) -> None:
    rows = exact_rows(result)
    assessed = result.study.assessment
    if assessed is not None:
        rows = [row for row in rows if row.method == assessed.method]
    if not rows:
        return
    a_unit, v_unit = _units(result)
    headings = ("vehicle on", "class", "method", "point", f"RMS v exact [{v_unit}]", "runs")
    print_table(
        f"Exact statistics over all roads, beside {result.study.runs} runs",
        (*headings, f"a 50 % [{a_unit}]", "runs", f"a 95 % [{a_unit}]", "runs (95 % interval)"),
        (
            (
                row.case,
                row.road,
                row.method,
                row.point,
                f"{row.rms:.4g}",
                f"{row.sampled_rms:.4g}",
                f"{row.peak[0]:.3g}",
                f"{row.sampled_peak[0]:.3g}",
                f"{row.peak[1]:.3g}",
                f"{row.sampled_peak[1]:.3g} ({row.between})",
            )
            for row in rows
        ),
        text_columns=4,
    )


def _print_comparison(result: StudyResult) -> None:
    a_unit, v_unit = _units(result)
    headings = (
        "road",
        "class",
        "method",
        f"a printed [{a_unit}]",
        f"a ours [{a_unit}]",
        "falls at",
    )
    print_table(
        _titled(
            result,
            "printed",
            f"printed values beside ours, median (5-95 %) of {result.study.runs} runs",
        ),
        (*headings, f"v printed [{v_unit}]", f"v ours [{v_unit}]", "falls at"),
        (
            (
                row.case,
                row.road,
                row.method,
                f"{row.printed_peak:.3g}",
                _with_range(row.peak),
                f"{row.peak_rank:.0f} %",
                f"{row.printed_rms:.5g}",
                _with_range(row.rms),
                f"{row.rms_rank:.0f} %",
            )
            for row in comparison_rows(result)
        ),
        text_columns=3,
    )


def _print_summary(result: StudyResult) -> None:
    print_table(
        f"Median (5-95 %) of {result.study.runs} runs",
        ("vehicle on", "class", "method", "point", *summary_headings(result.study.report)),
        (
            (row.case, row.road, row.method, row.point, *map(_with_range, row.ranges))
            for row in summary_rows(result)
        ),
        text_columns=4,
    )


def _with_range(values: tuple[float, float, float]) -> str:
    low, middle, high = values
    return f"{written(middle)} ({written(low)}-{written(high)})"


def _print_verdicts(result: StudyResult) -> None:
    columns, matrix = verdict_matrix(result)
    assessment = result.study.assessment
    if assessment is None:
        return
    title = (
        f"Verdict on {result.study.motion} motion at {assessment.percentile:g} % of the runs, "
        f"averaging {assessment.averaging}; margin = limit / level in the bands computed and "
        "excited"
    )
    for first in range(0, len(columns), _TOGETHER):
        some = slice(first, first + _TOGETHER)
        rows = ((name, *(_outcome(v) for v in verdicts[some])) for name, verdicts in matrix)
        print_table(title if first == 0 else "and", ("criterion", *columns[some]), rows)
    say(f"road {'; '.join(road_words(result.study))}")
    reasons = (r for _, vs in matrix for v in vs if v.status == "not assessed" for r in v.reasons)
    for reason in dict.fromkeys(reasons):
        say(f"not assessed: {reason}")
    say("? a pass whose 95 % interval reaches below 1: more runs might fail it")


def _print_together(result: StudyResult) -> None:
    lines = together_lines(result)
    if not lines:
        return
    print_table(
        "Sources together and alone: margins, and who governs",
        ("case", "road", "point", "criterion", "together", "by energy", "alone", "governed by"),
        (
            (x.case, x.road, x.point, x.criterion, x.together, x.energy, x.alone, x.governs)
            for x in lines
        ),
        text_columns=4,
    )


def _print_days(result: StudyResult) -> None:
    for day in day_views(result):
        print_table(
            f"{day.key.schedule}, road {day.key.road}: above each criterion, expected with 95 % "
            "intervals, and on one day that was run",
            ("point", "criterion", "events a day", "minutes a day", "on 95 % of days", "day run"),
            ((x.point, x.criterion, x.events, x.minutes, x.days, x.run) for x in day.lines),
            text_columns=2,
        )
        say(f"{day.passages}; {day.meeting}")


def _outcome(verdict: Verdict) -> str:
    """Write outcome and margin; a question mark behind a pass that is not sure."""
    if np.isnan(verdict.margin):
        return verdict.status
    return f"{verdict.status} {verdict.margin:.3g}{'?' if verdict.uncertain else ''}"

"""Print what is said of a measured record."""

from __future__ import annotations

import numpy as np

from trundle.cli.saying import say
from trundle.cli.screen import print_table
from trundle.records.assess import RecordResult
from trundle.study.report_plan import ReportPlan
from trundle.views.record import shown_rows
from trundle.views.record_answer import answers
from trundle.views.record_survey import dose_rows, shown_events

__all__ = ["print_record"]

_MOST_EVENTS = 20  # on the screen


def print_record(result: RecordResult, report: ReportPlan) -> None:
    """Print answers, numbers, verdicts, events and doubts of a record, in a report's units."""
    record = result.record
    for answer in answers(result):
        say(answer.words)
    print_table(
        f"{record.source}: {record.duration:.4g} s of {record.quantity} at "
        f"{record.sampling_frequency:g} Hz",
        (
            "channel",
            f"peak [{report.acceleration}]",
            f"RMS v [{report.velocity}]",
            "crest",
            "R",
            "VDV [m/s^1.75]",
        ),
        (
            (
                str(row["channel"]),
                *(
                    f"{row[name]:.3g}"
                    for name in ("peak", "rms", "crest_factor", "response_factor", "vdv")
                ),
            )
            for row in shown_rows(result, report)
        ),
    )
    print_table(
        f"Verdict, averaging {result.averaging}; margin = limit / level",
        ("channel", "axis", "criterion", "verdict", "margin", "band [Hz]", "after [s]"),
        (
            (
                v.point,
                v.axis,
                v.criterion.title,
                v.status,
                *("" if np.isnan(x) else f"{x:.3g}" for x in (v.margin, v.governing_band, v.time)),
            )
            for v in result.verdicts
        ),
        text_columns=4,
    )
    _print_events(result, report)
    reasons = (r for v in result.verdicts if v.status == "not assessed" for r in v.reasons)
    for reason in dict.fromkeys(reasons):
        say(f"not assessed: {reason}")
    for warning in result.warnings:
        say(f"warning: {warning}")


def _print_events(result: RecordResult, report: ReportPlan) -> None:
    """Print the first events, by which rule they were found, and doses of days and nights."""
    rows = shown_events(result, report)
    if rows:
        first = f", the first {_MOST_EVENTS}" if len(rows) > _MOST_EVENTS else ""
        print_table(
            f"{len(rows)} event{'' if len(rows) == 1 else 's'}{first}",
            (
                "channel",
                "start [s]",
                "end [s]",
                "clock",
                f"level [{report.velocity}]",
                "band [Hz]",
                "margin",
            ),
            (
                (
                    str(row["channel"]),
                    f"{row['start_s']:.1f}",
                    f"{row['end_s']:.1f}",
                    str(row["clock"]),
                    *(
                        "" if np.isnan(row[name]) else f"{row[name]:.3g}"
                        for name in ("level", "band_hz", "margin")
                    ),
                )
                for row in rows[:_MOST_EVENTS]
            ),
        )
    for one in result.events:
        say(f"events of {one.channel}: {len(one.events)}; {one.rule}")
    if result.record.begin is not None:
        print_table(
            "Vibration dose of what was measured",
            ("channel", "period", "measured [h]", "of [h]", "VDV [m/s^1.75]"),
            (
                (
                    str(row["channel"]),
                    str(row["period"]),
                    *(f"{row[name]:.3g}" for name in ("measured_h", "of_h", "vdv")),
                )
                for row in dose_rows(result)
            ),
            text_columns=2,
        )

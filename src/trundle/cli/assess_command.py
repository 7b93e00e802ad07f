"""Assess measured records from the command line."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any, get_args

import numpy as np

from trundle._checks import one_of
from trundle._progress import Tell
from trundle.cli.fail_on import check_fail_on, say_unmet
from trundle.cli.quantities import quantity_of
from trundle.cli.saying import say
from trundle.cli.screen import print_table, progress_bar
from trundle.cli.show import Show, say_json, warn
from trundle.criteria import VC, Criterion, Shape, find_criterion, shaped
from trundle.errors import InputError
from trundle.records import RecordOptions, read_record
from trundle.records.assess import RecordResult, assess_record, read_simulated
from trundle.report import write_record_report
from trundle.results.results_folder import check_target, new_results_folder
from trundle.signals import Averaging, Record
from trundle.study_file.user_criteria import read_criteria
from trundle.views.record import record_rows
from trundle.views.record_answer import answers
from trundle.views.record_survey import dose_rows, event_rows

__all__ = ["assess"]

_LARGE = 10e6  # bytes: less is assessed in a moment
_MOST_EVENTS = 20  # on the screen
_LEVELS = 0.8  # of the time, for levels; figures take the rest


def assess(
    files: list[Path],
    options: RecordOptions,
    *,
    criteria: str,
    shape: str,
    averaging: str,
    high_pass: str,
    events: float,
    simulation: Path | None,
    point: str | None,
    out: Path | None,
    show: Show = "tables",
    fail_on: Sequence[str] = (),
) -> bool:
    """Assess records one by one; write a results folder for each.

    Return whether a criterion asked for is unmet by any.
    """
    rule: Averaging = one_of("--averaging", averaging, get_args(Averaging))  # pyright: ignore
    one_of("--shape", shape, get_args(Shape))
    curves = shaped(_curves(criteria), shape)  # pyright: ignore[reportArgumentType] - checked
    check_fail_on(fail_on, curves)
    if point is not None and simulation is None:
        raise InputError("--point names a point of a study: say which by --simulation")
    limit = quantity_of("--high-pass", high_pass, "frequency")
    if not np.isfinite(events):
        raise InputError(f"--events {events:g}: must be a number of passages, such as 16")
    if out is not None and len(files) > 1:
        raise InputError("--out names the folder of one record; leave it out for several")
    places = [out or Path(f"{file.stem}-results") for file in files]
    if len(set(places)) < len(places):
        raise InputError("two records would have one results folder; assess them apart with --out")
    for place in places:
        check_target(place, "record")
    if simulation is not None and simulation.resolve() in {place.resolve() for place in places}:
        raise InputError(f"--simulation {simulation} would be replaced; choose another --out")
    simulated = (
        () if simulation is None else read_simulated(simulation, point=point, averaging=rule)
    )
    quick = sum(file.stat().st_size for file in files if file.is_file()) < _LARGE
    records = list[Record]()
    with progress_bar(quiet=quick or show == "nothing") as tell:
        for i, file in enumerate(files):
            tell(f"reading {file}", i / len(files))
            records.append(read_record(file, options))
    unmet, said = False, list[dict[str, Any]]()
    for record, place in zip(records, places, strict=True):
        with progress_bar(quiet=quick or show == "nothing") as tell:
            result = assess_record(
                record, curves, averaging=rule, high_pass=limit, events=events,
                simulated=simulated, tell=_part(tell, 0.0, _LEVELS),
            )  # fmt: skip
            with new_results_folder(place, kind="record") as folder:
                write_record_report(result, folder, tell=_part(tell, _LEVELS, 1.0))
        said.append(_said(result, place, show))
        unmet |= say_unmet(fail_on, show, ((f"{record.source}, ", v) for v in result.verdicts))
    if show == "json":
        say_json(said)
    return unmet


def _part(tell: Tell, low: float, high: float) -> Tell:
    """Return what tells the share of one part of the work as that of all."""
    return lambda what, share: tell(what, low + (high - low) * share)


def _said(result: RecordResult, place: Path, show: Show) -> dict[str, Any]:
    """Say what came out, and return it for programs."""
    report = place.resolve() / "report.html"
    if show == "tables":
        _print(result)
        say(f"\nreport: {report}")
    else:
        for warning in result.warnings:
            warn(warning, show)
    summary: dict[str, Any] = json.loads((place / "summary.json").read_text("utf-8"))
    return summary | {"report": str(report)}


def _curves(text: str) -> tuple[Criterion, ...]:
    """Return criteria named or in files, between commas; the generic curves for none."""
    found: list[Criterion] = []
    for name in filter(None, (part.strip() for part in text.split(","))):
        path = Path(name)
        own = path.suffix.lower() in {".csv", ".toml"}
        found += read_criteria(path) if own else [find_criterion(name)]
    return tuple(found) or VC


def _print(result: RecordResult) -> None:
    record = result.record
    for answer in answers(result):
        say(answer.words)
    print_table(
        f"{record.source}: {record.duration:.4g} s of {record.quantity} at "
        f"{record.sampling_frequency:g} Hz",
        ("channel", "peak [gal]", "RMS v [um/s]", "crest", "R", "VDV [m/s^1.75]"),
        (
            (
                str(row["channel"]),
                *(
                    f"{row[name]:.3g}"
                    for name in ("peak_gal", "rms_um_s", "crest_factor", "response_factor", "vdv")
                ),
            )
            for row in record_rows(result)
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
    _print_events(result)
    reasons = (r for v in result.verdicts if v.status == "not assessed" for r in v.reasons)
    for reason in dict.fromkeys(reasons):
        say(f"not assessed: {reason}")
    for warning in result.warnings:
        say(f"warning: {warning}")


def _print_events(result: RecordResult) -> None:
    """Print the first events, by which rule they were found, and doses of days and nights."""
    rows = event_rows(result)
    if rows:
        first = f", the first {_MOST_EVENTS}" if len(rows) > _MOST_EVENTS else ""
        print_table(
            f"{len(rows)} event{'' if len(rows) == 1 else 's'}{first}",
            ("channel", "start [s]", "end [s]", "clock", "level [um/s]", "band [Hz]", "margin"),
            (
                (
                    str(row["channel"]),
                    f"{row['start_s']:.1f}",
                    f"{row['end_s']:.1f}",
                    str(row["clock"]),
                    *(
                        "" if np.isnan(row[name]) else f"{row[name]:.3g}"
                        for name in ("level_um_s", "band_hz", "margin")
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

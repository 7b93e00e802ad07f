"""Assess measured records from the command line."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any, get_args

import numpy as np

from trundle._checks import one_of
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

__all__ = ["assess"]

_LARGE = 10e6  # bytes: less is assessed in a moment


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
            tell(f"levels of {record.source}", 0.0)
            result = assess_record(
                record, curves, averaging=rule, high_pass=limit, events=events, simulated=simulated
            )
            tell(f"figures of {record.source}", 0.8)
            with new_results_folder(place, kind="record") as folder:
                write_record_report(result, folder)
        said.append(_said(result, place, show))
        unmet |= say_unmet(fail_on, show, ((f"{record.source}, ", v) for v in result.verdicts))
    if show == "json":
        say_json(said)
    return unmet


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
    reasons = (r for v in result.verdicts if v.status == "not assessed" for r in v.reasons)
    for reason in dict.fromkeys(reasons):
        say(f"not assessed: {reason}")
    for warning in result.warnings:
        say(f"warning: {warning}")

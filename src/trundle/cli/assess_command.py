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
from trundle.cli.record_tables import print_record
from trundle.cli.saying import say
from trundle.cli.screen import progress_bar
from trundle.cli.show import Show, say_json, warn
from trundle.criteria import VC, Criterion, Shape, find_criterion, shaped
from trundle.errors import InputError
from trundle.records import RecordOptions, read_record
from trundle.records.assess import RecordResult, assess_record, read_simulated
from trundle.report import write_record_report
from trundle.results.results_folder import check_target, new_results_folder
from trundle.signals import Averaging, Record
from trundle.study.report_plan import AccelerationUnit, ReportPlan, VelocityUnit
from trundle.study_file.user_criteria import read_criteria

__all__ = ["assess"]

_LARGE = 10e6  # bytes: less is assessed in a moment
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
    velocity: str = "um/s",
    acceleration: str = "gal",
    out: Path | None,
    show: Show = "tables",
    fail_on: Sequence[str] = (),
) -> bool:
    """Assess records one by one; write a results folder for each.

    Return whether a criterion asked for is unmet by any.
    """
    _check_words(
        ("--averaging", averaging, get_args(Averaging)),
        ("--shape", shape, get_args(Shape)),
        ("--velocity", velocity, get_args(VelocityUnit)),
        ("--acceleration", acceleration, get_args(AccelerationUnit)),
    )
    rule: Averaging = averaging  # pyright: ignore[reportAssignmentType] - checked
    report = ReportPlan(velocity=velocity, acceleration=acceleration)
    curves = shaped(_curves(criteria), shape)  # pyright: ignore[reportArgumentType] - checked
    check_fail_on(fail_on, curves)
    if point is not None and simulation is None:
        raise InputError("--point names a point of a study: say which by --simulation")
    limit = quantity_of("--high-pass", high_pass, "frequency")
    if not np.isfinite(events):
        raise InputError(f"--events {events:g}: must be a number of passages, such as 16")
    places = _places(files, out, simulation)
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
                write_record_report(result, folder, report=report, tell=_part(tell, _LEVELS, 1.0))
        said.append(_said(result, place, report, show))
        unmet |= say_unmet(fail_on, show, ((f"{record.source}, ", v) for v in result.verdicts))
    if show == "json":
        say_json(said)
    return unmet


def _places(files: list[Path], out: Path | None, simulation: Path | None) -> list[Path]:
    """Return the results folder of each record; refuse what would be overwritten."""
    if out is not None and len(files) > 1:
        raise InputError("--out names the folder of one record; leave it out for several")
    places = [out or Path(f"{file.stem}-results") for file in files]
    if len(set(places)) < len(places):
        raise InputError("two records would have one results folder; assess them apart with --out")
    for place in places:
        check_target(place, "record")
    if simulation is not None and simulation.resolve() in {place.resolve() for place in places}:
        raise InputError(f"--simulation {simulation} would be replaced; choose another --out")
    return places


def _check_words(*given: tuple[str, str, Sequence[str]]) -> None:
    """Refuse the words of options that stand on no list, all of them at once."""
    wrong: list[str] = []
    for option, word, choices in given:
        try:
            one_of(option, word, choices)
        except InputError as error:
            wrong.append(str(error))
    if wrong:
        raise InputError("\n".join(wrong))


def _part(tell: Tell, low: float, high: float) -> Tell:
    """Return what tells the share of one part of the work as that of all."""
    return lambda what, share: tell(what, low + (high - low) * share)


def _said(result: RecordResult, place: Path, report: ReportPlan, show: Show) -> dict[str, Any]:
    """Say what came out, and return it for programs."""
    page = place.resolve() / "report.html"
    if show == "tables":
        print_record(result, report)
        say(f"\nreport: {page}")
    else:
        for warning in result.warnings:
            warn(warning, show)
    summary: dict[str, Any] = json.loads((place / "summary.json").read_text("utf-8"))
    return summary | {"report": str(page)}


def _curves(text: str) -> tuple[Criterion, ...]:
    """Return criteria named or in files, between commas; the generic curves for none."""
    found: list[Criterion] = []
    for name in filter(None, (part.strip() for part in text.split(","))):
        path = Path(name)
        own = path.suffix.lower() in {".csv", ".toml"}
        found += read_criteria(path) if own else [find_criterion(name)]
    return tuple(found) or VC

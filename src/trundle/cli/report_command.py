"""Draw the report of a results folder again, print it as a PDF, write its tables as a workbook."""

from __future__ import annotations

import tempfile
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

from trundle._face import read_results
from trundle._progress import Tell
from trundle.cli.aside import check_file
from trundle.cli.saying import say
from trundle.cli.screen import progress_bar
from trundle.errors import InputError
from trundle.report import check_workbooks, find_browser, print_pdf, write_report, write_workbook
from trundle.results.results_folder import check_target, new_results_folder
from trundle.results.study_result import StudyResult

__all__ = ["Wanted", "report"]


@dataclass(frozen=True, kw_only=True)
class Wanted:
    """Hold what the options of the command ask for.

    Attributes
    ----------
    html, pdf, xlsx : bool
        What is written; the page where none is asked for.
    heading : mapping of str to str
        What stands on the front instead of what the study says, by `ReportPlan`'s names.
    """

    html: bool = False
    pdf: bool = False
    xlsx: bool = False
    heading: Mapping[str, str] = field(default_factory=dict[str, str])


def report(results: Path, stem: Path | None, wanted: Wanted, *, quiet: bool = False) -> None:
    """Write what is asked for beside a results folder; nothing is computed again."""
    place = stem or Path(results.resolve().name)
    page, pdf, xlsx = (
        place.with_name(f"{place.name}{end}") for end in ("-report", "-report.pdf", "-tables.xlsx")
    )
    html = wanted.html or not (wanted.pdf or wanted.xlsx)
    if wanted.pdf:
        check_file("--pdf", pdf, [".pdf"])
        find_browser()
    if wanted.xlsx:
        check_file("--xlsx", xlsx, [".xlsx"])
        check_workbooks()
    if html:
        check_target(page, "report")
    with progress_bar(quiet=quiet) as tell:
        tell("reading the results", 0.0)
        result = _headed(read_results(results), wanted.heading)
        if html:
            with new_results_folder(page, kind="report") as aside:
                write_report(result, aside, tell=tell)
        if wanted.pdf:
            _print(result, results, pdf, wanted, tell)
        if wanted.xlsx:
            tell("workbook", 1.0)
            write_workbook(result, xlsx)
    if not quiet:
        for file in [page / "report.html"] * html + [pdf] * wanted.pdf + [xlsx] * wanted.xlsx:
            say(f"{file} ({file.stat().st_size / 1e6:.1f} MB)")


def _headed(result: StudyResult, heading: Mapping[str, str]) -> StudyResult:
    """Return a result whose report has another heading."""
    for name, text in heading.items():
        if not text.isprintable() or len(text) > 100:
            raise InputError(f"--{name} {text!r}: give one line of at most 100 letters")
    plan = replace(result.study.report, **heading)
    return replace(result, study=replace(result.study, report=plan))


def _print(result: StudyResult, results: Path, pdf: Path, wanted: Wanted, tell: Tell) -> None:
    """Print the page that is there; draw one first where its heading is another."""
    if not wanted.heading:
        tell("printing", 1.0)
        print_pdf((results / "report.html").resolve(), pdf)
        return
    with tempfile.TemporaryDirectory(prefix="trundle-report-") as folder:
        page = write_report(result, Path(folder), tell=tell)
        tell("printing", 1.0)
        print_pdf(page, pdf)

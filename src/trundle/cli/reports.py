"""Offer the command that draws the report of a results folder again."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from trundle.cli import options

__all__ = ["reports"]

reports = typer.Typer()


@reports.command()
def report(
    results: Annotated[Path, typer.Argument(help="Results folder of a run.", metavar="RESULTS")],
    *,
    html: Annotated[
        bool, typer.Option("--html", help="Draw page and figures again: NAME-report.")
    ] = False,
    pdf: Annotated[bool, typer.Option("--pdf", help="Print the report: NAME-report.pdf.")] = False,
    xlsx: Annotated[
        bool, typer.Option("--xlsx", help="Write its tables as a workbook: NAME-tables.xlsx.")
    ] = False,
    client: options.Client = None,
    job: options.Job = None,
    revision: options.Revision = None,
    date: options.Date = None,
    author: options.Author = None,
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", help="NAME of what is written. \\[default: that of RESULTS]"),
    ] = None,
    quiet: options.Quiet = False,
) -> None:
    r"""Draw the report of a results folder again, as a page, a PDF or a workbook.

    Nothing is computed again, and RESULTS stays as it is. What stands on its front is the study's
    \[report] unless it is said here.
    """
    from trundle.cli import report_command

    said = {"client": client, "job": job, "revision": revision, "date": date, "author": author}
    wanted = report_command.Wanted(
        html=html,
        pdf=pdf,
        xlsx=xlsx,
        heading={name: text for name, text in said.items() if text is not None},
    )
    report_command.report(results, out, wanted, quiet=quiet)

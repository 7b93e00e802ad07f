"""Run a study from the command line."""

from __future__ import annotations

from pathlib import Path

from trundle.cli.result_tables import print_result
from trundle.cli.screen import progress_bar
from trundle.report import write_report
from trundle.study.build import load_study
from trundle.study.run import run_study
from trundle.study.store import check_target, new_results_folder, write_results

__all__ = ["run"]


def run(path: Path, out: Path) -> None:
    """Run a study and write its results folder."""
    study = load_study(path)
    check_target(out)
    place = out.resolve()
    with progress_bar() as tell, new_results_folder(out) as folder:
        result = run_study(study, report=lambda what, share: tell(what, 0.94 * share))
        tell("writing results", 0.94)
        write_results(result, folder)
        write_report(result, folder, tell=lambda what, share: tell(what, 0.95 + 0.05 * share))
    print_result(result)
    print(f"\nreport: {place / 'report.html'}")

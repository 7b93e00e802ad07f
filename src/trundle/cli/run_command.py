"""Run a study from the command line."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path

from trundle._face import run_study
from trundle.cli.afford import check_affordable
from trundle.cli.executors import check_executor, executor_of
from trundle.cli.fail_on import check_fail_on, say_unmet
from trundle.cli.result_tables import print_result
from trundle.cli.saying import say
from trundle.cli.screen import progress_bar
from trundle.cli.show import Show, say_json, warn
from trundle.report import unused_numbers
from trundle.results.mesh_change import mesh_words
from trundle.results.parts_change import parts_words
from trundle.results.results_folder import check_target
from trundle.run.estimate import estimate_of
from trundle.study.doubts import study_doubts
from trundle.study_file.build import load_study

__all__ = ["run"]


def run(
    path: Path,
    out: Path,
    *,
    workers: int | None,
    scheduler: str | None,
    fresh: bool,
    yes: bool = False,
    show: Show = "tables",
    fail_on: Sequence[str] = (),
) -> bool:
    """Run a study and write its results folder; return whether a criterion asked for is unmet."""
    check_executor(workers, scheduler)
    study = load_study(path)
    check_fail_on(fail_on, () if study.assessment is None else study.assessment.criteria)
    check_target(out)
    told = list(study_doubts(study))
    for warning in told:
        warn(warning, show)
    check_affordable(str(path), estimate_of(study), yes=yes)
    place = out.resolve()
    with (
        executor_of(workers, scheduler) as executor,
        progress_bar(quiet=show == "nothing") as tell,
    ):
        result = run_study(study, out, tell=tell, executor=executor, fresh=fresh)
    report = place / "report.html"
    if show == "tables":
        print_result(result)
        if result.mesh is not None:
            say(f"mesh: {mesh_words(result.mesh)}")
        if result.parts is not None:
            say(f"parts: {parts_words(result.parts)}")
    for method, found in result.warnings().items() if show != "json" else ():
        for warning in found:
            if warning not in told:
                warn(f"{method}: {warning}", show)
    for name in unused_numbers(result):
        warn(f"publication.numbers.{name}: no figure or table of the report has this name", show)
    if show == "tables":
        say(f"\nreport: {report}")
    elif show == "json":
        say_json(json.loads((place / "summary.json").read_text("utf-8")) | {"report": str(report)})
    return say_unmet(
        fail_on,
        show,
        (
            (f"{key.case}, class {key.road}, ", verdict)
            for key, verdicts in result.verdicts.items()
            for verdict in verdicts
        ),
    )

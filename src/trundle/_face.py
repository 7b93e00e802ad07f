"""Do whole things from Python: what the commands do, with values instead of screens."""

from __future__ import annotations

from pathlib import Path

from trundle._kinds import kinds_checked
from trundle._progress import Tell
from trundle.criteria import Criterion, all_criteria
from trundle.mitigate import Change, Sweep
from trundle.mitigate import try_changes as _try_changes
from trundle.results.folder import files_of, index_of, read_result
from trundle.results.results_folder import check_target, new_results_folder
from trundle.results.store import write_results
from trundle.results.study_result import StudyResult
from trundle.run import Executor
from trundle.run.checkpoint import unfinished_of
from trundle.run.whole_study import run_study as _run_study
from trundle.study.model import Study
from trundle.study_file.build import load_study
from trundle.vehicle import VEHICLES

__all__ = [
    "list_criteria",
    "list_vehicles",
    "read_results",
    "run_study",
    "save",
    "try_changes",
]


@kinds_checked
def run_study(
    study: Study,
    out: Path | str | None = None,
    *,
    tell: Tell | None = None,
    executor: Executor | None = None,
) -> StudyResult:
    """Run every case of a study on every road by every method.

    Parameters
    ----------
    study : Study
        A study, see `load_study`.
    out : path-like, optional
        A results folder to write, with the report, as ``trundle run`` does. What a stopped run has
        finished is kept beside it, and taken up by the next.
    tell : callable, optional
        Told what is being done, and the share done.
    executor : Executor, optional
        Who computes, such as the workers of `trundle.run.local_cluster`; this process unless given.

    Returns
    -------
    StudyResult
        The same study gives the same bits, whoever computes it.

    Raises
    ------
    InputError
        A results folder that cannot be written, or holds something else.
    """
    if out is None:
        return _run_study(study, tell=tell, executor=executor)
    check_target(Path(out))
    with unfinished_of(study, Path(out)) as store:
        result = _run_study(study, tell=tell, store=store, executor=executor)
        save(result, out)
    return result


@kinds_checked
def save(result: StudyResult, folder: Path | str) -> Path:
    """Write results and report into a folder, aside and then in place; return the report's page.

    Earlier results of a study there are replaced; anything else is refused.

    Parameters
    ----------
    result : StudyResult
        A result, computed or read.
    folder : path-like
        Results folder.
    """
    from trundle.report import write_report  # noqa: PLC0415 - pictures take a second to import

    folder = Path(folder)
    check_target(folder)
    with new_results_folder(folder) as aside:
        write_results(result, aside)
        write_report(result, aside)
    return folder / "report.html"


@kinds_checked
def read_results(folder: Path | str) -> StudyResult:
    """Read a results folder back, bit by bit: its report can be drawn from it again.

    Parameters
    ----------
    folder : path-like
        What ``trundle run`` or `save` has written.

    Raises
    ------
    InputError
        No results, those of an earlier version, files that were changed since.
    """
    folder = Path(folder)
    index = index_of(folder)
    files = files_of(folder, index)
    study = load_study(folder / "study.toml", source=index.source, files=files)
    return read_result(folder, index, study)


@kinds_checked
def try_changes(
    study: Study,
    changes: list[Change] | tuple[Change, ...],
    *,
    speeds: list[float] | tuple[float, ...],
    roads: list[str] | tuple[str, ...] = ("A", "B", "C", "D"),
    runs: int = 60,
    tell: Tell | None = None,
    executor: Executor | None = None,
) -> Sweep:
    """Hold every combination of changes, speeds and road classes against a study's criteria.

    Parameters
    ----------
    study : Study
        A study with criteria.
    changes : sequence of Change
        See `trundle.mitigate.each_change` and `trundle.mitigate.every_combination`.
    speeds : sequence of float
        Speeds of every vehicle [m/s].
    roads : sequence of str
        Road classes, A to H.
    runs : int
        Runs of each combination.
    tell : callable, optional
        Told what is being done, and the share done.
    executor : Executor, optional
        Who computes; this process unless given.
    """
    return _try_changes(
        study, changes=changes, speeds=speeds, roads=roads, runs=runs, tell=tell, executor=executor
    )


def list_vehicles() -> tuple[str, ...]:
    """Return the names of all vehicles of the library, see `trundle.vehicle.library_vehicle`."""
    return tuple(VEHICLES)


def list_criteria() -> tuple[Criterion, ...]:
    """Return all criteria that ship with trundle."""
    return all_criteria()

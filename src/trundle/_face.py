"""Do whole things from Python: what the commands do, with values instead of screens."""

from __future__ import annotations

from pathlib import Path

from trundle._kinds import kinds_checked
from trundle._progress import Tell, silent
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
    fresh: bool = False,
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
    fresh : bool
        Begin anew: leave aside what a stopped run has finished.

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
    told, out = tell or silent, Path(out)
    check_target(out)
    with unfinished_of(study, out, fresh=fresh) as store:
        if store.n_found:
            told(f"going on from {store.n_found} finished pieces of an earlier run", 0.0)
        result = _run_study(
            study,
            tell=lambda what, share: told(what, 0.94 * share),
            store=store,
            executor=executor,
        )
        with new_results_folder(out, within=store.folder) as aside:
            _write(result, aside, lambda what, share: told(what, 0.94 + 0.06 * share))
    return result


@kinds_checked
def save(result: StudyResult, folder: Path | str, *, tell: Tell | None = None) -> Path:
    """Write results and report into a folder, aside and then in place; return the report's page.

    Earlier results of a study there are replaced; anything else is refused.

    Parameters
    ----------
    result : StudyResult
        A result, computed or read.
    folder : path-like
        Results folder.
    tell : callable, optional
        Told which figure is drawn, and the share drawn.
    """
    folder = Path(folder)
    check_target(folder)
    with new_results_folder(folder) as aside:
        _write(result, aside, tell or silent)
    return folder / "report.html"


def _write(result: StudyResult, folder: Path, tell: Tell) -> None:
    """Write everything into a new folder."""
    from trundle.report import write_report  # noqa: PLC0415 - pictures take a second to import

    tell("writing results", 0.0)
    write_results(result, folder)
    write_report(result, folder, tell=tell)


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

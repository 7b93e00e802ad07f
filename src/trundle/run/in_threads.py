"""Compute the parts of a study in threads of this process."""

from __future__ import annotations

import threading
from collections.abc import Callable, Mapping
from concurrent.futures import FIRST_COMPLETED, Executor, Future, ThreadPoolExecutor, wait

from trundle._progress import Tell
from trundle._threads import n_threads
from trundle.dynamics import repeatable
from trundle.results.pieces import Piece
from trundle.run.jobs import Job, LaidOut, compute

__all__ = ["compute_here"]

_AT_ONCE = 2  # while one part draws its roads or is filtered, another keeps the processors busy


class _StoppedError(Exception):
    """Ends a part whose result nobody waits for any more."""


def compute_here(
    missing: Mapping[Job, list[int]],
    lay_out: Callable[[Job], LaidOut],
    *,
    begin: Callable[[Job], None],
    progress: Tell,
    done: Callable[[str, Piece], None],
) -> None:
    """Compute parts, some at once, and hand over what each leaves.

    Parameters
    ----------
    missing : mapping of Job to list of int
        Which parts of each job.
    lay_out : callable
        Lays out a job, when its turn has come.
    begin : callable
        Told which job is begun.
    progress : callable
        Told the share of a piece that is done; from any thread.
    done : callable
        Given the name of a piece, and the piece; in the calling thread.
    """
    stop = threading.Event()
    running: dict[Future[Piece], str] = {}

    def collect(at_most: int) -> None:
        """Hand over pieces until so many parts are running."""
        while len(running) > at_most:
            for future in wait(running, return_when=FIRST_COMPLETED).done:
                done(running.pop(future), future.result())

    def run(job: Job, laid_out: LaidOut, part: int) -> Piece:
        """Compute a part, in a thread."""

        def tell(share: float) -> None:
            """Tell the share done, or end the part."""
            if stop.is_set():
                raise _StoppedError
            progress(job.pieces[part], share)

        return compute(job, laid_out, part, tell)

    def carry_out(jobs: list[Job], pool: Executor, at_once: int) -> None:
        """Compute what is missing of some jobs."""
        try:
            for job in jobs:
                begin(job)
                layout = lay_out(job)
                for part in missing[job]:
                    running[pool.submit(run, job, layout, part)] = job.pieces[part]
                    collect(at_once)
            collect(0)
        except BaseException:
            stop.set()
            raise

    at_once = min(_AT_ONCE, n_threads())
    wanted = [job for job, parts in missing.items() if parts]
    # One limit around all: parts that set their own would undo each other's.
    with repeatable(), ThreadPoolExecutor(at_once) as pool:
        carry_out([job for job in wanted if job.modal], pool, at_once)
    # A sparse solver answers one caller at a time.
    with repeatable(), ThreadPoolExecutor(1) as pool:
        carry_out([job for job in wanted if not job.modal], pool, 0)

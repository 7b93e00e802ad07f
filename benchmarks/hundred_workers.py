"""How long a large study would take on 1 to 100 workers: measured tasks, scheduled on paper.

The tasks of two routes of the reference unit are run here, each on one thread, and what would
travel to and from a worker is pickled. From these times and sizes a study of many such routes is
laid out job by job in one process, as `trundle run --scheduler` does it, and its tasks go to
whichever worker is free first. Nothing is said of workers that fail, of a network that others use,
or of machines that are not like this one.
"""

from __future__ import annotations

import argparse
import heapq
import json
import os
import pickle
import tempfile
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TypeVar

import trundle as tr
from trundle.dynamics import repeatable
from trundle.run.checkpoint import OnDisk
from trundle.run.floors import Floors
from trundle.run.jobs import plan_jobs, prepare_job
from trundle.run.tasks import tasks_of

_T = TypeVar("_T")

PAPER = Path(__file__).resolve().parent.parent / "examples" / "paper" / "study.toml"
MEASURED = ("rear", "side")
WORKERS = (1, 2, 4, 10, 30, 100)
LATENCY = 2e-3  # s that a scheduler takes to hand out a task, and again to hear of its end


@dataclass(frozen=True, kw_only=True)
class TaskCost:
    """Hold what a task takes.

    Attributes
    ----------
    seconds : float
        On one thread of a worker.
    size : float
        Of the piece that comes back [bytes].
    kept : float
        In the main process, to write the piece [s].
    """

    seconds: float
    size: float
    kept: float


@dataclass(frozen=True, kw_only=True)
class JobCost:
    """Hold what a job takes.

    Attributes
    ----------
    laying_out : float
        In the main process [s].
    size : float
        Of the layout, which travels once to each worker that takes one of its tasks [bytes].
    tasks : tuple of TaskCost
        Its tasks.
    """

    laying_out: float
    size: float
    tasks: tuple[TaskCost, ...]


@dataclass(frozen=True, kw_only=True)
class Outcome:
    """Hold what a schedule gives: when all is done, and how long was computed and sent [s]."""

    end: float
    computing: float
    sending: float


def scheduled(
    jobs: Sequence[JobCost], *, workers: int, modes: float, bandwidth: float, latency: float
) -> Outcome:
    """Schedule a study: each task goes to the worker that is free first.

    The main process finds the modes, then lays out one job after another and sends each layout off,
    then writes pieces as they come; its link carries one thing at a time, and so does the
    link of whoever holds a layout that several workers fetch.

    Parameters
    ----------
    jobs : sequence of JobCost
        In the order in which they are laid out.
    workers : int
        How many there are.
    modes : float
        Time until the first job can be laid out [s].
    bandwidth : float
        Of every link [bytes/s].
    latency : float
        Of handing out a task, and of hearing of its end [s].
    """
    main, computing, sending = modes, modes, 0.0
    free = [(0.0, worker) for worker in range(workers)]
    coming: list[tuple[float, float, float]] = []  # end, time to send, time to write
    for job in jobs:
        travels = job.size / bandwidth
        main += job.laying_out + travels
        computing, sending = computing + job.laying_out, sending + travels
        holder_free, holders = main, set[int]()
        for task in job.tasks:
            at, worker = heapq.heappop(free)
            begin = max(at, main) + latency
            if worker not in holders:
                if holders:
                    begin = holder_free = max(begin, holder_free) + travels
                    sending += travels
                holders.add(worker)
            end = begin + task.seconds
            heapq.heappush(free, (end, worker))
            coming.append((end + latency, task.size / bandwidth, task.kept))
            computing += task.seconds + task.kept
            sending += task.size / bandwidth
    for end, send, keep in sorted(coming):
        main = max(main, end) + send + keep
    return Outcome(end=main, computing=computing, sending=sending)


def longest_chain(jobs: Sequence[JobCost], *, modes: float) -> float:
    """Return the time of what must follow each other, with as many workers as there are tasks [s]."""
    at, longest = modes, 0.0
    for job in jobs:
        at += job.laying_out
        longest = max(longest, at + max(task.seconds + task.kept for task in job.tasks))
    return longest


def timed(what: Callable[[], _T]) -> tuple[float, _T]:
    """Return the processor time of a call [s], and what it gives."""
    start = time.process_time()
    found = what()
    return time.process_time() - start, found


def measured(runs: int) -> tuple[float, list[JobCost]]:
    """Return the time of the modes [s], and what the measured jobs take."""
    study = tr.load_study(PAPER)
    study = replace(
        study,
        runs=runs,
        cases=tuple(case for case in study.cases if case.name in MEASURED),
        methods=tuple(method for method in study.methods if method.name == "assessed"),
        printed=(),
        printed_bounds=(),
    )
    jobs = plan_jobs(study)
    f_max = study.methods[0].interaction.integration.f_max or 0.0
    of_modes, modes = timed(lambda: study.floor.modes(f_max))
    floors = Floors(study.floor, modes, jobs)
    of_floor, _ = timed(lambda: floors.of(jobs[0]))
    found = []
    with tempfile.TemporaryDirectory() as folder:
        store = OnDisk(Path(folder), "measured")
        for job in jobs:
            laying_out, shared = timed(lambda job=job: prepare_job(job, floors.of(job)))
            tasks = []
            for task in tasks_of(job):
                seconds, piece = timed(lambda task=task, shared=shared: task.compute(shared))
                size = len(pickle.dumps(piece, protocol=5))
                kept, _ = timed(lambda task=task, piece=piece: store.save(task.name, piece))
                tasks.append(TaskCost(seconds=seconds, size=size, kept=kept))
            size = len(pickle.dumps(shared, protocol=5))
            found.append(JobCost(laying_out=laying_out, size=size, tasks=tuple(tasks)))
    return of_modes + of_floor, found


def main() -> None:
    """Measure, schedule, and print JSON."""
    parser = argparse.ArgumentParser(description="Schedule a large study on 1 to 100 workers.")
    parser.add_argument("--routes", type=int, nargs="+", default=[40, 400])
    parser.add_argument("--runs", type=int, default=1000, help="roads of each route")
    parser.add_argument("--bandwidth", type=float, default=1e9, help="of every link [bit/s]")
    given = parser.parse_args()
    os.environ["TRUNDLE_THREADS"] = "1"  # as of a worker with one processor
    with repeatable():
        modes, some = measured(given.runs)
    link = given.bandwidth / 8.0
    found: dict[str, object] = {
        "runs": given.runs,
        "bandwidth [Mbit/s]": given.bandwidth / 1e6,
        "modes [s]": round(modes, 1),
        "laying out a job [s]": [round(job.laying_out, 2) for job in some],
        "layout [MB]": [round(job.size / 1e6, 2) for job in some],
        "tasks [s]": [[round(task.seconds, 2) for task in job.tasks] for job in some],
        "pieces [MB]": [[round(task.size / 1e6, 2) for task in job.tasks] for job in some],
        "keeping a piece [s]": [[round(task.kept, 3) for task in job.tasks] for job in some],
    }
    for routes in given.routes:
        jobs = [some[i % len(some)] for i in range(routes)]
        outcomes = {
            n: scheduled(jobs, workers=n, modes=modes, bandwidth=link, latency=LATENCY)
            for n in WORKERS
        }
        one = outcomes[1]
        found[f"{routes} routes"] = {
            "tasks": sum(len(job.tasks) for job in jobs),
            "longest chain [s]": round(longest_chain(jobs, modes=modes), 1),
            "workers": {
                n: {
                    "time [s]": round(out.end, 1),
                    "times faster": round(one.end / out.end, 1),
                    "computing over sending": round(out.computing / out.sending),
                }
                for n, out in outcomes.items()
            },
        }
    print(json.dumps(found))


if __name__ == "__main__":
    main()

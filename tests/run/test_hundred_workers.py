"""The schedule on paper of a large study: what it must give in closed form, and its bounds."""

import importlib.util
import sys
from pathlib import Path

import pytest

_PATH = Path(__file__).parents[2] / "benchmarks" / "hundred_workers.py"


@pytest.fixture(scope="module")
def paper():
    spec = importlib.util.spec_from_file_location("hundred_workers", _PATH)
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module  # dataclasses look there
    spec.loader.exec_module(module)
    yield module
    del sys.modules[spec.name]


def job(paper, seconds, *, laying_out=2.0, size=0.0, piece=0.0, kept=0.0):
    tasks = tuple(paper.TaskCost(seconds=s, size=piece, kept=kept) for s in seconds)
    return paper.JobCost(laying_out=laying_out, size=size, tasks=tasks)


def test_equal_tasks_take_so_many_rounds(paper):
    """Twelve tasks of 10 s on five workers are three rounds, after 7 s of modes and 2 s of layout."""
    jobs = [job(paper, [10.0] * 12)]
    out = paper.scheduled(jobs, workers=5, modes=7.0, bandwidth=1.0, latency=0.0)
    assert out.end == pytest.approx(7.0 + 2.0 + 3 * 10.0)
    assert out.computing == pytest.approx(7.0 + 2.0 + 120.0)
    assert out.sending == 0.0


def test_a_layout_travels_once_to_each_worker_that_needs_it(paper):
    """100 bytes at 10 bytes a second to the first of three workers, and from it to two others.

    One link serves both: they begin 10 and 20 s after the first, and the last ends at
    2 + 10 + 20 + 50 s; three pieces of 1 s come after one another, but none waits for another.
    """
    jobs = [job(paper, [50.0] * 3, size=100.0, piece=10.0)]
    out = paper.scheduled(jobs, workers=3, modes=0.0, bandwidth=10.0, latency=0.0)
    assert out.end == pytest.approx(2.0 + 10.0 + 20.0 + 50.0 + 1.0)
    assert out.sending == pytest.approx(3 * 10.0 + 3 * 1.0)
    alone = paper.scheduled(jobs, workers=1, modes=0.0, bandwidth=10.0, latency=0.0)
    assert alone.sending == pytest.approx(10.0 + 3 * 1.0)


@pytest.mark.parametrize("workers", [1, 2, 7, 100])
def test_no_schedule_beats_its_bounds(paper, workers):
    """Neither the work shared evenly nor the longest chain; and none is longer than all in a row."""
    jobs = [job(paper, [5.0, 3.0 + i % 4, 8.0], size=20.0, piece=5.0, kept=0.1) for i in range(30)]
    out = paper.scheduled(jobs, workers=workers, modes=40.0, bandwidth=100.0, latency=0.002)
    chain = paper.longest_chain(jobs, modes=40.0)
    tasks = sum(task.seconds for one in jobs for task in one.tasks)
    assert out.end >= max(chain, 40.0 + tasks / workers)
    assert out.end <= out.computing + out.sending + 90 * 2 * 0.002 + 1e-9

"""Choose who computes: this process, workers that it starts, or those of a scheduler."""

from __future__ import annotations

from collections.abc import Generator
from contextlib import contextmanager

from trundle.errors import InputError
from trundle.run.dask_cluster import cluster_at, local_cluster
from trundle.run.executor import Executor

__all__ = ["check_executor", "executor_of"]


def check_executor(workers: int | None, scheduler: str | None) -> None:
    """Refuse both kinds of workers at once."""
    if workers is not None and scheduler is not None:
        raise InputError("--workers starts a cluster and --scheduler uses one: give one of them")


@contextmanager
def executor_of(workers: int | None, scheduler: str | None) -> Generator[Executor | None]:
    """Give who is asked for; nobody if this process is to compute."""
    if scheduler is not None:
        with cluster_at(scheduler) as cluster:
            yield cluster
    elif workers is not None:
        with local_cluster(workers) as cluster:
            yield cluster
    else:
        yield None

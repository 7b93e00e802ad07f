"""Compute tasks on the workers of a dask cluster."""

from __future__ import annotations

import functools
import hashlib
import logging
import os
import platform
from collections.abc import Generator, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from trundle import __version__
from trundle._progress import Progress
from trundle.dynamics import repeatable
from trundle.errors import ComputationError, InputError
from trundle.run.executor import Shared, Work
from trundle.run.jobs import prepare_job
from trundle.run.tasks import Task
from trundle.simulate import PreparedFloor, prepare
from trundle.structure import Structure

__all__ = ["Cluster", "cluster_at", "local_cluster"]

_RETRIES = 3  # times that a part is tried again when its worker has died


class Cluster:
    """Send tasks to workers, and give what they leave."""

    here = False

    def __init__(self, client: Any) -> None:  # noqa: ANN401 - dask has no types
        self._client = client
        # what was sent, by its identity; held, for another may take the place of one let go of
        self._sent: dict[int, tuple[Shared, Any]] = {}
        self._pending: dict[Any, _Sent] = {}

    def submit(self, task: Work, shared: Shared, progress: Progress) -> None:
        """Send a task; what it shares travels once to each worker, and progress stays there."""
        del progress
        self._send(_Sent(task=task, shared=shared, tries=1))

    def _send(self, what: _Sent) -> None:
        place = id(what.shared)
        if place not in self._sent:
            self._sent[place] = (what.shared, self._client.scatter(what.shared, hash=False))
        future = self._client.submit(
            _compute,
            what.task,
            self._sent[place][1],
            _own_source(),
            key=f"{what.task.name}-{what.tries}",
            retries=_RETRIES,
            pure=False,
        )
        self._pending[future] = what

    def finished(self, *, wait: bool) -> Iterator[tuple[str, Any]]:
        """Give finished pieces: those there already, or all, as they come."""
        distributed = _distributed()
        while self._pending:
            if wait:
                # parts that were lost with a worker end the waiting, and are sent again below
                with suppress(distributed.CancelledError):
                    distributed.wait(list(self._pending), return_when="FIRST_COMPLETED")
                self._check_alive()
            for future in [future for future in self._pending if future.done()]:
                what = self._pending.pop(future)
                piece = self._piece(future, what)
                future.release()
                if not any(other.shared is what.shared for other in self._pending.values()):
                    self._sent.pop(id(what.shared), None)
                if piece is not None:
                    yield what.task.name, piece
            if not wait:
                return

    def _check_alive(self) -> None:
        """Stop with a name if the scheduler is gone: nothing would ever be done again."""
        if self._client.status not in {"running", "connecting"}:
            raise ComputationError(
                "the scheduler of the cluster was lost; what was finished is kept, and the same "
                "command goes on from there"
            )

    def _piece(self, future: Any, what: _Sent) -> Any:  # noqa: ANN401
        """Return a task's piece; if what it needs died with a worker, send the task again."""
        distributed = _distributed()
        name = what.task.name
        try:
            return future.result()
        except distributed.CancelledError as error:
            self._check_alive()
            if what.tries > _RETRIES:
                raise ComputationError(f"the cluster was lost while it computed {name}") from error
            lost = self._sent.pop(id(what.shared), None)
            if lost is not None and lost[1].status == "finished":
                self._sent[id(what.shared)] = lost
            self._send(replace(what, tries=what.tries + 1))
            return None
        except distributed.KilledWorker as error:
            raise ComputationError(
                f"the workers that computed {name} died {_RETRIES} times, most likely for "
                "want of memory; use fewer workers"
            ) from error
        except (TypeError, AttributeError, ImportError):
            # what another version of this program makes of the question
            _check_workers(self._client, "of this cluster")
            raise


@dataclass(frozen=True, kw_only=True, eq=False)
class _Sent:
    """A task that workers were asked for."""

    task: Work
    shared: Shared
    tries: int


_kept: dict[tuple[str, str], PreparedFloor] = {}  # of this worker: the last floor it prepared


def _compute(task: Work, shared: Shared, source: str) -> Any:  # noqa: ANN401
    """Compute a task, in a worker; one that joined late may have another source."""
    if source != source_hash():
        raise ComputationError(
            f"a worker on {platform.node()} has another trundle than the process that asks; what "
            "was finished is kept: install the same one there, and run it again"
        )
    with repeatable():
        if not isinstance(shared, Structure):
            return task.compute(shared)
        assert isinstance(task, Task)  # only jobs are given a floor as it is
        interaction = task.job.method.interaction
        key = (shared.content_hash, str(interaction))
        if key not in _kept:
            _kept.clear()
            _kept[key] = prepare(shared, interaction.integration, interaction.damping)
        return task.compute(prepare_job(task.job, _kept[key]))


@contextmanager
def local_cluster(n_workers: int) -> Generator[Cluster]:
    """Start so many workers on this machine, listening on loopback alone, for this process alone.

    What reaches a port of a dask cluster may run anything: all ports ask for keys that are made
    for this run, and there is no page.

    Parameters
    ----------
    n_workers : int
        Number of processes; they share the machine's processors.
    """
    distributed = _distributed()
    from dask import config  # noqa: PLC0415 - comes with it

    threads = str(max(1, (os.cpu_count() or 1) // n_workers))
    names = ("TRUNDLE_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS", "OPENBLAS_NUM_THREADS")
    try:
        keys = distributed.Security.temporary()
    except ImportError:
        raise InputError(
            "--workers needs the package cryptography, for keys that keep other users of this "
            "machine out: pip install 'trundle[cluster]'"
        ) from None
    no_pages = {"distributed.scheduler.http.routes": [], "distributed.worker.http.routes": []}
    with (
        config.set(no_pages),
        distributed.LocalCluster(
            n_workers=n_workers,
            threads_per_worker=1,
            processes=True,
            host="127.0.0.1",
            protocol="tls",
            security=keys,
            dashboard_address="127.0.0.1:0",
            worker_dashboard_address="127.0.0.1:0",
            silence_logs=logging.ERROR,
            env=dict.fromkeys(names, threads),
        ) as cluster,
        distributed.Client(cluster) as client,
    ):
        yield Cluster(client)


@contextmanager
def cluster_at(address: str) -> Generator[Cluster]:
    """Use the workers of a dask scheduler that runs already.

    Parameters
    ----------
    address : str
        Where it listens, as ``tcp://host:8786``.
    """
    distributed = _distributed()
    try:
        client = distributed.Client(address, timeout=10)
    except (OSError, ValueError, TypeError) as error:
        raise InputError(
            f"--scheduler {address!r}: no dask scheduler answers there ({error}); "
            "start one with 'dask scheduler', or use --workers"
        ) from None
    with client:
        _check_workers(client, address)
        yield Cluster(client)


@functools.cache
def source_hash() -> str:
    """Return a hash of this program's own source: versions may lie, and be edited in place."""
    root = Path(__file__).resolve().parent.parent
    found = hashlib.sha256()
    for path in sorted(root.rglob("*.py")):
        found.update(str(path.relative_to(root)).encode() + path.read_bytes())
    return found.hexdigest()


def _own_source() -> str:
    """Return the hash of this process's source: what workers must have too."""
    return source_hash()


def _check_workers(client: Any, address: str) -> None:  # noqa: ANN401
    """Refuse workers with another source: what they compute would be stored as this one's."""
    own = _own_source()
    try:
        theirs = client.run(source_hash, on_error="return")
    except Exception as error:  # a scheduler that dies here raises one of many
        raise InputError(
            f"--scheduler {address!r}: its workers do not answer ({type(error).__name__})"
        ) from None
    others = sorted(worker for worker, found in theirs.items() if found != own)
    if others:
        raise InputError(
            f"--scheduler {address!r}: {len(others)} of its workers have another trundle than this "
            f"process ({__version__}), the first at {others[0]}; install the same one there"
        )


def _distributed() -> Any:  # noqa: ANN401
    """Import dask.distributed when it is asked for, and not before."""
    try:
        import distributed  # noqa: PLC0415 - an extra, and slow to import
    except ImportError:
        raise InputError(
            "--workers and --scheduler need dask.distributed: pip install 'trundle[cluster]'"
        ) from None
    return distributed

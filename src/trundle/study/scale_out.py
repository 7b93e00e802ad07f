"""Compute the parts of a study on the workers of a dask cluster."""

from __future__ import annotations

import logging
import os
from collections.abc import Callable, Generator, Iterable
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import Any

from trundle.dynamics import repeatable
from trundle.errors import ComputationError, InputError
from trundle.simulate import PreparedFloor, prepare
from trundle.structure import Floor
from trundle.study.jobs import Job, LaidOut, compute, lay_out_job
from trundle.study.pieces import Piece

__all__ = ["Cluster", "cluster_at", "local_cluster"]

_RETRIES = 3  # times that a part is tried again when its worker has died

Done = Callable[[str, Piece], None]


class Cluster:
    """Send parts to workers, and hand over what they leave."""

    def __init__(self, client: Any) -> None:  # noqa: ANN401 - dask has no types
        self._client = client
        # what was sent, by its identity; held, for another may take the place of one let go of
        self._sent: dict[int, tuple[LaidOut | Floor, Any]] = {}
        self._pending: dict[Any, _Sent] = {}

    def submit(self, job: Job, parts: Iterable[int], carrier: LaidOut | Floor) -> None:
        """Send parts of a job; its layout, or its floor, travels once to each worker.

        Parameters
        ----------
        job : Job
            The job.
        parts : iterable of int
            Which of its parts.
        carrier : LaidOut or Floor
            Its layout, or the floor that a worker prepares for itself.
        """
        for part in parts:
            self._send(_Sent(job=job, part=part, carrier=carrier, tries=1))

    def _send(self, what: _Sent) -> None:
        place = id(what.carrier)
        if place not in self._sent:
            self._sent[place] = (what.carrier, self._client.scatter(what.carrier, hash=False))
        future = self._client.submit(
            _compute,
            what.job,
            self._sent[place][1],
            what.part,
            key=f"{what.name}-{what.tries}",
            retries=_RETRIES,
            pure=False,
        )
        self._pending[future] = what

    def collect(self, done: Done, *, wait: bool) -> None:
        """Hand over finished pieces: those there already, or all, as they come."""
        distributed = _distributed()
        while self._pending:
            if wait:
                distributed.wait(list(self._pending), return_when="FIRST_COMPLETED")
            ready = [future for future in self._pending if future.done()]
            for future in ready:
                self._take(future, done)
            if not wait:
                return

    def _take(self, future: Any, done: Done) -> None:  # noqa: ANN401
        """Hand over a part's piece, or send the part again if what it needs died with a worker."""
        distributed = _distributed()
        what = self._pending.pop(future)
        try:
            done(what.name, future.result())
        except distributed.CancelledError as error:
            if what.tries > _RETRIES:
                raise ComputationError(
                    f"the cluster was lost while it computed {what.name}"
                ) from error
            lost = self._sent.pop(id(what.carrier), None)
            if lost is not None and lost[1].status == "finished":
                self._sent[id(what.carrier)] = lost
            self._send(replace(what, tries=what.tries + 1))
        except distributed.KilledWorker as error:
            raise ComputationError(
                f"the workers that computed {what.name} died {_RETRIES} times, most likely for "
                "want of memory; use fewer workers"
            ) from error
        future.release()
        if not any(other.carrier is what.carrier for other in self._pending.values()):
            self._sent.pop(id(what.carrier), None)


@dataclass(frozen=True, kw_only=True, eq=False)
class _Sent:
    """A part that workers were asked for."""

    job: Job
    part: int
    carrier: LaidOut | Floor
    tries: int

    @property
    def name(self) -> str:
        return self.job.pieces[self.part]


_kept: dict[tuple[str, str], PreparedFloor] = {}  # of this worker: the last floor it prepared


def _compute(job: Job, carrier: LaidOut | Floor, part: int) -> Piece:
    """Compute a part, in a worker."""
    with repeatable():
        if isinstance(carrier, LaidOut):
            return compute(job, carrier, part)
        interaction = job.method.interaction
        key = (carrier.content_hash, str(interaction))
        if key not in _kept:
            _kept.clear()
            _kept[key] = prepare(carrier, interaction.integration, interaction.damping)
        return compute(job, lay_out_job(job, _kept[key]), part)


@contextmanager
def local_cluster(n_workers: int) -> Generator[Cluster]:
    """Start so many workers on this machine, listening on loopback alone.

    Parameters
    ----------
    n_workers : int
        Number of processes; they share the machine's processors.
    """
    distributed = _distributed()
    threads = str(max(1, (os.cpu_count() or 1) // n_workers))
    names = ("TRUNDLE_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS", "OPENBLAS_NUM_THREADS")
    with (
        distributed.LocalCluster(
            n_workers=n_workers,
            threads_per_worker=1,
            processes=True,
            host="127.0.0.1",
            dashboard_address=None,
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
        yield Cluster(client)


def _distributed() -> Any:  # noqa: ANN401
    """Import dask.distributed when it is asked for, and not before."""
    try:
        import distributed  # noqa: PLC0415 - an extra, and slow to import
    except ImportError:
        raise InputError(
            "--workers and --scheduler need dask.distributed: pip install 'trundle[cluster]'"
        ) from None
    return distributed

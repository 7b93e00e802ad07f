"""Say what whoever computes tasks must offer: threads of this process, or workers elsewhere."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any, Protocol, TypeAlias, runtime_checkable

from trundle._progress import Progress
from trundle.dynamics import repeatable
from trundle.run.checkpoint import PieceStore
from trundle.run.jobs import Job, PreparedJob
from trundle.run.progress import Bar
from trundle.run.tasks import Task
from trundle.structure import Structure
from trundle.structure.superelements import Part, ReducedPencil

__all__ = ["Batch", "Executor", "Shared", "Work", "carry_out"]

Shared: TypeAlias = PreparedJob | Structure | Part | ReducedPencil
"""What tasks are given: of a job its layout, or the floor that a worker lays it out on itself; what
is reduced; matrices of which modes are wanted."""


@runtime_checkable
class Work(Protocol):
    """What an executor computes: a part of a job, a reduction, a part of a spectrum."""

    @property
    def name(self) -> str:
        """Name of what it leaves, unique among what is computed beside it."""
        ...

    @property
    def alone(self) -> bool:
        """Whether no other may be computed beside it in one process."""
        ...

    def compute(self, shared: Any, /, progress: Progress | None = None) -> Any:  # noqa: ANN401
        """Compute it: the same bits wherever and whenever."""
        ...


@runtime_checkable
class Executor(Protocol):
    """Computes tasks, in any order, anywhere."""

    @property
    def here(self) -> bool:
        """Whether this process computes: it then needs the layout itself."""
        ...

    def submit(self, task: Work, shared: Shared, progress: Progress) -> None:
        """Take a task; wait as long as there is no room for it."""
        ...

    def finished(self, *, wait: bool) -> Iterator[tuple[str, Any]]:
        """Give the names of finished tasks with what they leave: those at hand, or all."""
        ...


@dataclass(frozen=True, kw_only=True, eq=False)
class Batch:
    """Hold tasks that share a layout.

    Attributes
    ----------
    label : str
        What is told while they are computed.
    job : Job
        Whose tasks they are.
    tasks : sequence of Task
        The tasks.
    floor : Structure
        The floor, before it is prepared.
    lay_out : callable
        Lays out what they share, when their turn has come.
    """

    label: str
    job: Job
    tasks: Sequence[Task]
    floor: Structure
    lay_out: Callable[[], PreparedJob]


def carry_out(batches: Sequence[Batch], executor: Executor, store: PieceStore, bar: Bar) -> None:
    """Compute the tasks whose pieces are not kept yet, and keep each as it is finished.

    Parameters
    ----------
    batches : sequence of Batch
        What is to be computed.
    executor : Executor
        Who computes.
    store : PieceStore
        Where pieces are kept.
    bar : Bar
        Told what is done.
    """
    for batch in batches:
        bar.finished(task.name for task in batch.tasks if store.has(task.name))

    def keep(*, wait: bool) -> None:
        """Keep what is finished, and tell of it."""
        for name, piece in executor.finished(wait=wait):
            store.save(name, piece)
            bar.finished([name])

    # One limit around all, layouts too: threads that set their own would undo each other's.
    with repeatable():
        for batch in batches:
            missing = [task for task in batch.tasks if not store.has(task.name)]
            if missing:
                bar.begin(batch.label)
                # A worker prepares a floor for direct integration itself: factors do not travel.
                shared = batch.lay_out() if executor.here or batch.job.modal else batch.floor
                for task in missing:
                    executor.submit(task, shared, bar.teller(task.name))
                    keep(wait=False)
        keep(wait=True)

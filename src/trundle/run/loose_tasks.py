"""Carry out tasks that depend on nothing but what they are given."""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from typing import Any

from trundle._progress import Progress
from trundle.dynamics import repeatable
from trundle.run.executor import Executor, Work
from trundle.run.threads import Threads

__all__ = ["compute_loose"]


def compute_loose(
    tasks: Sequence[tuple[Work, Any]],
    executor: Executor | None,
    progress: Progress,
    landed: Callable[[str, Any], None] | None = None,
) -> dict[str, Any]:
    """Compute tasks, each with what it needs; return what each leaves, by its name.

    Parameters
    ----------
    tasks : sequence of (Work, object)
        What is computed, and what it needs.
    executor : Executor or None
        Who computes; threads of this process if None.
    progress : callable
        Told about how much of the work is done, 0 to 1.
    landed : callable, optional
        Told the name of each task as it lands, and what it leaves.
    """
    if not tasks:
        return {}
    if executor is None:
        with Threads() as own:
            return compute_loose(tasks, own, progress, landed)
    found: dict[str, Any] = {}
    shares = dict.fromkeys((task.name for task, _ in tasks), 0.0)
    lock = threading.Lock()

    def teller(name: str) -> Progress:
        """Return what is told of one task."""

        def tell(share: float) -> None:
            """Tell the mean over all tasks."""
            with lock:
                shares[name] = share
                progress(sum(shares.values()) / len(shares))

        return tell

    def take(*, wait: bool) -> None:
        """Take what has landed."""
        for name, left in executor.finished(wait=wait):
            found[name] = left
            teller(name)(1.0)
            if landed is not None:
                landed(name, left)

    with repeatable():
        for task, shared in tasks:
            executor.submit(task, shared, teller(task.name))
            take(wait=False)
        take(wait=True)
    return found

"""Compute tasks in threads of this process."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from types import TracebackType
from typing import Any

from trundle._progress import Progress
from trundle._threads import n_threads
from trundle.run.executor import Shared, Work

__all__ = ["Threads"]

_AT_ONCE = 2  # while one task draws its roads or is filtered, another keeps the processors busy


class _StoppedError(Exception):
    """Ends a task whose result nobody waits for any more."""


class Threads:
    """Compute some tasks at once, within a ``with`` block; an error there ends them all."""

    here = True

    def __init__(self) -> None:
        self._at_once = min(_AT_ONCE, n_threads())
        self._stop = threading.Event()
        self._running: dict[Future[Any], str] = {}
        self._done: list[tuple[str, Future[Any]]] = []
        self._pool = ThreadPoolExecutor(self._at_once)

    def __enter__(self) -> Threads:
        """Begin."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        """End; after an error nobody waits for what is running."""
        del kind, traceback
        if error is not None:
            self._stop.set()
        self._pool.shutdown()

    def submit(self, task: Work, shared: Shared, progress: Progress) -> None:
        """Take a task, when so few are running that there is room."""
        beside = 0 if task.alone else self._at_once
        self._collect(beside)
        self._running[self._pool.submit(self._run, task, shared, progress)] = task.name
        self._collect(beside)

    def finished(self, *, wait: bool) -> Iterator[tuple[str, Any]]:
        """Give what is finished, or all as they come."""
        while True:
            yield from self._taken()
            if not wait or not self._running:
                return
            self._collect(len(self._running) - 1)

    def _taken(self) -> Iterator[tuple[str, Any]]:
        """Give what is at hand; an error comes after all that went well."""
        taken, self._done = self._done, []
        for name, future in sorted(taken, key=lambda pair: pair[1].exception() is not None):
            yield name, future.result()

    def _collect(self, at_most: int) -> None:
        """Wait until so many tasks are running."""
        while len(self._running) > at_most:
            for future in wait(self._running, return_when=FIRST_COMPLETED).done:
                self._done.append((self._running.pop(future), future))

    def _run(self, task: Work, shared: Shared, progress: Progress) -> Any:  # noqa: ANN401
        """Compute a task, in a thread."""

        def tell(share: float) -> None:
            """Tell the share done, or end the task."""
            if self._stop.is_set():
                raise _StoppedError
            progress(share)

        return task.compute(shared, tell)

"""Tell how much of a study is done."""

from __future__ import annotations

import threading
from collections.abc import Iterable, Mapping

from trundle._progress import Tell
from trundle.run.jobs import Job

__all__ = ["Bar"]


class Bar:
    """Tell the share of a study that is done, by what each part costs; from any thread."""

    def __init__(self, tell: Tell, base: float, costs: Mapping[str, float]) -> None:
        self._tell, self._base = tell, base
        self._costs = dict(costs)
        self._label = ""
        self._shares = dict.fromkeys(self._costs, 0.0)
        self._lock = threading.Lock()

    def begin(self, job: Job) -> None:
        """Tell that a job is begun."""
        with self._lock:
            at = "" if job.speed is None else f" at {3.6 * job.speed:.3g} km/h"
            self._label = f"{job.case.name}{at}, {job.method.name}"
            self._show()

    def part(self, name: str, share: float) -> None:
        """Tell that a share of a piece is done."""
        with self._lock:
            self._shares[name] = share
            self._show()

    def finished(self, names: Iterable[str]) -> None:
        """Tell that pieces are done."""
        with self._lock:
            self._shares |= dict.fromkeys(names, 1.0)
            self._show()

    def _show(self) -> None:
        if self._label:
            done = sum(cost * self._shares[name] for name, cost in self._costs.items())
            share = done / sum(self._costs.values())
            self._tell(self._label, self._base + (1.0 - self._base) * share)

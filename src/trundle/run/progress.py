"""Tell how much is done."""

from __future__ import annotations

import threading
from collections.abc import Iterable, Mapping

from trundle._progress import Progress, Tell

__all__ = ["Bar"]


class Bar:
    """Tell the share that is done, by what each task costs; from any thread."""

    def __init__(self, tell: Tell, base: float, costs: Mapping[str, float]) -> None:
        self._tell, self._base = tell, base
        self._costs = dict(costs)
        self._label = ""
        self._shares = dict.fromkeys(self._costs, 0.0)
        self._lock = threading.Lock()

    def begin(self, label: str) -> None:
        """Tell what is begun."""
        with self._lock:
            self._label = label
            self._show()

    def teller(self, name: str) -> Progress:
        """Return what is told the share of a task that is done."""

        def tell(share: float) -> None:
            """Tell it."""
            with self._lock:
                self._shares[name] = share
                self._show()

        return tell

    def finished(self, names: Iterable[str]) -> None:
        """Tell that tasks are done."""
        with self._lock:
            self._shares |= dict.fromkeys(names, 1.0)
            self._show()

    def _show(self) -> None:
        if self._label:
            done = sum(cost * self._shares[name] for name, cost in self._costs.items())
            share = done / sum(self._costs.values())
            self._tell(self._label, self._base + (1.0 - self._base) * share)

"""Say how many threads may compute at once in this process."""

from __future__ import annotations

import os

__all__ = ["n_threads"]


def n_threads() -> int:
    """Return the number of threads: ``TRUNDLE_THREADS``, or all processors of the machine.

    Results do not depend on it. Workers that share a machine are given a part each.
    """
    named = os.environ.get("TRUNDLE_THREADS", "")
    return max(1, int(named)) if named.isdigit() else os.cpu_count() or 1

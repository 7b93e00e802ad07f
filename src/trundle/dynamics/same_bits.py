"""Make products and solutions give the same bits, whatever else a process has done."""

from __future__ import annotations

from collections.abc import Generator
from contextlib import contextmanager

from threadpoolctl import threadpool_limits

from trundle.dynamics.sparse_solver import available_backends

__all__ = ["repeatable"]


@contextmanager
def repeatable() -> Generator[None]:
    """Hold products and sparse solutions to one thread each inside the block.

    Threads that share a sum add it up in another order: solutions by two threads differ from those
    by one in their last digits, and some from call to call. The sparse solver's library is loaded
    before, for a limit reaches only what is there.
    """
    available_backends()
    with threadpool_limits(limits=1):
        yield

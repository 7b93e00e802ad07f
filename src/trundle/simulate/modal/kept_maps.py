"""Keep small maps of blocks from drive to drive over one layout.

Runs, waves and maps drive over the same places one after another. What they share of a block, how
forces push at contacts and move points, is small and dear to form: sums over all modes for every
pair of steps. What is large, rows on the state of all modes, is formed anew by every drive.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Hashable
from typing import TypeAlias

from trundle._typing import Array

__all__ = ["KeptMaps"]

_ROOM = 200e6  # bytes; blocks that find none are formed by every drive

Maps: TypeAlias = tuple[Array, ...]


class KeptMaps:
    """Hold maps by the blocks they belong to, as far as there is room.

    It belongs to one layout, and travels to another process empty.
    """

    def __init__(self) -> None:
        self._found: dict[Hashable, Maps] = {}
        self._room = _ROOM
        self._lock = threading.Lock()

    def __reduce__(self) -> tuple[type[KeptMaps], tuple[()]]:
        """Leave behind what was found."""
        return (KeptMaps, ())

    def of(self, block: Hashable, form: Callable[[], Maps]) -> Maps:
        """Return the maps of a block, formed unless they are here.

        One drive forms at a time: another that comes to the same block finds its maps then.

        Parameters
        ----------
        block : hashable
            Which block.
        form : callable
            Forms its maps, the same bits whoever asks.
        """
        with self._lock:
            if block in self._found:
                return self._found[block]
            maps = form()
            size = sum(one.nbytes for one in maps)
            if size <= self._room:
                self._room -= size
                self._found[block] = maps
            return maps

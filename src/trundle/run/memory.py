"""Have large arrays give their memory back as soon as nobody needs them."""

from __future__ import annotations

import ctypes
import sys

__all__ = ["give_back"]

_MMAP_THRESHOLD = -3  # glibc's number of the setting
_LARGE = 1_000_000  # bytes, of an array that gets pages of its own


def give_back() -> bool:
    """Let arrays of a megabyte and more have pages of their own; return whether the system does.

    The C library otherwise raises that size with every large array that is freed, and keeps what
    lies between arrays that live longer: two batches of runs beside the next layout kept some
    250 MB for nothing. Nothing of a result depends on it.
    """
    if sys.platform != "linux":
        return False
    try:
        libc = ctypes.CDLL(None)
        return bool(libc.mallopt(_MMAP_THRESHOLD, _LARGE))
    except (OSError, AttributeError):  # another C library
        return False

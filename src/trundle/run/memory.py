"""Have large arrays give their memory back as soon as nobody needs them."""

from __future__ import annotations

import ctypes
import sys

__all__ = ["give_back"]

_TRIM_THRESHOLD, _MMAP_THRESHOLD = -1, -3  # glibc's numbers of the settings
_LARGE = 1 << 22  # bytes, of an array that gets pages of its own; numpy then asks for huge ones
_KEPT = 1 << 25  # bytes of free memory that is kept for the next arrays below that size


def give_back() -> bool:
    """Let arrays of four megabytes and more have pages of their own; return whether they do.

    The C library otherwise raises that size with every large array that is freed, and keeps what
    lies between arrays that live longer: two batches of runs beside the next layout kept some
    250 MB for nothing. Smaller arrays take memory that was used before: pages that the system has
    to clear first cost more than most of what is computed in them. Nothing of a result depends on
    it.
    """
    if sys.platform != "linux":
        return False
    try:
        libc = ctypes.CDLL(None)
        kept = libc.mallopt(_TRIM_THRESHOLD, _KEPT)
        return bool(kept and libc.mallopt(_MMAP_THRESHOLD, _LARGE))
    except (OSError, AttributeError):  # another C library
        return False

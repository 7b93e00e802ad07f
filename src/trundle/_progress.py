"""Name what is told while something takes long."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

__all__ = ["Progress", "Tell", "silent"]

Progress: TypeAlias = Callable[[float], None]
"""Told the share done, 0 to 1."""

Tell: TypeAlias = Callable[[str, float], None]
"""Told what is being done, and the share of the whole that is done, 0 to 1."""


def silent(what: str, share: float) -> None:
    """Tell nobody."""
    del what, share

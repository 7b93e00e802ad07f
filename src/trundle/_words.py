"""Say quantities in the messages of numerics, which know no unit but those of SI."""

from __future__ import annotations

__all__ = ["in_kmh"]


def in_kmh(speed: float, digits: int = 3) -> str:
    """Return a speed [m/s] as drivers say it."""
    return f"{3.6 * speed:.{digits}g} km/h"

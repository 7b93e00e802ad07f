"""Say where in a building something is, for messages."""

from __future__ import annotations

from typing import Any

from trundle._typing import Array
from trundle.errors import Problem
from trundle.structure.building.parts import Building, Column, Wall
from trundle.structure.mesh.planar import SNAP

__all__ = ["outline", "parts", "shared_storeys", "shown"]


def outline(place: str, corners: Array, fault: str) -> Problem:
    """Return the problem of an outline."""
    return Problem(
        place=place,
        value=shown(corners),
        rule=fault,
        remedy="give the corners in order round the area, the first not repeated",
    )


def shown(corners: Array) -> str:
    """Return corners as messages show them."""
    shown = ", ".join(f"[{x:g}, {y:g}]" for x, y in corners[:3])
    return f"{shown}, ..." if len(corners) > 3 else shown


def parts(building: Building, kind: str) -> tuple[Any, ...]:
    """Return the parts of one kind, by its name in a study file."""
    plural = {"mass": "masses"}.get(kind, f"{kind}s")
    return getattr(building, plural)


def shared_storeys(building: Building, one: Column | Wall, other: Column | Wall) -> bool:
    """Return whether two members stand beside each other over some height."""
    low = max(building.level(one.bottom), building.level(other.bottom))
    high = min(building.level(one.top), building.level(other.top))
    return high - low > SNAP

"""Draw outlines of straight lines between corners."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from trundle._checks import finite
from trundle.errors import InputError
from trundle.road.profile import Profile

__all__ = ["WALL", "check_ramps", "height_of", "lines", "plateau"]

WALL = 2e-3
"""Chamfer over which a wall is drawn [m]."""


def plateau(length: float, height: float, ramp: float) -> Profile:
    """Return what is level at a height, between two ramps [m]."""
    return lines([(0.0, 0.0), (ramp, height), (length - ramp, height), (length, 0.0)])


def lines(corners: Sequence[tuple[float, float]]) -> Profile:
    """Join corners by straight lines, level beyond them."""
    return Profile.piecewise_linear(*np.array(corners).T, beyond="level")


def height_of(name: str, value: float) -> float:
    """Return a finite height or grade that is not 0, or say why it is not one."""
    if finite(name, value) == 0.0:
        raise InputError(f"{name} must not be 0: there would be nothing")
    return float(value)


def check_ramps(length: float, ramp: float) -> None:
    """Refuse two sides that do not fit into a length [m]."""
    if not WALL <= ramp < 0.5 * length:
        raise InputError(
            f"its two sides of {ramp:g} m each do not fit into its length of {length:g} m"
        )

"""Place grids of Nastran bulk data, whose systems stand in each other."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from trundle._typing import Array
from trundle.errors import InputError
from trundle.imports.nastran_deck import Grid, System

__all__ = ["Places"]


class Places:
    """Finds where grids are, in the basic system."""

    def __init__(
        self, grids: Mapping[int, Grid], every: Grid, systems: Mapping[int, System]
    ) -> None:
        self._grids, self._every, self._systems = grids, every, systems
        self._frames: dict[int, tuple[Array, Array]] = {}
        self._looking: list[int] = []

    def of(self, number: int) -> Array:
        """Return where a grid is [m].

        Raises
        ------
        InputError
            A grid or system that is not there, or systems that stand on themselves.
        """
        if number not in self._grids:
            raise InputError(f"a coordinate system names grid {number}, which is not there")
        grid = self._grids[number]
        system = grid.system if grid.system is not None else self._every.system or 0
        return self._in_basic(system, grid.place)

    def axes_of(self, system: int, where: str) -> Array:
        """Return the axes of a rectangular system, as rows.

        Raises
        ------
        InputError
            None, or one whose axes turn from place to place.
        """
        if system == 0:
            return np.eye(3)
        axes = self._frame(system)[1]
        if self._systems[system].kind != "R":
            raise InputError(f"{where}: the axes of system {system} turn from place to place")
        return axes

    def _in_basic(self, system: int, place: Array) -> Array:
        if system == 0:
            return place
        origin, axes = self._frame(system)
        return origin + _straight(self._systems[system].kind, place) @ axes

    def _frame(self, number: int) -> tuple[Array, Array]:
        """Return the origin of a system, and its axes as rows."""
        if number in self._frames:
            return self._frames[number]
        if number not in self._systems or number in self._looking:
            raise InputError(f"coordinate system {number} is not given, or stands on itself")
        self._looking.append(number)
        system = self._systems[number]
        if system.grids is None:
            points = [self._in_basic(system.under, point) for point in system.points]
        else:
            points = [self.of(grid) for grid in system.grids]
        self._looking.pop()
        origin, on_z, in_xz = points
        z = on_z - origin
        y = np.cross(z, in_xz - origin)
        if not np.linalg.norm(y) > 0.0:
            raise InputError(f"coordinate system {number}: its three points lie on one line")
        z, y = z / np.linalg.norm(z), y / np.linalg.norm(y)
        self._frames[number] = origin, np.array([np.cross(y, z), y, z])
        return self._frames[number]


def _straight(kind: str, place: Array) -> Array:
    """Return rectangular coordinates of a place; angles are in degrees."""
    if kind == "R":
        return place
    r, first, second = place
    if kind == "C":
        turn = np.radians(first)
        return np.array([r * np.cos(turn), r * np.sin(turn), second])
    down, turn = np.radians([first, second])
    return r * np.array([np.sin(down) * np.cos(turn), np.sin(down) * np.sin(turn), np.cos(down)])

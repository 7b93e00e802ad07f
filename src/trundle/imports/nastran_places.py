"""Place grids of Nastran bulk data, whose systems stand in each other, and turn what is said there.

A grid stands in one system (CP) and moves in another (CD): vectors, offsets, masses and dofs of
its cards are along the axes in which it moves.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from trundle._typing import Array
from trundle.errors import InputError
from trundle.imports.nastran_deck import Grid, System

__all__ = ["Places"]

_ASLANT = 1e-9  # of unit vectors, by which axes may miss the basic ones


class Places:
    """Finds where grids are, in the basic system, and what their own axes mean there."""

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

    def moves_in(self, number: int) -> int:
        """Return the system in which a grid moves; 0 for the basic one."""
        own = self._grids[number].moves_in
        return own if own is not None else self._every.moves_in or 0

    def angle_of(self, number: int, held: str) -> float:
        """Return by how much the axes are turned about z along which a grid is held in part [rad].

        Raises
        ------
        InputError
            Axes that are turned otherwise, or from place to place.
        """
        axes = self.axes_of(self.moves_in(number), f"grid {number}")
        if abs(axes[2, 2] - 1.0) > _ASLANT:
            raise InputError(
                f"grid {number} is held in {held} of a system of its own (CD) that is not turned "
                "about z alone, which is not read"
            )
        return float(np.arctan2(axes[0, 1], axes[0, 0]))

    def from_own(self, vector: Sequence[float], number: int, where: str) -> Array:
        """Return a vector along the axes in which a grid moves in the basic system.

        Raises
        ------
        InputError
            Axes that turn from place to place.
        """
        system = self.moves_in(number)
        if not system or not np.any(vector):
            return np.array(vector)
        return np.round(np.array(vector) @ self.axes_of(system, where), 12) + 0.0

    def inertia_from_own(self, six: Array, number: int) -> Array:
        """Return masses along the axes in which a grid moves along the basic axes.

        Raises
        ------
        InputError
            Masses that differ along axes aslant: products of inertia would be left.
        """
        system, where = self.moves_in(number), f"the masses (CMASS2) of grid {number}"
        if not system or all(np.ptp(some) == 0.0 for some in (six[:3], six[3:])):
            return six
        axes = self.axes_of(system, where)
        found = np.zeros(6)
        for kind in (slice(0, 3), slice(3, 6)):
            turned = axes.T @ np.diag(six[kind]) @ axes
            found[kind] = np.diag(turned)
            if np.abs(turned - np.diag(found[kind])).max() > _ASLANT * six[kind].max():
                raise InputError(
                    f"{where} differ along the axes of system {system} (CD), which lie aslant: "
                    "products of inertia are not read"
                )
        return found

    def dofs_in_basic(self, number: int, dofs: str, where: str) -> Array:
        """Return which dofs of the basic system some dofs of a grid are, of six.

        Raises
        ------
        InputError
            They lie aslant to the basic axes.
        """
        named, system = np.array([str(i) in dofs for i in range(1, 7)]), self.moves_in(number)
        kinds = (slice(0, 3), slice(3, 6))
        if not system or all(named[kind].all() or not named[kind].any() for kind in kinds):
            return named
        axes = self.axes_of(system, where)
        for kind in kinds:
            along = axes[named[kind]]
            spanned = along.T @ along
            named[kind] = np.diag(spanned) > 0.5
            if np.abs(spanned - np.diag(named[kind])).max() > _ASLANT:
                raise InputError(
                    f"{where}: dofs {dofs} of grid {number}, whose displacements have a system "
                    f"(CD {system}), lie aslant to the basic axes, which is not read"
                )
        return named

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

"""Make parts of tables: places, sections and plates by name, with what is wrong kept by place."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from trundle._typing import Array
from trundle.errors import Problem
from trundle.structure import STEEL, ShellSection
from trundle.structure.building import Profile
from trundle.structure.sections import PlateSection

__all__ = ["Maker", "grid_lines"]

_ANY_PROFILE = Profile.rectangle(1.0, 1.0, STEEL)
_ANY_PLATE = ShellSection(thickness=1.0, material=STEEL)
_FAR = 1e5  # m, to which a grid line at an x or a y reaches


def grid_lines(grid: Any) -> dict[str, Array]:
    """Return grid lines by name, by two places on each [m]."""
    return {
        **{name: np.array([[x, -_FAR], [x, _FAR]]) for name, x in grid.x.items()},
        **{name: np.array([[-_FAR, y], [_FAR, y]]) for name, y in grid.y.items()},
        **{name: np.array(ends) for name, ends in grid.lines.items()},
    }


class Maker:
    """Makes parts of tables; names that there are not are kept as problems."""

    def __init__(
        self, section: Any, profiles: Mapping[str, Profile], plates: Mapping[str, PlateSection]
    ) -> None:
        self._section, self._profiles, self._plates = section, profiles, plates
        self._grid = grid_lines(section.grid)
        self.problems: list[Problem] = []

    @property
    def mesh_size(self) -> float:
        """Largest element edge of the building [m]."""
        return float(self._section.mesh_size)

    def check_grid(self) -> None:
        """Keep grid lines of one name, and lines between two places at one."""
        grid = self._section.grid
        names = [*grid.x, *grid.y, *grid.lines]
        for name in dict.fromkeys(name for name in names if names.count(name) > 1):
            rule = "names of grid lines must differ, for places are found by them"
            self.refuse("building.grid", f"{name!r} {names.count(name)} times", rule, "rename one")
        for name, (start, end) in grid.lines.items():
            if start == end:
                rule, remedy = "a grid line runs through two places", "give two that are apart"
                self.refuse(f"building.grid.lines.{name}", "one place twice", rule, remedy)

    def profile(self, place: str, name: str) -> Profile:
        """Return a cross-section by its name; any for one with a mistake."""
        self._check(f"{place}.section", name, "sections")
        return self._profiles.get(name, _ANY_PROFILE)

    def plate(self, place: str, name: str) -> PlateSection:
        """Return a plate by its name; any for one with a mistake."""
        self._check(f"{place}.plate", name, "plates")
        return self._plates.get(name, _ANY_PLATE)

    def _check(self, place: str, name: str, kind: str) -> None:
        declared = getattr(self._section, kind)
        if name not in declared:
            self.problems.append(
                Problem(
                    place=place,
                    value=repr(name),
                    rule=f"must be the name of one of the building's {kind}",
                    remedy=f"there are: {', '.join(declared) or 'none'}; add "
                    f"[building.{kind}.{name}]",
                )
            )

    def places(self, place: str, given: Sequence[Any]) -> Array:
        """Return places in plan [m], crossings of grid lines found."""
        several = len(given) > 1
        return np.array(
            [
                self.place(f"{place}[{i}]" if several else place, one)
                for i, one in enumerate(given, start=1)
            ],
            dtype=float,
        ).reshape(-1, 2)

    def place(self, place: str, given: Any) -> Array:
        """Return a place in plan [m]."""
        if not isinstance(given, str):
            return np.array(given, dtype=float)
        names = [name.strip() for name in given.split("/")]
        unknown = [name for name in names if name not in self._grid]
        if unknown:
            remedy = f"there are: {', '.join(self._grid) or 'none'}; see [building.grid]"
            self.refuse(place, given, f"there is no grid line {unknown[0]!r}", remedy)
            return np.zeros(2)
        if any(np.array_equal(*self._grid[name]) for name in names):
            return np.zeros(2)  # told with its grid
        found = _crossing(*(self._grid[name] for name in names))
        if found is None:
            rule = f"grid lines {names[0]!r} and {names[1]!r} do not cross"
            self.refuse(place, given, rule, "name two that do, or give [x, y]")
            return np.zeros(2)
        return found

    def on_grid(self) -> list[Array]:
        """Return where lines at an x cross lines at a y."""
        grid = self._section.grid
        return [np.array([x, y]) for x in grid.x.values() for y in grid.y.values()]

    def line_or_places(self, place: str, table: Any) -> list[tuple[int | None, Array]]:
        """Return one line, or single places with their numbers."""
        if (table.along is None) == (table.at is None):
            rule = "it stands along a line, or at places"
            self.refuse(place, "both" if table.at else "neither", rule, "give along, or at")
            return []
        if table.along is not None:
            return [(None, self.places(f"{place}.along", table.along))]
        found = self.places(f"{place}.at", table.at)
        return [(i if len(found) > 1 else None, at[None]) for i, at in enumerate(found, start=1)]

    def refuse(self, place: str, value: str, rule: str, remedy: str) -> None:
        """Keep a mistake."""
        self.problems.append(Problem(place=place, value=value, rule=rule, remedy=remedy))


def _crossing(one: Array, other: Array) -> Array | None:
    along, across = one[1] - one[0], other[1] - other[0]
    turn = along[0] * across[1] - along[1] * across[0]
    if abs(turn) < 1e-9 * np.linalg.norm(along) * np.linalg.norm(across):
        return None
    from_one = other[0] - one[0]
    share = (from_one[0] * across[1] - from_one[1] * across[0]) / turn
    return np.round(one[0] + share * along, 9)

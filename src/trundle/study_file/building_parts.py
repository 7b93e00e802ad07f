"""Turn the tables of a building into its parts, and remember which table each came from."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from itertools import pairwise
from typing import Any, TypeAlias

import numpy as np

from trundle._typing import Array
from trundle.errors import Problem
from trundle.structure import STEEL, Material, ShellSection
from trundle.structure.building import (
    Base,
    Beam,
    Brace,
    Building,
    Column,
    Mass,
    Profile,
    Ramp,
    Slab,
    Springs,
    Storey,
    Support,
    SymmetryPlane,
    Wall,
)
from trundle.structure.sections import PlateSection
from trundle.study_file.building_makes import plates_of, profiles_of

__all__ = ["Origins", "grid_lines", "parts_of"]

Origins: TypeAlias = Mapping[str, Sequence[tuple[int, int | None]]]
"""For each kind of part, the number of its table, and of its place in it if it has several."""

_DOFS = ("ux", "uy", "uz", "rx", "ry", "rz")
_HOLDS = {"roller": ("uz",), "pinned": ("ux", "uy", "uz"), "fixed": _DOFS}
_ANY_PROFILE = Profile.rectangle(1.0, 1.0, STEEL)
_ANY_PLATE = ShellSection(thickness=1.0, material=STEEL)
_FAR = 1e5  # m, to which a grid line at an x or a y reaches


def parts_of(
    section: Any, materials: Mapping[str, Material]
) -> tuple[Building | None, Origins, list[Problem]]:
    """Return the building of a section, where its parts stand in the file, and what is wrong."""
    profiles, wrong = profiles_of(section, materials)
    plates, more = plates_of(section, materials)
    maker = _Maker(section, profiles, plates)
    parts = {kind: maker.made(kind) for kind in _KINDS}
    found = [*wrong, *more, *maker.problems]
    if found:
        return None, {}, found
    building = Building(
        name=section.name,
        storeys=tuple(Storey(name=s.name, level=s.level) for s in section.storey),
        symmetry=tuple(
            SymmetryPlane(axis="xy".index(s.axis), position=s.at) for s in section.symmetry
        ),
        grid=grid_lines(section.grid),
        north=None if section.north is None else float(np.degrees(section.north)),
        **{_plural(kind): tuple(part for part, _ in some) for kind, some in parts.items()},
    )
    origins = {kind: [origin for _, origin in some] for kind, some in parts.items()}
    for kind in ("storey", "symmetry"):
        origins[kind] = [(i, None) for i in range(1, len(getattr(section, kind)) + 1)]
    return building, origins, []


def _plural(kind: str) -> str:
    return "masses" if kind == "mass" else f"{kind}s"


def grid_lines(grid: Any) -> dict[str, Array]:
    """Return grid lines by name, by two places on each [m]."""
    return {
        **{name: np.array([[x, -_FAR], [x, _FAR]]) for name, x in grid.x.items()},
        **{name: np.array([[-_FAR, y], [_FAR, y]]) for name, y in grid.y.items()},
        **{name: np.array(ends) for name, ends in grid.lines.items()},
    }


class _Maker:
    """Makes parts of tables; names that there are not are kept as problems."""

    def __init__(
        self, section: Any, profiles: Mapping[str, Profile], plates: Mapping[str, PlateSection]
    ) -> None:
        self._section, self._profiles, self._plates = section, profiles, plates
        self._grid = grid_lines(section.grid)
        self.problems: list[Problem] = []

    def made(self, kind: str) -> list[tuple[Any, tuple[int, int | None]]]:
        """Return the parts of one kind, each with where it stands."""
        made = []
        for i, table in enumerate(getattr(self._section, kind), start=1):
            before = len(self.problems)
            parts = list(_KINDS[kind](self, f"building.{kind}[{i}]", table))
            if len(self.problems) == before:
                made += [(part, (i, j)) for j, part in parts]
        return made

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
            self._refuse(place, given, f"there is no grid line {unknown[0]!r}", remedy)
            return np.zeros(2)
        found = _crossing(*(self._grid[name] for name in names))
        if found is None:
            rule = f"grid lines {names[0]!r} and {names[1]!r} do not cross"
            self._refuse(place, given, rule, "name two that do, or give [x, y]")
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
            self._refuse(place, "both" if table.at else "neither", rule, "give along, or at")
            return []
        if table.along is not None:
            return [(None, self.places(f"{place}.along", table.along))]
        found = self.places(f"{place}.at", table.at)
        return [(i if len(found) > 1 else None, at[None]) for i, at in enumerate(found, start=1)]

    def _refuse(self, place: str, value: str, rule: str, remedy: str) -> None:
        self.problems.append(Problem(place=place, value=value, rule=rule, remedy=remedy))


def _crossing(one: Array, other: Array) -> Array | None:
    along, across = one[1] - one[0], other[1] - other[0]
    turn = along[0] * across[1] - along[1] * across[0]
    if abs(turn) < 1e-9 * np.linalg.norm(along) * np.linalg.norm(across):
        return None
    from_one = other[0] - one[0]
    share = (from_one[0] * across[1] - from_one[1] * across[0]) / turn
    return np.round(one[0] + share * along, 9)


def _base(given: Any) -> Base | None:
    if given == "fixed":
        return "fixed"
    if given == "pinned":
        return "pinned"
    return None if given is None else _springs(given)


def _springs(given: Any) -> Springs:
    """Return six springs; those that a table has no key for are nought."""
    ux, uy, uz, rx, ry, rz = (float(getattr(given, dof, 0.0)) for dof in _DOFS)
    return ux, uy, uz, rx, ry, rz


def _slab(maker: _Maker, place: str, table: Any) -> list[tuple[int | None, Slab]]:
    outline = maker.places(f"{place}.outline", table.outline)
    openings = [
        maker.places(f"{place}.openings[{i}]", one) for i, one in enumerate(table.openings, 1)
    ]
    plate = maker.plate(place, table.plate)
    slab = Slab(
        on=table.on,
        section=plate,
        outline=outline,
        openings=tuple(openings),
        panel=table.panel,
        name=f"slab {table.plate}",
    )
    return [(None, slab)]


def _beam(maker: _Maker, place: str, table: Any) -> list[tuple[int | None, Beam]]:
    beam = Beam(
        on=table.on,
        profile=maker.profile(place, table.section),
        along=maker.places(f"{place}.along", table.along),
        below=table.below,
        hinged=(table.hinged in ("start", "both"), table.hinged in ("end", "both")),
        name=f"beam {table.section}",
    )
    return [(None, beam)]


def _columns(maker: _Maker, place: str, table: Any) -> list[tuple[int | None, Column]]:
    places = maker.on_grid() if table.at == "grid" else list(maker.places(f"{place}.at", table.at))
    if not len(places):
        maker.problems.append(
            Problem(
                place=f"{place}.at",
                value="grid",
                rule="columns stand where grid lines at an x cross those at a y",
                remedy="name lines in [building.grid.x] and [building.grid.y], or give places",
            )
        )
    profile = maker.profile(place, table.section)
    several = len(places) > 1 and table.at != "grid"
    return [
        (
            i if several else None,
            Column(
                profile=profile,
                at=at,
                bottom=table.from_,
                top=table.to,
                angle=float(np.degrees(table.angle)),
                base=_base(table.base),
                cap=_base(table.cap),
                head=table.head,
                name="column",
            ),
        )
        for i, at in enumerate(places, start=1)
    ]


def _walls(maker: _Maker, place: str, table: Any) -> list[tuple[int | None, Wall]]:
    line = maker.places(f"{place}.along", table.along)
    plate = maker.plate(place, table.plate)
    return [
        (
            None,
            Wall(
                section=plate,
                along=np.stack(pair),
                bottom=table.from_,
                top=table.to,
                base=_base(table.base),
                name=f"wall {table.plate}",
            ),
        )
        for pair in pairwise(line)
    ]


def _brace(maker: _Maker, place: str, table: Any) -> list[tuple[int | None, Brace]]:
    ends = [maker.place(f"{place}.{key}", getattr(table, key)) for key in ("start", "end")]
    brace = Brace(
        profile=maker.profile(place, table.section),
        ends=np.array(ends),
        on=table.on,
        hinged=table.hinged,
        name=f"brace {table.section}",
    )
    return [(None, brace)]


def _ramp(maker: _Maker, place: str, table: Any) -> list[tuple[int | None, Ramp]]:
    ramp = Ramp(
        name=table.name,
        section=maker.plate(place, table.plate),
        outline=maker.places(f"{place}.outline", table.outline),
        bottom=table.from_,
        top=table.to,
    )
    return [(None, ramp)]


def _supports(maker: _Maker, place: str, table: Any) -> list[tuple[int | None, Support]]:
    hold = _HOLDS[table.hold] if isinstance(table.hold, str) else table.hold
    ux, uy, uz, rx, ry, rz = (dof in hold for dof in _DOFS)
    held, springs = (ux, uy, uz, rx, ry, rz), _springs(table.springs)
    return [
        (i, Support(on=table.on, along=line, held=held, springs=springs, name="support"))
        for i, line in maker.line_or_places(place, table)
    ]


def _masses(maker: _Maker, place: str, table: Any) -> list[tuple[int | None, Mass]]:
    mass = table.mass if table.at is not None else table.mass_per_metre
    other = table.mass_per_metre if table.at is not None else table.mass
    if not mass or other is not None:
        key = "mass" if table.at is not None else "mass_per_metre"
        maker.problems.append(
            Problem(
                place=f"{place}.{key}",
                value="nothing" if not mass else "both",
                rule="places have a mass, and a line has a mass_per_metre, above 0",
                remedy=f'give {key} alone, such as "{"2 t" if key == "mass" else "120 kg/m"}"',
            )
        )
        return []
    return [
        (i, Mass(on=table.on, along=line, mass=mass, name="mass"))
        for i, line in maker.line_or_places(place, table)
    ]


_KINDS: dict[str, Callable[[_Maker, str, Any], list[tuple[int | None, Any]]]] = {
    "slab": _slab,
    "beam": _beam,
    "column": _columns,
    "wall": _walls,
    "brace": _brace,
    "ramp": _ramp,
    "support": _supports,
    "mass": _masses,
}

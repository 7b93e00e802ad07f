"""Turn the tables of a building into its parts, and remember which table each came from."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import pairwise
from typing import Any, TypeAlias

import numpy as np

from trundle.errors import Problem
from trundle.structure import Material, MirrorPlane
from trundle.structure.building import (
    Base,
    Beam,
    Brace,
    Building,
    Column,
    Joint,
    Mass,
    Ramp,
    Slab,
    Springs,
    Storey,
    Support,
    Wall,
)
from trundle.study_file.building_maker import Maker, grid_lines
from trundle.study_file.building_makes import plates_of, profiles_of
from trundle.study_file.building_tables import LineSpringsSection

__all__ = ["Origins", "parts_of"]

Origins: TypeAlias = Mapping[str, Sequence[tuple[int, int | None]]]
"""For each kind of part, the number of its table, and of its place in it if it has several."""

_SHORT = 0.02  # m, between two places of a plane
_DOFS = ("ux", "uy", "uz", "rx", "ry", "rz")
_HOLDS = {"roller": ("uz",), "pinned": ("ux", "uy", "uz"), "fixed": _DOFS}


def parts_of(
    section: Any, materials: Mapping[str, Material]
) -> tuple[Building | None, Origins, list[Problem]]:
    """Return the building of a section, where its parts stand in the file, and what is wrong."""
    profiles, wrong = profiles_of(section, materials)
    plates, more = plates_of(section, materials)
    maker = Maker(section, profiles, plates)
    maker.check_grid()
    parts = {kind: _made(section, maker, kind) for kind in _KINDS}
    planes = [
        plane
        for i, table in enumerate(section.symmetry, start=1)
        for plane in _symmetry(maker, f"building.symmetry[{i}]", table)
    ]
    found = [*wrong, *more, *maker.problems]
    if found:
        return None, {}, found
    building = Building(
        name=section.name,
        storeys=tuple(Storey(name=s.name, level=s.level) for s in section.storey),
        symmetry=tuple(planes),
        grid=grid_lines(section.grid),
        north=None if section.north is None else float(np.degrees(section.north)),
        **{_plural(kind): tuple(part for part, _ in some) for kind, some in parts.items()},
    )
    origins = {kind: [origin for _, origin in some] for kind, some in parts.items()}
    for kind in ("storey", "symmetry"):
        origins[kind] = [(i, None) for i in range(1, len(getattr(section, kind)) + 1)]
    return building, origins, []


def _made(section: Any, maker: Maker, kind: str) -> list[tuple[Any, tuple[int, int | None]]]:
    """Return the parts of one kind, each with where it stands."""
    made = []
    for i, table in enumerate(getattr(section, kind), start=1):
        before = len(maker.problems)
        parts = list(_KINDS[kind](maker, f"building.{kind}[{i}]", table))
        if len(maker.problems) == before:
            made += [(part, (i, j)) for j, part in parts]
    return made


def _plural(kind: str) -> str:
    return "masses" if kind == "mass" else f"{kind}s"


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


def _slab(maker: Maker, place: str, table: Any) -> list[tuple[int | None, Slab]]:
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


def _beam(maker: Maker, place: str, table: Any) -> list[tuple[int | None, Beam]]:
    beam = Beam(
        on=table.on,
        profile=maker.profile(place, table.section),
        along=maker.places(f"{place}.along", table.along),
        below=table.below,
        hinged=(table.hinged in ("start", "both"), table.hinged in ("end", "both")),
        name=f"beam {table.section}",
    )
    return [(None, beam)]


def _columns(maker: Maker, place: str, table: Any) -> list[tuple[int | None, Column]]:
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


def _walls(maker: Maker, place: str, table: Any) -> list[tuple[int | None, Wall]]:
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


def _brace(maker: Maker, place: str, table: Any) -> list[tuple[int | None, Brace]]:
    ends = [maker.place(f"{place}.{key}", getattr(table, key)) for key in ("start", "end")]
    brace = Brace(
        profile=maker.profile(place, table.section),
        ends=np.array(ends),
        on=table.on,
        hinged=table.hinged,
        name=f"brace {table.section}",
    )
    return [(None, brace)]


def _ramp(maker: Maker, place: str, table: Any) -> list[tuple[int | None, Ramp]]:
    ramp = Ramp(
        name=table.name,
        section=maker.plate(place, table.plate),
        outline=maker.places(f"{place}.outline", table.outline),
        bottom=table.from_,
        top=table.to,
    )
    return [(None, ramp)]


def _supports(maker: Maker, place: str, table: Any) -> list[tuple[int | None, Support]]:
    hold = _HOLDS[table.hold] if isinstance(table.hold, str) else table.hold
    ux, uy, uz, rx, ry, rz = (dof in hold for dof in _DOFS)
    held, springs = (ux, uy, uz, rx, ry, rz), _springs(table.springs)
    if not _by_line(maker, place, table):
        return []
    if table.angle % np.pi and any(springs):
        maker.refuse(
            f"{place}.angle",
            f"{np.degrees(table.angle):g} deg, with springs",
            "springs act along x, y and z",
            "leave angle out, or hold without springs",
        )
        return []
    return [
        (
            i,
            Support(
                on=table.on,
                along=line,
                held=held,
                springs=springs,
                angle=float(np.degrees(table.angle)),
                name="support",
            ),
        )
        for i, line in maker.line_or_places(place, table)
    ]


def _by_line(maker: Maker, place: str, table: Any) -> bool:
    """Return whether springs are by the metre where a line has them, and there alone."""
    by_metre = isinstance(table.springs, LineSpringsSection)
    if table.springs is None or by_metre == (table.along is not None):
        return True
    maker.refuse(
        f"{place}.springs",
        "by the metre" if by_metre else "not by the metre",
        "springs along a line are by the metre, those at places are not",
        'write "5 MN/m/m" along a line, "5 MN/m" at a place',
    )
    return False


def _symmetry(maker: Maker, place: str, table: Any) -> Iterator[MirrorPlane]:
    """Give the plane of a table, by an axis and a place on it or by two places."""
    axis, at, along = table.axis, table.at, table.along
    if along is None and axis is not None and at is not None:
        yield MirrorPlane.across("xy".index(axis), at)
    elif along is not None and axis is None and at is None:
        line = maker.places(f"{place}.along", along)
        if np.hypot(*(line[1] - line[0])) > _SHORT:
            yield MirrorPlane.through(line)
        else:
            maker.refuse(
                f"{place}.along",
                "two places at one",
                "a plane of symmetry runs along two places",
                "give two that are apart",
            )
    else:
        maker.refuse(
            place,
            "both" if along else "neither",
            "a plane of symmetry is across an axis at a place, or runs along two places",
            'give axis = "x" with at = "12 m", or along = [[x, y], [x, y]]',
        )


def _masses(maker: Maker, place: str, table: Any) -> list[tuple[int | None, Mass]]:
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


def _joint(maker: Maker, place: str, table: Any) -> list[tuple[int | None, Joint]]:
    along, to = (maker.places(f"{place}.{key}", getattr(table, key)) for key in ("along", "to"))
    springs = (table.springs.ux, table.springs.uy, table.springs.uz)
    return [(None, Joint(on=table.on, along=along, to=to, springs=springs))]


_KINDS: dict[str, Callable[[Maker, str, Any], list[tuple[int | None, Any]]]] = {
    "slab": _slab,
    "beam": _beam,
    "column": _columns,
    "wall": _walls,
    "brace": _brace,
    "ramp": _ramp,
    "support": _supports,
    "mass": _masses,
    "joint": _joint,
}

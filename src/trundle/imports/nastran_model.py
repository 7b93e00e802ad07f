"""Make a floor of what the cards of Nastran bulk data say."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from trundle._typing import Array
from trundle.errors import InputError
from trundle.imports.nastran_deck import Deck, Face, Laminate, Member, MemberMake, Spring
from trundle.imports.nastran_places import Places
from trundle.imports.nastran_plates import axis_of, is_turned, plate_section
from trundle.structure import (
    BeamGroup,
    BeamSection,
    Floor,
    Material,
    OrthotropicSection,
    PointMasses,
    RigidLinks,
    ShellGroup,
    ShellSection,
    SpringGroup,
    TriangleGroup,
)
from trundle.structure.elements import GROUND, Elements, NodeInertia, ReleasedBeams
from trundle.structure.frames import plate_areas

__all__ = ["floor_of"]

_SAME = 1e-6  # m, within which the grids of a bush are at one place


def floor_of(deck: Deck, asked: int | None, name: str) -> Floor:
    """Return the floor of a deck; `asked` is the set of supports that case control names.

    Raises
    ------
    InputError
        Numbers that name nothing, or what cannot be made of the cards.
    """
    return _Builder(deck, asked, name).floor()


class _Builder:
    """Makes a floor of what the cards say."""

    def __init__(self, deck: Deck, asked: int | None, name: str) -> None:
        self._deck, self._asked, self._name = deck, asked, name
        self._row = {number: row for row, number in enumerate(deck.grids)}
        self._places = Places(deck.grids, deck.every_grid, deck.systems)
        self._nodes = np.array([self._places.of(number) for number in deck.grids]).reshape(-1, 3)
        self._lumps: dict[str, Array] = {}
        self._angles = np.zeros((len(self._nodes), 2))

    def floor(self) -> Floor:
        """Return it."""
        shells, triangles = self._faces()
        bars = list(self._bars())
        masses, fixed = list(self._masses()), self._fixed()
        lumps = () if self._deck.consistent else tuple(self._lumped())
        return Floor(
            nodes=self._nodes,
            fixed=fixed,
            angles=self._angles if self._angles.any() else None,
            shells=tuple(shells),
            beams=tuple(bar for bar in bars if isinstance(bar, BeamGroup)),
            springs=tuple(self._springs()),
            masses=(*(m for m in masses if isinstance(m, PointMasses)), *lumps),
            others=(
                *triangles,
                *(b for b in bars if not isinstance(b, BeamGroup)),
                *(m for m in masses if isinstance(m, NodeInertia)),
            ),
            links=self._links(),
            name=self._name,
        )

    def _node(self, number: int, where: str) -> int:
        if number not in self._row:
            raise InputError(f"{where} names grid {number}, which is not there")
        return self._row[number]

    def _material(self, number: int, where: str) -> Material:
        if number not in self._deck.materials:
            raise InputError(f"{where} names material {number}, which is not there")
        material = self._deck.materials[number]
        return replace(material, density=material.density * self._deck.weight_to_mass)

    def _lump(self, name: str, elements: Array, masses: Array) -> None:
        """Put the mass of each element of a property on its nodes, alike on all."""
        share = np.repeat(masses / elements.shape[1], elements.shape[1])
        lumps = self._lumps.setdefault(name, np.zeros(len(self._nodes)))
        np.add.at(lumps, elements.ravel(), share)

    def _lumped(self) -> Iterator[PointMasses]:
        for name, lumps in self._lumps.items():
            heavy = np.flatnonzero(lumps)
            if len(heavy):
                yield PointMasses(nodes=heavy, mass=lumps[heavy], name=f"{name}, lumped")

    def _faces(self) -> tuple[list[ShellGroup], list[Elements]]:
        found: dict[tuple[int, int, tuple[float, ...]], list[list[int]]] = defaultdict(list)
        for face in self._deck.faces:
            if face.property not in self._deck.shells:
                raise InputError(
                    f"{face.place} names property {face.property}, which is no PSHELL or PCOMP"
                )
            nodes = [self._node(n, face.place) for n in face.corners]
            axis = self._axis(face, nodes) if is_turned(self._deck, face.property) else ()
            found[face.property, len(nodes), axis].append(nodes)
        shells, triangles = list[ShellGroup](), list[Elements]()
        for (number, corners, axis), elements in found.items():
            numbers = np.array(elements)
            section, name = self._plate(number, numbers, axis), self._plate_name(number)
            if corners == 4:
                shells.append(ShellGroup(elements=numbers, section=section, name=name))
            else:
                triangles.append(TriangleGroup(connectivity=numbers, section=section, name=name))
        return shells, triangles

    def _axis(self, face: Face, nodes: list[int]) -> tuple[float, ...]:
        first = None
        if face.system is not None:
            first = self._places.axes_of(face.system, face.place)[0]
        return axis_of(face, self._nodes[nodes], first)

    def _plate_name(self, number: int) -> str:
        laminate = isinstance(self._deck.shells[number], Laminate)
        return f"{'PCOMP' if laminate else 'PSHELL'} {number}"

    def _plate(
        self, number: int, elements: Array, axis: tuple[float, ...]
    ) -> ShellSection | OrthotropicSection:
        """Return a plate's section; without mass where that is on its nodes."""
        section = plate_section(self._deck, number)
        if isinstance(section, OrthotropicSection) and axis:
            section = replace(section, axis=np.array(axis))
        if self._deck.consistent:
            return section
        name = self._plate_name(number)
        self._lump(name, elements, section.mass_per_area * plate_areas(self._nodes[elements]))
        if isinstance(section, OrthotropicSection):
            return replace(section, mass_per_area=0.0, rotary_inertia=0.0)
        light = replace(section.material, density=0.0)
        return replace(section, material=light, superimposed_mass=0.0)

    def _bars(self) -> Iterator[BeamGroup | ReleasedBeams]:
        found: dict[tuple, list[tuple[int, int]]] = defaultdict(list)
        for bar in self._deck.bars:
            ends = self._node(bar.ends[0], bar.place), self._node(bar.ends[1], bar.place)
            make = self._make(bar)
            up, offset = self._up(bar, ends), self._offset(bar)
            found[bar.property, up, offset, _released(bar, make)].append(ends)
        for (number, up, offset, released), elements in found.items():
            numbers = np.array(elements)
            group = BeamGroup(
                elements=numbers,
                section=self._bar_section(number, numbers),
                up=np.array(up),
                offset=np.array(offset),
                name=_bar_name(number),
            )
            pins = np.array(released)
            yield ReleasedBeams(beams=group, released=pins) if pins.any() else group

    def _make(self, bar: Member) -> MemberMake:
        if bar.property not in self._deck.members:
            raise InputError(f"{bar.place} names property {bar.property}, which is not there")
        return self._deck.members[bar.property]

    def _up(self, bar: Member, ends: tuple[int, int]) -> tuple[float, ...]:
        """Return the direction that lies in the plane of a bar's first bending."""
        along = self._nodes[ends[1]] - self._nodes[ends[0]]
        if not np.linalg.norm(along) > 0.0:
            raise InputError(f"{bar.place}: both ends are at one place")
        if bar.up is not None:
            up = np.array(bar.up)
            if not bar.up_in_basic:
                up = self._places.from_own(bar.up, bar.ends[0], bar.place)
        elif bar.towards is not None:
            up = self._nodes[self._node(bar.towards, bar.place)] - self._nodes[ends[0]]
        else:  # a rod has no sides: any direction across it
            up = np.eye(3)[int(np.abs(along).argmin())]
        if np.linalg.norm(np.cross(along, up)) < 1e-9 * np.linalg.norm(along):
            raise InputError(f"{bar.place}: the orientation lies along the bar")
        return tuple((up / np.linalg.norm(up)).tolist())

    def _offset(self, bar: Member) -> tuple[float, ...]:
        """Return how far from its grids a bar lies, alike at both ends."""
        first, last = (
            self._places.from_own(offset, end, bar.place)
            for offset, end in zip(bar.offsets, bar.ends, strict=True)
        )
        if np.linalg.norm(first - last) > _SAME * np.linalg.norm(first):
            raise InputError(f"{bar.place}: offsets that differ at both ends are not read")
        return tuple(first.tolist())

    def _bar_section(self, number: int, elements: Array) -> BeamSection:
        """Return a member's section; without mass where that is on its nodes."""
        make = self._deck.members[number]
        material = self._material(make.material, f"property {number}")
        # mass that a metre has besides is spread over the section
        density = material.density + make.more * self._deck.weight_to_mass / make.section.area
        if not self._deck.consistent:
            lengths = np.linalg.norm(np.diff(self._nodes[elements], axis=1)[:, 0], axis=1)
            self._lump(_bar_name(number), elements, density * make.section.area * lengths)
            density = 0.0
        return replace(make.section, material=replace(material, density=density))

    def _masses(self) -> Iterator[PointMasses | NodeInertia]:
        own = self._deck.own_masses
        numbers = [*(number for number, _ in self._deck.masses), *own]
        if not numbers:
            return
        at = np.array([self._node(number, "a mass") for number in numbers])
        turned = [self._places.inertia_from_own(six, number) for number, six in own.items()]
        six = np.array([*(mass for _, mass in self._deck.masses), *turned])
        six = self._deck.weight_to_mass * six
        plain = (six[:, :3] == six[:, :1]).all(axis=1) & ~six[:, 3:].any(axis=1)
        if plain.any():
            yield PointMasses(nodes=at[plain], mass=six[plain, 0], name="CONM2")
        if not plain.all():
            yield NodeInertia(nodes=at[~plain], inertia=six[~plain], name="CONM2 and CMASS2")

    def _springs(self) -> Iterator[SpringGroup]:
        for spring in self._deck.springs:
            known = spring.stiffness or self._deck.stiffnesses.get(spring.property)
            if known is None:
                raise InputError(
                    f"{spring.place} names property {spring.property}, which is no spring's"
                )
            stiffness = np.zeros(6)
            ends = [GROUND if n is None else self._node(n, spring.place) for n in spring.ends]
            self._check_spring(spring, ends)
            if spring.dof:
                dof = self._places.dofs_in_basic(spring.ends[0], str(spring.dof), spring.place)
                stiffness[dof] = known[0]
            elif len(known) == 6:
                stiffness[:] = known
            else:
                raise InputError(
                    f"{spring.place} names property {spring.property}, which is no PBUSH"
                )
            yield SpringGroup(elements=np.array([ends]), stiffness=stiffness, name="spring")

    def _check_spring(self, spring: Spring, ends: Sequence[int]) -> None:
        """Refuse springs between dofs along different axes, and bushes with arms."""
        systems = {self._places.moves_in(number) for number in spring.ends if number is not None}
        if spring.dof and len(systems) > 1:
            raise InputError(
                f"{spring.place}: a spring between grids whose displacements have two systems (CD)"
            )
        apart = GROUND not in ends and np.ptp(self._nodes[list(ends)], axis=0).max() > _SAME
        if not spring.dof and apart:
            raise InputError(f"{spring.place}: a bush between grids that are apart is not read")

    def _links(self) -> tuple[RigidLinks, ...]:
        wholly: dict[int, int] = {}
        partly: dict[tuple[bool, ...], list[tuple[int, int]]] = defaultdict(list)
        for lead, some, dofs, place in self._deck.rigid:
            for number in self._there(some):
                pair = self._node(number, place), self._node(lead, place)
                if dofs != "123456":
                    tied = self._places.dofs_in_basic(number, dofs, place)
                    partly[tuple(tied.tolist())].append(pair)
                elif pair[0] in wholly:
                    raise InputError("a grid follows two others by RBE2")
                else:
                    wholly[pair[0]] = pair[1]
        found = list[RigidLinks]()
        if wholly:
            leads = np.array([_first_of(wholly, node) for node in wholly.values()])
            found.append(RigidLinks(leads=leads, follows=np.array(list(wholly))))
        for dofs, pairs in partly.items():
            behind, leads = np.array(pairs).T
            leads = np.array([wholly.get(int(node), int(node)) for node in leads])
            found.append(RigidLinks(leads=leads, follows=behind, dofs=np.array(dofs)))
        return tuple(found)

    def _fixed(self) -> Array:
        fixed = np.zeros((len(self._row), 6), dtype=bool)
        for number, grid in self._deck.grids.items():
            self._hold(fixed, number, grid.held or self._deck.every_grid.held)
        sets = self._deck.supports
        asked = self._asked
        if asked is None and len(sets) > 1:
            raise InputError(f"sets {sorted(sets)} of supports, and case control asks for none")
        chosen = list(sets) if asked is None else self._deck.added.get(asked, [asked])
        for number in chosen:
            if number not in sets:
                raise InputError(f"case control asks for SPC {number}, which is not there")
            for grids, dofs in sets[number]:
                for grid in self._there((grids,)):
                    self._hold(fixed, grid, dofs)
        return fixed

    def _there(self, ranges: Sequence[range]) -> Iterator[int]:
        """Give grids: of a range those that are there; one that is named must be."""
        for some in ranges:
            yield from some if len(some) == 1 else (n for n in self._deck.grids if n in some)

    def _hold(self, fixed: Array, grid: int, dofs: str) -> None:
        if not re.fullmatch(r"[1-6]*|0", dofs):
            raise InputError(f"grid {grid} is held in {dofs!r}; dofs are numbered 1 to 6")
        node = self._node(grid, "a support")
        held = {int(dof) for dof in dofs.strip("0")}
        if self._places.moves_in(grid) and any(
            0 < len(held & some) < 3 for some in ({1, 2, 3}, {4, 5, 6})
        ):
            self._angles[node] = self._places.angle_of(grid, dofs)
        fixed[node, [dof - 1 for dof in held]] = True


def _bar_name(number: int) -> str:
    return f"property {number}" if number > 0 else f"CONROD {-number}"


def _released(bar: Member, make: MemberMake) -> tuple[tuple[bool, ...], ...]:
    """Return which rotations both ends of a member let go: about its axis, its y, its z.

    Dofs of pins are along the member: 4 about its axis, 6 in plane 1, which holds the orientation
    and bends about our y, 5 in plane 2.
    """
    if make.rod:
        return ((not make.twists, True, True),) * 2
    for pins in bar.pins:
        if not re.fullmatch(r"[456]*|0?", pins):
            raise InputError(f"{bar.place}: pins in {pins} are not read; rotations, 4 to 6, are")
    return tuple(("4" in pins, "6" in pins, "5" in pins) for pins in bar.pins)


def _first_of(root: dict[int, int], node: int) -> int:
    """Return the grid that leads all that a grid follows."""
    seen = {node}
    while node in root:
        node = root[node]
        if node in seen:
            raise InputError("grids follow each other in a ring by RBE2")
        seen.add(node)
    return node

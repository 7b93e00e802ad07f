"""Nastran bulk data: shells, bars, masses and supports; every other card is told, none is dropped.

Read are GRID, CORD2R, CQUAD4, CTRIA3, PSHELL, CBAR, PBAR, MAT1, CONM2, SPC, SPC1, SPCADD and
INCLUDE, in all three forms of fields; lengths in m, forces in N, masses in kg. Masses are
consistent, whatever PARAM COUPMASS says: Nastran's own default lumps them, and its frequencies
differ by what that does.

Reference: MSC Nastran 2021 Quick Reference Guide, bulk data entries.
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np

from trundle._typing import Array
from trundle.errors import InputError, Problem
from trundle.imports.model_format import ModelFormat, ReadModel
from trundle.imports.nastran_cards import Card, cards_of, case_control
from trundle.imports.nastran_deck import CARDS, Deck
from trundle.structure import (
    BeamGroup,
    BeamSection,
    Floor,
    Material,
    PointMasses,
    ShellGroup,
    ShellSection,
    TriangleGroup,
)
from trundle.structure.elements import Elements

__all__ = ["FORMAT"]

_NOTHING_OF_THE_MODEL = frozenset(
    (
        "EIGRL", "EIGR", "EIGB", "FORCE", "MOMENT", "PLOAD", "PLOAD1", "PLOAD2", "PLOAD4", "GRAV",
        "LOAD", "TEMP", "TEMPD", "TLOAD1", "TLOAD2", "RLOAD1", "RLOAD2", "DLOAD", "DAREA",
        "TABLED1", "TSTEP", "FREQ", "FREQ1",
    )
)  # fmt: skip
"""Loads, and what is asked for."""


def read(path: Path) -> ReadModel:
    """Read bulk data.

    Parameters
    ----------
    path : Path
        A file with or without executive and case control; lengths in m, forces in N, masses in kg
        (after WTMASS).
    """
    deck, problems = Deck(), []
    asked = case_control(path).get("SPC")
    for card in cards_of(path):
        problem = _taken(deck, card)
        if problem is not None:
            problems.append(problem)
    if problems:
        return ReadModel(structure=None, problems=tuple(problems))
    try:
        floor = _Builder(deck, asked, path.stem).floor()
        if not floor.n_dofs:
            raise InputError("nothing of it can move: no grid is free")
        floor.matrices()  # elements without area or warped are told here
        return ReadModel(structure=floor)
    except InputError as error:
        problem = Problem(
            place=path.name, value="the model", rule=str(error), remedy="correct the model"
        )
        return ReadModel(structure=None, problems=(problem,))


def _taken(deck: Deck, card: Card) -> Problem | None:
    """Take a card into the deck; return why it cannot be."""
    if card.name in _NOTHING_OF_THE_MODEL:
        return None
    if card.name not in CARDS:
        return Problem(
            place=card.place,
            value=card.name,
            rule="this card is not read, and nothing is left out in silence",
            remedy=f"remove it if it is nothing of the model; read are {', '.join(CARDS)}",
        )
    try:
        CARDS[card.name](deck, card)
    except InputError as error:
        rule, _, value = str(error).partition("; got ")
        shown = f"{card.name} {card.get(2)}" + (f": {value}" if value else "")
        return Problem(place=card.place, value=shown, rule=rule, remedy="correct the card")
    return None


class _Builder:
    """Makes a floor of what the cards say."""

    def __init__(self, deck: Deck, asked: int | None, name: str) -> None:
        self._deck, self._asked, self._name = deck, asked, name
        self._row = {number: row for row, number in enumerate(deck.grids)}

    def floor(self) -> Floor:
        """Return it."""
        deck = self._deck
        nodes = np.array([self._placed(*grid[:2]) for grid in deck.grids.values()]).reshape(-1, 3)
        shells, triangles = self._faces()
        return Floor(
            nodes=nodes,
            fixed=self._fixed(),
            shells=tuple(shells),
            beams=tuple(self._bars(nodes)),
            masses=tuple(self._masses()),
            others=tuple(triangles),
            name=self._name,
        )

    def _placed(self, system: int, place: Array, depth: int = 0) -> Array:
        """Return where a place of a coordinate system is."""
        if system == 0:
            return place
        if system not in self._deck.systems or depth > len(self._deck.systems):
            raise InputError(f"coordinate system {system} is not given, or stands on itself")
        under, points = self._deck.systems[system]
        origin, on_z, in_xz = points
        z = (on_z - origin) / np.linalg.norm(on_z - origin)
        y = np.cross(z, in_xz - origin)
        y /= np.linalg.norm(y)
        axes = np.array([np.cross(y, z), y, z])
        return self._placed(under, origin + place @ axes, depth + 1)

    def _node(self, number: int, where: str) -> int:
        if number not in self._row:
            raise InputError(f"{where} names grid {number}, which is not there")
        return self._row[number]

    def _material(self, number: int, where: str) -> Material:
        if number not in self._deck.materials:
            raise InputError(f"{where} names material {number}, which is not there")
        material = self._deck.materials[number]
        return replace(material, density=material.density * self._deck.weight_to_mass)

    def _faces(self) -> tuple[list[ShellGroup], list[Elements]]:
        found: dict[tuple[int, int], list[list[int]]] = defaultdict(list)
        for number, corners, place in self._deck.faces:
            if number not in self._deck.shells:
                raise InputError(f"{place} names property {number}, which is no PSHELL")
            found[number, len(corners)].append([self._node(n, place) for n in corners])
        shells, triangles = [], []
        for (number, corners), elements in found.items():
            material, thickness, more = self._deck.shells[number]
            section = ShellSection(
                thickness=thickness,
                material=self._material(material, f"PSHELL {number}"),
                superimposed_mass=more * self._deck.weight_to_mass,
            )
            name, numbers = f"PSHELL {number}", np.array(elements)
            if corners == 4:
                shells.append(ShellGroup(elements=numbers, section=section, name=name))
            else:
                triangles.append(TriangleGroup(connectivity=numbers, section=section, name=name))
        return shells, triangles

    def _bars(self, nodes: Array) -> Iterator[BeamGroup]:
        found: dict[tuple, list[tuple[int, int]]] = defaultdict(list)
        for bar, place in self._deck.members:
            ends = self._node(bar.ends[0], place), self._node(bar.ends[1], place)
            if bar.up is None:
                up = nodes[self._node(bar.towards, place)] - nodes[ends[0]]
            else:
                up = np.array(bar.up)
            along = nodes[ends[1]] - nodes[ends[0]]
            if np.linalg.norm(np.cross(along, up)) < 1e-9 * np.linalg.norm(along):
                raise InputError(f"{place}: the orientation lies along the bar")
            found[bar.property, tuple(up / np.linalg.norm(up)), bar.offset].append(ends)
        for (number, up, offset), elements in found.items():
            yield BeamGroup(
                elements=np.array(elements),
                section=self._bar_section(number),
                up=np.array(up),
                offset=np.array(offset),
                name=f"PBAR {number}",
            )

    def _bar_section(self, number: int) -> BeamSection:
        if number not in self._deck.bars:
            raise InputError(f"a bar names property {number}, which is no PBAR")
        material_number, (area, plane_1, plane_2, torsion, more, k1, k2) = self._deck.bars[number]
        material = self._material(material_number, f"PBAR {number}")
        # mass that a metre has besides is spread over the section
        density = material.density + more * self._deck.weight_to_mass / area
        return BeamSection(
            area=area,
            inertia_y=plane_1,
            inertia_z=plane_2,
            torsion_constant=torsion,
            shear_area_y=k2 * area if k2 else np.inf,
            shear_area_z=k1 * area if k1 else np.inf,
            material=replace(material, density=density),
        )

    def _masses(self) -> Iterator[PointMasses]:
        found: dict[float, list[int]] = defaultdict(list)
        for number, mass in self._deck.masses:
            found[mass * self._deck.weight_to_mass].append(self._node(number, "a CONM2"))
        for mass, at in found.items():
            yield PointMasses(nodes=np.array(at), mass=mass, name="CONM2")

    def _fixed(self) -> Array:
        fixed = np.zeros((len(self._row), 6), dtype=bool)
        for number, (_, _, dofs) in self._deck.grids.items():
            self._hold(fixed, number, dofs)
        sets = self._deck.supports
        asked = self._asked
        if asked is None and len(sets) > 1:
            raise InputError(f"sets {sorted(sets)} of supports, and case control asks for none")
        chosen = list(sets) if asked is None else self._deck.added.get(asked, [asked])
        for number in chosen:
            if number not in sets:
                raise InputError(f"case control asks for SPC {number}, which is not there")
            for grids, dofs in sets[number]:
                # of a range those count that are there; a grid that is named must be
                there = grids if len(grids) == 1 else [n for n in self._deck.grids if n in grids]
                for grid in there:
                    self._hold(fixed, grid, dofs)
        return fixed

    def _hold(self, fixed: Array, grid: int, dofs: str) -> None:
        if not re.fullmatch(r"[1-6]*|0", dofs):
            raise InputError(f"grid {grid} is held in {dofs!r}; dofs are numbered 1 to 6")
        for dof in dofs.strip("0"):
            fixed[self._node(grid, "a support"), int(dof) - 1] = True


FORMAT = ModelFormat(
    name="Nastran bulk data",
    suffixes=(".bdf", ".dat", ".nas"),
    claims=lambda data: re.search(rb"^\s*(BEGIN\s+BULK|GRID[*, ])", data, re.I | re.M) is not None,
    read=read,
)

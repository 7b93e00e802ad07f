"""Make a floor of a mesh that knows of geometry alone, and of what each of its groups is."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Bool, Float, Int

from trundle._typing import Array
from trundle.errors import InputError
from trundle.structure import (
    BeamGroup,
    BeamSection,
    Floor,
    PlateSection,
    ShellGroup,
    SpringGroup,
    TriangleGroup,
)
from trundle.structure.elements import GROUND, Elements

__all__ = ["GroupMake", "GroupedMesh", "floor_of_mesh"]

_CORNERS = {1: "points", 2: "lines", 3: "triangles", 4: "quadrilaterals"}
_ALONG = 1e-6  # a beam's direction and `up` less than this across each other are one


@dataclass(frozen=True, kw_only=True, eq=False)
class GroupMake:
    """Hold what the elements of a group are; all of it may be nothing.

    Attributes
    ----------
    plate : PlateSection or None
        Of triangles and quadrilaterals.
    section : BeamSection or None
        Of lines.
    offset : ndarray of float, shape (3,)
        From the nodes to the beams' axis [m].
    up : ndarray of float, shape (3,)
        Direction of the beams' depth; x where a beam stands upright along it.
    held : ndarray of bool, shape (6,)
        Dofs in which its nodes are held.
    springs : ndarray of float, shape (6,)
        Springs to the ground at each of its nodes [N/m], [N m/rad].
    """

    plate: PlateSection | None = None
    section: BeamSection | None = None
    offset: Float[Array, " 3"] = field(default_factory=lambda: np.zeros(3))
    up: Float[Array, " 3"] = field(default_factory=lambda: np.array([0.0, 0.0, 1.0]))
    held: Bool[Array, " 6"] = field(default_factory=lambda: np.zeros(6, dtype=bool))
    springs: Float[Array, " 6"] = field(default_factory=lambda: np.zeros(6))

    @property
    def nothing(self) -> bool:
        """Whether its elements are nothing of the floor."""
        made = self.plate is not None or self.section is not None
        return not (made or self.held.any() or self.springs.any())


@dataclass(frozen=True, kw_only=True, eq=False)
class GroupedMesh:
    """Hold a mesh as it came.

    Attributes
    ----------
    nodes : ndarray of float, shape (n_nodes, 3)
        In the units of its file.
    groups : mapping of str to tuple of ndarray of int, shape (n_elements, n_corners)
        Elements of each group, one array for each number of corners, 1 to 4.
    """

    nodes: Float[Array, "nodes 3"]
    groups: Mapping[str, tuple[Int[Array, "_ _"], ...]]


def floor_of_mesh(
    mesh: GroupedMesh, makes: Mapping[str, GroupMake], name: str, *, length: float = 1.0
) -> Floor:
    """Return the floor that groups make of a mesh; what they are is in SI.

    Parameters
    ----------
    mesh : GroupedMesh
        The mesh.
    makes : mapping of str to GroupMake
        What every group is.
    name : str
        Of the floor.
    length : float
        One unit of its places [m].

    Raises
    ------
    InputError
        Groups that are not there, or of which nothing is said; plates of lines and the like;
        an element that is made twice.
    """
    _check_names(mesh, makes)
    nodes = mesh.nodes * length
    fixed = np.zeros((len(nodes), 6), dtype=bool)
    elements, springs = list[Elements](), list[SpringGroup]()
    for group, blocks in mesh.groups.items():
        make = makes[group]
        used = np.unique(np.concatenate([block.ravel() for block in blocks]))
        fixed[used] |= make.held
        elements += _elements(nodes, group, blocks, make)
        if make.springs.any():
            ends = np.column_stack([used, np.full(len(used), GROUND)])
            springs.append(SpringGroup(elements=ends, stiffness=make.springs, name=group))
    _check_once(elements)
    return Floor(
        nodes=nodes,
        fixed=fixed,
        shells=tuple(one for one in elements if isinstance(one, ShellGroup)),
        beams=tuple(one for one in elements if isinstance(one, BeamGroup)),
        springs=tuple(springs),
        others=tuple(one for one in elements if isinstance(one, TriangleGroup)),
        name=name,
    )


def _check_names(mesh: GroupedMesh, makes: Mapping[str, GroupMake]) -> None:
    there = ", ".join(map(repr, mesh.groups)) or "none"
    if missing := [n for n, make in makes.items() if n not in mesh.groups and not make.nothing]:
        raise InputError(f"there is no group {missing[0]!r} in the mesh; there are: {there}")
    if unsaid := [name for name in mesh.groups if name not in makes]:
        raise InputError(
            f"nothing says what {', '.join(map(repr, unsaid))} of the mesh is: give it a plate, a "
            "section, what holds it, or nothing = true"
        )


def _elements(
    nodes: Array, group: str, blocks: tuple[Array, ...], make: GroupMake
) -> Iterator[Elements]:
    plates = [block for block in blocks if block.shape[1] > 2]
    lines = [block for block in blocks if block.shape[1] == 2]
    if make.plate is not None and not plates:
        raise InputError(f"group {group!r} has a plate, and no triangles or quadrilaterals")
    if make.section is not None and not lines:
        raise InputError(f"group {group!r} has a section, and no lines")
    if make.plate is not None:
        for block in plates:
            if block.shape[1] == 4:
                yield ShellGroup(elements=block, section=make.plate, name=group)
            else:
                yield TriangleGroup(connectivity=block, section=make.plate, name=group)
    if make.section is not None:
        for block in lines:
            yield from _beams(nodes, group, block, make, make.section)


def _beams(
    nodes: Array, group: str, block: Array, make: GroupMake, section: BeamSection
) -> Iterator[BeamGroup]:
    """Give the beams of a group: those that stand along `up` have their depth along x."""
    along = nodes[block[:, 1]] - nodes[block[:, 0]]
    length = np.linalg.norm(along, axis=1)
    if np.any(length == 0.0):
        raise InputError(f"group {group!r}: a line without a length")
    up = make.up / np.linalg.norm(make.up)
    across = np.linalg.norm(np.cross(along, up), axis=1)
    stands = across < _ALONG * length
    for some, way in ((~stands, up), (stands, np.eye(3)[int(np.abs(up).argmin())])):
        if some.any():
            yield BeamGroup(
                elements=block[some], section=section, offset=make.offset, up=way, name=group
            )


def _check_once(elements: list[Elements]) -> None:
    """Refuse an element that two groups, or one, make twice."""
    for corners, word in _CORNERS.items():
        some = [one for one in elements if one.connectivity.shape[1] == corners]
        if not some:
            continue
        every = np.sort(np.concatenate([one.connectivity for one in some]), axis=1)
        owner = np.repeat(np.arange(len(some)), [len(one.connectivity) for one in some])
        _, first, times = np.unique(every, axis=0, return_index=True, return_counts=True)
        if np.any(times > 1):
            one = first[times > 1][0]
            same = (every == every[one]).all(axis=1)
            names = " and ".join(dict.fromkeys(repr(some[i].name) for i in owner[same]))
            raise InputError(f"{names}: {int((times > 1).sum())} {word} are there twice")

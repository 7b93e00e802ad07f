"""Build a finite-element model of a building."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import chain

import numpy as np
from jaxtyping import Float

from trundle._checks import positive, set_frozen
from trundle._kinds import kinds_checked
from trundle._typing import Array
from trundle.errors import InputError
from trundle.structure.building.checks import building_problems
from trundle.structure.building.holding import heads, held_dofs, joints, masses, springs
from trundle.structure.building.idle import idle_rotations
from trundle.structure.building.members import (
    SlabThickness,
    laid_beams,
    laid_braces,
    laid_columns,
    laid_walls,
)
from trundle.structure.building.nodes import Nodes
from trundle.structure.building.parts import Building
from trundle.structure.building.sheets import plane_of, sheets_of, ties_of
from trundle.structure.elements import BeamGroup, Elements, ShellGroup, Standable, TriangleGroup
from trundle.structure.floor import Floor
from trundle.structure.links import leaders_of
from trundle.structure.mechanisms import loose_parts
from trundle.structure.mesh.mesher import mesh_sheets
from trundle.structure.mesh.sheet import Refinement
from trundle.structure.mesh.sheet_mesh import SheetMesh
from trundle.structure.places import Frame
from trundle.structure.surface import Surface

__all__ = ["Meshing", "build_building", "mesh_building"]


@dataclass(frozen=True, kw_only=True, eq=False)
class Meshing:
    """Hold how a building is meshed.

    Attributes
    ----------
    mesh_size : float
        Largest element edge [m].
    refinements : tuple of Refinement
        Where elements are smaller.
    guides : mapping of str to tuple of ndarray of float, shape (n, 2)
        Lines and, with one corner, places on storeys and ramps that the mesh must follow [m].
    only_triangles : bool
        Whether slabs are meshed with triangles alone.
    """

    mesh_size: float
    refinements: tuple[Refinement, ...] = ()
    guides: Mapping[str, tuple[Float[Array, "_ 2"], ...]] = field(
        default_factory=dict[str, tuple[Array, ...]]
    )
    only_triangles: bool = False

    def __post_init__(self) -> None:
        """Check the size."""
        set_frozen(self, mesh_size=positive("mesh_size", self.mesh_size))

    def scaled(self, factor: float) -> Meshing:
        """Return the same with all sizes times a factor."""
        finer = tuple(replace(r, size=r.size * factor) for r in self.refinements)
        return replace(self, mesh_size=self.mesh_size * factor, refinements=finer)


def mesh_building(building: Building, meshing: Meshing) -> SheetMesh:
    """Mesh the storeys and ramps of a building."""
    return mesh_sheets(
        sheets_of(building, meshing.guides),
        size=meshing.mesh_size,
        refinements=meshing.refinements,
        ties=ties_of(building),
        only_triangles=meshing.only_triangles,
    )


@kinds_checked
def build_building(building: Building, meshing: Meshing) -> Floor:
    """Build a finite-element model of a building.

    Parameters
    ----------
    building : Building
        What it is made of.
    meshing : Meshing
        How it is meshed.

    Returns
    -------
    Floor
        Each storey with a slab, or with beams alone, is a surface of its name, and each ramp.

    Raises
    ------
    InputError
        Parts that do not fit, see `building_problems`, or that nothing holds.
    """
    problems = building_problems(building)
    if problems:
        raise InputError(f"{building.name}:\n" + "\n".join(map(str, problems)))
    floor = _assembled(building, mesh_building(building, meshing), meshing.mesh_size)
    loose = loose_parts(floor)
    if loose:
        raise InputError(
            f"{building.name}: {'; '.join(loose)}: join it to the rest, or give it supports"
        )
    return floor


def _assembled(building: Building, mesh: SheetMesh, mesh_size: float) -> Floor:
    nodes = Nodes(building, mesh)
    links = heads(building, mesh, nodes)
    leader = leaders_of(links, len(mesh.nodes))[:, 0]
    block = np.where(leader < 0, np.arange(len(leader)), leader)
    laid = [
        *laid_beams(building, mesh, SlabThickness(building, mesh), block),
        *laid_columns(building, nodes),
        *laid_braces(building, nodes),
    ]
    walls = list(laid_walls(building, mesh, nodes, mesh_size))
    xyz, number = nodes.merged()
    members = list(chain.from_iterable(one.groups(xyz, number, building.mirrors) for one in laid))
    quads, triangles = _faces(building, mesh)
    wall_groups = [ShellGroup(elements=number[e], section=w.section, name=w.name) for w, e in walls]
    grounded = tuple(springs(building, mesh, nodes))
    joined = tuple(joints(building, mesh))
    stiff = (*quads.values(), *triangles.values(), *wall_groups, *members, *grounded)
    idle = idle_rotations(xyz, stiff, links)
    fixed, angles = held_dofs(building, mesh, nodes, xyz, idle)
    return Floor(
        nodes=xyz,
        fixed=fixed,
        angles=angles,
        shells=(*quads.values(), *wall_groups),
        beams=tuple(one for one in members if isinstance(one, BeamGroup)),
        springs=grounded,
        masses=tuple(masses(building, mesh)),
        others=(
            *triangles.values(),
            *(o for o in members if not isinstance(o, BeamGroup)),
            *joined,
        ),
        links=links,
        decks=tuple(_decks(building, xyz, {**quads}, triangles, members)),
        mirrors=building.mirrors,
        name=building.name,
    )


def _faces(
    building: Building, mesh: SheetMesh
) -> tuple[dict[tuple[int, int], ShellGroup], dict[tuple[int, int], TriangleGroup]]:
    """Return the elements of slabs and ramps, by sheet and part."""
    parts = (*building.slabs, *building.ramps)
    quads = {
        key: ShellGroup(elements=some, section=parts[key[1]].section, name=parts[key[1]].name)
        for key, some in _by_owner(mesh.quads, mesh.quad_owner)
    }
    triangles = {
        key: TriangleGroup(
            connectivity=some, section=parts[key[1]].section, name=parts[key[1]].name
        )
        for key, some in _by_owner(mesh.triangles, mesh.triangle_owner)
    }
    return quads, triangles


def _by_owner(elements: Array, owner: Array) -> Iterator[tuple[tuple[int, int], Array]]:
    for key in np.unique(owner, axis=0):
        yield (int(key[0]), int(key[1])), elements[(owner == key).all(axis=1)]


def _decks(
    building: Building,
    xyz: Array,
    quads: Mapping[tuple[int, int], Elements],
    triangles: Mapping[tuple[int, int], Elements],
    members: Sequence[Elements],
) -> Iterator[Surface]:
    """Give a surface for each storey and ramp that something can be stood on."""
    frames = [
        *(Frame.level(storey.level) for storey in building.storeys),
        *(Frame.through(plane_of(building, ramp)) for ramp in building.ramps),
    ]
    for i, name in enumerate(building.floors):
        groups = [g for kind in (quads, triangles) for key, g in kind.items() if key[0] == i]
        if not groups:
            level = building.storeys[i].level
            groups = [g for g in members if _lies(xyz, g, level)]
        some = tuple(g for g in groups if isinstance(g, Standable))
        if some:
            yield Surface(name=name, nodes=xyz, groups=some, frame=frames[i])


def _lies(xyz: Array, group: Elements, level: float) -> bool:
    """Return whether any member of a group lies level at a height."""
    return bool((np.abs(xyz[group.connectivity][..., 2] - level) < 1e-6).all(axis=1).any())

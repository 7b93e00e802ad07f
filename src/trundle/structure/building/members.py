"""Lay beams, columns, walls and braces between the nodes of a mesh."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from jaxtyping import Bool, Float, Int

from trundle._typing import Array
from trundle.structure.building.held import share_inside
from trundle.structure.building.nodes import Nodes
from trundle.structure.building.parts import Beam, Building, Wall
from trundle.structure.building.profile import Profile
from trundle.structure.building.sheets import passes
from trundle.structure.elements import BeamGroup, ReleasedBeams
from trundle.structure.mesh.sheet_mesh import SheetMesh
from trundle.structure.model import MirrorPlane

__all__ = ["Laid", "laid_beams", "laid_braces", "laid_columns", "laid_walls"]

_FEWEST = 4  # elements of a column or wall between storeys
_UPRIGHT = 1e-3  # m
_BENDING = np.array([False, True, True])
_ALL = np.ones(3, dtype=bool)
_UP = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True, kw_only=True, eq=False)
class Laid:
    """Hold pieces of members that are alike.

    Attributes
    ----------
    profile : Profile
        Section.
    offset, up : ndarray of float, shape (3,)
        From nodes to centroids [m], and where the depth points.
    released : ndarray of bool, shape (2, 3)
        Rotations that start and end transmit no moment of.
    name : str
        What they are.
    ends : ndarray of int, shape (n, 2)
        Nodes.
    """

    profile: Profile
    offset: Float[Array, " 3"]
    up: Float[Array, " 3"]
    released: Bool[Array, "2 3"]
    name: str
    ends: Int[Array, "pieces 2"]

    def groups(
        self,
        nodes: Float[Array, "nodes 3"],
        number: Int[Array, " made"],
        planes: Sequence[MirrorPlane],
    ) -> Iterator[BeamGroup | ReleasedBeams]:
        """Give groups of elements; what lies in planes of symmetry belongs to the model by half.

        `number` is the row in `nodes` of each node as it was given out.
        """
        ends = number[self.ends]
        share = share_inside(nodes[ends], planes)
        for wanted in np.unique(share)[::-1]:
            section = self.profile.section
            group = BeamGroup(
                elements=ends[share == wanted],
                section=section if wanted == 1.0 else section.scaled(float(wanted)),
                offset=self.offset,
                up=self.up,
                name=self.name,
            )
            if self.released.any():
                yield ReleasedBeams(beams=group, released=self.released)
            else:
                yield group


def laid_beams(
    building: Building, mesh: SheetMesh, thickness: SlabThickness, block: Int[Array, " nodes"]
) -> Iterator[Laid]:
    """Give the pieces of beams along element edges, each hanging as its slab is thick.

    `block` names the rigid block that each node of the mesh is part of: itself, if of none.
    """
    number = {name: i for i, name in enumerate(building.floors)}
    for beam in building.beams:
        sheet, found = number[beam.on], []
        for pair in pairwise(beam.along):
            nodes = mesh.along(sheet, np.stack(pair))
            found.append(np.stack([nodes[:-1], nodes[1:]], axis=1))
        ends = np.concatenate(found)
        drop = _drops(beam, ends, thickness)
        for piece, released in _hinged(ends, beam.hinged, block):
            for depth in np.unique(drop[piece]):
                yield Laid(
                    profile=beam.profile,
                    offset=np.array([0.0, 0.0, -depth]),
                    up=_UP,
                    released=released,
                    name=beam.name,
                    ends=ends[piece][drop[piece] == depth],
                )


class SlabThickness:
    """Tells how thick the slab is that has an element edge."""

    def __init__(self, building: Building, mesh: SheetMesh) -> None:
        thick = np.array([p.section.thickness for p in (*building.slabs, *building.ramps)])
        sides, values = [], []
        for elements, owner in (
            (mesh.quads, mesh.quad_owner),
            (mesh.triangles, mesh.triangle_owner),
        ):
            if len(elements):
                around = np.stack([elements, np.roll(elements, -1, axis=1)], axis=2)
                sides.append(np.sort(around.reshape(-1, 2), axis=1))
                values.append(np.repeat(thick[owner[:, 1]], elements.shape[1]))
        self._big = len(mesh.nodes)
        both = np.concatenate([np.zeros((0, 2), dtype=np.intp), *sides])
        keys, place = np.unique(both[:, 0] * self._big + both[:, 1], return_inverse=True)
        self._keys, self._thick = keys, np.zeros(len(keys))
        if len(keys):
            np.maximum.at(self._thick, place, np.concatenate(values))

    def at(self, ends: Int[Array, "n 2"]) -> Float[Array, " n"]:
        """Return the thickest slab at each edge [m]; 0 where there is none."""
        if not len(self._keys):
            return np.zeros(len(ends))
        low, high = np.sort(ends, axis=1).T
        key = low * self._big + high
        place = np.minimum(np.searchsorted(self._keys, key), len(self._keys) - 1)
        return np.where(self._keys[place] == key, self._thick[place], 0.0)


def _drops(beam: Beam, ends: Array, thickness: SlabThickness) -> Array:
    """Return how far below the nodes each piece's centroid lies [m]."""
    if not beam.below:
        return np.zeros(len(ends))
    return np.round(0.5 * thickness.at(ends) + beam.profile.above, 9)


def _hinged(ends: Array, hinged: tuple[bool, bool], block: Array) -> Iterator[tuple[Array, Array]]:
    """Give pieces of a member alike in their hinges: the first, the last, those between.

    Pieces within the head of a column do not bend: a hinge there would let go of nothing, and
    stands at the column's face instead.
    """
    bending = np.flatnonzero(block[ends[:, 0]] != block[ends[:, 1]])
    at_start, at_end = np.zeros((2, len(ends)), dtype=bool)
    at_start[bending[:1]], at_end[bending[-1:]] = hinged
    for start, end in sorted({*zip(at_start.tolist(), at_end.tolist(), strict=True)}):
        piece = np.flatnonzero((at_start == start) & (at_end == end))
        yield piece, np.stack([_BENDING & start, _BENDING & end])


def laid_columns(building: Building, nodes: Nodes) -> Iterator[Laid]:
    """Give the pieces of columns, and make the nodes between storeys."""
    for column in building.columns:
        storeys = [
            s for s in building.between(column.bottom, column.top)
            if passes(building, column, s.name)
        ]  # fmt: skip
        heads = [nodes.at(s.name, column.at, f"column {column.name!r}") for s in storeys]
        for low, high in pairwise(heads):
            rows = nodes.rows_between(np.array([low]), np.array([high]), np.inf, _FEWEST)
            chain = rows[:, 0]
            yield Laid(
                profile=column.profile,
                offset=np.zeros(3),
                up=column.depth_axis,
                released=np.zeros((2, 3), dtype=bool),
                name=column.name,
                ends=np.stack([chain[:-1], chain[1:]], axis=1),
            )


def laid_braces(building: Building, nodes: Nodes) -> Iterator[Laid]:
    """Give braces, an element each."""
    for brace in building.braces:
        what = f"brace {brace.name!r}"
        ends = [nodes.at(brace.on[i], brace.ends[i], what) for i in (0, 1)]
        upright = np.allclose(*brace.ends, rtol=0.0, atol=_UPRIGHT)
        released = np.tile(_ALL & brace.hinged, (2, 1))
        yield Laid(
            profile=brace.profile,
            offset=np.zeros(3),
            up=np.array([1.0, 0.0, 0.0]) if upright else _UP,
            released=released,
            name=brace.name,
            ends=np.array([ends]),
        )


def laid_walls(
    building: Building, mesh: SheetMesh, nodes: Nodes, size: float
) -> Iterator[tuple[Wall, Int[Array, "elements 4"]]]:
    """Give walls with the nodes of their shells, in rows between storeys; make those between."""
    number = {name: i for i, name in enumerate(building.floors)}
    for wall in building.walls:
        names = [s.name for s in building.between(wall.bottom, wall.top)]
        lines = [mesh.along(number[name], wall.along) for name in names]
        for low, high in pairwise(lines):
            rows = nodes.rows_between(low, high, size, _FEWEST)
            corners = [rows[:-1, :-1], rows[:-1, 1:], rows[1:, 1:], rows[1:, :-1]]
            elements = np.stack([corner.ravel() for corner in corners], axis=1)
            yield wall, elements

"""Hold a floor: nodes, elements, supports, and the matrices they assemble to."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from jaxtyping import Bool, Float, Int
from scipy import sparse

from trundle._checks import frozen_array, set_frozen
from trundle._typing import Array, SparseMatrix
from trundle.errors import InputError
from trundle.structure.beam import beam_mass, beam_stiffness
from trundle.structure.sections import BeamSection, ShellSection
from trundle.structure.shell import shell_mass, shell_stiffness

__all__ = [
    "DOF_NAMES",
    "BeamGroup",
    "Floor",
    "MirrorPlane",
    "PointMasses",
    "ShellGroup",
    "SpringGroup",
]

DOF_NAMES = ("ux", "uy", "uz", "rx", "ry", "rz")
"""The six degrees of freedom of a node, in the order of every matrix."""

GROUND = -1
"""Second node of a spring that stands on rigid ground."""

_UP = (0.0, 0.0, 1.0)
_ROUND_OFF = 1e-15  # against the roots of both diagonals; a coupling that counts is far above


@dataclass(frozen=True, kw_only=True, eq=False)
class ShellGroup:
    """Hold flat shells of one section.

    Attributes
    ----------
    elements : ndarray of int, shape (n_elements, 4)
        Node numbers, in order round each element.
    section : ShellSection
        Thickness, material and superimposed mass.
    name : str
        What the group is: ``slab`` ...
    """

    elements: Int[Array, "elements 4"]
    section: ShellSection
    name: str = "slab"

    def __post_init__(self) -> None:
        """Freeze the connectivity."""
        elements = frozen_array("elements", self.elements, shape=(None, 4), dtype=np.intp)
        set_frozen(self, elements=elements)


@dataclass(frozen=True, kw_only=True, eq=False)
class BeamGroup:
    """Hold straight members of one section, offset and orientation.

    Attributes
    ----------
    elements : ndarray of int, shape (n_elements, 2)
        Node numbers of the two ends.
    section : BeamSection
        Cross-section about its own centroid.
    offset : ndarray of float, shape (3,)
        From node to centroid in global axes [m].
    up : ndarray of float, shape (3,)
        Direction of the section's depth; members parallel to it use global x instead.
    name : str
        What the group is: ``beam``, ``column`` ...
    """

    elements: Int[Array, "elements 2"]
    section: BeamSection
    offset: Float[Array, " 3"] = field(default_factory=lambda: np.zeros(3))
    up: Float[Array, " 3"] = field(default_factory=lambda: np.array(_UP))
    name: str = "beam"

    def __post_init__(self) -> None:
        """Freeze connectivity and vectors."""
        set_frozen(
            self,
            elements=frozen_array("elements", self.elements, shape=(None, 2), dtype=np.intp),
            offset=frozen_array("offset", self.offset, shape=(3,)),
            up=frozen_array("up", self.up, shape=(3,)),
        )


@dataclass(frozen=True, kw_only=True, eq=False)
class SpringGroup:
    """Hold linear springs between two nodes, or between a node and the ground.

    Attributes
    ----------
    elements : ndarray of int, shape (n_springs, 2)
        Node numbers; `GROUND` (-1) as the second stands for rigid ground.
    stiffness : ndarray of float, shape (6,)
        Stiffness in each global dof [N/m], [N m/rad].
    name : str
        What the group is.
    """

    elements: Int[Array, "springs 2"]
    stiffness: Float[Array, " 6"]
    name: str = "spring"

    def __post_init__(self) -> None:
        """Freeze and refuse a negative stiffness."""
        stiffness = frozen_array("spring stiffness", self.stiffness, shape=(6,))
        if np.any(stiffness < 0.0):
            raise InputError(f"spring stiffness must be 0 or more; got {stiffness.tolist()}")
        elements = frozen_array("elements", self.elements, shape=(None, 2), dtype=np.intp)
        set_frozen(self, elements=elements, stiffness=stiffness)


@dataclass(frozen=True, kw_only=True, eq=False)
class PointMasses:
    """Hold equal point masses at nodes, moving in the three translations.

    Attributes
    ----------
    nodes : ndarray of int, shape (n_masses,)
        Node numbers.
    mass : float
        Mass at each node [kg].
    """

    nodes: Int[Array, " masses"]
    mass: float

    def __post_init__(self) -> None:
        """Freeze the node list."""
        set_frozen(self, nodes=frozen_array("nodes", self.nodes, shape=(None,), dtype=np.intp))


@dataclass(frozen=True, kw_only=True)
class MirrorPlane:
    """Hold a vertical plane of symmetry, at which the modelled part of a building ends.

    What stands in the plane belongs to the model by half.

    Attributes
    ----------
    axis : int
        Axis normal to the plane: 0 for x, 1 for y.
    position : float
        Where the plane cuts that axis [m].
    """

    axis: int
    position: float


@dataclass(frozen=True, kw_only=True, eq=False)
class Floor:
    """Hold a finite-element floor with six dofs a node.

    Attributes
    ----------
    nodes : ndarray of float, shape (n_nodes, 3)
        Coordinates [m], z up.
    fixed : ndarray of bool, shape (n_nodes, 6)
        True where a dof is held by a support or a symmetry plane.
    shells, beams, springs, masses : tuple of groups
        The elements.
    mirrors : tuple of MirrorPlane
        Planes of symmetry, whose dofs are among those held.
    name : str
        Name for reports.

    Raises
    ------
    InputError
        A node number that does not exist, or a floor without any element.
    """

    nodes: Float[Array, "nodes 3"]
    fixed: Bool[Array, "nodes 6"]
    shells: tuple[ShellGroup, ...] = ()
    beams: tuple[BeamGroup, ...] = ()
    springs: tuple[SpringGroup, ...] = ()
    masses: tuple[PointMasses, ...] = ()
    mirrors: tuple[MirrorPlane, ...] = ()
    name: str = "floor"

    def __post_init__(self) -> None:
        """Freeze arrays and check every node number."""
        nodes = frozen_array("nodes", self.nodes, shape=(None, 3))
        fixed = frozen_array("fixed", self.fixed, shape=(len(nodes), 6), dtype=np.bool_)
        set_frozen(self, nodes=nodes, fixed=fixed)
        if not self.shells and not self.beams:
            raise InputError("a floor needs at least one group of shells or beams")
        for group in (*self.shells, *self.beams, *self.springs):
            _check_numbers(group.name, group.elements, len(nodes), lowest=_lowest(group))
        for group in self.masses:
            _check_numbers("point mass", group.nodes, len(nodes), lowest=0)

    @cached_property
    def dof_index(self) -> Int[Array, "nodes 6"]:
        """Row of each dof in the matrices, -1 where it is held or carries no element."""
        free = ~self.fixed & self._carried
        index = np.full(self.fixed.shape, -1, dtype=np.intp)
        index[free] = np.arange(np.count_nonzero(free))
        index.setflags(write=False)
        return index

    @property
    def n_dofs(self) -> int:
        """Number of free degrees of freedom."""
        return int(self.dof_index.max()) + 1

    @cached_property
    def stiffness(self) -> SparseMatrix:
        """Stiffness matrix of the free dofs [N/m]."""
        blocks = [
            (group.elements, shell_stiffness(self.nodes[group.elements], group.section))
            for group in self.shells
        ]
        blocks += [
            (
                group.elements,
                beam_stiffness(
                    self.nodes[group.elements], group.section, offset=group.offset, up=group.up
                ),
            )
            for group in self.beams
        ]
        blocks += [(group.elements, _spring_blocks(group)) for group in self.springs]
        return self._assemble(blocks)

    @cached_property
    def mass(self) -> SparseMatrix:
        """Consistent mass matrix of the free dofs [kg]."""
        blocks = [
            (group.elements, shell_mass(self.nodes[group.elements], group.section))
            for group in self.shells
        ]
        blocks += [
            (
                group.elements,
                beam_mass(
                    self.nodes[group.elements], group.section, offset=group.offset, up=group.up
                ),
            )
            for group in self.beams
        ]
        blocks += [(group.nodes[:, None], _point_blocks(group)) for group in self.masses]
        return self._assemble(blocks)

    @cached_property
    def content_hash(self) -> str:
        """Hash of all that decides the matrices; equal floors share it."""
        digest = hashlib.sha256()
        for matrix in (self.stiffness, self.mass):
            for part in (matrix.indptr, matrix.indices, matrix.data):
                digest.update(np.ascontiguousarray(part).tobytes())
        return digest.hexdigest()[:16]

    def nearest_node(self, x: float, y: float) -> int:
        """Return the number of the node nearest to a place in plan [m]."""
        away = self.nodes[:, :2] - np.array([x, y], dtype=float)
        return int(np.argmin(np.einsum("ij,ij->i", away, away)))

    def rigid_vector(self, dof: int) -> Float[Array, " dofs"]:
        """Return the vector of ones in one of the six dofs, over the free dofs."""
        vector = np.zeros(self.n_dofs)
        rows = self.dof_index[:, dof]
        vector[rows[rows >= 0]] = 1.0
        return vector

    def moving_mass(self, dof: int = 2) -> float:
        """Return the mass that moves with a unit motion of all free dofs of a kind [kg]."""
        ones = self.rigid_vector(dof)
        return float(ones @ (self.mass @ ones))

    @cached_property
    def _carried(self) -> Bool[Array, "nodes 6"]:
        """True for dofs that any element gives a stiffness or a mass."""
        carried = np.zeros((len(self.nodes), 6), dtype=bool)
        for group in (*self.shells, *self.beams):
            carried[group.elements.ravel()] = True
        for group in self.springs:
            ends = group.elements[group.elements != GROUND]
            carried[ends] |= group.stiffness > 0.0
        for group in self.masses:
            carried[group.nodes, :3] = True
        return carried

    def _assemble(self, blocks: list[tuple[Array, Array]]) -> SparseMatrix:
        rows, columns, values = [], [], []
        for elements, matrices in blocks:
            dofs = self._element_dofs(elements)
            row = np.broadcast_to(dofs[:, :, None], matrices.shape)
            column = np.broadcast_to(dofs[:, None, :], matrices.shape)
            keep = (row >= 0) & (column >= 0)
            rows.append(row[keep])
            columns.append(column[keep])
            values.append(matrices[keep])
        shape = (self.n_dofs, self.n_dofs)
        entries = np.concatenate(values)
        at = (np.concatenate(rows), np.concatenate(columns))
        matrix = sparse.coo_array((entries, at), shape=shape).tocsc()
        matrix.sum_duplicates()
        return _without_noughts(matrix)

    def _element_dofs(self, elements: Array) -> Array:
        dofs = self.dof_index[elements]
        dofs = np.where(elements[:, :, None] == GROUND, -1, dofs)
        return dofs.reshape(len(elements), -1)


def _without_noughts(matrix: SparseMatrix) -> SparseMatrix:
    """Return a matrix without entries that are nought but for the round-off of their sums.

    On a level slab these are more than half of what elements store, and a factor fills with them.
    """
    entries = matrix.tocoo()
    row, column = entries.coords
    size = np.sqrt(np.abs(matrix.diagonal()))
    keep = np.abs(entries.data) > _ROUND_OFF * size[row] * size[column]
    keep |= row == column  # solvers look for the whole diagonal
    at = (row[keep], column[keep])
    return sparse.coo_array((entries.data[keep], at), shape=matrix.shape).tocsc()


def _lowest(group: ShellGroup | BeamGroup | SpringGroup) -> int:
    return GROUND if isinstance(group, SpringGroup) else 0


def _check_numbers(name: str, elements: Array, n_nodes: int, *, lowest: int) -> None:
    if elements.size and (elements.min() < lowest or elements.max() >= n_nodes):
        raise InputError(
            f"{name}: node numbers must be {lowest} to {n_nodes - 1}; "
            f"got {elements.min()} to {elements.max()}"
        )


def _spring_blocks(group: SpringGroup) -> Array:
    pair = np.array([[1.0, -1.0], [-1.0, 1.0]])
    return np.broadcast_to(np.kron(pair, np.diag(group.stiffness)), (len(group.elements), 12, 12))


def _point_blocks(group: PointMasses) -> Array:
    block = np.diag([group.mass] * 3 + [0.0] * 3)
    return np.broadcast_to(block, (len(group.nodes), 6, 6))

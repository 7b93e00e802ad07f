"""Hold a floor: nodes, elements, supports, and the matrices they assemble to."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Bool, Float, Int

from trundle._checks import frozen_array, set_frozen
from trundle._progress import Progress
from trundle._typing import Array, SparseMatrix
from trundle.dynamics import Factor, Modes, factorise, natural_modes
from trundle.errors import InputError
from trundle.structure.assembly import Form, assembled, blocks_of, without_noughts
from trundle.structure.content import hash_of, parts_of
from trundle.structure.elements.beam import BeamGroup
from trundle.structure.elements.point_mass import PointMasses
from trundle.structure.elements.protocol import GROUND, Damped, Elements
from trundle.structure.elements.quad_shell import ShellGroup
from trundle.structure.elements.spring import SpringGroup
from trundle.structure.links import RigidLinks, expansion_of, leaders_of, own_motion
from trundle.structure.model import MirrorPlane
from trundle.structure.surface import Surface, check_names, found_surface, named_surface

__all__ = ["DOF_NAMES", "Floor"]

DOF_NAMES = ("ux", "uy", "uz", "rx", "ry", "rz")
"""The six degrees of freedom of a node, in the order of every matrix."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Floor:
    """Hold a finite-element floor with six dofs a node.

    Attributes
    ----------
    nodes : ndarray of float, shape (n_nodes, 3)
        Coordinates [m], z up.
    fixed : ndarray of bool, shape (n_nodes, 6)
        True where a dof is held by a support or a symmetry plane.
    angles : ndarray of float, shape (n_nodes, 2), or None
        By how much the axes of each node's translations, and of its rotations, are turned about z
        [rad], where supports hold along other axes than x and y; `fixed` and `dof_index` speak of
        turned axes there.
    shells, beams, springs, masses : tuple of groups
        The elements.
    others : tuple of Elements
        Elements of any other kind, see `trundle.structure.elements`.
    links : tuple of RigidLinks
        Nodes that follow others as rigid bodies do.
    decks : tuple of Surface
        Surfaces that are driven and stood on; one called ``floor``, of the level shells or of the
        level beams without any, unless given.
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
    angles: Float[Array, "nodes 2"] | None = None
    shells: tuple[ShellGroup, ...] = ()
    beams: tuple[BeamGroup, ...] = ()
    springs: tuple[SpringGroup, ...] = ()
    masses: tuple[PointMasses, ...] = ()
    others: tuple[Elements, ...] = ()
    links: tuple[RigidLinks, ...] = ()
    decks: tuple[Surface, ...] = ()
    mirrors: tuple[MirrorPlane, ...] = ()
    name: str = "floor"

    def __post_init__(self) -> None:
        """Freeze arrays and check every node number."""
        nodes = frozen_array("nodes", self.nodes, shape=(None, 3))
        fixed = frozen_array("fixed", self.fixed, shape=(len(nodes), 6), dtype=np.bool_)
        set_frozen(self, nodes=nodes, fixed=fixed)
        if self.angles is not None:
            set_frozen(self, angles=frozen_array("angles", self.angles, shape=(len(nodes), 2)))
        if not (self.shells or self.beams or self.others):
            raise InputError("a floor needs at least one group of shells, beams or other elements")
        for group in self.elements:
            _check_numbers(group, len(nodes))
        check_names(self.decks)
        leaders_of(self.links, len(nodes))

    @property
    def elements(self) -> tuple[Elements, ...]:
        """All groups of elements."""
        return (*self.shells, *self.beams, *self.springs, *self.masses, *self.others)

    @property
    def surfaces(self) -> Mapping[str, Surface]:
        """What is driven and stood on, by name.

        Raises
        ------
        InputError
            None was given, and there is no level element, or there are several heights.
        """
        return self._surfaces

    @cached_property
    def _surfaces(self) -> Mapping[str, Surface]:
        decks = self.decks or (found_surface(self.name, self.nodes, self.elements),)
        return {deck.name: deck for deck in decks}

    def surface(self, name: str | None = None) -> Surface:
        """Return a surface by its name; None for the only one."""
        return named_surface(self.surfaces, name)

    @property
    def dof_index(self) -> Int[Array, "nodes 6"]:
        """Row of each dof in the matrices, -1 where it is held or carries no element."""
        return self._dof_index

    @property
    def expansion(self) -> SparseMatrix | None:
        """Motion of all nodes by the free dofs; None where `dof_index` says it all."""
        return self._expansion

    @cached_property
    def _expansion(self) -> SparseMatrix | None:
        if not self.links and self.angles is None:
            return None
        return expansion_of(self.nodes, self._leader, self.dof_index, self.fixed, self.angles)

    @cached_property
    def _leader(self) -> Int[Array, "nodes 6"]:
        return leaders_of(self.links, len(self.nodes))

    @cached_property
    def _dof_index(self) -> Int[Array, "nodes 6"]:
        free = ~self.fixed & self._carried
        if self.links:
            free[self._leader >= 0] = False
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
        return self._assemble(lambda group, xyz: group.stiffness_blocks(xyz))

    @cached_property
    def mass(self) -> SparseMatrix:
        """Consistent mass matrix of the free dofs [kg]."""
        return self._assemble(lambda group, xyz: group.mass_blocks(xyz))

    def damped_stiffness(self, other: float) -> SparseMatrix:
        """Return the stiffness, every element's times its damping ratio [N/m].

        `other` is the ratio of elements whose material has none.
        """

        def blocks(group: Elements, xyz: Array) -> Array | None:
            """Return the stiffness of each element times its ratio."""
            known = group.damping_ratio if isinstance(group, Damped) else None
            stiffness = group.stiffness_blocks(xyz)
            ratio = other if known is None else known
            return None if stiffness is None else ratio * stiffness

        return self._assemble(blocks)

    @property
    def content_hash(self) -> str:
        """Hash of all that decides matrices, damping and places; equal floors share it."""
        return self._content_hash

    @cached_property
    def _content_hash(self) -> str:
        motion = [self.dof_index, *parts_of(self.stiffness), *parts_of(self.mass)]
        if self.expansion is not None:
            motion += parts_of(self.expansion.tocsc())
        return hash_of(self, motion)

    def modes(self, f_max: float, *, progress: Progress | None = None) -> Modes:
        """Return all natural modes below a frequency [Hz], see `natural_modes`."""
        return natural_modes(self.mass, self.stiffness, f_max=f_max, progress=progress)

    def flexibility(self) -> Factor:
        """Return what solves for static deflections: the factorised stiffness."""
        return factorise(self.stiffness)

    @property
    def has_matrices(self) -> bool:
        """Whether its modes are computed, not given."""
        return True

    def matrices(self) -> tuple[SparseMatrix, SparseMatrix]:
        """Return mass [kg] and stiffness [N/m] of the free dofs."""
        return self.mass, self.stiffness

    def nearest_node(self, x: float, y: float) -> int:
        """Return the number of the node nearest to a place in plan [m]."""
        away = self.nodes[:, :2] - np.array([x, y], dtype=float)
        return int(np.argmin(np.einsum("ij,ij->i", away, away)))

    def rigid_vector(self, dof: int) -> Float[Array, " dofs"]:
        """Return the vector of ones in one of the six dofs, over the free dofs."""
        in_space = np.zeros(self.fixed.size)
        in_space[dof::6] = 1.0
        return in_space @ own_motion(self.dof_index, self.n_dofs, self.angles)

    def inertia_of(self, dof: int) -> Float[Array, " dofs"]:
        """Return the forces on the free dofs of a unit acceleration of all nodes in a dof [kg].

        All nodes are those too that supports hold: the mass between a support and the node beside
        it hangs on that node in part.
        """
        blocks = blocks_of(self.elements, self.nodes, lambda group, xyz: group.mass_blocks(xyz))
        forces = np.zeros(self.fixed.shape)
        for one in blocks:
            by_shape = one.distinct[:, :, dof::6].sum(axis=2)
            on_nodes = by_shape[one.which].reshape(*one.connectivity.shape, 6)
            there = one.connectivity != GROUND
            np.add.at(forces, one.connectivity[there], on_nodes[there])
        if self.expansion is None:
            return forces[self.dof_index >= 0]
        return forces.ravel() @ self.expansion

    def moving_mass(self, dof: int = 2) -> float:
        """Return the mass that moves with a unit motion of all free dofs of a kind [kg]."""
        moving = self.rigid_vector(dof)
        return float(moving @ (self.mass @ moving))

    @cached_property
    def _carried(self) -> Bool[Array, "nodes 6"]:
        """True for dofs that any element gives a stiffness or a mass."""
        carried = np.zeros((len(self.nodes), 6), dtype=bool)
        for group in self.elements:
            ends = group.connectivity[group.connectivity != GROUND]
            carried[ends] |= group.carried
        for link in self.links:
            carried[link.leads] = True
        return carried

    def _assemble(self, form: Form) -> SparseMatrix:
        blocks = blocks_of(self.elements, self.nodes, form)
        expansion = self.expansion
        if expansion is None:
            return assembled(blocks, self.dof_index, self.n_dofs)
        # of every dof first, then by those that move by themselves
        numbers = np.arange(self.fixed.size).reshape(-1, 6)
        matrix = assembled(blocks, numbers, self.fixed.size)
        return without_noughts((expansion.T @ matrix @ expansion).tocsc())


def _check_numbers(group: Elements, n_nodes: int) -> None:
    numbers, lowest = group.connectivity, GROUND if group.stands_on_ground else 0
    if numbers.size and (numbers.min() < lowest or numbers.max() >= n_nodes):
        raise InputError(
            f"{group.name}: node numbers must be {lowest} to {n_nodes - 1}; "
            f"got {numbers.min()} to {numbers.max()}"
        )

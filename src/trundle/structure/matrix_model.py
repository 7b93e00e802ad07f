"""A structure of which another program has given the matrices."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Float, Int

from trundle._checks import frozen_array, set_frozen
from trundle._progress import Progress
from trundle._typing import Array, SparseMatrix
from trundle.dynamics import Factor, Modes, factorise, natural_modes
from trundle.errors import InputError
from trundle.structure.content import hash_of, parts_of
from trundle.structure.elements import Elements
from trundle.structure.elements.faces import FaceGroup
from trundle.structure.model import MirrorPlane
from trundle.structure.surface import Surface, check_names, named_surface

__all__ = ["MatrixModel"]


@dataclass(frozen=True, kw_only=True, eq=False)
class MatrixModel:
    """Hold nodes, the rows of their dofs, and both matrices.

    Attributes
    ----------
    nodes : ndarray of float, shape (n_nodes, 3)
        Coordinates [m], z up.
    dof_index : ndarray of int, shape (n_nodes, 6)
        Row of each dof of each node, -1 where it has none.
    mass, stiffness : sparse matrix, shape (n_dofs, n_dofs)
        In SI [kg], [N/m]; symmetric.
    faces : tuple of FaceGroup
        Between which nodes wheels can stand.
    decks : tuple of Surface
        Surfaces of them.
    name : str
        Name for reports.
    """

    nodes: Float[Array, "nodes 3"]
    dof_index: Int[Array, "nodes 6"]
    mass: SparseMatrix
    stiffness: SparseMatrix
    faces: tuple[FaceGroup, ...]
    decks: tuple[Surface, ...]
    name: str = "matrices"

    def __post_init__(self) -> None:
        """Freeze what is frozen, and check rows and shapes."""
        nodes = frozen_array("nodes", self.nodes, shape=(None, 3))
        rows = frozen_array("dof_index", self.dof_index, shape=(len(nodes), 6), dtype=np.intp)
        set_frozen(self, nodes=nodes, dof_index=rows)
        if self.mass.shape != self.stiffness.shape or self.mass.shape[0] != self.mass.shape[1]:
            raise InputError(
                f"mass {self.mass.shape} and stiffness {self.stiffness.shape} must be square, and "
                "of one size"
            )
        if rows.max() >= self.n_dofs:
            raise InputError(f"row {rows.max() + 1} of a node, and the matrices have {self.n_dofs}")
        check_names(self.decks)

    @property
    def n_dofs(self) -> int:
        """Number of dofs."""
        return int(self.mass.shape[0])

    @property
    def elements(self) -> tuple[Elements, ...]:
        """The faces."""
        return self.faces

    @property
    def expansion(self) -> SparseMatrix | None:
        """Nothing: `dof_index` says it all."""
        return None

    @property
    def surfaces(self) -> Mapping[str, Surface]:
        """What is driven and stood on, by name."""
        return {deck.name: deck for deck in self.decks}

    @property
    def mirrors(self) -> tuple[MirrorPlane, ...]:
        """None: what the matrices end at, they do not say."""
        return ()

    @property
    def has_matrices(self) -> bool:
        """Whether its modes are computed, not given."""
        return True

    def surface(self, name: str | None = None) -> Surface:
        """Return a surface by its name; None for the only one."""
        return named_surface(self.surfaces, name)

    @property
    def content_hash(self) -> str:
        """Hash of both matrices, and of all places."""
        return self._content_hash

    @cached_property
    def _content_hash(self) -> str:
        return hash_of(self, [self.dof_index, *parts_of(self.stiffness), *parts_of(self.mass)])

    def modes(self, f_max: float, *, progress: Progress | None = None) -> Modes:
        """Return all natural modes below a frequency [Hz], see `natural_modes`."""
        return natural_modes(self.mass, self.stiffness, f_max=f_max, progress=progress)

    def flexibility(self) -> Factor:
        """Return what solves for static deflections: the factorised stiffness."""
        return factorise(self.stiffness)

    def matrices(self) -> tuple[SparseMatrix, SparseMatrix]:
        """Return mass [kg] and stiffness [N/m]."""
        return self.mass, self.stiffness

    def damped_stiffness(self, other: float) -> SparseMatrix:
        """Return the stiffness times a damping ratio: nothing says what is of which material."""
        return other * self.stiffness

    def inertia_of(self, dof: int) -> Float[Array, " dofs"]:
        """Return the forces of inertia of a unit acceleration of all dofs of a kind [kg].

        What the other program held is not among them, nor the mass that hangs on it.
        """
        return self.mass @ self._unit(dof)

    def moving_mass(self, dof: int = 2) -> float:
        """Return the mass that moves with a unit motion of all dofs of a kind [kg]."""
        return float(self._unit(dof) @ self.inertia_of(dof))

    def _unit(self, dof: int) -> Array:
        unit = np.zeros(self.n_dofs)
        rows = self.dof_index[:, dof]
        unit[rows[rows >= 0]] = 1.0
        return unit

"""Say what a simulation asks of a structure, whatever it is made of."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float, Int
from scipy import sparse

from trundle._checks import frozen_array, positive, set_frozen
from trundle._progress import Progress
from trundle._typing import Array, SparseMatrix
from trundle.dynamics import Factor, Modes
from trundle.structure.elements import Elements
from trundle.structure.surface import Surface

__all__ = ["MirrorPlane", "Structure", "can_move", "node_motion"]


@dataclass(frozen=True, kw_only=True, eq=False)
class MirrorPlane:
    """Hold a vertical plane of symmetry, at which the modelled part of a building ends.

    What stands in the plane belongs to the model by half.

    Attributes
    ----------
    normal : ndarray of float, shape (2,)
        Across the plane, in plan, of unit length.
    position : float
        Where it lies along its normal, from the origin [m].
    """

    normal: Float[Array, " 2"]
    position: float

    def __post_init__(self) -> None:
        """Freeze the normal, and make it one."""
        normal = frozen_array("normal", self.normal, shape=(2,))
        length = positive("length of normal", float(np.hypot(*normal)))
        set_frozen(self, normal=frozen_array("normal", normal / length, shape=(2,)))

    @classmethod
    def across(cls, axis: int, position: float) -> MirrorPlane:
        """Return the plane across x (0) or y (1) at a place [m]."""
        return cls(normal=np.eye(2)[axis], position=position)

    @classmethod
    def through(cls, line: Float[Array, "2 2"]) -> MirrorPlane:
        """Return the plane through two places of the plan [m]."""
        along = line[1] - line[0]
        normal = np.array([along[1], -along[0]]) / np.hypot(*along)
        return cls(normal=normal, position=float(normal @ line[0]))

    def away(self, places: Float[Array, "*some axes"]) -> Float[Array, "*some"]:
        """Return how far on the side of its normal places are, in plan or in space [m]."""
        return places[..., :2] @ self.normal - self.position

    def facing(self, places: Float[Array, "places axes"]) -> MirrorPlane:
        """Return the same plane with its normal to the side on which most of some places lie."""
        if self.away(places).sum() >= 0.0:
            return self
        return MirrorPlane(normal=-self.normal, position=-self.position)

    def angle_to(self, other: MirrorPlane) -> float:
        """Return the angle between two planes, on the sides that their normals point to [rad]."""
        return float(np.pi - np.arccos(np.clip(self.normal @ other.normal, -1.0, 1.0)))

    def __str__(self) -> str:
        """Say where it is."""
        for name, one in zip("xy", np.eye(2), strict=True):
            if abs(self.normal @ one) == 1.0:
                return f"{name} = {self.position * (self.normal @ one):g} m"
        x, y = self.normal * self.position
        along = np.degrees(np.arctan2(self.normal[1], self.normal[0])) + 90.0
        return f"through ({x:g}, {y:g}) m along {along:g} degrees"


@runtime_checkable
class Structure(Protocol):
    """What vehicles drive over: it vibrates in modes, deflects, and has surfaces to stand on."""

    @property
    def name(self) -> str:
        """Name for reports."""
        ...

    @property
    def n_dofs(self) -> int:
        """Number of free degrees of freedom."""
        ...

    @property
    def nodes(self) -> Float[Array, "nodes 3"]:
        """Place of every node [m], z up."""
        ...

    @property
    def elements(self) -> tuple[Elements, ...]:
        """All groups of elements, for pictures; none where only modes are known."""
        ...

    @property
    def has_matrices(self) -> bool:
        """Whether its modes are computed; False where they are given."""
        ...

    def inertia_of(self, dof: int) -> Float[Array, " dofs"] | None:
        """Return the forces on the free dofs of a unit acceleration of the whole in a dof [kg].

        The whole is what supports hold too, where that is known; None where only modes are known.
        """
        ...

    def moving_mass(self, dof: int = 2) -> float | None:
        """Return the mass that moves with a unit motion of the whole in a dof [kg].

        None where only modes are known.
        """
        ...

    @property
    def dof_index(self) -> Int[Array, "nodes 6"]:
        """Row of each dof of each node among them, -1 where it is held or carries nothing."""
        ...

    @property
    def expansion(self) -> SparseMatrix | None:
        """Motion of all nodes by the free dofs, (6 n_nodes, n_dofs); None: `dof_index` says it."""
        ...

    @property
    def content_hash(self) -> str:
        """Hash of all that decides its motion and its places; equal structures share it."""
        ...

    @property
    def surfaces(self) -> Mapping[str, Surface]:
        """What is driven and stood on, by name."""
        ...

    @property
    def mirrors(self) -> tuple[MirrorPlane, ...]:
        """Mirror planes at which it ends."""
        ...

    def surface(self, name: str | None = None) -> Surface:
        """Return a surface by its name; None for the only one."""
        ...

    def modes(self, f_max: float, *, progress: Progress | None = None) -> Modes:
        """Return all natural modes below a frequency [Hz]."""
        ...

    def flexibility(self) -> Factor | None:
        """Return what solves for static deflections; None where only modes are known."""
        ...

    def damped_stiffness(self, other: float) -> SparseMatrix:
        """Return the stiffness, every element's times its damping ratio, or the other [N/m]."""
        ...

    def matrices(self) -> tuple[SparseMatrix, SparseMatrix]:
        """Return mass [kg] and stiffness [N/m]; refused by one that is known by its modes alone."""
        ...


def can_move(structure: Structure, dof: int) -> bool:
    """Return whether any node moves along a dof: of a test, whether it was measured there."""
    if structure.expansion is not None:
        return True
    return bool((structure.dof_index[:, dof] >= 0).any())


def node_motion(structure: Structure, dof: int) -> SparseMatrix:
    """Return rows of weights that give one dof of every node, (n_nodes, n_dofs)."""
    if structure.expansion is not None:
        return structure.expansion[dof::6]
    rows = structure.dof_index[:, dof]
    moving = np.flatnonzero(rows >= 0)
    entries = (np.ones(len(moving)), (moving, rows[moving]))
    return sparse.csr_array(entries, shape=(len(rows), structure.n_dofs))

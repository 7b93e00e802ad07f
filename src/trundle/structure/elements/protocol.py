"""Say what a floor asks of its elements."""

from __future__ import annotations

from typing import Protocol, runtime_checkable

from jaxtyping import Bool, Float, Int

from trundle._typing import Array
from trundle.structure.elements.standing import ContactShape, Located, Weights

__all__ = ["GROUND", "Damped", "Elements", "Repeating", "Standable"]

GROUND = -1
"""Node number that stands for rigid ground."""


@runtime_checkable
class Elements(Protocol):
    """Elements of one kind: their nodes, the dofs that they carry, and their matrices.

    Blocks are in the order of the nodes, six dofs a node (`DOF_NAMES`), in global axes.
    """

    @property
    def name(self) -> str:
        """What the group is: ``slab``, ``column`` ..."""
        ...

    @property
    def connectivity(self) -> Int[Array, "elements nodes"]:
        """Node numbers of each element; `GROUND` for rigid ground."""
        ...

    @property
    def stands_on_ground(self) -> bool:
        """Whether `GROUND` may be among them."""
        ...

    @property
    def carried(self) -> Bool[Array, " 6"]:
        """True for dofs of its nodes to which it gives a stiffness or a mass."""
        ...

    def stiffness_blocks(
        self, xyz: Float[Array, "elements nodes 3"]
    ) -> Float[Array, "elements dofs dofs"] | None:
        """Return the stiffness of each element [N/m], or None; `xyz` are its nodes [m]."""
        ...

    def mass_blocks(
        self, xyz: Float[Array, "elements nodes 3"]
    ) -> Float[Array, "elements dofs dofs"] | None:
        """Return the consistent mass of each element [kg], or None; `xyz` are its nodes [m]."""
        ...


@runtime_checkable
class Repeating(Protocol):
    """Elements of one section: those of one shape have the same matrices, wherever they are."""

    @property
    def of_one_section(self) -> bool:
        """True: nothing but its shape tells an element from others."""
        ...


@runtime_checkable
class Damped(Protocol):
    """Elements that know how they are damped."""

    @property
    def damping_ratio(self) -> float | None:
        """Ratio of critical damping of what they are made of; None where it says nothing."""
        ...


@runtime_checkable
class Standable(Elements, Protocol):
    """Elements that wheels and points can stand on: they know places between their nodes."""

    def locate(self, corners: Float[Array, "n nodes 2"], places: Float[Array, "n 2"]) -> Located:
        """Return where in elements places lie; both in the plane of a surface [m]."""
        ...

    def weights(
        self, local: Float[Array, "n 2"], corners: Float[Array, "n nodes 2"], shape: ContactShape
    ) -> Weights:
        """Return what the nodes' motion gives at places: deflection and its gradient."""
        ...

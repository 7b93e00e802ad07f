"""Connect two nodes, or a node and the ground, by linear springs."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Int

from trundle._checks import frozen_array, set_frozen
from trundle._typing import Array
from trundle.errors import InputError
from trundle.structure.elements.protocol import GROUND

__all__ = ["SpringGroup"]


@dataclass(frozen=True, kw_only=True, eq=False)
class SpringGroup:
    """Hold linear springs between two nodes, or between a node and the ground.

    Attributes
    ----------
    elements : ndarray of int, shape (n_springs, 2)
        Node numbers; `GROUND` (-1) stands for rigid ground, and becomes the second.
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
        elements = np.array(self.elements, dtype=np.intp)
        if elements.ndim == 2 and elements.shape[1] == 2:
            elements[elements[:, 0] == GROUND] = elements[elements[:, 0] == GROUND, ::-1]
            if np.any(elements[:, 0] == GROUND):
                raise InputError("a spring needs a node at one end; got ground at both")
        elements = frozen_array("elements", elements, shape=(None, 2), dtype=np.intp)
        set_frozen(self, elements=elements, stiffness=stiffness)

    @property
    def connectivity(self) -> Int[Array, "elements 2"]:
        """Node numbers of each element."""
        return self.elements

    @property
    def of_one_section(self) -> bool:
        """True: elements of one shape have the same matrices."""
        return True

    @property
    def stands_on_ground(self) -> bool:
        """Whether an end may be rigid ground."""
        return True

    @property
    def carried(self) -> Bool[Array, " 6"]:
        """Those in which it is stiff."""
        return self.stiffness > 0.0

    def stiffness_blocks(
        self, xyz: Float[Array, "elements 2 3"]
    ) -> Float[Array, "elements dofs dofs"]:
        """Return the same block for every spring."""
        pair = np.array([[1.0, -1.0], [-1.0, 1.0]])
        return np.broadcast_to(np.kron(pair, np.diag(self.stiffness)), (len(xyz), 12, 12))

    def mass_blocks(
        self, xyz: Float[Array, "elements 2 3"]
    ) -> Float[Array, "elements dofs dofs"] | None:
        """Return nothing: springs have no mass."""
        del xyz

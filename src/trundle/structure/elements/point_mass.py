"""Put point masses on nodes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Int

from trundle._checks import frozen_array, set_frozen
from trundle._typing import Array

__all__ = ["PointMasses"]


@dataclass(frozen=True, kw_only=True, eq=False)
class PointMasses:
    """Hold equal point masses at nodes, moving in the three translations.

    Attributes
    ----------
    nodes : ndarray of int, shape (n_masses,)
        Node numbers.
    mass : float
        Mass at each node [kg].
    name : str
        What the group is.
    """

    nodes: Int[Array, " masses"]
    mass: float
    name: str = "point mass"

    def __post_init__(self) -> None:
        """Freeze the node list."""
        set_frozen(self, nodes=frozen_array("nodes", self.nodes, shape=(None,), dtype=np.intp))

    @property
    def connectivity(self) -> Int[Array, "elements 1"]:
        """Node numbers of each element."""
        return self.nodes[:, None]

    @property
    def stands_on_ground(self) -> bool:
        """Whether an end may be rigid ground."""
        return False

    @property
    def carried(self) -> Bool[Array, " 6"]:
        """The three translations."""
        return np.array([True, True, True, False, False, False])

    def stiffness_blocks(
        self, xyz: Float[Array, "elements 1 3"]
    ) -> Float[Array, "elements dofs dofs"] | None:
        """Return nothing: masses have no stiffness."""
        del xyz

    def mass_blocks(self, xyz: Float[Array, "elements 1 3"]) -> Float[Array, "elements dofs dofs"]:
        """Return the same block for every mass."""
        block = np.diag([self.mass] * 3 + [0.0] * 3)
        return np.broadcast_to(block, (len(xyz), 6, 6))

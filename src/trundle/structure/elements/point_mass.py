"""Put point masses on nodes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Int

from trundle._checks import frozen_array, set_frozen
from trundle._typing import Array
from trundle.errors import InputError

__all__ = ["PointMasses"]


@dataclass(frozen=True, kw_only=True, eq=False)
class PointMasses:
    """Hold point masses at nodes, moving in the three translations.

    Attributes
    ----------
    nodes : ndarray of int, shape (n_masses,)
        Node numbers.
    mass : ndarray of float, shape (n_masses,)
        Mass at each node [kg]; one number, if all are equal.
    name : str
        What the group is.
    """

    nodes: Int[Array, " masses"]
    mass: Float[Array, " masses"] | float
    name: str = "point mass"

    def __post_init__(self) -> None:
        """Freeze both, and refuse a negative mass."""
        nodes = frozen_array("nodes", self.nodes, shape=(None,), dtype=np.intp)
        every = np.broadcast_to(np.asarray(self.mass, dtype=float), nodes.shape)
        mass = frozen_array("mass", every, shape=nodes.shape)
        if np.any(mass < 0.0):
            raise InputError(f"masses must be 0 or more; got {mass.min():g} kg")
        set_frozen(self, nodes=nodes, mass=mass)

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
        """Return the block of each mass."""
        del xyz
        moving = np.diag([1.0, 1.0, 1.0, 0.0, 0.0, 0.0])
        return np.asarray(self.mass)[:, None, None] * moving

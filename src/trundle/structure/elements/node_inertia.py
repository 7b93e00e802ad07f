"""Inertia of nodes, of its own in each of the six dofs."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Int

from trundle._checks import frozen_array, set_frozen
from trundle._typing import Array
from trundle.errors import InputError

__all__ = ["NodeInertia"]


@dataclass(frozen=True, kw_only=True, eq=False)
class NodeInertia:
    """Hold masses and moments of inertia at nodes, along and about the axes of space.

    Attributes
    ----------
    nodes : ndarray of int, shape (n_nodes,)
        Node numbers.
    inertia : ndarray of float, shape (n_nodes, 6)
        Mass along x, y and z [kg], moment of inertia about them [kg m2].
    name : str
        What the group is.
    """

    nodes: Int[Array, " some"]
    inertia: Float[Array, "some 6"]
    name: str = "node inertia"

    def __post_init__(self) -> None:
        """Freeze both, and refuse what is below nought."""
        nodes = frozen_array("nodes", self.nodes, shape=(None,), dtype=np.intp)
        inertia = frozen_array("inertia", self.inertia, shape=(len(nodes), 6))
        if np.any(inertia < 0.0):
            raise InputError(f"inertia must be 0 or more; got {inertia.min():g}")
        set_frozen(self, nodes=nodes, inertia=inertia)

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
        """The dofs in which any of them has inertia."""
        return np.asarray(np.any(self.inertia > 0.0, axis=0))

    def stiffness_blocks(self, xyz: Float[Array, "elements 1 3"]) -> None:
        """Return nothing: it has no stiffness."""
        del xyz

    def mass_blocks(self, xyz: Float[Array, "elements 1 3"]) -> Float[Array, "elements 6 6"]:
        """Return the inertia of each node."""
        del xyz
        return np.einsum("ni,ij->nij", self.inertia, np.eye(6))

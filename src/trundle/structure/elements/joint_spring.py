"""Connect two edges across a joint: springs in the middle between pairs of nodes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Int

from trundle._checks import frozen_array, set_frozen
from trundle._typing import Array
from trundle.errors import InputError

__all__ = ["JointSprings"]


@dataclass(frozen=True, kw_only=True, eq=False)
class JointSprings:
    """Hold springs halfway between two nodes, to which rigid arms lead from both.

    Attributes
    ----------
    elements : ndarray of int, shape (n_springs, 2)
        Node numbers.
    stiffness : ndarray of float, shape (n_springs, 3)
        Of each spring along x, y and z [N/m].
    name : str
        What the group is.

    Notes
    -----
    With nodes a and b, and the arms ``r = (x_b - x_a) / 2`` and ``-r``, a spring is stretched by
    ``u_a + theta_a x r - u_b + theta_b x r``: a motion of both as one rigid body stretches nothing.
    """

    elements: Int[Array, "springs 2"]
    stiffness: Float[Array, "springs 3"]
    name: str = "joint"

    def __post_init__(self) -> None:
        """Freeze both, and refuse a negative stiffness."""
        elements = frozen_array("elements", self.elements, shape=(None, 2), dtype=np.intp)
        stiffness = frozen_array("joint stiffness", self.stiffness, shape=(len(elements), 3))
        if np.any(stiffness < 0.0):
            raise InputError(f"joint stiffness must be 0 or more; got {stiffness.min():g}")
        set_frozen(self, elements=elements, stiffness=stiffness)

    @property
    def connectivity(self) -> Int[Array, "elements 2"]:
        """Node numbers of each element."""
        return self.elements

    @property
    def stands_on_ground(self) -> bool:
        """Whether an end may be rigid ground."""
        return False

    @property
    def carried(self) -> Bool[Array, " 6"]:
        """All six: arms turn forces into moments."""
        return np.ones(6, dtype=bool)

    def stiffness_blocks(
        self, xyz: Float[Array, "elements 2 3"]
    ) -> Float[Array, "elements dofs dofs"]:
        """Return the stiffness of each spring at its two nodes."""
        arm = 0.5 * (xyz[:, 1] - xyz[:, 0])
        stretch = np.zeros((len(xyz), 3, 12))
        stretch[:, :, 0:3], stretch[:, :, 6:9] = np.eye(3), -np.eye(3)
        stretch[:, :, 3:6] = stretch[:, :, 9:12] = _turning(arm)
        return np.einsum("nki,nk,nkj->nij", stretch, self.stiffness, stretch)

    def mass_blocks(
        self, xyz: Float[Array, "elements 2 3"]
    ) -> Float[Array, "elements dofs dofs"] | None:
        """Return nothing: springs have no mass."""
        del xyz


def _turning(arm: Float[Array, "n 3"]) -> Float[Array, "n 3 3"]:
    """Return what a rotation moves the end of an arm by: ``theta x r`` as a matrix on theta."""
    x, y, z = arm.T
    none = np.zeros_like(x)
    rows = [[none, z, -y], [-z, none, x], [y, -x, none]]
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=1)

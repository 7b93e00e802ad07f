"""Gather what holds nodes along axes that are turned in plan, and find the axes that say it all."""

from __future__ import annotations

import numpy as np
from jaxtyping import Bool, Float, Int

from trundle._typing import Array

__all__ = ["Holds"]

_SAME = 1e-9  # square of the sine of the angle between directions that are one
_ALONG = 1e-9  # sine of twice the angle of directions along x or y


class Holds:
    """Gathers directions in which nodes are held.

    In plan a node's translations are held in no direction, in one, or in all: two that differ leave
    none. So are its rotations. With one direction the node's axes are turned to it, and nothing
    needs to be solved for; along x or y they stay as they are.
    """

    def __init__(self, n_nodes: int) -> None:
        self._upright = np.zeros((n_nodes, 2), dtype=bool)
        self._level = np.zeros((n_nodes, 2, 2, 2))  # sums of d d^T, of translations and rotations

    def add(self, nodes: Int[Array, " some"], held: Bool[Array, " 6"], angle: float = 0.0) -> None:
        """Hold nodes in some of ux, uy, uz, rx, ry, rz, along axes turned about z [rad]."""
        c, s = np.cos(angle), np.sin(angle)
        for kind in (0, 1):
            for i, axis in enumerate(np.array([[c, s], [-s, c]])):
                if held[3 * kind + i]:
                    self._level[nodes, kind] += np.outer(axis, axis)
            self._upright[nodes, kind] |= held[3 * kind + 2]

    def found(self) -> tuple[Bool[Array, "nodes 6"], Float[Array, "nodes 2"] | None]:
        """Return which dofs are held along each node's axes, and the angles of those; None: 0."""
        sizes, directions = np.linalg.eigh(self._level)
        all_of_them = sizes[..., 0] > _SAME * np.maximum(sizes[..., 1], 1.0)
        one = (sizes[..., 1] > 0.5) & ~all_of_them
        x, y = directions[..., 0, 1], directions[..., 1, 1]
        square = np.abs(2.0 * x * y) < _ALONG
        angles = np.where(one & ~square, np.arctan2(y, x), 0.0)
        fixed = np.zeros((len(self._level), 2, 3), dtype=bool)
        fixed[..., 0] = all_of_them | (one & (~square | (np.abs(x) > np.abs(y))))
        fixed[..., 1] = all_of_them | (one & square & (np.abs(y) > np.abs(x)))
        fixed[..., 2] = self._upright
        return fixed.reshape(-1, 6), angles if np.any(angles) else None

"""Arrange a structure's elements as the cells that viewers draw."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from trundle._typing import Array
from trundle.dynamics import Modes
from trundle.structure import Structure, node_motion
from trundle.structure.elements import GROUND

__all__ = ["Cells", "cells_of", "shapes_at_nodes"]

_GROUND_PAIR = 2


@dataclass(frozen=True, kw_only=True, eq=False)
class Cells:
    """Hold points, lines, triangles and quadrilaterals between nodes.

    Attributes
    ----------
    blocks : tuple of ndarray of int, shape (n_cells, n_corners)
        By group.
    groups : tuple of str
        What each block is called.
    """

    blocks: tuple[Int[Array, "_ _"], ...]
    groups: tuple[str, ...]


def cells_of(structure: Structure) -> Cells:
    """Return the elements of a structure; springs to the ground are the points that they hold."""
    blocks, names = list[Array](), list[str]()
    for group in structure.elements:
        corners = group.connectivity
        if (corners == GROUND).any():
            corners = corners[:, :1] if corners.shape[1] == _GROUND_PAIR else corners[:0]
        if len(corners):
            blocks.append(np.asarray(corners))
            names.append(group.name)
    return Cells(blocks=tuple(blocks), groups=tuple(names))


def shapes_at_nodes(structure: Structure, modes: Modes) -> Float[Array, "modes nodes 6"]:
    """Return the motion of every node in each mode, scaled to unit modal mass; 0 if not known."""
    return np.stack([modes.seen(node_motion(structure, dof)).T for dof in range(6)], axis=-1)

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
    """Return the elements of a structure; springs to the ground are the points that they hold.

    A group of which some stand on the ground is two blocks of one name.
    """
    blocks, names = list[Array](), list[str]()
    for group in structure.elements:
        corners = np.asarray(group.connectivity)
        grounded = np.any(corners == GROUND, axis=1)
        points = corners[grounded].max(axis=1, keepdims=True)
        for cells in (corners[~grounded], points[points[:, 0] != GROUND]):
            if len(cells):
                blocks.append(cells)
                names.append(group.name)
    return Cells(blocks=tuple(blocks), groups=tuple(names))


def shapes_at_nodes(structure: Structure, modes: Modes) -> Float[Array, "modes nodes 6"]:
    """Return the motion of every node in each mode, scaled to unit modal mass; 0 if not known."""
    return np.stack([modes.seen(node_motion(structure, dof)).T for dof in range(6)], axis=-1)

"""Find rotations of nodes that nothing resists: all that meets there is hinged."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
from jaxtyping import Bool, Float

from trundle._typing import Array
from trundle.structure.elements import GROUND, Elements, ReleasedBeams, SpringGroup
from trundle.structure.links import RigidLinks

__all__ = ["idle_rotations"]

_NOTHING = 1e-9  # of the stiffest rotation
_ROTATIONS = slice(3, 6)


def idle_rotations(
    nodes: Float[Array, "nodes 3"], groups: Sequence[Elements], links: Sequence[RigidLinks]
) -> Iterator[tuple[int, Bool[Array, " 6"], float]]:
    """Give nodes with rotations that turn nothing, about which axes, and how those are turned.

    Such a rotation is no motion of the building: it is held, which changes nothing else. About a
    level axis it may lie at any angle [rad]; others than level and upright axes are left alone.

    Parameters
    ----------
    nodes : ndarray of float, shape (n_nodes, 3)
        Places [m].
    groups : sequence of Elements
        All that has stiffness.
    links : sequence of RigidLinks
        Nodes that move as one.
    """
    hinged = [group for group in groups if isinstance(group, ReleasedBeams)]
    if not hinged:
        return
    turned = np.zeros(len(nodes), dtype=bool)
    for group in groups:
        straight = isinstance(group, SpringGroup) and not group.stiffness[_ROTATIONS].any()
        if not isinstance(group, ReleasedBeams) and not straight:
            turned[group.connectivity[group.connectivity != GROUND]] = True
    for link in links:
        turned[link.leads] = turned[link.follows] = True
    blocks = np.zeros((len(nodes), 3, 3))
    for group in hinged:
        ends = group.connectivity
        # about hinges themselves: an arm between node and hinge swings, and holds nothing
        at_nodes = replace(group, beams=replace(group.beams, offset=np.zeros(3)))
        stiffness = at_nodes.stiffness_blocks(nodes[ends])
        for i, first in enumerate((3, 9)):
            np.add.at(blocks, ends[:, i], stiffness[:, first : first + 3, first : first + 3])
    stiffest = np.abs(blocks).max(initial=0.0)
    alone = np.unique(np.concatenate([group.connectivity.ravel() for group in hinged]))
    for node in alone[~turned[alone]].tolist():
        yield from _idle(int(node), blocks[node], _NOTHING * max(stiffest, 1.0))


def _idle(
    node: int, block: Array, nothing: float
) -> Iterator[tuple[int, Bool[Array, " 6"], float]]:
    if np.abs(block[2]).max() < nothing:
        yield node, np.array([False] * 5 + [True]), 0.0
    elif np.abs(block[2, :2]).max() > nothing:
        return  # an axis that is neither level nor upright
    sizes, axes = np.linalg.eigh(block[:2, :2])
    for size, axis in zip(sizes, axes.T, strict=True):
        if size < nothing:
            about = np.array([False, False, False, True, False, False])
            yield node, about, float(np.arctan2(axis[1], axis[0]))

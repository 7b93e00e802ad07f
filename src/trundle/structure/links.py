"""Let nodes follow another one as a rigid body does: a column's head under its slab.

A node that follows has no motion of its own: ``u = u_0 + theta_0 x r``, ``theta = theta_0``, with r
from the node that leads. Its dofs are taken out of the equations exactly, and what acts on it acts
on the one that leads.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Int
from scipy import sparse

from trundle._checks import frozen_array, set_frozen
from trundle._typing import Array, SparseMatrix
from trundle.errors import InputError

__all__ = ["RigidLinks", "expansion_of", "follows"]


@dataclass(frozen=True, kw_only=True, eq=False)
class RigidLinks:
    """Hold which nodes follow which.

    Attributes
    ----------
    leads, follows : ndarray of int, shape (n_links,)
        Node numbers; a node may lead many, and follows one at most.
    """

    leads: Int[Array, " links"]
    follows: Int[Array, " links"]

    def __post_init__(self) -> None:
        """Check that nothing follows twice, or leads what it follows."""
        leads = frozen_array("leads", self.leads, shape=(None,), dtype=np.intp)
        follows = frozen_array("follows", self.follows, shape=(len(leads),), dtype=np.intp)
        set_frozen(self, leads=leads, follows=follows)


def follows(links: Sequence[RigidLinks], n_nodes: int) -> Int[Array, " nodes"]:
    """Return the node that each follows, -1 for those that move by themselves.

    Raises
    ------
    InputError
        A node number that does not exist, one that follows twice, or leads though it follows.
    """
    leader = np.full(n_nodes, -1, dtype=np.intp)
    for group in links:
        both = np.concatenate([group.leads, group.follows])
        if both.size and (both.min() < 0 or both.max() >= n_nodes):
            raise InputError(f"rigid links: node numbers must be 0 to {n_nodes - 1}")
        taken = group.follows[(leader[group.follows] >= 0)]
        repeated = len(np.unique(group.follows)) < len(group.follows)
        if taken.size or repeated:
            raise InputError("rigid links: a node follows two others")
        leader[group.follows] = group.leads
    if np.any(leader[leader[leader >= 0]] >= 0):
        raise InputError("rigid links: a node leads others and follows one itself")
    return leader


def expansion_of(
    nodes: Float[Array, "nodes 3"],
    leader: Int[Array, " nodes"],
    index: Int[Array, "nodes 6"],
    fixed: Bool[Array, "nodes 6"],
) -> SparseMatrix:
    """Return the motion of all nodes by the free dofs, (6 n_nodes, n_dofs).

    Parameters
    ----------
    nodes : ndarray of float, shape (n_nodes, 3)
        Coordinates [m].
    leader : ndarray of int, shape (n_nodes,)
        Whom each follows, -1 for nobody.
    index : ndarray of int, shape (n_nodes, 6)
        Row of each dof that moves by itself, -1 for others.
    fixed : ndarray of bool, shape (n_nodes, 6)
        What supports hold.

    Raises
    ------
    InputError
        A node that follows is held in a dof in which the one that leads moves it.
    """
    n_dofs = int(index.max()) + 1
    own = index.ravel() >= 0
    rows, columns = [np.flatnonzero(own)], [index.ravel()[own]]
    values = [np.ones(int(own.sum()))]
    behind = np.flatnonzero(leader >= 0)
    arm = nodes[behind] - nodes[leader[behind]]
    lead = index[leader[behind]]
    for dof, on, factor in _rigid_motion(arm):
        moves = (lead[:, on] >= 0) & (factor != 0.0)
        held = moves & fixed[behind, dof]
        if np.any(held):
            raise InputError(
                f"rigid links: node {behind[int(np.argmax(held))]} is held, and follows a node "
                "that moves: hold the one that leads"
            )
        rows.append(6 * behind[moves] + dof)
        columns.append(lead[moves, on])
        values.append(factor[moves])
    at = (np.concatenate(rows), np.concatenate(columns))
    shape = (6 * len(nodes), n_dofs)
    return sparse.coo_array((np.concatenate(values), at), shape=shape).tocsr()


def _rigid_motion(arm: Array) -> list[tuple[int, int, Array]]:
    """Return each dof that follows, the dof that moves it, and by what factor."""
    x, y, z = arm.T
    one = np.ones(len(arm))
    same = [(dof, dof, one) for dof in range(6)]
    # u = theta x r
    turned = [(0, 4, z), (0, 5, -y), (1, 5, x), (1, 3, -z), (2, 3, y), (2, 4, -x)]
    return same + turned

"""Let nodes follow another one as a rigid body does: a column's head, a floor's diaphragm.

A node that follows has no motion of its own: ``u = u_0 + theta_0 x r``, ``theta = theta_0``, with r
from the node that leads. Its dofs are taken out of the equations exactly, and what acts on it acts
on the one that leads. Where a node follows in some dofs alone, as the nodes of a diaphragm do in
its plane, the others stay its own. One that follows in all may follow one that itself follows in
some; there are no longer chains.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Bool, Float, Int
from scipy import sparse

from trundle._checks import frozen_array, set_frozen
from trundle._typing import Array, SparseMatrix
from trundle.errors import InputError

__all__ = ["RigidLinks", "expansion_of", "leaders_of", "own_motion"]

_MOVED = 1e-9  # by a unit motion of the node that is followed


@dataclass(frozen=True, kw_only=True, eq=False)
class RigidLinks:
    """Hold which nodes follow which.

    Attributes
    ----------
    leads, follows : ndarray of int, shape (n_links,)
        Node numbers; a node may lead many, and follows one at most in each dof.
    dofs : ndarray of bool, shape (6,)
        In which dofs they follow; all, unless given.
    """

    leads: Int[Array, " links"]
    follows: Int[Array, " links"]
    dofs: Bool[Array, " 6"] = field(default_factory=lambda: np.ones(6, dtype=bool))

    def __post_init__(self) -> None:
        """Check that each has its own leader."""
        leads = frozen_array("leads", self.leads, shape=(None,), dtype=np.intp)
        follows = frozen_array("follows", self.follows, shape=(len(leads),), dtype=np.intp)
        dofs = frozen_array("dofs", self.dofs, shape=(6,), dtype=np.bool_)
        set_frozen(self, leads=leads, follows=follows, dofs=dofs)


def leaders_of(links: Sequence[RigidLinks], n_nodes: int) -> Int[Array, "nodes 6"]:
    """Return the node that each follows in each dof, -1 where it moves by itself.

    Raises
    ------
    InputError
        A node number that does not exist, one that follows twice, or a longer chain of nodes that
        follow each other.
    """
    leader = np.full((n_nodes, 6), -1, dtype=np.intp)
    for group in links:
        both = np.concatenate([group.leads, group.follows])
        if both.size and (both.min() < 0 or both.max() >= n_nodes):
            raise InputError(f"rigid links: node numbers must be 0 to {n_nodes - 1}")
        taken = (leader[group.follows][:, group.dofs] >= 0).any()
        repeated = len(np.unique(group.follows)) < len(group.follows)
        if taken or repeated:
            raise InputError("rigid links: a node follows two others")
        leader[np.ix_(group.follows, group.dofs)] = group.leads[:, None]
    wholly, partly = _kinds(leader)
    if np.any((wholly | partly)[leader[partly][leader[partly] >= 0]]) or np.any(
        wholly[leader[wholly]]
    ):
        raise InputError("rigid links: a node leads others and follows one itself")
    if np.any(leader[wholly] != leader[wholly][:, :1]):
        raise InputError("rigid links: a node follows two others")
    return leader


def _kinds(leader: Array) -> tuple[Array, Array]:
    """Return which nodes follow in all dofs, and which in some."""
    wholly = np.asarray(np.all(leader >= 0, axis=1))
    return wholly, np.asarray(np.any(leader >= 0, axis=1)) & ~wholly


def expansion_of(
    nodes: Float[Array, "nodes 3"],
    leader: Int[Array, "nodes 6"],
    index: Int[Array, "nodes 6"],
    fixed: Bool[Array, "nodes 6"],
    angles: Float[Array, "nodes 2"] | None = None,
) -> SparseMatrix:
    """Return the motion of all nodes by the free dofs, (6 n_nodes, n_dofs).

    Parameters
    ----------
    nodes : ndarray of float, shape (n_nodes, 3)
        Coordinates [m].
    leader : ndarray of int, shape (n_nodes, 6)
        Whom each follows in each dof, see `leaders_of`.
    index : ndarray of int, shape (n_nodes, 6)
        Row of each dof that moves by itself, -1 for others.
    fixed : ndarray of bool, shape (n_nodes, 6)
        What supports hold.
    angles : ndarray of float, shape (n_nodes, 2), optional
        How far each node's own axes are turned, see `own_motion`.

    Raises
    ------
    InputError
        A node that follows is held in a dof in which the one that leads moves it, or follows along
        x or y alone and has axes of its own.
    """
    own = own_motion(index, int(index.max()) + 1, angles)
    wholly, partly = _kinds(leader)
    _check_axes(leader, angles)
    base = own + _carried(nodes, leader, partly) @ own
    carried = _carried(nodes, leader, wholly) @ base
    _check_held(carried + (base - own), fixed, angles, leader)
    return (base + carried).tocsr()


def _carried(nodes: Array, leader: Array, some: Array) -> SparseMatrix:
    """Return how some nodes move with those that they follow, (6 n_nodes, 6 n_nodes)."""
    behind = np.flatnonzero(some)
    followed = leader[behind].max(axis=1)
    rows, columns, values = [], [], []
    for dof, on, factor in _rigid_motion(nodes[behind] - nodes[followed]):
        there = leader[behind, dof] >= 0
        rows.append(6 * behind[there] + dof)
        columns.append(6 * followed[there] + on)
        values.append(factor[there])
    at = (np.concatenate(rows), np.concatenate(columns))
    shape = (6 * len(nodes), 6 * len(nodes))
    return sparse.coo_array((np.concatenate(values), at), shape=shape).tocsr()


def own_motion(
    index: Int[Array, "nodes 6"], n_dofs: int, angles: Float[Array, "nodes 2"] | None
) -> SparseMatrix:
    """Return the motion of nodes in space, (6 n_nodes, n_dofs), by dofs along their own axes.

    Parameters
    ----------
    index : ndarray of int, shape (n_nodes, 6)
        Row of each dof, -1 for those that are none.
    n_dofs : int
        How many there are.
    angles : ndarray of float, shape (n_nodes, 2), optional
        By how much the axes of each node's translations, and of its rotations, are turned about z
        [rad]; by nothing, if not given.
    """
    n = len(index)
    c, s = np.ones((n, 2)), np.zeros((n, 2))
    if angles is not None:
        c, s = np.cos(angles), np.sin(angles)
    rows, columns, values = [], [], []
    for first, kind in ((0, 0), (3, 1)):
        cosine, sine, one = c[:, kind], s[:, kind], np.ones(n)
        for to, by, factor in (
            (0, 0, cosine), (1, 0, sine), (0, 1, -sine), (1, 1, cosine), (2, 2, one),
        ):  # fmt: skip
            dof = index[:, first + by]
            some = np.flatnonzero((dof >= 0) & (factor != 0.0))
            rows.append(6 * some + first + to)
            columns.append(dof[some])
            values.append(factor[some])
    at = (np.concatenate(rows), np.concatenate(columns))
    return sparse.coo_array((np.concatenate(values), at), shape=(6 * n, n_dofs)).tocsr()


def _check_held(carried: SparseMatrix, fixed: Array, angles: Array | None, leader: Array) -> None:
    """Refuse nodes that are moved by the one they follow in what supports hold."""
    numbers = np.arange(fixed.size).reshape(-1, 6)
    along_own = own_motion(numbers, fixed.size, angles).T @ carried
    held = np.flatnonzero((fixed & (leader >= 0)).ravel())
    moved = abs(along_own[held]).max(axis=1).toarray().ravel() > _MOVED
    if np.any(moved):
        raise InputError(
            f"rigid links: node {held[int(np.argmax(moved))] // 6} is held, and follows a node "
            "that moves: hold the one that leads"
        )


def _check_axes(leader: Array, angles: Array | None) -> None:
    """Refuse nodes that follow along x or y alone, and whose own dofs would move them there too."""
    if angles is None:
        return
    follows = leader >= 0
    odd = (follows[:, [0, 3]] != follows[:, [1, 4]]) & (angles != 0.0)
    if np.any(odd):
        raise InputError(
            f"rigid links: node {np.argwhere(odd)[0, 0]} follows along x or y alone, and its own "
            "axes are turned: let it follow along both"
        )


def _rigid_motion(arm: Array) -> list[tuple[int, int, Array]]:
    """Return each dof that follows, the dof that moves it, and by what factor."""
    x, y, z = arm.T
    one = np.ones(len(arm))
    same = [(dof, dof, one) for dof in range(6)]
    # u = theta x r
    turned = [(0, 4, z), (0, 5, -y), (1, 5, x), (1, 3, -z), (2, 3, y), (2, 4, -x)]
    return same + turned

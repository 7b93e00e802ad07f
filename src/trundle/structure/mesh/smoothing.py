"""Move nodes inside faces to where elements are better shaped."""

from __future__ import annotations

import numpy as np
from jaxtyping import Bool, Float, Int
from scipy import sparse

from trundle._typing import Array
from trundle.structure.mesh.quality import angles

__all__ = ["smoothed"]

_ROUNDS = 12


def smoothed(
    points: Float[Array, "nodes 2"],
    quads: Int[Array, "quads 4"],
    triangles: Int[Array, "triangles 3"],
    free: Bool[Array, " nodes"],
) -> Float[Array, "nodes 2"]:
    """Move free nodes towards the middle of their neighbours, where no element gets worse.

    Parameters
    ----------
    points : ndarray of float, shape (n_nodes, 2)
        Nodes [m].
    quads, triangles : ndarray of int
        Elements.
    free : ndarray of bool, shape (n_nodes,)
        Which may move.
    """
    beside = _neighbours(quads, triangles, len(points))
    n_beside = np.maximum(beside.sum(axis=1), 1.0)
    worst = _worst(points, quads, triangles)
    for _ in range(_ROUNDS):
        middle = np.stack([beside @ points[:, i] for i in range(2)], axis=1) / n_beside[:, None]
        moved = np.where(free[:, None], 0.5 * (points + middle), points)
        after = _worst(moved, quads, triangles)
        better = free & (after >= worst - 1e-9)
        if not better.any():
            break
        # one that stays changes elements of those that move: again, with them as they will be
        tried = np.where(better[:, None], moved, points)
        after = _worst(tried, quads, triangles)
        spoiled = after < worst - 1e-9
        near = (beside @ spoiled.astype(float) > 0.0) | spoiled
        tried = np.where(near[:, None], points, tried)
        after = _worst(tried, quads, triangles)
        if after.min() < worst.min() - 1e-9:
            break
        points, worst = tried, after
    return points


def _neighbours(quads: Array, triangles: Array, n: int) -> sparse.csr_array:
    ends = [
        np.stack([e, np.roll(e, -1, axis=1)], axis=2).reshape(-1, 2) for e in (quads, triangles)
    ]
    both = np.concatenate([*ends, *(end[:, ::-1] for end in ends)])
    out = sparse.coo_array((np.ones(len(both)), both.T), shape=(n, n)).tocsr()
    out.data[:] = 1.0
    return out


def _worst(points: Array, quads: Array, triangles: Array) -> Array:
    """Return how good the worst element at each node is: 1 for right or equal angles."""
    worst = np.ones(len(points))
    for elements, ideal in ((quads, 0.5 * np.pi), (triangles, np.pi / 3.0)):
        if len(elements):
            off = np.abs(angles(points[elements]) - ideal).max(axis=1) / ideal
            np.minimum.at(worst, elements.ravel(), np.repeat(1.0 - off, elements.shape[1]))
    return worst

"""Move nodes inside faces to where elements are better shaped."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from jaxtyping import Bool, Float, Int
from scipy import sparse

from trundle._typing import Array
from trundle.structure.mesh.quality import angles

__all__ = ["smoothed"]

_ROUNDS = 12
_ROUND_OFF = 1e-9


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
    kinds = [e for e in (quads, triangles) if len(e)]
    worst = _worst(points, kinds)
    for _ in range(_ROUNDS):
        middle = np.stack([beside @ points[:, i] for i in range(2)], axis=1) / n_beside[:, None]
        tried = np.where(free[:, None], 0.5 * (points + middle), points)
        # corners of spoiled elements go back; with all of them back no element is spoiled
        while len(spoiled := _spoiled(tried, kinds, worst)):
            tried[spoiled] = points[spoiled]
        if np.array_equal(tried, points):
            break
        points, worst = tried, _worst(tried, kinds)
    return points


def _neighbours(quads: Array, triangles: Array, n: int) -> sparse.csr_array:
    ends = [
        np.stack([e, np.roll(e, -1, axis=1)], axis=2).reshape(-1, 2) for e in (quads, triangles)
    ]
    both = np.concatenate([*ends, *(end[:, ::-1] for end in ends)])
    out = sparse.coo_array((np.ones(len(both)), both.T), shape=(n, n)).tocsr()
    out.data[:] = 1.0
    return out


def _good(points: Array, elements: Array) -> Array:
    """Return how good elements are: 1 with right or equal angles, below 0 if one is folded."""
    ideal = (1.0 - 2.0 / elements.shape[1]) * np.pi
    return 1.0 - np.abs(angles(points[elements]) - ideal).max(axis=1) / ideal


def _worst(points: Array, kinds: Sequence[Array]) -> Array:
    """Return how good the worst element at each node is."""
    worst = np.ones(len(points))
    for elements in kinds:
        good = _good(points, elements)
        np.minimum.at(worst, elements.ravel(), np.repeat(good, elements.shape[1]))
    return worst


def _spoiled(points: Array, kinds: Sequence[Array], worst: Array) -> Array:
    """Return corners of elements that are worse than the worst was at one of their corners."""
    found = [e[_good(points, e) < worst[e].max(axis=1) - _ROUND_OFF].ravel() for e in kinds]
    return np.concatenate([np.zeros(0, dtype=np.intp), *found])

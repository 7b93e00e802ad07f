"""Pair triangles to quadrilaterals, best pairs first."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float, Int

from trundle._typing import Array
from trundle.structure.mesh.quality import squareness

__all__ = ["paired"]

_LEAST = 0.35  # squareness below which two triangles are better than their quadrilateral


def paired(
    points: Float[Array, "nodes 2"],
    triangles: Int[Array, "triangles 3"],
    face: Int[Array, " triangles"],
    kept: Int[Array, "sides 2"],
) -> tuple[Int[Array, "quads 4"], Int[Array, "rest 3"], Int[Array, " quads"], Int[Array, " rest"]]:
    """Pair triangles of the same face over the side that they share.

    Parameters
    ----------
    points : ndarray of float, shape (n_nodes, 2)
        Nodes [m].
    triangles : ndarray of int, shape (n_triangles, 3)
        Node numbers, counterclockwise.
    face : ndarray of int, shape (n_triangles,)
        Face of each.
    kept : ndarray of int, shape (n_sides, 2)
        Sides that must stay.

    Returns
    -------
    quads, rest : ndarray of int
        Quadrilaterals, and the triangles that found no partner.
    quad_face, rest_face : ndarray of int
        Face of each.

    Notes
    -----
    In rounds: a pair is made where each of two is the other's best partner. Every round makes the
    best of all pairs left, so that it ends.
    """
    one, other, quads = _candidates(triangles, face, kept)
    worth = squareness(points[quads])
    good = worth > _LEAST
    one, other, quads, worth = one[good], other[good], quads[good], worth[good]
    # ties are broken by place in the list, or two equals would each wait for a third
    rank = np.empty(len(worth), dtype=np.intp)
    rank[np.lexsort((np.arange(len(worth)), -np.round(worth, 6)))] = np.arange(len(worth))
    free = np.ones(len(triangles), dtype=bool)
    chosen = [np.zeros(0, dtype=np.intp)]
    left = np.arange(len(worth))
    while len(left):
        best = np.full(len(triangles), len(worth))
        np.minimum.at(best, one[left], rank[left])
        np.minimum.at(best, other[left], rank[left])
        made = left[(best[one[left]] == rank[left]) & (best[other[left]] == rank[left])]
        chosen.append(made)
        free[one[made]] = free[other[made]] = False
        left = left[free[one[left]] & free[other[left]]]
    picked = np.concatenate(chosen)
    return quads[picked], triangles[free], face[one[picked]], face[free]


def _candidates(triangles: Array, face: Array, kept: Array) -> tuple[Array, Array, Array]:
    """Return both triangles of every side that may go, and the quadrilateral round them."""
    big = int(triangles.max(initial=0)) + 1
    sides = np.concatenate([triangles[:, [i, (i + 1) % 3]] for i in range(3)])
    owner = np.tile(np.arange(len(triangles)), 3)
    apex = np.concatenate([triangles[:, (i + 2) % 3] for i in range(3)])
    low, high = sides.min(axis=1), sides.max(axis=1)
    key = low * big + high
    order = np.argsort(key, kind="stable")
    pair = np.flatnonzero(key[order][1:] == key[order][:-1])
    a, b = order[pair], order[pair + 1]
    fixed = np.sort(kept, axis=1)
    may = ~np.isin(key[a], fixed[:, 0] * big + fixed[:, 1]) & (face[owner[a]] == face[owner[b]])
    a, b = a[may], b[may]
    # counterclockwise: from the side's start round the other triangle's apex to its end
    quads = np.stack([sides[a, 0], apex[b], sides[a, 1], apex[a]], axis=1)
    return owner[a], owner[b], quads

"""Find places that are one: within a distance of each other, however they are rounded."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float, Int
from scipy import sparse
from scipy.sparse import csgraph
from scipy.spatial import cKDTree

from trundle._typing import Array

__all__ = ["first_there", "linked"]


def first_there(
    places: Float[Array, "places axes"],
    within: float,
    apart: Int[Array, " places"] | None = None,
) -> Int[Array, " places"]:
    """Return for each place the first one that is within a distance of it, or linked to it so.

    Parameters
    ----------
    places : ndarray of float, shape (n, 2) or (n, 3)
        Places [m].
    within : float
        Distance [m].
    apart : ndarray of int, shape (n,), optional
        Groups of places that are not one though they are near.
    """
    if not len(places):
        return np.zeros(0, dtype=np.intp)
    pairs = cKDTree(places).query_pairs(within, output_type="ndarray")
    if apart is not None:
        pairs = pairs[apart[pairs[:, 0]] != apart[pairs[:, 1]]]
    return linked(pairs, len(places))


def linked(pairs: Int[Array, "pairs 2"], n: int) -> Int[Array, " members"]:
    """Return for each of n members the first of those that pairs link it to, itself included."""
    graph = sparse.coo_array((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(n, n))
    _, group = csgraph.connected_components(graph, directed=False)
    _, first = np.unique(group, return_index=True)
    return first[group].astype(np.intp)

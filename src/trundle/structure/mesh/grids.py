"""Mesh faces with four corners by grids between their sides."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float, Int

from trundle._typing import Array

__all__ = ["grid_between"]


def grid_between(
    sides: Sequence[Int[Array, " _"]], points: Float[Array, "nodes 2"], first: int
) -> tuple[Float[Array, "inner 2"], Int[Array, "elements 4"]]:
    """Fill four sides with a grid.

    Parameters
    ----------
    sides : sequence of four ndarrays of int
        Nodes along each side, in order round the face, corners included; opposite ones as many.
    points : ndarray of float, shape (n_nodes, 2)
        Nodes that there are [m].
    first : int
        Number of the first new one.

    Returns
    -------
    inner : ndarray of float, shape (n, 2)
        New nodes [m].
    elements : ndarray of int, shape (n_elements, 4)
        Node numbers, counterclockwise.

    Notes
    -----
    Transfinite interpolation (Gordon and Hall, Int. J. Numer. Meth. Eng. 7 (1973) 461-477):
    between opposite sides along both directions, less what the corners count twice. Lines between
    evenly divided straight sides are straight and evenly divided.
    """
    south, east, north, west = sides[0], sides[1], sides[2][::-1], sides[3][::-1]
    n, m = len(south), len(east)
    grid = np.zeros((m, n), dtype=np.intp)
    grid[0], grid[-1], grid[:, 0], grid[:, -1] = south, north, west, east
    grid[1:-1, 1:-1] = first + np.arange((m - 2) * (n - 2)).reshape(m - 2, n - 2)
    u = _shares(points[south], points[north])[None, 1:-1, None]
    v = _shares(points[west], points[east])[1:-1, None, None]
    across = (1 - v) * points[south][None, 1:-1] + v * points[north][None, 1:-1]
    along = (1 - u) * points[west][1:-1, None] + u * points[east][1:-1, None]
    corners = (1 - u) * ((1 - v) * points[south[0]] + v * points[north[0]])
    corners = corners + u * ((1 - v) * points[south[-1]] + v * points[north[-1]])
    parts = [grid[:-1, :-1], grid[:-1, 1:], grid[1:, 1:], grid[1:, :-1]]
    elements = np.stack([part.ravel() for part in parts], axis=1)
    return (across + along - corners).reshape(-1, 2), elements


def _shares(one: Array, other: Array) -> Array:
    """Return where along a side nodes stand, as the mean of two opposite sides."""

    def along(side: Array) -> Array:
        steps = np.linalg.norm(np.diff(side, axis=0), axis=1)
        return np.concatenate([[0.0], np.cumsum(steps)]) / steps.sum()

    return 0.5 * (along(one) + along(other))

"""Hold the edges of a plan, and its plane where they leave that free."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal, TypeAlias

import numpy as np
from jaxtyping import Bool, Float, Int

from trundle._typing import Array

__all__ = ["EDGES", "Edge", "hold_edge", "hold_plane", "middle_of"]

Edge: TypeAlias = Literal["free", "symmetry", "simple", "pinned", "clamped"]
"""How an edge of the plan is held.

=========  ====================================================================================
free       not at all
symmetry   as in the middle of a larger floor: no motion across the edge, no rotation out of it
simple     on a bearing: no deflection, no motion along the edge; free to rotate and to slide
           across the edge, as in Navier's simple support
pinned     no motion at the slab's mid-plane in any direction, free to rotate: two pinned edges
           take thrust, and a floor on hanging beams arches between them
clamped    no motion and no rotation
=========  ====================================================================================
"""

EDGES = ("x_min", "x_max", "y_min", "y_max")
"""Names of the four edges of a plan."""


def hold_edge(
    fixed: Bool[Array, "nodes 6"], nodes: Int[Array, " edge"], edge: str, kind: Edge
) -> None:
    """Hold the nodes of an edge, in place."""
    normal = 0 if edge.startswith("x") else 1
    held = {
        "free": [],
        # A mirror plane lets nothing cross it and allows no rotation out of it.
        "symmetry": [normal, 3 + (1 - normal), 5],
        # Hard support: an edge that does not deflect does not twist along itself either; with
        # it goes the motion along the edge, or hanging beams would swing about the slab.
        "simple": [1 - normal, 2, 3 + normal],
        "pinned": [0, 1, 2, 3 + normal],
        "clamped": [0, 1, 2, 3, 4, 5],
    }
    for dof in held[kind]:
        fixed[nodes, dof] = True


def hold_plane(
    fixed: Bool[Array, "nodes 6"],
    nodes: Float[Array, "nodes 3"],
    middle: tuple[float, float],
) -> None:
    """Hold a level floor against moving as a whole in its plane, in place.

    Only what its supports leave free is held, by one dof each: these are statically determinate,
    so that they strain nothing and carry only what the plane's own inertia asks of them. They
    stand in the middle of the whole floor, where that is least: a symmetric floor's symmetric
    motions have no motion in the plane there.

    Parameters
    ----------
    fixed : ndarray of bool, shape (n_nodes, 6)
        Held dofs.
    nodes : ndarray of float, shape (n_nodes, 3)
        Places of the nodes [m].
    middle : tuple of float
        Middle of the whole floor, mirror images included [m].
    """
    away = np.hypot(*(nodes[:, :2] - middle).T)
    centre, far = int(np.argmin(away)), int(np.argmax(away))
    across = int(np.argmin(np.abs(nodes[far, :2] - nodes[centre, :2])))
    for node, dof in ((centre, 0), (centre, 1), (far, across)):
        before = fixed[node, dof]
        held = _motions_held(fixed, nodes)
        fixed[node, dof] = True
        fixed[node, dof] = before or _motions_held(fixed, nodes) > held


def _motions_held(fixed: Array, nodes: Array) -> int:
    """Return how many of the plane's three rigid motions are held."""
    size = np.ptp(nodes[:, :2])
    x, y = (nodes[:, :2] / size).T
    one, nought = np.ones(len(nodes)), np.zeros(len(nodes))
    motions = {
        0: np.column_stack([one, nought, -y]),
        1: np.column_stack([nought, one, x]),
        5: np.column_stack([nought, nought, one]),
    }
    rows = np.vstack([rows[fixed[:, dof]] for dof, rows in motions.items()])
    return int(np.linalg.matrix_rank(rows.T @ rows)) if len(rows) else 0


def middle_of(
    extents: tuple[tuple[float, float], tuple[float, float]], kinds: Mapping[str, Edge]
) -> tuple[float, float]:
    """Return the middle of a floor with its mirror images [m]."""

    def along(axis: str, low: float, high: float) -> float:
        """Return the middle along one axis: a lone plane of symmetry, or halfway."""
        mirrors = [kinds.get(f"{axis}_{side}") == "symmetry" for side in ("min", "max")]
        if mirrors[0] != mirrors[1]:
            return low if mirrors[0] else high
        return 0.5 * (low + high)

    return along("x", *extents[0]), along("y", *extents[1])

"""Shells on grids of places, meshed by either kind of element."""

import numpy as np
from scipy.sparse.linalg import spsolve

from trundle.structure import Floor, Material, ShellGroup, ShellSection, TriangleGroup

KINDS = ("quadrilaterals", "triangles")


def shell(places, thickness, elastic_modulus, poisson, fixed, kind, density=1.0):
    """A grid of places (n_x, n_y, 3), meshed by elements between them; `fixed` has their dofs."""
    n_x, n_y, _ = places.shape
    number = np.arange(n_x * n_y).reshape(n_x, n_y)
    corners = [number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]]
    quads = np.stack([corner.ravel() for corner in corners], axis=1)
    section = ShellSection(
        thickness=thickness,
        material=Material(elastic_modulus=elastic_modulus, poisson_ratio=poisson, density=density),
    )
    parts = {"nodes": places.reshape(-1, 3), "fixed": fixed.reshape(-1, 6)}
    if kind == "quadrilaterals":
        return Floor(shells=(ShellGroup(elements=quads, section=section),), **parts)
    halves = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    return Floor(others=(TriangleGroup(connectivity=halves, section=section),), **parts)


def moved(floor, loads):
    """Motion of all nodes (n, 6) under forces at nodes {(node, dof): force}."""
    force = np.zeros(floor.n_dofs)
    for (node, dof), value in loads.items():
        force[floor.dof_index[node, dof]] += value
    u = np.append(spsolve(floor.stiffness, force), 0.0)
    return u[floor.dof_index]

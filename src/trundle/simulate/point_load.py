"""Deflect a floor under a load that stands at a place."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from trundle._checks import finite
from trundle._kinds import kinds_checked
from trundle.dynamics import factorise
from trundle.route import contact_rows
from trundle.structure import Floor, Hermite

__all__ = ["point_load_deflection"]


@kinds_checked
def point_load_deflection(
    floor: Floor,
    at: tuple[float, float],
    *,
    force: float = 1e3,
    points: Mapping[str, tuple[float, float]] | None = None,
) -> dict[str, float]:
    """Return how far places of a floor sink under a force that stands on it.

    Load and places may lie anywhere between nodes, as wheels do.

    Parameters
    ----------
    floor : Floor
        The floor.
    at : tuple of float
        Where the force stands (x, y) [m].
    force : float
        The force, positive downwards [N]; 1 kN unless given.
    points : mapping of str to (x, y), optional
        Where the deflection is read [m]; under the load, as "load", unless given.

    Returns
    -------
    dict of str to float
        Deflection [m], up positive: a floor sinks to negative values.

    Raises
    ------
    InputError
        A place off the floor.
    UnrestrainedModeError
        Part of the floor can move without strain.
    """
    read = {"load": at} if points is None else dict(points)
    places = np.array([at, *read.values()], dtype=float)
    along_x = np.broadcast_to([1.0, 0.0], places.shape)
    rows = contact_rows(floor, places, along_x, shape=Hermite())
    weights = rows.matrix(rows.value).toarray()
    load = -finite("force", force) * float(rows.load_share[0]) * weights[0]
    found = weights[1:] @ factorise(floor.stiffness).solve(load)
    return dict(zip(read, map(float, found), strict=True))

"""Deflect a floor under its own weight."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from trundle._checks import positive
from trundle._typing import Array
from trundle.dynamics import factorise
from trundle.structure.floor import Floor

__all__ = ["self_weight_deflection"]


def self_weight_deflection(floor: Floor, *, gravity: float = 9.81) -> Float[Array, " nodes"]:
    """Return the vertical deflection of every node under all masses of the floor.

    Parameters
    ----------
    floor : Floor
        The floor; superimposed mass counts as weight.
    gravity : float
        Acceleration of gravity [m/s2].

    Returns
    -------
    ndarray of float, shape (n_nodes,)
        Deflection [m], up positive: a floor sags to negative values.

    Raises
    ------
    UnrestrainedModeError
        Part of the floor can move without strain.
    """
    weight = positive("gravity", gravity) * (floor.mass @ floor.rigid_vector(2))
    u = factorise(floor.stiffness).solve(-weight)
    rows = floor.dof_index[:, 2]
    return np.where(rows >= 0, u[np.maximum(rows, 0)], 0.0)

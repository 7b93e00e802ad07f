"""Deflect a floor under its own weight."""

from __future__ import annotations

from jaxtyping import Float

from trundle._checks import positive
from trundle._typing import Array
from trundle.errors import InputError
from trundle.structure.model import Structure, node_motion

__all__ = ["self_weight_deflection"]


def self_weight_deflection(floor: Structure, *, gravity: float = 9.81) -> Float[Array, " nodes"]:
    """Return the vertical deflection of every node under all masses of the floor.

    Parameters
    ----------
    floor : Structure
        The floor; superimposed mass counts as weight.
    gravity : float
        Acceleration of gravity [m/s2].

    Returns
    -------
    ndarray of float, shape (n_nodes,)
        Deflection [m], up positive: a floor sags to negative values.

    Raises
    ------
    InputError
        A structure that is known by its modes alone.
    UnrestrainedModeError
        Part of the floor can move without strain.
    """
    flexibility = floor.flexibility()
    inertia = floor.inertia_of(2)
    if flexibility is None or inertia is None:
        raise InputError(f"{floor.name} is known by its modes: nothing says how it sinks")
    u = flexibility.solve(-positive("gravity", gravity) * inertia)
    return node_motion(floor, 2) @ u

"""Deflect a floor under its own weight."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from trundle._checks import positive
from trundle._typing import Array
from trundle.dynamics import Factor
from trundle.errors import InputError, UnrestrainedModeError
from trundle.structure.model import Structure, node_motion

__all__ = ["self_weight_deflection"]

_RIGID = 1e-4  # rad2/s2: what swings more slowly moves without strain, as for `natural_modes`


def self_weight_deflection(floor: Structure, *, gravity: float = 9.81) -> Float[Array, " nodes"]:
    """Return the vertical deflection of every node under all masses of the floor.

    Parameters
    ----------
    floor : Structure
        The floor; superimposed mass counts as weight, and so does what lies beside supports. Of a
        structure known by its matrices alone only the mass between its free dofs is known.
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
    _check_held(floor, flexibility)
    u = flexibility.solve(-positive("gravity", gravity) * inertia)
    return node_motion(floor, 2) @ u


def _check_held(floor: Structure, flexibility: Factor) -> None:
    """Refuse a floor of which part is loose: a factor of it is wrong, and need not fail.

    Notes
    -----
    Any load of inertia sets all masses in motion, and what nothing holds the furthest: the
    frequency by Rayleigh's quotient is then that of a motion without strain.
    """
    mass, stiffness = floor.matrices()
    load = mass @ np.random.default_rng(0).standard_normal(floor.n_dofs)
    moved = flexibility.solve(load)
    strain, motion = moved @ (stiffness @ moved), moved @ (mass @ moved)
    if flexibility.n_negative or not strain > _RIGID * motion:
        raise UnrestrainedModeError(
            f"{floor.name} can move without strain, and nothing says how far it sinks: part of it "
            "is loose or unsupported; add supports, or connect the loose part"
        )

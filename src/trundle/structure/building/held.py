"""Hold what holds and loads a building: bases, supports, masses, planes of symmetry."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np
from jaxtyping import Float

from trundle._checks import frozen_array, positive, set_frozen
from trundle._typing import Array
from trundle.errors import InputError

__all__ = ["Base", "Held", "Mass", "Springs", "Support", "SymmetryPlane", "share_inside"]

Held: TypeAlias = tuple[bool, bool, bool, bool, bool, bool]
"""Which of ux, uy, uz, rx, ry, rz are held."""

Springs: TypeAlias = tuple[float, float, float, float, float, float]
"""Stiffness in each of the six [N/m], [N m/rad]."""

_ON_PLANE = 1e-3  # m
_FREE: Held = (False, False, False, False, False, False)
_NO_SPRINGS: Springs = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)

Base: TypeAlias = Literal["fixed", "pinned"] | Springs
"""What a column or wall ends in: rigid ground, a hinge on it, or six springs [N/m], [N m/rad]."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Support:
    """Hold what supports a line or a point of a floor.

    Attributes
    ----------
    on : str
        Storey or ramp.
    along : ndarray of float, shape (n, 2)
        Corners of the line; one place for a point [m].
    held : tuple of bool
        Which of ux, uy, uz, rx, ry, rz are held.
    springs : tuple of float
        Stiffness in each of the six [N/m], [N m/rad]; of a line, per metre.
    name : str
        Name for messages.
    """

    on: str
    along: Float[Array, "corners 2"]
    held: Held = _FREE
    springs: Springs = _NO_SPRINGS
    name: str = "support"

    def __post_init__(self) -> None:
        """Freeze the line and check the springs."""
        set_frozen(self, along=frozen_array("along", self.along, shape=(None, 2)))
        if min(self.springs) < 0.0:
            raise InputError(f"springs must be 0 or more; got {list(self.springs)}")


@dataclass(frozen=True, kw_only=True, eq=False)
class Mass:
    """Hold mass that stands on a floor, at a point or along a line.

    Attributes
    ----------
    on : str
        Storey or ramp.
    along : ndarray of float, shape (n, 2)
        Corners of the line; one place for a point [m].
    mass : float
        At the point [kg], or along the line [kg/m].
    name : str
        Name for messages.
    """

    on: str
    along: Float[Array, "corners 2"]
    mass: float
    name: str = "mass"

    def __post_init__(self) -> None:
        """Freeze the line and check the mass."""
        set_frozen(
            self,
            along=frozen_array("along", self.along, shape=(None, 2)),
            mass=positive("mass", self.mass),
        )


@dataclass(frozen=True, kw_only=True)
class SymmetryPlane:
    """Hold a vertical plane at which the modelled part of a building ends.

    Attributes
    ----------
    axis : int
        Axis across it: 0 for x, 1 for y.
    position : float
        Where it cuts that axis [m].
    """

    axis: int
    position: float


def share_inside(
    parts: Float[Array, "parts nodes axes"], planes: Sequence[SymmetryPlane]
) -> Float[Array, " parts"]:
    """Return what share of parts belongs to a model that ends at planes of symmetry.

    Parameters
    ----------
    parts : ndarray of float, shape (n_parts, n_nodes, 2 or 3)
        Where the nodes of each are [m]; what has all of them in a plane belongs to it by half.
    planes : sequence of SymmetryPlane
        Where the model ends.
    """
    share = np.ones(len(parts))
    for plane in planes:
        on = np.abs(parts[:, :, plane.axis] - plane.position) < _ON_PLANE
        share[on.all(axis=1)] *= 0.5
    return share

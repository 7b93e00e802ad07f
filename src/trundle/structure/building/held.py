"""Hold what holds and loads a building: bases, supports, masses, planes of symmetry."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Literal, TypeAlias

import numpy as np
from jaxtyping import Float

from trundle._checks import frozen_array, positive, set_frozen
from trundle._typing import Array
from trundle.errors import InputError
from trundle.structure.model import MirrorPlane

__all__ = ["ON_PLANE", "Base", "Held", "Mass", "Springs", "Support", "share_inside"]

Held: TypeAlias = tuple[bool, bool, bool, bool, bool, bool]
"""Which of ux, uy, uz, rx, ry, rz are held."""

Springs: TypeAlias = tuple[float, float, float, float, float, float]
"""Stiffness in each of the six [N/m], [N m/rad]."""

ON_PLANE = 1e-3
"""Distance within which a node is in a plane of symmetry [m]."""

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
    angle : float
        By how much the axes x and y of what is held are turned about z [degrees].
    name : str
        Name for messages.
    """

    on: str
    along: Float[Array, "corners 2"]
    held: Held = _FREE
    springs: Springs = _NO_SPRINGS
    angle: float = 0.0
    name: str = "support"

    def __post_init__(self) -> None:
        """Freeze the line and check the springs."""
        set_frozen(self, along=frozen_array("along", self.along, shape=(None, 2)))
        if min(self.springs) < 0.0:
            raise InputError(f"springs must be 0 or more; got {list(self.springs)}")
        if self.angle % 180.0 and any(self.springs):
            raise InputError(
                "springs act along x, y and z: leave angle out, or hold without springs"
            )


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


def share_inside(
    parts: Float[Array, "parts nodes axes"], planes: Sequence[MirrorPlane]
) -> Float[Array, " parts"]:
    """Return what share of parts belongs to a model that ends at planes of symmetry.

    What has all its nodes in a plane belongs to it by half; what stands where two planes meet, as
    far round it as the model reaches.

    Parameters
    ----------
    parts : ndarray of float, shape (n_parts, n_nodes, 2 or 3)
        Where the nodes of each are [m].
    planes : sequence of MirrorPlane
        Where the model ends; it lies on the sides that their normals point to.
    """
    on = [(np.abs(plane.away(parts)) < ON_PLANE).all(axis=1) for plane in planes]
    share = np.ones(len(parts))
    for here in on:
        share[here] = 0.5
    for (i, one), (j, other) in combinations(enumerate(planes), 2):
        share[on[i] & on[j]] = one.angle_to(other) / (2.0 * np.pi)
    return share

"""Say where: a surface's frame in space, and places in it."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Literal, TypeAlias, get_args

import numpy as np
from jaxtyping import Float

from trundle._checks import finite, frozen_array, one_of, set_frozen
from trundle._typing import Array
from trundle.errors import InputError

__all__ = ["Axis", "Frame", "Spot", "Spots"]

Axis: TypeAlias = Literal["z", "x", "y"]
"""Along the normal of a surface, or level along an axis of the plan."""


@dataclass(frozen=True)
class Spot:
    """Say where: a place on a surface.

    Attributes
    ----------
    x, y : float
        Coordinates in the surface's frame [m].
    on : str or None
        Name of the surface; None where a structure has only one.
    axis : {"z", "x", "y"}
        Which motion is read there: along the surface's normal, or level, along an axis of the plan.
    """

    x: float
    y: float
    on: str | None = None
    axis: Axis = "z"

    def __post_init__(self) -> None:
        """Check both coordinates and the axis."""
        set_frozen(self, x=finite("x", self.x), y=finite("y", self.y))
        one_of("axis", self.axis, get_args(Axis))


@dataclass(frozen=True, kw_only=True, eq=False)
class Spots:
    """Hold many places on one surface.

    Attributes
    ----------
    xy : ndarray of float, shape (n_spots, 2)
        Coordinates in the surface's frame [m].
    on : str or None
        Name of the surface; None where a structure has only one.
    axis : {"z", "x", "y"}
        Which motion is read there, see `Spot`.
    """

    xy: Float[Array, "spots 2"]
    on: str | None = None
    axis: Axis = "z"

    def __post_init__(self) -> None:
        """Freeze the coordinates."""
        set_frozen(self, xy=frozen_array("places", self.xy, shape=(None, 2)))

    def __len__(self) -> int:
        """Return how many there are."""
        return len(self.xy)


@dataclass(frozen=True, kw_only=True, eq=False)
class Frame:
    """Hold where a surface lies in space.

    Attributes
    ----------
    origin : ndarray of float, shape (3,)
        Where its x and y are 0 [m].
    x_axis, y_axis : ndarray of float, shape (3,)
        Its axes in space, of unit length and at right angles; forces press against their cross
        product, which points up.
    """

    origin: Float[Array, " 3"] = field(default_factory=lambda: np.zeros(3))
    x_axis: Float[Array, " 3"] = field(default_factory=lambda: np.array([1.0, 0.0, 0.0]))
    y_axis: Float[Array, " 3"] = field(default_factory=lambda: np.array([0.0, 1.0, 0.0]))

    def __post_init__(self) -> None:
        """Check that the axes are a frame that looks up."""
        set_frozen(
            self,
            origin=frozen_array("origin", self.origin, shape=(3,)),
            x_axis=frozen_array("x_axis", self.x_axis, shape=(3,)),
            y_axis=frozen_array("y_axis", self.y_axis, shape=(3,)),
        )
        axes = np.array([self.x_axis, self.y_axis])
        if np.abs(axes @ axes.T - np.eye(2)).max() > 1e-9:
            raise InputError("a surface's axes must be of unit length and at right angles")
        if self.normal[2] <= 0.0:
            raise InputError("a surface must look up: exchange its axes")

    @classmethod
    def level(cls, height: float) -> Frame:
        """Lie level at a height [m], with the axes of the plan."""
        return cls(origin=np.array([0.0, 0.0, height]))

    @classmethod
    def through(cls, plane: Float[Array, " 3"]) -> Frame:
        """Lie in a plane ``z = plane[0] + plane[1] x + plane[2] y``; x runs along the plan's."""
        x_axis = np.array([1.0, 0.0, plane[1]])
        up = np.array([-plane[1], -plane[2], 1.0])
        x_axis, up = x_axis / np.linalg.norm(x_axis), up / np.linalg.norm(up)
        origin = np.array([0.0, 0.0, plane[0]])
        return cls(origin=origin, x_axis=x_axis, y_axis=np.cross(up, x_axis))

    @property
    def normal(self) -> Float[Array, " 3"]:
        """Direction that points away from the surface."""
        return np.cross(self.x_axis, self.y_axis)

    def coordinates(self, xyz: Float[Array, "n 3"]) -> Float[Array, "n 3"]:
        """Return x, y in the surface and the height above it [m]."""
        return (xyz - self.origin) @ np.array([self.x_axis, self.y_axis, self.normal]).T

    def in_space(self, xy: Float[Array, "n 2"]) -> Float[Array, "n 3"]:
        """Return where in space places of the surface are [m]."""
        return self.origin + xy @ np.array([self.x_axis, self.y_axis])

    def from_plan(self, xy: Float[Array, "n 2"]) -> Float[Array, "n 2"]:
        """Return where in the surface places of the plan lie, straight above or below them [m]."""
        normal = self.normal
        rise = (self.origin[:2] - xy) @ normal[:2] / normal[2] + self.origin[2]
        return self.coordinates(np.column_stack([xy, rise]))[:, :2]

    def to_plan(self, xy: Float[Array, "n 2"]) -> Float[Array, "n 2"]:
        """Return where in plan places of the surface are [m]."""
        return self.in_space(xy)[:, :2]

    @cached_property
    def motion(self) -> Float[Array, "3 6"]:
        """Deflection and both rotations in the frame, by a node's six dofs in space."""
        turn = np.zeros((3, 6))
        turn[0, :3] = self.normal
        turn[1, 3:], turn[2, 3:] = self.x_axis, self.y_axis
        return turn

"""Say what is meshed: sheets of areas, with the lines and points that the mesh must hold."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Float

from trundle._checks import frozen_array, set_frozen
from trundle._typing import Array

__all__ = ["Area", "Refinement", "Sheet", "Tie"]


@dataclass(frozen=True, kw_only=True, eq=False)
class Area:
    """Hold a polygon with openings, all of one make.

    Attributes
    ----------
    outline : ndarray of float, shape (n, 2)
        Corners in plan [m], in either sense, the first not repeated.
    openings : tuple of ndarray of float, shape (n, 2)
        Corners of its openings [m].
    tag : int
        What it is made of; elements are gathered by it.
    over : bool
        Whether it only changes what others are made of, where they are: it fills no opening, its
        own openings go through them, and it reaches no further.
    """

    outline: Float[Array, "corners 2"]
    openings: tuple[Float[Array, "_ 2"], ...] = ()
    tag: int = 0
    over: bool = False

    def __post_init__(self) -> None:
        """Freeze the corners."""
        set_frozen(
            self,
            outline=frozen_array("outline", self.outline, shape=(None, 2)),
            openings=tuple(frozen_array("opening", o, shape=(None, 2)) for o in self.openings),
        )


@dataclass(frozen=True, kw_only=True, eq=False)
class Sheet:
    """Hold areas of one plane, and what their mesh must follow.

    Attributes
    ----------
    name : str
        Name for messages.
    areas : tuple of Area
        What carries elements; none at a level where only walls and columns stand.
    lines : tuple of ndarray of float, shape (n, 2)
        Lines in plan that element edges must lie on [m], on areas or beside them.
    points : ndarray of float, shape (n, 2)
        Places in plan where a node must be [m].
    plane : ndarray of float, shape (3,)
        Height of a place: ``z = plane[0] + plane[1] x + plane[2] y`` [m].
    """

    name: str
    areas: tuple[Area, ...] = ()
    lines: tuple[Float[Array, "_ 2"], ...] = ()
    points: Float[Array, "points 2"] = field(default_factory=lambda: np.zeros((0, 2)))
    plane: Float[Array, " 3"] = field(default_factory=lambda: np.zeros(3))

    def __post_init__(self) -> None:
        """Freeze what is given."""
        set_frozen(
            self,
            lines=tuple(frozen_array("line", line, shape=(None, 2)) for line in self.lines),
            points=frozen_array("points", self.points, shape=(None, 2)),
            plane=frozen_array("plane", self.plane, shape=(3,)),
        )

    def height(self, xy: Float[Array, "n 2"]) -> Float[Array, " n"]:
        """Return the height of places in plan [m]."""
        return self.plane[0] + xy @ self.plane[1:]


@dataclass(frozen=True, kw_only=True, eq=False)
class Tie:
    """Say that two sheets are divided alike along a line: under a wall, or where a ramp begins.

    Attributes
    ----------
    sheets : tuple of int
        Numbers of the two.
    line : ndarray of float, shape (2, 2)
        Both ends in plan [m].
    """

    sheets: tuple[int, int]
    line: Float[Array, "2 2"]


@dataclass(frozen=True, kw_only=True, eq=False)
class Refinement:
    """Ask for smaller elements near a line or a point.

    Attributes
    ----------
    line : ndarray of float, shape (n, 2)
        Corners of the line in plan [m]; one for a point.
    size : float
        Largest edge of an element there [m].
    reach : float
        Distance up to which it holds [m]; beyond, edges grow by half of the distance from there.
    sheet : str or None
        Name of the sheet; all unless given.
    """

    line: Float[Array, "corners 2"]
    size: float
    reach: float
    sheet: str | None = None

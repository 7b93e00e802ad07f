"""Hold what a building is made of: storeys, slabs, beams, columns, walls, ramps and supports.

Places are in plan, x and y in metres. `on` names the storey or the ramp that a part lies on.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from jaxtyping import Float

from trundle._checks import finite, frozen_array, one_of, set_frozen
from trundle._typing import Array
from trundle.structure.building.held import Base, Mass, Support
from trundle.structure.building.joint import Joint
from trundle.structure.building.profile import Profile
from trundle.structure.model import MirrorPlane
from trundle.structure.sections import PlateSection

__all__ = [
    "Beam",
    "Brace",
    "Building",
    "Column",
    "Ramp",
    "Slab",
    "Storey",
    "Wall",
]


@dataclass(frozen=True, kw_only=True)
class Storey:
    """Hold a level.

    Attributes
    ----------
    name : str
        How parts, routes and points call it.
    level : float
        Height of the mid-plane of its slabs [m].
    """

    name: str
    level: float

    def __post_init__(self) -> None:
        """Check the height."""
        set_frozen(self, level=finite("level", self.level))


@dataclass(frozen=True, kw_only=True, eq=False)
class Slab:
    """Hold an area of slab.

    Attributes
    ----------
    on : str
        Its storey.
    section : PlateSection
        What it is made of, with what lies on it.
    outline : ndarray of float, shape (n, 2)
        Corners [m].
    openings : tuple of ndarray of float, shape (n, 2)
        Corners of openings [m].
    panel : bool
        Whether it takes the place of a slab that lies there: a drop panel, a thicker strip.
    name : str
        Name for messages.
    """

    on: str
    section: PlateSection
    outline: Float[Array, "corners 2"]
    openings: tuple[Float[Array, "_ 2"], ...] = ()
    panel: bool = False
    name: str = "slab"

    def __post_init__(self) -> None:
        """Freeze the corners."""
        set_frozen(
            self,
            outline=frozen_array("outline", self.outline, shape=(None, 2)),
            openings=tuple(frozen_array("opening", o, shape=(None, 2)) for o in self.openings),
        )

    @property
    def area(self) -> float:
        """Net area, without openings [m2]."""
        return _area(self.outline) - sum(map(_area, self.openings))


@dataclass(frozen=True, kw_only=True, eq=False)
class Beam:
    """Hold a beam along a line.

    Attributes
    ----------
    on : str
        Its storey, or the ramp whose slope it follows.
    profile : Profile
        Its section.
    along : ndarray of float, shape (n, 2)
        Corners of the line [m].
    below : bool
        Whether its top meets the underside of the slab; in the slab's mid-plane otherwise.
    hinged : tuple of bool
        Whether its start and its end transmit no bending moment.
    name : str
        Name for messages and pictures.
    """

    on: str
    profile: Profile
    along: Float[Array, "corners 2"]
    below: bool = True
    hinged: tuple[bool, bool] = (False, False)
    name: str = "beam"

    def __post_init__(self) -> None:
        """Freeze the line."""
        set_frozen(self, along=frozen_array("along", self.along, shape=(None, 2)))


@dataclass(frozen=True, kw_only=True, eq=False)
class Column:
    """Hold a column through one storey or several.

    Attributes
    ----------
    profile : Profile
        Its section; the depth lies along x unless turned.
    at : ndarray of float, shape (2,)
        Where it stands [m].
    bottom, top : str
        Storeys between which it stands; it is joined to all that it passes.
    angle : float
        By which it is turned in plan, counterclockwise [degrees].
    base, cap : Base or None
        What its ends are held by; None where a floor carries or is carried.
    head : {"rigid", "point"}
        Whether slabs move with its cross-section as a rigid body, or are held at one node.
    name : str
        Name for messages and pictures.
    """

    profile: Profile
    at: Float[Array, " 2"]
    bottom: str
    top: str
    angle: float = 0.0
    base: Base | None = None
    cap: Base | None = None
    head: Literal["rigid", "point"] = "rigid"
    name: str = "column"

    def __post_init__(self) -> None:
        """Freeze the place."""
        set_frozen(self, at=frozen_array("at", self.at, shape=(2,)))
        one_of("head", self.head, ("rigid", "point"))

    @property
    def footprint(self) -> Float[Array, "4 2"]:
        """Box round its section, by its corners [m]."""
        half = 0.5 * np.array([self.profile.depth, self.profile.width])
        corners = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * half
        turn = np.deg2rad(self.angle)
        c, s = np.cos(turn), np.sin(turn)
        return self.at + corners @ np.array([[c, s], [-s, c]])

    @property
    def depth_axis(self) -> Float[Array, " 3"]:
        """Direction of its depth."""
        turn = np.deg2rad(self.angle)
        return np.array([np.cos(turn), np.sin(turn), 0.0])


@dataclass(frozen=True, kw_only=True, eq=False)
class Wall:
    """Hold a wall that bends and carries in its plane.

    Attributes
    ----------
    section : PlateSection
        What it is made of.
    along : ndarray of float, shape (2, 2)
        Both ends [m].
    bottom, top : str
        Storeys between which it stands; it is joined to all that it passes.
    base : Base or None
        What its foot is held by; None where a floor carries it.
    name : str
        Name for messages.
    """

    section: PlateSection
    along: Float[Array, "2 2"]
    bottom: str
    top: str
    base: Base | None = None
    name: str = "wall"

    def __post_init__(self) -> None:
        """Freeze the line."""
        set_frozen(self, along=frozen_array("along", self.along, shape=(2, 2)))


@dataclass(frozen=True, kw_only=True, eq=False)
class Brace:
    """Hold a straight member between two nodes of the building.

    Attributes
    ----------
    profile : Profile
        Its section.
    ends : ndarray of float, shape (2, 2)
        Where it starts and ends in plan [m].
    on : tuple of str
        Storeys of both ends.
    hinged : bool
        Whether its ends transmit no bending moment.
    name : str
        Name for messages.
    """

    profile: Profile
    ends: Float[Array, "2 2"]
    on: tuple[str, str]
    hinged: bool = True
    name: str = "brace"

    def __post_init__(self) -> None:
        """Freeze the ends."""
        set_frozen(self, ends=frozen_array("ends", self.ends, shape=(2, 2)))


@dataclass(frozen=True, kw_only=True, eq=False)
class Ramp:
    """Hold a slab that rises from one storey to another.

    Attributes
    ----------
    name : str
        How routes and points call it.
    section : PlateSection
        What it is made of.
    outline : ndarray of float, shape (4, 2)
        Corners [m]: both ends of the lower edge, then of the upper one, in order round it.
    bottom, top : str
        Storeys of the lower and the upper edge.
    """

    name: str
    section: PlateSection
    outline: Float[Array, "4 2"]
    bottom: str
    top: str

    def __post_init__(self) -> None:
        """Freeze the corners."""
        set_frozen(self, outline=frozen_array("outline", self.outline, shape=(4, 2)))

    @property
    def area(self) -> float:
        """Size in plan [m2]."""
        return _area(self.outline)


@dataclass(frozen=True, kw_only=True, eq=False)
class Building:
    """Hold all parts of a building.

    Attributes
    ----------
    storeys : tuple of Storey
        From below to above.
    slabs, beams, columns, walls, braces, ramps, supports, masses, joints, symmetry : tuple
        Its parts.
    grid : mapping of str to ndarray of float, shape (2, 2)
        Grid lines by name, two places on each [m], for pictures and places like ``A/1``.
    north : float
        Direction of north, counterclockwise from y [degrees].
    name : str
        Name for reports.
    """

    storeys: tuple[Storey, ...]
    slabs: tuple[Slab, ...] = ()
    beams: tuple[Beam, ...] = ()
    columns: tuple[Column, ...] = ()
    walls: tuple[Wall, ...] = ()
    braces: tuple[Brace, ...] = ()
    ramps: tuple[Ramp, ...] = ()
    supports: tuple[Support, ...] = ()
    masses: tuple[Mass, ...] = ()
    joints: tuple[Joint, ...] = ()
    symmetry: tuple[MirrorPlane, ...] = ()
    grid: dict[str, Float[Array, "2 2"]] = field(default_factory=dict[str, Array])
    north: float | None = None
    name: str = "building"

    @property
    def mirrors(self) -> tuple[MirrorPlane, ...]:
        """Where it ends by symmetry: planes with normals that point to it."""
        rows = [slab.outline for slab in (*self.slabs, *self.ramps)]
        rows += [part.along for part in (*self.beams, *self.walls)]
        rows += [column.at[None] for column in self.columns]
        places = np.concatenate([np.zeros((0, 2)), *rows])
        return tuple(plane.facing(places) for plane in self.symmetry)

    @property
    def floors(self) -> tuple[str, ...]:
        """All that parts can lie on: storeys and ramps, by name."""
        return (*(s.name for s in self.storeys), *(r.name for r in self.ramps))

    def level(self, storey: str) -> float:
        """Return the height of a storey [m]."""
        return next(s.level for s in self.storeys if s.name == storey)

    def between(self, bottom: str, top: str) -> tuple[Storey, ...]:
        """Return the storeys from one to another, both included, rising."""
        low, high = self.level(bottom), self.level(top)
        some = (s for s in self.storeys if low - 1e-9 <= s.level <= high + 1e-9)
        return tuple(sorted(some, key=lambda s: s.level))


def _area(corners: Array) -> float:
    x, y = corners.T
    return 0.5 * abs(float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1))))

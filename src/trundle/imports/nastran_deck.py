"""Hold what cards of Nastran bulk data say, by the numbers that they use."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, field

import numpy as np

from trundle._typing import Array
from trundle.errors import InputError
from trundle.structure import BeamSection, Material

_NOWHERE = (0.0, 0.0, 0.0)
_MOST = 3_000_000  # grids, elements and properties: of more, memory would be full

__all__ = [
    "Deck",
    "Face",
    "Grid",
    "Laminate",
    "Member",
    "MemberMake",
    "PlaneLaw",
    "Plate",
    "Spring",
    "System",
]


@dataclass(frozen=True, kw_only=True)
class Grid:
    """Hold a GRID, or what GRDSET says where one does not; None and "" where neither has."""

    system: int | None = None
    place: Array = field(default_factory=lambda: np.zeros(3))
    moves_in: int | None = None
    held: str = ""


@dataclass(frozen=True, kw_only=True)
class System:
    """Hold a coordinate system: its kind, and three points of it or three grids."""

    kind: str  # "R", "C" or "S"
    under: int = 0
    points: Array = field(default_factory=lambda: np.zeros((3, 3)))
    grids: tuple[int, int, int] | None = None


@dataclass(frozen=True, kw_only=True)
class Member:
    """Hold a bar, beam or rod: its grids, its property, how it lies."""

    ends: tuple[int, int]
    property: int
    up: tuple[float, float, float] | None = None  # in the plane of its first bending; None:
    towards: int | None = None  # a grid that it points to; None: of no matter
    up_in_basic: bool = False  # not in the system in which its first grid moves
    offsets: tuple[tuple[float, ...], tuple[float, ...]] = (_NOWHERE, _NOWHERE)  # as its grids move
    pins: tuple[str, str] = ("", "")
    place: str = ""


@dataclass(frozen=True, kw_only=True)
class MemberMake:
    """Hold a property of bars, beams or rods.

    `section` has no material yet, and mass besides is per metre; a rod does not bend.
    """

    material: int
    section: BeamSection
    more: float = 0.0
    rod: bool = False
    twists: bool = True


@dataclass(frozen=True, kw_only=True)
class Plate:
    """Hold a PSHELL: its materials of stretching, bending and shear, and its sizes.

    Without a material of shear (0) it does not shear; `bending` is 12 I / T^3, `shear` TS / T, and
    `more` mass besides a square metre.
    """

    materials: tuple[int, int, int]
    thickness: float
    bending: float = 1.0
    shear: float = 5.0 / 6.0
    more: float = 0.0


@dataclass(frozen=True, kw_only=True)
class PlaneLaw:
    """Hold a MAT2 or MAT8: stresses by strains along its axes, shear across, density."""

    plane: tuple[float, float, float, float]  # along x, along y, both, in shear
    across: tuple[float, float] | None  # None: it does not shear
    density: float


@dataclass(frozen=True, kw_only=True)
class Laminate:
    """Hold a PCOMP: plies from below, as material, thickness and angle [degrees]."""

    plies: tuple[tuple[int, float, float], ...]
    bottom: float
    more: float


@dataclass(frozen=True, kw_only=True)
class Face:
    """Hold a plate element: its grids, its property, and the axis of its material."""

    property: int
    corners: tuple[int, ...]
    angle: float = 0.0  # from its first side [degrees]
    system: int | None = None  # whose x axis is it instead
    place: str = ""


@dataclass(frozen=True, kw_only=True)
class Spring:
    """Hold a spring between two grids, or a grid and the ground, along the basic axes."""

    ends: tuple[int, int | None]
    stiffness: tuple[float, ...] | None  # of the six dofs; None:
    property: int = 0
    dof: int = 0  # of a scalar spring
    place: str = ""


@dataclass(kw_only=True)
class Deck:
    """What the cards say, by the numbers that they use.

    Masses are along the axes of space, own masses along those in which their grid moves.
    """

    grids: dict[int, Grid] = field(default_factory=dict)
    every_grid: Grid = field(default_factory=Grid)
    systems: dict[int, System] = field(default_factory=dict)
    materials: dict[int, Material] = field(default_factory=dict)
    laws: dict[int, PlaneLaw] = field(default_factory=dict)
    shells: dict[int, Plate | Laminate] = field(default_factory=dict)
    members: dict[int, MemberMake] = field(default_factory=dict)
    stiffnesses: dict[int, tuple[float, ...]] = field(default_factory=dict)
    faces: list[Face] = field(default_factory=list)
    bars: list[Member] = field(default_factory=list)
    springs: list[Spring] = field(default_factory=list)
    rigid: list[tuple[int, tuple[range, ...], str, str]] = field(default_factory=list)
    masses: list[tuple[int, tuple[float, ...]]] = field(default_factory=list)
    own_masses: dict[int, Array] = field(default_factory=lambda: defaultdict(lambda: np.zeros(6)))
    supports: dict[int, list[tuple[range, str]]] = field(default_factory=lambda: defaultdict(list))
    added: dict[int, list[int]] = field(default_factory=dict)
    weight_to_mass: float = 1.0
    consistent: bool = False
    taken: set[tuple[str, int]] = field(default_factory=set)

    def claim(self, kind: str, number: int) -> int:
        """Return a number that nothing else of its kind has; refuse one that is taken."""
        if len(self.taken) >= _MOST:
            raise InputError(f"a model may have {_MOST:g} cards with numbers: cut it down")
        if (kind, number) in self.taken:
            raise InputError(f"{kind} {number} is there twice")
        self.taken.add((kind, number))
        return number

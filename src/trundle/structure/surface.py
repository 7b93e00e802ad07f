"""Say what wheels, people and points stand on: surfaces, and places on them.

A surface is a plane of elements with a frame of its own: (x, y) is measured in it, whether it is a
storey's slab or a ramp. A place is a `Spot`; many places are `Spots`.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Literal, TypeAlias, get_args

import numpy as np
from jaxtyping import Bool, Float, Int
from scipy.spatial import cKDTree

from trundle._checks import finite, frozen_array, one_of, set_frozen
from trundle._typing import Array
from trundle.errors import InputError
from trundle.structure.elements import Elements, Located, Standable

__all__ = [
    "Axis",
    "Frame",
    "Spot",
    "Spots",
    "Surface",
    "check_names",
    "found_surface",
    "named_surface",
]

Axis: TypeAlias = Literal["z", "x", "y"]
"""Along the normal of a surface, or level along an axis of the plan."""

_CANDIDATES = 12
_BLOCK = 20_000  # places looked up at once, to bound memory
_EDGE = 1e-6  # share of an element by which a place may lie outside it
_FLAT = 1e-6  # m, by which a node may lie off its surface


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


@dataclass(frozen=True, kw_only=True, eq=False)
class Surface:
    """Hold elements that wheels and points can stand on, with their places in their plane.

    Attributes
    ----------
    name : str
        How routes and points call it.
    nodes : ndarray of float, shape (n_nodes, 3)
        Nodes of the structure [m].
    groups : tuple of Standable
        Its elements; of a group that lies in it in part, only that part is stood on.
    frame : Frame
        The plane, in which x and y are measured.

    Raises
    ------
    InputError
        No element lies in the plane.
    """

    name: str
    nodes: Float[Array, "nodes 3"]
    groups: tuple[Standable, ...]
    frame: Frame

    def __repr__(self) -> str:
        """Say in a line what it is."""
        n = sum(len(part.elements) for part in self._parts)
        return f"<Surface {self.name!r}: {n} elements>"

    def __post_init__(self) -> None:
        """Check that something can be stood on."""
        set_frozen(self, nodes=frozen_array("nodes", self.nodes, shape=(None, 3)))
        if not any(len(part.elements) for part in self._parts):
            raise InputError(f"surface {self.name!r}: no element of its groups lies in its plane")

    @cached_property
    def _parts(self) -> tuple[_Part, ...]:
        """Each group's elements in the plane."""
        flat = self.frame.coordinates(self.nodes)
        found, at = [], 0
        for group in self.groups:
            corners = flat[group.connectivity]
            inside = (np.abs(corners[..., 2]) < _FLAT).all(axis=1)
            part = _Part(
                group=group,
                first=at,
                elements=group.connectivity[inside],
                corners=np.ascontiguousarray(corners[inside][:, :, :2]),
            )
            found.append(part)
            at += len(part.elements)
        return tuple(found)

    @property
    def parts(self) -> Iterator[tuple[Standable, Int[Array, "elements nodes"]]]:
        """Groups, with the node numbers of their elements in the surface."""
        return ((part.group, part.elements) for part in self._parts)

    @cached_property
    def _tree(self) -> cKDTree:
        return cKDTree(np.concatenate([part.corners.mean(axis=1) for part in self._parts]))

    @property
    def element_size(self) -> float:
        """Median edge of its elements [m]."""
        ends = self.nodes[self._parts[0].elements[:, :2]]
        return float(np.median(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)))

    @property
    def extent(self) -> tuple[Float[Array, " 2"], Float[Array, " 2"]]:
        """Lowest and highest x, y [m]."""
        flat = np.concatenate([part.corners.reshape(-1, 2) for part in self._parts])
        return flat.min(axis=0), flat.max(axis=0)

    def find(
        self, places: Float[Array, "n 2"]
    ) -> Iterator[tuple[_Part, Int[Array, " some"], Int[Array, " some"], Float[Array, "some 2"]]]:
        """Find the elements under places.

        Yields
        ------
        part : _Part
            A group's elements.
        rows : ndarray of int, shape (n_some,)
            Which of the places stand on it.
        elements : ndarray of int, shape (n_some,)
            On which of its elements.
        local : ndarray of float, shape (n_some, 2)
            Where in them.

        Raises
        ------
        InputError
            A place that no element lies under.
        """
        blocks = [
            self._look_up(places[i : i + _BLOCK]) for i in range(0, max(1, len(places)), _BLOCK)
        ]
        numbers, local = (np.concatenate(found) for found in zip(*blocks, strict=True))
        for part in self._parts:
            rows = np.flatnonzero(part.holds(numbers))
            if rows.size:
                yield part, rows, numbers[rows] - part.first, local[rows]

    def holds(self, places: Float[Array, "n 2"]) -> Bool[Array, " n"]:
        """Return which places some element lies under."""
        blocks = [
            self._nearest(places[i : i + _BLOCK])[2] for i in range(0, max(1, len(places)), _BLOCK)
        ]
        return np.concatenate(blocks) <= _EDGE

    def _look_up(self, places: Array) -> tuple[Array, Array]:
        """Return the number of the element under each place among all, and where in it."""
        found, local, worst = self._nearest(places)
        if np.any(worst > _EDGE):
            self._refuse(places[int(worst.argmax())])
        return found, local

    def _nearest(self, places: Array) -> tuple[Array, Array, Array]:
        """Return the element nearest to each place, where in it, and how far outside."""
        n_near = min(_CANDIDATES, self._tree.n)
        _, near = self._tree.query(places, k=n_near)
        near = np.asarray(near).reshape(len(places), n_near)
        located = self._locate(near.ravel(), np.repeat(places, n_near, axis=0))
        outside = located.outside.reshape(len(places), n_near)
        best, rows = outside.argmin(axis=1), np.arange(len(places))
        found, local = near[rows, best], located.local.reshape(len(places), n_near, 2)[rows, best]
        worst = outside[rows, best]
        lost = np.flatnonzero(worst > _EDGE)
        if lost.size:
            # On a graded mesh the element under a place can have a centre far from it.
            found[lost], local[lost], worst[lost] = self._search_all(places[lost])
        return found, local, worst

    def _locate(self, numbers: Array, places: Array) -> Located:
        local, outside = np.empty((len(places), 2)), np.empty(len(places))
        for part in self._parts:
            mine = part.holds(numbers)
            corners = part.corners[numbers[mine] - part.first]
            local[mine], outside[mine] = part.group.locate(corners, places[mine])
        return Located(local, outside)

    def _search_all(self, places: Array) -> tuple[Array, Array, Array]:
        """Return element, local place and distance outside among all that could hold it."""
        low = np.concatenate([part.corners.min(axis=1) for part in self._parts]) - _EDGE
        high = np.concatenate([part.corners.max(axis=1) for part in self._parts]) + _EDGE
        found = np.zeros(len(places), dtype=np.intp)
        local, outside = np.full((len(places), 2), np.inf), np.full(len(places), np.inf)
        for i, place in enumerate(places):
            near = np.flatnonzero(((low <= place) & (place <= high)).all(axis=1))
            if near.size:
                tried = self._locate(near, np.broadcast_to(place, (len(near), 2)))
                best = int(tried.outside.argmin())
                found[i], local[i] = near[best], tried.local[best]
                outside[i] = tried.outside[best]
        return found, local, outside

    def _refuse(self, place: Array) -> None:
        low, high = self.extent
        name = "the floor" if self.name == "floor" else repr(self.name)
        inside = bool(((low <= place) & (place <= high)).all())
        if inside:
            raise InputError(
                f"point ({place[0]:g}, {place[1]:g}) m is not on {name}: there is an opening, or "
                "nothing yet"
            )
        raise InputError(
            f"point ({place[0]:g}, {place[1]:g}) m is not on {name}, which "
            f"covers x {low[0]:g} to {high[0]:g} m and y {low[1]:g} to {high[1]:g} m"
        )


@dataclass(frozen=True, kw_only=True, eq=False)
class _Part:
    """A group's elements in a surface, numbered from `first` on among all of it."""

    group: Standable
    first: int
    elements: Int[Array, "elements nodes"]
    corners: Float[Array, "elements nodes 2"]

    def holds(self, numbers: Array) -> Array:
        """Return which numbers are those of its elements."""
        return (numbers >= self.first) & (numbers < self.first + len(self.elements))


def found_surface(name: str, nodes: Float[Array, "nodes 3"], groups: Sequence[Elements]) -> Surface:
    """Return the one level surface of a structure: of its slabs, or of its beams without any.

    Raises
    ------
    InputError
        No level element, or level elements at more than one height.
    """
    standable = [group for group in groups if isinstance(group, Standable)]
    areas = [group for group in standable if group.connectivity.shape[1] > 2]
    used = tuple(areas or standable)
    heights = [nodes[group.connectivity][:, :, 2] for group in used]
    level = [z[np.ptp(z, axis=1) < _FLAT] for z in heights]
    found = np.concatenate([z.ravel() for z in level]) if level else np.zeros(0)
    if not found.size:
        raise InputError(f"{name}: no level element for a wheel to stand on")
    if np.ptp(found) > _FLAT:
        raise InputError(
            f"{name}: level elements at {found.min():g} and {found.max():g} m; name the surfaces "
            "that vehicles drive on: Floor(..., decks=(Surface(name=..., ...), ...))"
        )
    return Surface(name="floor", nodes=nodes, groups=used, frame=Frame.level(float(found[0])))


def check_names(decks: Sequence[Surface]) -> None:
    """Refuse surfaces of one name."""
    names = sorted(deck.name for deck in decks)
    twice = [a for a, b in itertools.pairwise(names) if a == b]
    if twice:
        raise InputError(f"two surfaces are called {twice[0]!r}: name them apart")


def named_surface(surfaces: Mapping[str, Surface], name: str | None) -> Surface:
    """Return a surface by its name; None for the only one.

    Raises
    ------
    InputError
        No such name, or none where there are several.
    """
    there = ", ".join(map(repr, surfaces))
    if name is None and len(surfaces) == 1:
        return next(iter(surfaces.values()))
    if name is None:
        raise InputError(f"say on which surface: {there}")
    if name not in surfaces:
        raise InputError(f"there is no surface {name!r}; choose {there}")
    return surfaces[name]

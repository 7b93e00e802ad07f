"""Say what wheels, people and points stand on: surfaces, and places on them.

A surface is a plane of elements with a frame of its own: (x, y) is measured in it, whether it is a
storey's slab or a ramp. A place is a `Spot`; many places are `Spots`.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Bool, Float, Int
from scipy.spatial import cKDTree

from trundle._checks import frozen_array, set_frozen
from trundle._typing import Array
from trundle.errors import InputError
from trundle.structure.elements import Elements, Located, Standable
from trundle.structure.places import Frame

__all__ = ["Surface", "check_names", "found_surface", "named_surface"]

_CANDIDATES = 12
_BLOCK = 20_000  # places looked up at once, to bound memory
_EDGE = 1e-6  # share of an element by which a place may lie outside it
_FLAT = 1e-6  # m, by which a node may lie off its surface


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
    flat : float
        By how much a node may lie off the plane [m]: what other programs round.

    Raises
    ------
    InputError
        No element lies in the plane.
    """

    name: str
    nodes: Float[Array, "nodes 3"]
    groups: tuple[Standable, ...]
    frame: Frame
    flat: float = _FLAT

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
            inside = (np.abs(corners[..., 2]) < self.flat).all(axis=1)
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
        # of a group that lies elsewhere there is nothing
        some = next(part for part in self._parts if len(part.elements))
        ends = self.nodes[some.elements[:, :2]]
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

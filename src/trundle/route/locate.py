"""Find the element under a place in plan, and where in it the place lies."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Float, Int
from scipy.spatial import cKDTree

from trundle._typing import Array
from trundle.errors import InputError
from trundle.structure import Floor
from trundle.structure.elements import ETA, XI

__all__ = ["Deck", "deck_of"]

_CANDIDATES = 12
_BLOCK = 20_000  # places looked up at once, to bound memory
_EDGE = 1e-6  # share of an element by which a place may lie outside it


@dataclass(frozen=True, kw_only=True, eq=False)
class Deck:
    """Hold the elements that wheels and points can stand on, with their places in plan.

    Attributes
    ----------
    elements : ndarray of int, shape (n_elements, 4 or 2)
        Node numbers of the shells, or of the beams where a floor has no shells.
    corners : ndarray of float, shape (n_elements, 4 or 2, 2)
        Coordinates in plan [m].
    """

    elements: Int[Array, "elements corners"]
    corners: Float[Array, "elements corners 2"]

    @property
    def is_line(self) -> bool:
        """True for a floor that is only beams."""
        return self.elements.shape[1] == 2

    @cached_property
    def _tree(self) -> cKDTree:
        return cKDTree(self.corners.mean(axis=1))

    @property
    def extent(self) -> tuple[Float[Array, " 2"], Float[Array, " 2"]]:
        """Lowest and highest x, y of the deck [m]."""
        flat = self.corners.reshape(-1, 2)
        return flat.min(axis=0), flat.max(axis=0)

    def find(self, places: Float[Array, "n 2"]) -> tuple[Int[Array, " n"], Float[Array, "n 2"]]:
        """Return the element under each place, and its coordinates in -1 to 1 there.

        Raises
        ------
        InputError
            A place that no element lies under.
        """
        if len(places) > _BLOCK:
            blocks = [self.find(places[i : i + _BLOCK]) for i in range(0, len(places), _BLOCK)]
            found, local = zip(*blocks, strict=True)
            return np.concatenate(found), np.concatenate(local)
        n_near = min(_CANDIDATES, len(self.elements))
        _, near = self._tree.query(places, k=n_near)
        near = np.asarray(near).reshape(len(places), n_near)
        inverse = self._on_line if self.is_line else self._on_quad
        local = inverse(np.repeat(places, n_near, axis=0), near.ravel())
        local = local.reshape(len(places), n_near, 2)
        overshoot = np.abs(local).max(axis=2) - 1.0
        best = overshoot.argmin(axis=1)
        rows = np.arange(len(places))
        worst = overshoot[rows, best]
        found, local = near[rows, best], local[rows, best]
        lost = np.flatnonzero(worst > _EDGE)
        if lost.size:
            # On a graded mesh the element under a place can have a centre far from it.
            found[lost], local[lost], worst[lost] = self._search_all(places[lost])
        if np.any(worst > _EDGE):
            bad = int(worst.argmax())
            low, high = self.extent
            raise InputError(
                f"point ({places[bad, 0]:g}, {places[bad, 1]:g}) m is not on the floor, which "
                f"covers x {low[0]:g} to {high[0]:g} m and y {low[1]:g} to {high[1]:g} m"
            )
        return found, np.clip(local, -1.0, 1.0)

    def _search_all(self, places: Array) -> tuple[Array, Array, Array]:
        """Return element, local place and overshoot among all elements that could hold it."""
        low, high = self.corners.min(axis=1) - _EDGE, self.corners.max(axis=1) + _EDGE
        inverse = self._on_line if self.is_line else self._on_quad
        found = np.zeros(len(places), dtype=np.intp)
        local = np.full((len(places), 2), np.inf)
        overshoot = np.full(len(places), np.inf)
        for i, place in enumerate(places):
            near = np.flatnonzero(((low <= place) & (place <= high)).all(axis=1))
            if near.size:
                tried = inverse(np.broadcast_to(place, (len(near), 2)), near)
                outside = np.abs(tried).max(axis=1) - 1.0
                best = int(outside.argmin())
                found[i], local[i], overshoot[i] = near[best], tried[best], outside[best]
        return found, local, overshoot

    def _on_quad(self, places: Array, elements: Array) -> Array:
        """Invert the bilinear map by Newton's method; exact in one step on a parallelogram."""
        corners = self.corners[elements]
        local = np.zeros((len(places), 2))
        for _ in range(8):
            xi, eta = local[:, :1], local[:, 1:]
            shape = 0.25 * (1 + xi * XI) * (1 + eta * ETA)
            d_xi, d_eta = (
                0.25 * XI * (1 + eta * ETA),
                0.25 * ETA * (1 + xi * XI),
            )
            gap = places - np.einsum("na,naj->nj", shape, corners)
            jacobian = np.stack(
                [np.einsum("na,naj->nj", d, corners) for d in (d_xi, d_eta)], axis=2
            )
            step = np.linalg.solve(jacobian, gap[:, :, None])[:, :, 0]
            local = np.clip(local + step, -4.0, 4.0)
            if np.abs(step).max() < 1e-12:
                break
        return local

    def _on_line(self, places: Array, elements: Array) -> Array:
        start, end = self.corners[elements, 0], self.corners[elements, 1]
        along = end - start
        length = np.linalg.norm(along, axis=1)
        direction = along / length[:, None]
        gap = places - start
        across = gap[:, 0] * direction[:, 1] - gap[:, 1] * direction[:, 0]
        xi = 2.0 * np.sum(gap * direction, axis=1) / length - 1.0
        return np.stack([xi, np.where(np.abs(across) < _EDGE * length, 0.0, 9.0)], axis=1)


def deck_of(floor: Floor) -> Deck:
    """Return the deck of a floor: its level shells, or its level beams if it has none.

    Raises
    ------
    InputError
        No level element, or level shells at more than one height.
    """
    groups = floor.shells if floor.shells else floor.beams
    elements = np.vstack([group.elements for group in groups])
    corners = floor.nodes[elements]
    height = corners[:, :, 2]
    level = np.ptp(height, axis=1) < 1e-6
    if not np.any(level):
        raise InputError(f"{floor.name}: no level element for a wheel to stand on")
    if np.ptp(height[level]) > 1e-6:
        raise InputError(
            f"{floor.name}: level elements at {height[level].min():g} and "
            f"{height[level].max():g} m; a vehicle needs a floor of one height"
        )
    return Deck(elements=elements[level], corners=np.ascontiguousarray(corners[level][:, :, :2]))

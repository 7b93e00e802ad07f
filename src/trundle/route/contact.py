"""Form the contact operator H: from floor dofs to the floor's height under a wheel.

One operator serves the loading of the floor (its transpose), the motion that a coupled
wheel feels, and the reading of a response at a point.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from jaxtyping import Float, Int
from scipy import sparse

from trundle._typing import Array
from trundle.errors import InputError
from trundle.route.locate import Deck, deck_of
from trundle.structure import Floor
from trundle.structure.elements import ETA, XI

__all__ = ["ContactRows", "ContactShape", "Hat", "Hermite", "contact_rows"]

_UZ, _RX, _RY = 2, 3, 4
_ON_PLANE = 1e-6  # m, and sine of the angle to a mirror plane


@dataclass(frozen=True)
class Hermite:
    """Interpolate deflection with the nodes' rotations, smooth across element borders.

    On a rectangle this is the bicubic Hermite surface without twist at the nodes: deflection
    and slope are continuous, so a wheel does not rattle over mesh lines.
    """

    def __str__(self) -> str:
        """Describe the interpolation for a report."""
        return "smooth (C1 Hermite)"


@dataclass(frozen=True)
class Hat:
    """Interpolate deflection linearly between nodes: the paper's triangular functions.

    A wheel at speed V then meets a kink every element of size h, which excites V/h and its
    multiples.
    """

    def __str__(self) -> str:
        """Describe the interpolation for a report."""
        return "hat functions between nodes"


ContactShape: TypeAlias = Hermite | Hat
"""How deflection is interpolated between the nodes of an element."""


@dataclass(frozen=True, kw_only=True, eq=False)
class ContactRows:
    """Hold rows of the contact operator, each over the few dofs of one element.

    Attributes
    ----------
    dofs : ndarray of int, shape (n_rows, width)
        Row numbers in the floor's matrices; 0 with no weight where a dof is held.
    value : ndarray of float, shape (n_rows, width)
        Weights that give the deflection [m].
    slope : ndarray of float, shape (n_rows, width)
        Weights that give its derivative along the direction of travel [m/m].
    load_share : ndarray of float, shape (n_rows,)
        Share of a wheel's force that the modelled part of the floor carries: one half for
        a wheel that drives along a mirror plane, one elsewhere.
    n_dofs : int
        Number of dofs of the floor.
    """

    dofs: Int[Array, "rows width"]
    value: Float[Array, "rows width"]
    slope: Float[Array, "rows width"]
    load_share: Float[Array, " rows"]
    n_dofs: int

    def used_dofs(self) -> Int[Array, " dofs"]:
        """Return the dofs on which any row has a weight, rising."""
        return np.unique(self.dofs[(self.value != 0.0) | (self.slope != 0.0)])

    def part(self, rows: slice) -> ContactRows:
        """Return some of the rows."""
        return ContactRows(
            dofs=self.dofs[rows],
            value=self.value[rows],
            slope=self.slope[rows],
            load_share=self.load_share[rows],
            n_dofs=self.n_dofs,
        )

    def matrix(self, weights: Float[Array, "rows width"]) -> sparse.csr_array:
        """Return weights as a sparse matrix of shape (n_rows, n_dofs)."""
        n, width = self.dofs.shape
        starts = np.arange(0, n * width + 1, width)
        return sparse.csr_array(
            (weights.ravel(), self.dofs.ravel(), starts), shape=(n, self.n_dofs)
        )

    def scaled(
        self, share: Float[Array, " rows"], share_slope: Float[Array, " rows"]
    ) -> ContactRows:
        """Return rows for wheels that the floor carries only in part.

        The share g varies along the route, so ``d(g H)/ds = g' H + g dH/ds``.
        """
        return ContactRows(
            dofs=self.dofs,
            value=share[:, None] * self.value,
            slope=share_slope[:, None] * self.value + share[:, None] * self.slope,
            load_share=self.load_share,
            n_dofs=self.n_dofs,
        )


def contact_rows(
    floor: Floor,
    places: Float[Array, "n 2"],
    directions: Float[Array, "n 2"],
    *,
    shape: ContactShape,
    deck: Deck | None = None,
) -> ContactRows:
    """Form one row of the contact operator, and of its slope, for each place.

    Parameters
    ----------
    floor : Floor
        The floor.
    places : ndarray of float, shape (n, 2)
        Places in plan [m].
    directions : ndarray of float, shape (n, 2)
        Unit vectors along which the slope is taken.
    shape : Hermite or Hat
        Interpolation.
    deck : Deck, optional
        Result of `deck_of` for this floor, to save finding it again.

    Returns
    -------
    ContactRows
        One row a place.

    Raises
    ------
    InputError
        A place off the floor.
    """
    deck = deck or deck_of(floor)
    elements, local = deck.find(places)
    corners = deck.corners[elements]
    if deck.is_line:
        value, gradient = _line_weights(local[:, 0], corners, shape)
    else:
        value, gradient = _quad_weights(local, corners, shape)
    along = np.einsum("njk,nj->nk", gradient, directions)
    dofs = floor.dof_index[deck.elements[elements]][:, :, [_UZ, _RX, _RY]]
    dofs = dofs.reshape(len(places), -1)
    free = dofs >= 0
    return ContactRows(
        dofs=np.where(free, dofs, 0),
        value=np.where(free, value, 0.0),
        slope=np.where(free, along, 0.0),
        load_share=_load_share(floor, places, directions),
        n_dofs=floor.n_dofs,
    )


def _load_share(floor: Floor, places: Array, directions: Array) -> Array:
    share = np.ones(len(places))
    for mirror in floor.mirrors:
        in_plane = np.abs(places[:, mirror.axis] - mirror.position) < _ON_PLANE
        # A wheel that only crosses the plane is on it for no time at all.
        along = np.abs(directions[:, mirror.axis]) < _ON_PLANE
        share[in_plane & along] *= 0.5
    return share


def _cubic(t: Array) -> tuple[Array, Array, Array, Array]:
    """Return Hermite's value and slope functions of both ends, and their derivatives.

    t runs from -1 to 1; arrays of shape (n, 2), one column an end.
    """
    value = np.stack([0.25 * (1 - t) ** 2 * (2 + t), 0.25 * (1 + t) ** 2 * (2 - t)], axis=1)
    slope = np.stack([0.25 * (1 - t) ** 2 * (1 + t), 0.25 * (1 + t) ** 2 * (t - 1)], axis=1)
    d_value = np.stack([0.75 * (t**2 - 1), 0.75 * (1 - t**2)], axis=1)
    d_slope = np.stack([0.25 * (3 * t**2 - 2 * t - 1), 0.25 * (3 * t**2 + 2 * t - 1)], axis=1)
    return value, slope, d_value, d_slope


def _quad_weights(local: Array, corners: Array, shape: ContactShape) -> tuple[Array, Array]:
    """Return weights (n, 12) on (uz, rx, ry) of four nodes and their x, y gradients."""
    xi, eta = local[:, :1], local[:, 1:]
    linear = 0.25 * (1 + xi * XI) * (1 + eta * ETA)
    d_linear = np.stack([0.25 * XI * (1 + eta * ETA), 0.25 * ETA * (1 + xi * XI)], axis=1)
    if isinstance(shape, Hat):
        value = _spread(linear)
        natural = np.stack([_spread(d_linear[:, 0]), _spread(d_linear[:, 1])], axis=1)
    else:
        value, natural = _hermite_quad(local, corners)
    jacobian = np.einsum("nia,naj->nij", d_linear, corners)
    return value, np.linalg.solve(jacobian, natural)


def _spread(on_deflection: Array) -> Array:
    weights = np.zeros((len(on_deflection), on_deflection.shape[1], 3))
    weights[:, :, 0] = on_deflection
    return weights.reshape(len(weights), -1)


_Pair: TypeAlias = tuple[Array, Array]  # functions of xi and of eta, multiplied at a node


def _hermite_quad(local: Array, corners: Array) -> tuple[Array, Array]:
    fx, gx, dfx, dgx = _cubic(local[:, 0])
    fy, gy, dfy, dgy = _cubic(local[:, 1])
    i, j = (XI > 0).astype(int), (ETA > 0).astype(int)
    # Edge vectors at each node turn its rotations into slopes along xi and eta:
    # dw/dx = -ry and dw/dy = rx.
    edges = [_node_edges(corners, axis) for axis in (0, 1)]

    # On a quadrilateral that is no parallelogram a plane has a twist in xi and eta; taking it
    # from the nodes' slopes keeps planes, and so a load's moments, exact. Zero on rectangles.
    twist = 0.25 * np.einsum("a,nak->nk", XI * ETA, corners)[:, None, :]

    def combine(deflection: _Pair, along_xi: _Pair, along_eta: _Pair, both: _Pair) -> Array:
        on_xi, on_eta, on_both = (
            pair[0][:, i] * pair[1][:, j] for pair in (along_xi, along_eta, both)
        )
        weights = np.empty((len(local), 4, 3))
        weights[:, :, 0] = deflection[0][:, i] * deflection[1][:, j]
        for dof, component, sign in ((1, 1, 1.0), (2, 0, -1.0)):
            weights[:, :, dof] = sign * (
                on_xi * edges[0][:, :, component]
                + on_eta * edges[1][:, :, component]
                + on_both * twist[:, :, component]
            )
        return weights.reshape(len(local), 12)

    value = combine((fx, fy), (gx, fy), (fx, gy), (gx, gy))
    d_xi = combine((dfx, fy), (dgx, fy), (dfx, gy), (dgx, gy))
    d_eta = combine((fx, dfy), (gx, dfy), (fx, dgy), (gx, dgy))
    return value, np.stack([d_xi, d_eta], axis=1)


def _node_edges(corners: Array, axis: int) -> Array:
    """Return d(x, y)/dxi (axis 0) or d(x, y)/deta (axis 1) at each node, (n, 4, 2)."""
    pairs = [(0, 1), (0, 1), (3, 2), (3, 2)] if axis == 0 else [(0, 3), (1, 2), (1, 2), (0, 3)]
    return np.stack([0.5 * (corners[:, b] - corners[:, a]) for a, b in pairs], axis=1)


def _line_weights(xi: Array, corners: Array, shape: ContactShape) -> tuple[Array, Array]:
    """Return weights (n, 6) on (uz, rx, ry) of two nodes and their x, y gradients."""
    half = 0.5 * (corners[:, 1] - corners[:, 0])
    size = np.linalg.norm(half, axis=1)
    if np.any(size == 0.0):
        raise InputError("a beam under a wheel must have a length in plan")
    if isinstance(shape, Hat):
        value = _spread(np.stack([0.5 * (1 - xi), 0.5 * (1 + xi)], axis=1))
        slope = _spread(np.broadcast_to([-0.5, 0.5], (len(xi), 2)))
    else:
        f, g, df, dg = _cubic(xi)
        value, slope = (_hermite_line(a, b, half) for a, b in ((f, g), (df, dg)))
    direction = half / size[:, None] ** 2
    return value, direction[:, :, None] * slope[:, None, :]


def _hermite_line(on_deflection: Array, on_slope: Array, half: Array) -> Array:
    weights = np.empty((len(half), 2, 3))
    weights[:, :, 0] = on_deflection
    weights[:, :, 1] = on_slope * half[:, 1:]
    weights[:, :, 2] = -on_slope * half[:, :1]
    return weights.reshape(len(half), 6)

"""Interpolate the deflection of elements under a wheel: smooth, or with kinks at mesh lines.

A wheel stands between nodes. How a deflection runs from node to node along an edge is a
`ContactShape`; quadrilaterals and lines combine it over their corners.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple, Protocol, TypeAlias, runtime_checkable

import numpy as np
from jaxtyping import Float

from trundle._typing import Array
from trundle.errors import InputError

__all__ = [
    "ETA",
    "XI",
    "Alongside",
    "ContactShape",
    "Hat",
    "Hermite",
    "Located",
    "Weights",
    "line_locate",
    "line_weights",
    "quad_locate",
    "quad_weights",
    "triangle_locate",
    "triangle_weights",
]

XI = np.array([-1.0, 1.0, 1.0, -1.0])
ETA = np.array([-1.0, -1.0, 1.0, 1.0])
"""Corners of a quadrilateral in its own coordinates, in order round it."""

_NEWTON_STEPS = 8
_FOLD = 1e-9  # of its size squared: a determinant below that is none
_ARRIVED = 1e-5  # of an element's extent, by which the last step may miss a place
_EDGE = 1e-6  # of its length, that a place may lie beside a line


class Located(NamedTuple):
    """Say where in elements places lie.

    Attributes
    ----------
    local : ndarray of float, shape (n, 2)
        The element's own coordinates, moved onto it if they lie outside.
    outside : ndarray of float, shape (n,)
        By how much a place lies outside, in shares of the element; 0 or less inside, infinite
        where it lies so far out that nothing in the element's own coordinates leads to it.
    """

    local: Float[Array, "n 2"]
    outside: Float[Array, " n"]


class Weights(NamedTuple):
    """Hold weights on the nodes' deflection w and rotations about the surface's axes x, y.

    Attributes
    ----------
    value : ndarray of float, shape (n, 3 nodes)
        Weights that give the deflection at a place [m].
    gradient : ndarray of float, shape (n, 2, 3 nodes)
        Weights that give its derivatives along x and y [m/m].
    """

    value: Float[Array, "n width"]
    gradient: Float[Array, "n 2 width"]


class Alongside(NamedTuple):
    """Hold functions of both ends of an edge at t from -1 to 1, shape (n, 2), one column an end.

    `value` multiplies the ends' deflections, `slope` their slopes in t; then derivatives in t.
    """

    value: Float[Array, "n 2"]
    slope: Float[Array, "n 2"]
    d_value: Float[Array, "n 2"]
    d_slope: Float[Array, "n 2"]


@runtime_checkable
class ContactShape(Protocol):
    """How deflection is interpolated between the nodes of an element."""

    @property
    def kinks(self) -> bool:
        """Whether a wheel meets a kink at every mesh line."""
        ...

    def alongside(self, t: Float[Array, " n"]) -> Alongside:
        """Return the functions of both ends of an edge."""
        ...


@dataclass(frozen=True)
class Hermite:
    """Interpolate deflection with the nodes' rotations.

    On a rectangle this is the bicubic Hermite surface without twist at the nodes: deflection
    and slope are continuous, so a wheel does not rattle over mesh lines. Between elements of other
    shapes deflection is continuous, and its slope along their border; the slope across it steps
    by what the mesh leaves.
    """

    @property
    def kinks(self) -> bool:
        """Whether a wheel meets a kink at every mesh line: no."""
        return False

    def alongside(self, t: Float[Array, " n"]) -> Alongside:
        """Return Hermite's cubics."""
        return Alongside(
            np.stack([0.25 * (1 - t) ** 2 * (2 + t), 0.25 * (1 + t) ** 2 * (2 - t)], axis=1),
            np.stack([0.25 * (1 - t) ** 2 * (1 + t), 0.25 * (1 + t) ** 2 * (t - 1)], axis=1),
            np.stack([0.75 * (t**2 - 1), 0.75 * (1 - t**2)], axis=1),
            np.stack([0.25 * (3 * t**2 - 2 * t - 1), 0.25 * (3 * t**2 + 2 * t - 1)], axis=1),
        )

    def __str__(self) -> str:
        """Describe the interpolation for a report."""
        return "smooth (cubic Hermite)"


@dataclass(frozen=True)
class Hat:
    """Interpolate deflection linearly between nodes: the paper's triangular functions.

    A wheel at speed V then meets a kink every element of size h, which excites V/h and its
    multiples.
    """

    @property
    def kinks(self) -> bool:
        """Whether a wheel meets a kink at every mesh line: yes."""
        return True

    def alongside(self, t: Float[Array, " n"]) -> Alongside:
        """Return straight lines, which know of no slopes."""
        value = np.stack([0.5 * (1 - t), 0.5 * (1 + t)], axis=1)
        none = np.zeros_like(value)
        return Alongside(value, none, np.broadcast_to([-0.5, 0.5], value.shape), none)

    def __str__(self) -> str:
        """Describe the interpolation for a report."""
        return "hat functions between nodes"


def quad_locate(corners: Float[Array, "n 4 2"], places: Float[Array, "n 2"]) -> Located:
    """Invert the bilinear map by Newton's method; exact in one step on a parallelogram.

    Parameters
    ----------
    corners : ndarray of float, shape (n, 4, 2)
        Corners of an element for each place, in order round it [m].
    places : ndarray of float, shape (n, 2)
        The places [m].
    """
    local = np.zeros((len(places), 2))
    # the same number of steps for all, so that it does not matter which are looked up together
    for _ in range(_NEWTON_STEPS):
        xi, eta = local[:, :1], local[:, 1:]
        slopes = (0.25 * XI * (1 + eta * ETA), 0.25 * ETA * (1 + xi * XI))
        gap = _quad_gap(local, corners, places)
        jacobian = np.stack([np.einsum("na,naj->nj", d, corners) for d in slopes], axis=2)
        # a convex element folds nowhere in itself: who stands on a fold is outside, and stays there
        folded = np.abs(np.linalg.det(jacobian)) < _FOLD * np.abs(jacobian).max(axis=(1, 2)) ** 2
        jacobian[folded], gap[folded] = np.eye(2), 0.0
        step = np.linalg.solve(jacobian, gap[:, :, None])[:, :, 0]
        local = np.clip(local + step, -4.0, 4.0)
    # Within a convex element the steps arrive; from a place outside they may still wander, through
    # coordinates of the inside too.
    missed = np.abs(_quad_gap(local, corners, places)).max(axis=1)
    lost = missed > _ARRIVED * np.ptp(corners, axis=1).max(axis=1)
    outside = np.where(lost, np.inf, np.abs(local).max(axis=1) - 1.0)
    return Located(np.clip(local, -1.0, 1.0), outside)


def _quad_gap(local: Array, corners: Array, places: Array) -> Array:
    """Return the way from where coordinates of elements are to places [m]."""
    shape = 0.25 * (1 + local[:, :1] * XI) * (1 + local[:, 1:] * ETA)
    return places - np.einsum("na,naj->nj", shape, corners)


def line_locate(corners: Float[Array, "n 2 2"], places: Float[Array, "n 2"]) -> Located:
    """Find places along lines: the first coordinate from -1 to 1, the second 0."""
    start, end = corners[:, 0], corners[:, 1]
    along = end - start
    length = np.linalg.norm(along, axis=1)
    direction = along / length[:, None]
    gap = places - start
    across = gap[:, 0] * direction[:, 1] - gap[:, 1] * direction[:, 0]
    xi = 2.0 * np.sum(gap * direction, axis=1) / length - 1.0
    beside = np.abs(across) >= _EDGE * length
    outside = np.where(beside, np.inf, np.abs(xi) - 1.0)
    return Located(np.stack([np.clip(xi, -1.0, 1.0), np.zeros_like(xi)], axis=1), outside)


def quad_weights(
    local: Float[Array, "n 2"], corners: Float[Array, "n 4 2"], shape: ContactShape
) -> Weights:
    """Return weights on (w, rx, ry) of four nodes."""
    xi, eta = local[:, :1], local[:, 1:]
    d_linear = np.stack([0.25 * XI * (1 + eta * ETA), 0.25 * ETA * (1 + xi * XI)], axis=1)
    value, natural = _quad_natural(local, corners, shape)
    jacobian = np.einsum("nia,naj->nij", d_linear, corners)
    return Weights(value, np.linalg.solve(jacobian, natural))


_Pair: TypeAlias = tuple[Array, Array]  # functions of xi and of eta, multiplied at a node


def _quad_natural(local: Array, corners: Array, shape: ContactShape) -> tuple[Array, Array]:
    """Return values and derivatives along xi and eta."""
    fx, gx, dfx, dgx = shape.alongside(local[:, 0])
    fy, gy, dfy, dgy = shape.alongside(local[:, 1])
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


def triangle_locate(corners: Float[Array, "n 3 2"], places: Float[Array, "n 2"]) -> Located:
    """Find places in triangles: area coordinates of the second and third corner."""
    sides = (corners[:, 1:] - corners[:, :1]).transpose(0, 2, 1)
    local = np.linalg.solve(sides, (places - corners[:, 0])[:, :, None])[:, :, 0]
    area = np.column_stack([1.0 - local.sum(axis=1), local])
    inside = np.maximum(area, 0.0)
    return Located((inside / inside.sum(axis=1, keepdims=True))[:, 1:], -area.min(axis=1))


def triangle_weights(
    local: Float[Array, "n 2"], corners: Float[Array, "n 3 2"], shape: ContactShape
) -> Weights:
    """Return weights on (w, rx, ry) of three nodes.

    Smooth: the cubic of Bazeley, Cheung, Irons and Zienkiewicz (1965), whose sides are Hermite's
    cubics as those of a quadrilateral are; planes and constant curvatures are exact. Across a side
    the slope is continuous at the nodes only.
    """
    area = np.column_stack([1.0 - local.sum(axis=1), local])
    sides = (corners[:, 1:] - corners[:, :1]).transpose(0, 2, 1)
    turn = np.linalg.inv(sides)  # rows: gradients of the second and third area coordinate
    slopes = np.concatenate([-turn.sum(axis=1, keepdims=True), turn], axis=1)  # (n, 3, 2)
    value, by_area = np.zeros((len(local), 3, 3)), np.zeros((len(local), 3, 3, 3))
    for i in range(3):
        value[:, i], by_area[:, i] = _triangle_node(area, corners, i, smooth=not shape.kinks)
    gradient = np.einsum("nkda,naj->njkd", by_area, slopes)
    return Weights(value.reshape(len(local), 9), gradient.reshape(len(local), 2, 9))


def _triangle_node(area: Array, corners: Array, i: int, *, smooth: bool) -> tuple[Array, Array]:
    """Return a node's weights (n, 3) on (w, rx, ry), and their derivatives by areas (n, 3, 3)."""
    j, k = (i + 1) % 3, (i + 2) % 3
    a, b, c = area[:, i], area[:, j], area[:, k]
    value, slopes = np.zeros((len(area), 3)), np.zeros((len(area), 3, 3))
    if not smooth:
        value[:, 0], slopes[:, 0, i] = a, 1.0
        return value, slopes
    value[:, 0] = a + a * a * b + a * a * c - a * b * b - a * c * c
    slopes[:, 0, i] = 1.0 + 2.0 * a * b + 2.0 * a * c - b * b - c * c
    slopes[:, 0, j], slopes[:, 0, k] = a * a - 2.0 * a * b, a * a - 2.0 * a * c
    for other, along in ((j, b), (k, c)):
        edge = corners[:, other] - corners[:, i]
        on_slope = a * a * along + 0.5 * a * b * c
        derivative = np.zeros((len(area), 3))
        derivative[:, i] = 2.0 * a * along + 0.5 * b * c
        derivative[:, j], derivative[:, k] = 0.5 * a * c, 0.5 * a * b
        derivative[:, other] += a * a
        # dw/dx = -ry and dw/dy = rx
        for dof, part in ((1, edge[:, 1]), (2, -edge[:, 0])):
            value[:, dof] += part * on_slope
            slopes[:, dof] += part[:, None] * derivative
    return value, slopes


def line_weights(
    local: Float[Array, "n 2"], corners: Float[Array, "n 2 2"], shape: ContactShape
) -> Weights:
    """Return weights on (w, rx, ry) of two nodes."""
    half = 0.5 * (corners[:, 1] - corners[:, 0])
    size = np.linalg.norm(half, axis=1)
    if np.any(size == 0.0):
        raise InputError("a beam under a wheel must have a length in plan")
    f, g, df, dg = shape.alongside(local[:, 0])
    value, slope = (_on_line(a, b, half) for a, b in ((f, g), (df, dg)))
    direction = half / size[:, None] ** 2
    return Weights(value, direction[:, :, None] * slope[:, None, :])


def _on_line(on_deflection: Array, on_slope: Array, half: Array) -> Array:
    weights = np.empty((len(half), 2, 3))
    weights[:, :, 0] = on_deflection
    weights[:, :, 1] = on_slope * half[:, 1:]
    weights[:, :, 2] = -on_slope * half[:, :1]
    return weights.reshape(len(half), 6)

"""Form stiffness and mass of flat three-node shells, all elements at once.

Bending is the discrete Kirchhoff triangle (DKT): straight normals stay normal at corners and
mid-sides, so plates bend without shear. Membrane is Felippa's optimal triangle (OPT) with drilling
rotations of its own, exact in the bending of a row of triangles in their plane whatever their
aspect.

References
----------
J.-L. Batoz, K.-J. Bathe and L.-W. Ho, Int. J. Numer. Meth. Eng. 15 (1980) 1771-1812 (DKT).
C. A. Felippa, Comput. Meth. Appl. Mech. Eng. 192 (2003) 2125-2168 (OPT).
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import permutations

import numpy as np
from jaxtyping import Bool, Float, Int

from trundle._checks import frozen_array, set_frozen
from trundle._typing import Array
from trundle.structure.elements.standing import (
    ContactShape,
    Hermite,
    Located,
    Weights,
    triangle_locate,
    triangle_weights,
)
from trundle.structure.frames import rotate_blocks, triangle_frames
from trundle.structure.sections import PlateSection

__all__ = ["TriangleGroup", "triangle_mass", "triangle_stiffness"]

_GAUSS = np.array([[1 / 6, 1 / 6], [2 / 3, 1 / 6], [1 / 6, 2 / 3]])  # exact for quadratic functions
_SEXTIC = tuple(  # Dunavant's rule of degree 6: area coordinates and weight of 12 places
    (np.array(sorted(set(permutations((a, b, 1.0 - a - b))))), weight)
    for a, b, weight in (
        (0.249286745170910, 0.249286745170910, 0.116786275726379),
        (0.063089014491502, 0.063089014491502, 0.050844906370207),
        (0.053145049844817, 0.310352451033784, 0.082851075618374),
    )
)
_UX, _UY, _UZ, _RX, _RY, _RZ = (np.arange(3) * 6 + i for i in range(6))
_MEMBRANE = np.array([0, 1, 5, 6, 7, 11, 12, 13, 17])  # ux, uy, rz of each node
_BENDING = np.array([2, 3, 4, 8, 9, 10, 14, 15, 16])  # uz, rx, ry of each node
_BASIC = 1.5  # Felippa's alpha_b
_BETA = np.array([[1.0, 2.0, 1.0], [0.0, 1.0, -1.0], [-1.0, -1.0, -2.0]])  # beta_1 to beta_9
_LEAST_HIGHER = 0.01  # of beta_0, which is (1 - 4 nu^2) / 2


def triangle_stiffness(
    corners: Float[Array, "elements 3 3"], section: PlateSection
) -> Float[Array, "elements 18 18"]:
    """Form the stiffness matrices in global axes.

    Parameters
    ----------
    corners : ndarray of float, shape (n_elements, 3, 3)
        Corner coordinates in order round the element [m].
    section : PlateSection
        Thickness and material.

    Returns
    -------
    ndarray of float, shape (n_elements, 18, 18)
        Per node ux, uy, uz [m], rx, ry, rz [rad], in global axes.

    Raises
    ------
    InputError
        An element that has no area.
    """
    local, frames = triangle_frames(corners)
    stiffness = np.zeros((len(corners), 18, 18))
    laws = section.laws(frames)
    _add(stiffness, _MEMBRANE, _membrane(local, laws.membrane, section.poisson_ratio))
    _add(stiffness, _BENDING, _bending(local, laws.bending))
    return rotate_blocks(stiffness, frames)


def triangle_mass(
    corners: Float[Array, "elements 3 3"], section: PlateSection
) -> Float[Array, "elements 18 18"]:
    """Form the consistent mass matrices in global axes.

    Translations carry slab and superimposed mass, by a deflection that is cubic between corners and
    a linear motion in the plane; rotations carry the slab's rotary inertia.

    Parameters
    ----------
    corners : ndarray of float, shape (n_elements, 3, 3)
        Corner coordinates [m].
    section : PlateSection
        Thickness, material, superimposed mass.

    Returns
    -------
    ndarray of float, shape (n_elements, 18, 18)
        Mass [kg], [kg m2].
    """
    local, frames = triangle_frames(corners)
    block = _area(local)[:, None, None] * (np.ones((3, 3)) + np.eye(3)) / 12.0
    mass = np.zeros((len(corners), 18, 18))
    for dofs in (_UX, _UY):
        _add(mass, dofs, section.mass_per_area * block)
    _add(mass, _BENDING, section.mass_per_area * _deflected(local))
    for dofs in (_RX, _RY, _RZ):
        _add(mass, dofs, section.rotary_inertia * block)
    return rotate_blocks(mass, frames)


def _deflected(local: Array) -> Array:
    """Return the integral of products of deflections by (uz, rx, ry), (n, 9, 9) [m2, m3, m4]."""
    out, area = np.zeros((len(local), 9, 9)), _area(local)
    for places, weight in _SEXTIC:
        for place in places:
            at = np.broadcast_to(place[1:], (len(local), 2))
            rows = triangle_weights(at, local, Hermite()).value
            out += (weight * area)[:, None, None] * rows[:, :, None] * rows[:, None, :]
    return out


def _add(matrices: Array, dofs: Array, block: Array) -> None:
    matrices[np.ix_(np.arange(len(matrices)), dofs, dofs)] += block


def _area(local: Array) -> Array:
    first, second = local[:, 1] - local[:, 0], local[:, 2] - local[:, 0]
    return 0.5 * (first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0])


def _differences(local: Array) -> tuple[Array, Array]:
    """Return ``x_i - x_j`` and ``y_i - y_j``, (n, 3, 3)."""
    x, y = local[:, :, 0], local[:, :, 1]
    return x[:, :, None] - x[:, None, :], y[:, :, None] - y[:, None, :]


def _membrane(local: Array, law: Array, nu: float) -> Array:
    """Return Felippa's template: a basic part for constant stress, a higher one for bending.

    The basic part lumps edge tractions of a constant stress to the corners, drilling moments with
    them. The higher part is made of strains along the three sides that the *hierarchical* rotations
    cause (rotation less that of the constant strain triangle); its nine numbers are those for which
    a rectangle of triangles bends exactly.
    """
    lumped = _lumping(local)
    basic = lumped @ law @ np.swapaxes(lumped, 1, 2) / _area(local)[:, None, None]
    share = 0.75 * max(0.5 * (1.0 - 4.0 * nu**2), _LEAST_HIGHER)
    rotations = _hierarchical(local)
    return basic + share * np.swapaxes(rotations, 1, 2) @ _higher(local, law) @ rotations


def _lumping(local: Array) -> Array:
    """Return forces at (ux, uy, rz) of the corners for unit stress resultants, (n, 9, 3)."""
    dx, dy = _differences(local)
    out = np.zeros((len(local), 9, 3))
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        y_jk, x_kj = dy[:, j, k], dx[:, k, j]
        out[:, 3 * i, 0], out[:, 3 * i, 2] = y_jk, x_kj
        out[:, 3 * i + 1, 1], out[:, 3 * i + 1, 2] = x_kj, y_jk
        out[:, 3 * i + 2, 0] = _BASIC / 6.0 * y_jk * (dy[:, i, k] - dy[:, j, i])
        out[:, 3 * i + 2, 1] = _BASIC / 6.0 * x_kj * (dx[:, k, i] - dx[:, i, j])
        out[:, 3 * i + 2, 2] = (
            _BASIC / 3.0 * (dx[:, k, i] * dy[:, i, k] - dx[:, i, j] * dy[:, j, i])
        )
    return 0.5 * out


def _hierarchical(local: Array) -> Array:
    """Return rotations at the corners less that of the constant strain triangle, (n, 3, 9)."""
    dx, dy = _differences(local)
    out = np.zeros((len(local), 3, 9))
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        out[:, :, 3 * i] = dx[:, k, j][:, None]
        out[:, :, 3 * i + 1] = dy[:, k, j][:, None]
    out /= 4.0 * _area(local)[:, None, None]
    out[:, np.arange(3), 3 * np.arange(3) + 2] = 1.0
    return out


def _higher(local: Array, law: Array) -> Array:
    """Return the stiffness against hierarchical rotations, (n, 3, 3)."""
    dx, dy = _differences(local)
    area = _area(local)
    sides = np.array([(1, 0), (2, 1), (0, 2)])  # 21, 32, 13
    square = dx[:, sides[:, 0], sides[:, 1]] ** 2 + dy[:, sides[:, 0], sides[:, 1]] ** 2
    # strains in x, y by strains along the three sides
    natural = np.empty((len(local), 3, 3))
    for side, (i, j, k) in enumerate(((0, 1, 2), (1, 2, 0), (2, 0, 1))):
        natural[:, 0, side] = dy[:, j, k] * dy[:, i, k]
        natural[:, 1, side] = dx[:, j, k] * dx[:, i, k]
        natural[:, 2, side] = dy[:, j, k] * dx[:, k, i] + dx[:, k, j] * dy[:, i, k]
    natural = natural * square[:, None, :] / (4.0 * area**2)[:, None, None]
    along = np.swapaxes(natural, 1, 2) @ law @ natural
    scale = 2.0 / 3.0 * area[:, None, None] / square[:, :, None]
    # strains along the sides at the corners, by the rotations: the same pattern turned round
    corner = [scale * _turned(i) for i in range(3)]
    out = np.zeros((len(local), 3, 3))
    for a, b in ((0, 1), (1, 2), (2, 0)):
        middle = 0.5 * (corner[a] + corner[b])
        out += np.swapaxes(middle, 1, 2) @ along @ middle
    return area[:, None, None] * out


def _turned(times: int) -> Array:
    """Return Felippa's nine numbers for a corner: rows and columns turned round so many times."""
    order = [(i - times) % 3 for i in range(3)]
    return _BETA[np.ix_(order, order)]


def _bending(local: Array, law: Array) -> Array:
    area = _area(local)
    out = np.zeros((len(local), 9, 9))
    for xi, eta in _GAUSS:
        rows = _curvatures(local, xi, eta)
        out += np.swapaxes(rows, 1, 2) @ (law @ rows) * (area / 3.0)[:, None, None]
    return out


def _curvatures(local: Array, xi: float, eta: float) -> Array:
    """Return B (n, 3, 9) of (bx,x; by,y; bx,y + by,x) by (w, rx, ry) of the corners.

    bx and by are the slopes of the normal, with ``rx = dw/dy`` and ``ry = -dw/dx`` at the corners.
    """
    by_xi, by_eta = (_slopes(local, *_quadratic_derivatives(xi, eta, axis)) for axis in (0, 1))
    first, second = local[:, 1] - local[:, 0], local[:, 2] - local[:, 0]
    twice = (2.0 * _area(local))[:, None]
    (x21, y21), (x31, y31) = first.T[:, :, None], second.T[:, :, None]
    slope_x, slope_y = (
        ((y31 * d_xi - y21 * d_eta) / twice, (x21 * d_eta - x31 * d_xi) / twice)
        for d_xi, d_eta in zip(by_xi, by_eta, strict=True)
    )
    return np.stack([slope_x[0], slope_y[1], slope_x[1] + slope_y[0]], axis=1)


def _quadratic_derivatives(xi: float, eta: float, axis: int) -> tuple[Array, Array]:
    """Return derivatives of the corner and the mid-side functions (23, 31, 12)."""
    zeta = 1.0 - xi - eta
    if axis == 0:
        return (
            np.array([1.0 - 4.0 * zeta, 4.0 * xi - 1.0, 0.0]),
            np.array([4.0 * eta, -4.0 * eta, 4.0 * (zeta - xi)]),
        )
    return (
        np.array([1.0 - 4.0 * zeta, 0.0, 4.0 * eta - 1.0]),
        np.array([4.0 * xi, 4.0 * (zeta - eta), -4.0 * xi]),
    )


def _slopes(local: Array, corner: Array, middle: Array) -> tuple[Array, Array]:
    """Return slopes of the normal along x and y by (w, rx, ry), (n, 9) each.

    Batoz's H_x and H_y with given (derivatives of) shape functions; side k lies opposite to corner
    k, and its cubic deflection gives the slope at its middle.
    """
    dx, dy = _differences(local)
    i, j = np.array([1, 2, 0]), np.array([2, 0, 1])
    x, y = dx[:, i, j], dy[:, i, j]
    square = x**2 + y**2
    a, b = -x / square, 0.75 * x * y / square
    c, d = (0.25 * x**2 - 0.5 * y**2) / square, -y / square
    e = (0.25 * y**2 - 0.5 * x**2) / square
    h_x, h_y = np.empty((len(local), 9)), np.empty((len(local), 9))
    for k in range(3):
        # sides that meet at corner k: the one before it (p) and the one behind it (q)
        p, q = (k + 1) % 3, (k + 2) % 3
        n_p, n_q = middle[p], middle[q]
        h_x[:, 3 * k] = 1.5 * (a[:, q] * n_q - a[:, p] * n_p)
        h_x[:, 3 * k + 1] = b[:, p] * n_p + b[:, q] * n_q
        h_x[:, 3 * k + 2] = corner[k] - c[:, p] * n_p - c[:, q] * n_q
        h_y[:, 3 * k] = 1.5 * (d[:, q] * n_q - d[:, p] * n_p)
        h_y[:, 3 * k + 1] = -corner[k] + e[:, p] * n_p + e[:, q] * n_q
        h_y[:, 3 * k + 2] = -b[:, p] * n_p - b[:, q] * n_q
    return h_x, h_y


@dataclass(frozen=True, kw_only=True, eq=False)
class TriangleGroup:
    """Hold flat three-node shells of one section.

    Attributes
    ----------
    connectivity : ndarray of int, shape (n_elements, 3)
        Node numbers, in order round each element.
    section : PlateSection
        Thickness, material and superimposed mass.
    name : str
        What the group is: ``slab`` ...
    """

    connectivity: Int[Array, "elements 3"]
    section: PlateSection
    name: str = "slab"

    def __post_init__(self) -> None:
        """Freeze the connectivity."""
        numbers = frozen_array("elements", self.connectivity, shape=(None, 3), dtype=np.intp)
        set_frozen(self, connectivity=numbers)

    @property
    def of_one_section(self) -> bool:
        """True: elements of one shape have the same matrices."""
        return True

    @property
    def stands_on_ground(self) -> bool:
        """Whether an end may be rigid ground."""
        return False

    @property
    def damping_ratio(self) -> float | None:
        """Ratio of critical damping of what they are made of, if known."""
        return self.section.damping_ratio

    @property
    def carried(self) -> Bool[Array, " 6"]:
        """All six: membrane, bending and drilling."""
        return np.ones(6, dtype=bool)

    def stiffness_blocks(
        self, xyz: Float[Array, "elements 3 3"]
    ) -> Float[Array, "elements dofs dofs"]:
        """Return the stiffness of each element, see `triangle_stiffness`."""
        return triangle_stiffness(xyz, self.section)

    def mass_blocks(self, xyz: Float[Array, "elements 3 3"]) -> Float[Array, "elements dofs dofs"]:
        """Return the mass of each element, see `triangle_mass`."""
        return triangle_mass(xyz, self.section)

    def locate(self, corners: Float[Array, "n 3 2"], places: Float[Array, "n 2"]) -> Located:
        """Return where in elements places lie, see `triangle_locate`."""
        return triangle_locate(corners, places)

    def weights(
        self, local: Float[Array, "n 2"], corners: Float[Array, "n 3 2"], shape: ContactShape
    ) -> Weights:
        """Return what the nodes' motion gives at places, see `triangle_weights`."""
        return triangle_weights(local, corners, shape)

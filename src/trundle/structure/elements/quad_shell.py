"""Form stiffness and mass of flat four-node shells, all elements at once.

Bending is MITC4, membrane is the four-node element with Taylor's incompatible modes, and
the drilling rotation is tied to the membrane's in-plane rotation by a penalty of the shear
stiffness, so that all six rigid-body motions cost no energy.

References
----------
E. N. Dvorkin and K. J. Bathe, Eng. Comput. 1 (1984) 77-88 (MITC4).
R. L. Taylor, P. J. Beresford and E. L. Wilson, Int. J. Numer. Meth. Eng. 10 (1976)
1211-1219 (QM6).
T. J. R. Hughes and F. Brezzi, Comput. Meth. Appl. Mech. Eng. 72 (1989) 105-121 (drilling).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Int

from trundle._checks import frozen_array, set_frozen
from trundle._typing import Array
from trundle.errors import InputError
from trundle.structure.elements.standing import (
    ETA,
    XI,
    ContactShape,
    Located,
    Weights,
    quad_locate,
    quad_weights,
)
from trundle.structure.frames import rotate_blocks, shell_frames
from trundle.structure.sections import PlateSection

__all__ = ["ShellGroup", "shell_mass", "shell_stiffness"]

_GAUSS = 1.0 / np.sqrt(3.0)
_UX, _UY, _UZ, _RX, _RY, _RZ = (np.arange(4) * 6 + i for i in range(6))


def shell_stiffness(
    corners: Float[Array, "elements 4 3"], section: PlateSection
) -> Float[Array, "elements 24 24"]:
    """Form the stiffness matrices in global axes.

    Parameters
    ----------
    corners : ndarray of float, shape (n_elements, 4, 3)
        Corner coordinates in order round the element [m].
    section : PlateSection
        Thickness and material.

    Returns
    -------
    ndarray of float, shape (n_elements, 24, 24)
        Per node ux, uy, uz [m], rx, ry, rz [rad], in global axes.

    Raises
    ------
    InputError
        An element that is turned inside out or has no area.
    """
    local, frames = shell_frames(corners)
    stiffness = np.zeros((len(corners), 24, 24))
    laws = section.laws(frames)
    _add_membrane(stiffness, local, laws.membrane)
    _add_bending(stiffness, local, laws.bending)
    _add_transverse_shear(stiffness, local, laws.shear)
    _add_drilling(stiffness, local, laws.drilling)
    return rotate_blocks(stiffness, frames)


def shell_mass(
    corners: Float[Array, "elements 4 3"], section: PlateSection
) -> Float[Array, "elements 24 24"]:
    """Form the consistent mass matrices in global axes.

    Translations carry slab and superimposed mass; rotations carry the slab's rotary inertia
    ``density t^3 / 12`` (the drilling rotation too, so that the mass matrix is definite).

    Parameters
    ----------
    corners : ndarray of float, shape (n_elements, 4, 3)
        Corner coordinates [m].
    section : PlateSection
        Thickness, material, superimposed mass.

    Returns
    -------
    ndarray of float, shape (n_elements, 24, 24)
        Mass [kg], [kg m2].
    """
    local, frames = shell_frames(corners)
    rotary = section.rotary_inertia
    mass = np.zeros((len(corners), 24, 24))
    for xi, eta in _gauss_points():
        shape, _, det = _shape_functions(local, xi, eta)
        block = det[:, None, None] * np.outer(shape, shape)
        for dofs in (_UX, _UY, _UZ):
            mass[np.ix_(np.arange(len(corners)), dofs, dofs)] += section.mass_per_area * block
        for dofs in (_RX, _RY, _RZ):
            mass[np.ix_(np.arange(len(corners)), dofs, dofs)] += rotary * block
    return rotate_blocks(mass, frames)


def _gauss_points() -> list[tuple[float, float]]:
    return [(x * _GAUSS, y * _GAUSS) for x in (-1.0, 1.0) for y in (-1.0, 1.0)]


def _parent_derivatives(xi: float, eta: float) -> Array:
    return 0.25 * np.array([XI * (1 + eta * ETA), ETA * (1 + xi * XI)])


def _jacobian(local: Array, xi: float, eta: float) -> tuple[Array, Array]:
    """Return J with rows d(x, y)/dxi, d(x, y)/deta, and its determinant."""
    jacobian = np.einsum("ia,eaj->eij", _parent_derivatives(xi, eta), local)
    det = jacobian[:, 0, 0] * jacobian[:, 1, 1] - jacobian[:, 0, 1] * jacobian[:, 1, 0]
    if np.any(det <= 0.0):
        bad = int(np.argmin(det))
        raise InputError(
            f"shell element {bad} is turned inside out or has no area; "
            "list its four corners in order round the element"
        )
    return jacobian, det


def _shape_functions(local: Array, xi: float, eta: float) -> tuple[Array, Array, Array]:
    """Return N (4,), dN/d(x, y) (n, 2, 4) and det J (n,)."""
    shape = 0.25 * (1 + xi * XI) * (1 + eta * ETA)
    jacobian, det = _jacobian(local, xi, eta)
    gradient = np.linalg.solve(
        jacobian, np.broadcast_to(_parent_derivatives(xi, eta), (len(local), 2, 4))
    )
    return shape, gradient, det


def _strain_rows(gradient: Array) -> Array:
    """Return B (n, 3, 8) of ex, ey, gxy for the columns (u1..u4, v1..v4)."""
    rows = np.zeros((len(gradient), 3, 8))
    rows[:, 0, :4] = gradient[:, 0]
    rows[:, 1, 4:] = gradient[:, 1]
    rows[:, 2, :4] = gradient[:, 1]
    rows[:, 2, 4:] = gradient[:, 0]
    return rows


def _quadratic_form(rows: Array, law: Array, other: Array, weight: Array) -> Array:
    return np.swapaxes(rows, 1, 2) @ (law @ other) * weight[:, None, None]


def _add_to(stiffness: Array, dofs: Array, block: Array) -> None:
    stiffness[np.ix_(np.arange(len(stiffness)), dofs, dofs)] += block


def _add_membrane(stiffness: Array, local: Array, law: Array) -> None:
    centre, centre_det = _jacobian(local, 0.0, 0.0)
    inverse = np.linalg.inv(centre)
    n = len(local)
    full = np.zeros((n, 12, 12))
    for xi, eta in _gauss_points():
        _, gradient, det = _shape_functions(local, xi, eta)
        rows = np.zeros((n, 3, 12))
        rows[:, :, :8] = _strain_rows(gradient)
        # Taylor's correction: the bubbles' gradients are taken at the centre and scaled by
        # det J0 / det J, so that they do no work on a constant stress (patch test).
        bubbles = np.array([[-2.0 * xi, 0.0], [0.0, -2.0 * eta]])
        bubble_gradient = (inverse @ bubbles) * (centre_det / det)[:, None, None]
        rows[:, 0, 8:10] = bubble_gradient[:, 0]
        rows[:, 1, 10:12] = bubble_gradient[:, 1]
        rows[:, 2, 8:10] = bubble_gradient[:, 1]
        rows[:, 2, 10:12] = bubble_gradient[:, 0]
        full += _quadratic_form(rows, law, rows, det)
    condensed = full[:, :8, :8] - full[:, :8, 8:] @ np.linalg.solve(
        full[:, 8:, 8:], full[:, 8:, :8]
    )
    _add_to(stiffness, np.concatenate([_UX, _UY]), condensed)


def _add_bending(stiffness: Array, local: Array, law: Array) -> None:
    for xi, eta in _gauss_points():
        _, gradient, det = _shape_functions(local, xi, eta)
        # beta_x = ry and beta_y = -rx turn the membrane's rows into curvatures.
        rows = _strain_rows(gradient)
        rows[:, :, 4:] *= -1.0
        _add_to(stiffness, np.concatenate([_RY, _RX]), _quadratic_form(rows, law, rows, det))


def _natural_shear(local: Array, xi: float, eta: float, direction: int) -> Array:
    """Return the covariant shear strain row (n, 12) for (w, rx, ry) at one tying point."""
    shape = 0.25 * (1 + xi * XI) * (1 + eta * ETA)
    jacobian, _ = _jacobian(local, xi, eta)
    row = np.zeros((len(local), 12))
    row[:, 0:4] = _parent_derivatives(xi, eta)[direction]
    row[:, 4:8] = -jacobian[:, direction, 1, None] * shape
    row[:, 8:12] = jacobian[:, direction, 0, None] * shape
    return row


def _add_transverse_shear(stiffness: Array, local: Array, law: Array) -> None:
    below, above = (_natural_shear(local, 0.0, side, 0) for side in (-1.0, 1.0))
    left, right = (_natural_shear(local, side, 0.0, 1) for side in (-1.0, 1.0))
    for xi, eta in _gauss_points():
        jacobian, det = _jacobian(local, xi, eta)
        natural = np.stack(
            [
                0.5 * ((1 - eta) * below + (1 + eta) * above),
                0.5 * ((1 - xi) * left + (1 + xi) * right),
            ],
            axis=1,
        )
        rows = np.linalg.solve(jacobian, natural)
        dofs = np.concatenate([_UZ, _RX, _RY])
        _add_to(stiffness, dofs, _quadratic_form(rows, law, rows, det))


def _add_drilling(stiffness: Array, local: Array, tie: float) -> None:
    # One point at the centre: more would lock the membrane in in-plane bending.
    shape, gradient, det = _shape_functions(local, 0.0, 0.0)
    row = np.zeros((len(local), 1, 12))
    row[:, 0, 0:4] = 0.5 * gradient[:, 1]
    row[:, 0, 4:8] = -0.5 * gradient[:, 0]
    row[:, 0, 8:12] = shape
    law = tie * np.eye(1)
    block = _quadratic_form(row, law, row, 4.0 * det)
    _add_to(stiffness, np.concatenate([_UX, _UY, _RZ]), block)
    _add_drilling_hourglass(stiffness, local, tie)


def _add_drilling_hourglass(stiffness: Array, local: Array, tie: float) -> None:
    """Hold the drilling patterns that the one-point penalty cannot see.

    Three patterns of the four rotations have no value at the centre; each is restrained by
    a small share of the penalty, orthogonal to a uniform rotation and so free of work in
    any rigid-body motion or constant strain.
    """
    patterns = np.array([XI, ETA, XI * ETA]) / 4.0
    _, det = _jacobian(local, 0.0, 0.0)
    share = 1e-3 * tie
    block = np.einsum("e,pa,pb->eab", 4.0 * det * share, patterns, patterns)
    _add_to(stiffness, _RZ, block)


@dataclass(frozen=True, kw_only=True, eq=False)
class ShellGroup:
    """Hold flat shells of one section.

    Attributes
    ----------
    elements : ndarray of int, shape (n_elements, 4)
        Node numbers, in order round each element.
    section : PlateSection
        Thickness, material and superimposed mass.
    name : str
        What the group is: ``slab`` ...
    """

    elements: Int[Array, "elements 4"]
    section: PlateSection
    name: str = "slab"

    def __post_init__(self) -> None:
        """Freeze the connectivity."""
        elements = frozen_array("elements", self.elements, shape=(None, 4), dtype=np.intp)
        set_frozen(self, elements=elements)

    @property
    def connectivity(self) -> Int[Array, "elements 4"]:
        """Node numbers of each element."""
        return self.elements

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
        self, xyz: Float[Array, "elements 4 3"]
    ) -> Float[Array, "elements dofs dofs"]:
        """Return the stiffness of each element, see `shell_stiffness`."""
        return shell_stiffness(xyz, self.section)

    def mass_blocks(self, xyz: Float[Array, "elements 4 3"]) -> Float[Array, "elements dofs dofs"]:
        """Return the mass of each element, see `shell_mass`."""
        return shell_mass(xyz, self.section)

    def locate(self, corners: Float[Array, "n 4 2"], places: Float[Array, "n 2"]) -> Located:
        """Return where in elements places lie, see `quad_locate`."""
        return quad_locate(corners, places)

    def weights(
        self, local: Float[Array, "n 2"], corners: Float[Array, "n 4 2"], shape: ContactShape
    ) -> Weights:
        """Return what the nodes' motion gives at places, see `quad_weights`."""
        return quad_weights(local, corners, shape)

"""Form stiffness and mass of straight Timoshenko members with rigid offsets, all at once.

The shape functions solve the unloaded Timoshenko beam exactly, so a static member needs no
more than one element and there is no shear locking; with infinite shear areas they are the
Bernoulli-Euler cubic.

References
----------
J. S. Przemieniecki, Theory of Matrix Structural Analysis (1968), section 5.6.
Z. Friedman and J. B. Kosmatka, Computers & Structures 47 (1993) 473-481.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Bool, Float, Int

from trundle._checks import frozen_array, set_frozen
from trundle._typing import Array
from trundle.structure.elements.standing import (
    ContactShape,
    Located,
    Weights,
    line_locate,
    line_weights,
)
from trundle.structure.frames import beam_frames, rotate_blocks
from trundle.structure.sections import BeamSection

__all__ = ["BeamGroup", "beam_mass", "beam_stiffness", "with_offset"]

_UP = (0.0, 0.0, 1.0)
_GAUSS_4 = np.polynomial.legendre.leggauss(4)
# Bending in the local x-z plane uses w and ry = -dw/dx; in the x-y plane v and rz = dv/dx.
_PLANE_XZ, _SIGN_XZ = np.array([2, 4, 8, 10]), np.array([1.0, -1.0, 1.0, -1.0])
_PLANE_XY, _SIGN_XY = np.array([1, 5, 7, 11]), np.array([1.0, 1.0, 1.0, 1.0])


def beam_stiffness(
    ends: Float[Array, "elements 2 3"],
    section: BeamSection,
    *,
    offset: Float[Array, " 3"],
    up: Float[Array, " 3"],
) -> Float[Array, "elements 12 12"]:
    """Form the stiffness matrices in global axes at the nodes.

    Parameters
    ----------
    ends : ndarray of float, shape (n_elements, 2, 3)
        Node coordinates [m].
    section : BeamSection
        Cross-section about its own centroid.
    offset : ndarray of float, shape (3,)
        From node to centroid, the same at both ends, in global axes [m]; a beam that hangs
        below its slab has a negative z.
    up : ndarray of float, shape (3,)
        Direction that the section's depth points to.

    Returns
    -------
    ndarray of float, shape (n_elements, 12, 12)
        Per node ux, uy, uz [m], rx, ry, rz [rad].
    """
    lengths, frames = beam_frames(ends, up)
    material = section.material
    local = np.zeros((len(ends), 12, 12))
    _add_bar(local, 0, material.elastic_modulus * section.area / lengths)
    _add_bar(local, 3, material.shear_modulus * section.torsion_constant / lengths)
    for plane, signs, inertia, shear_area in _planes(section):
        rigidity = material.elastic_modulus * inertia
        phi = _shear_parameter(rigidity, material.shear_modulus * shear_area, lengths)
        block = _bending_stiffness(rigidity, phi, lengths)
        local[np.ix_(np.arange(len(ends)), plane, plane)] += block * np.outer(signs, signs)
    return with_offset(rotate_blocks(local, frames), offset, lengths, frames[:, 0])


def beam_mass(
    ends: Float[Array, "elements 2 3"],
    section: BeamSection,
    *,
    offset: Float[Array, " 3"],
    up: Float[Array, " 3"],
) -> Float[Array, "elements 12 12"]:
    """Form the consistent mass matrices, rotary inertia included, in global axes.

    Parameters and shape as in `beam_stiffness`; masses in kg and kg m2.
    """
    lengths, frames = beam_frames(ends, up)
    density = section.material.density
    local = np.zeros((len(ends), 12, 12))
    bar = np.array([[2.0, 1.0], [1.0, 2.0]]) / 6.0
    polar = section.inertia_y + section.inertia_z
    for dof, mass_per_length in ((0, density * section.area), (3, density * polar)):
        pair = np.array([dof, dof + 6])
        local[np.ix_(np.arange(len(ends)), pair, pair)] += (
            mass_per_length * lengths[:, None, None] * bar
        )
    for plane, signs, inertia, shear_area in _planes(section):
        rigidity = section.material.elastic_modulus * inertia
        phi = _shear_parameter(rigidity, section.material.shear_modulus * shear_area, lengths)
        block = _bending_mass(density * section.area, density * inertia, phi, lengths)
        local[np.ix_(np.arange(len(ends)), plane, plane)] += block * np.outer(signs, signs)
    return with_offset(rotate_blocks(local, frames), offset, lengths, frames[:, 0])


def _planes(section: BeamSection) -> tuple[tuple[Array, Array, float, float], ...]:
    return (
        (_PLANE_XZ, _SIGN_XZ, section.inertia_y, section.shear_area_z),
        (_PLANE_XY, _SIGN_XY, section.inertia_z, section.shear_area_y),
    )


def _add_bar(local: Array, dof: int, stiffness: Array) -> None:
    local[:, dof, dof] += stiffness
    local[:, dof + 6, dof + 6] += stiffness
    local[:, dof, dof + 6] -= stiffness
    local[:, dof + 6, dof] -= stiffness


def _shear_parameter(rigidity: float, shear_rigidity: float, lengths: Array) -> Array:
    """Return Phi = 12 E I / (G As L^2); zero for an infinite shear area."""
    return 12.0 * rigidity / (shear_rigidity * lengths**2)


def _bending_stiffness(rigidity: float, phi: Array, length: Array) -> Array:
    """Return the 4 x 4 matrices for (w1, slope1, w2, slope2)."""
    factor = rigidity / ((1.0 + phi) * length**3)
    one = np.ones_like(length)
    rows = [
        [12 * one, 6 * length, -12 * one, 6 * length],
        [6 * length, (4 + phi) * length**2, -6 * length, (2 - phi) * length**2],
        [-12 * one, -6 * length, 12 * one, -6 * length],
        [6 * length, (2 - phi) * length**2, -6 * length, (4 + phi) * length**2],
    ]
    return np.moveaxis(np.array(rows), -1, 0) * factor[:, None, None]


def _bending_mass(line_mass: float, line_rotary: float, phi: Array, length: Array) -> Array:
    """Integrate the exact static shape functions; four Gauss points are exact for them."""
    mass = np.zeros((len(length), 4, 4))
    for point, weight in zip(*_GAUSS_4, strict=True):
        deflection, rotation = _shapes(0.5 * (1.0 + point), phi, length)
        half = (0.5 * weight * length)[:, None, None]
        mass += half * line_mass * deflection[:, :, None] * deflection[:, None, :]
        mass += half * line_rotary * rotation[:, :, None] * rotation[:, None, :]
    return mass


def _shapes(x: float, phi: Array, length: Array) -> tuple[Array, Array]:
    """Return deflection and section rotation at x (share of the length), shape (n, 4)."""
    d = 1.0 + phi
    deflection = [
        (1 - 3 * x**2 + 2 * x**3 + phi * (1 - x)) / d,
        length * (x - 2 * x**2 + x**3 + 0.5 * phi * (x - x**2)) / d,
        (3 * x**2 - 2 * x**3 + phi * x) / d,
        length * (-(x**2) + x**3 - 0.5 * phi * (x - x**2)) / d,
    ]
    rotation = [
        6 * (-x + x**2) / (d * length),
        (1 - 4 * x + 3 * x**2 + phi * (1 - x)) / d,
        6 * (x - x**2) / (d * length),
        (-2 * x + 3 * x**2 + phi * x) / d,
    ]
    return np.stack(deflection, axis=1), np.stack(rotation, axis=1)


def with_offset(
    matrices: Float[Array, "elements 12 12"],
    offset: Float[Array, " 3"],
    lengths: Float[Array, " elements"],
    along: Float[Array, "elements 3"],
) -> Float[Array, "elements 12 12"]:
    """Move matrices from a member's centroid to its nodes, which lie off it.

    Parameters
    ----------
    matrices : ndarray of float, shape (n_elements, 12, 12)
        About the centroid, in global axes.
    offset : ndarray of float, shape (3,)
        From nodes to centroid [m].
    lengths : ndarray of float, shape (n_elements,)
        Lengths [m].
    along : ndarray of float, shape (n_elements, 3)
        Unit vectors along the members.

    Notes
    -----
    The centroid moves as a rigid arm does, ``u + theta x o``. Its section turns with the node and,
    where the member is twisted, further: a web under a slab that does not move sideways goes aside
    by ``o`` times the twist, and its section must turn with that line or be sheared. With the
    rate of twist ``tau = a . (theta_2 - theta_1) / L`` about the axis a, the angle that leaves
    twisting without shear is ``a x (tau a x o) = -tau o_across``. Sections that turned with the
    nodes alone would make torsion stiffer by ``G A_s o^2``, wherever nodes do not turn in the
    plane: a slab of elements with rotations of their own made a T several times too stiff.
    """
    ex, ey, ez = (float(component) for component in offset)
    link = np.eye(6)
    link[0, 4], link[0, 5] = ez, -ey
    link[1, 3], link[1, 5] = -ez, ex
    link[2, 3], link[2, 4] = ey, -ex
    transform = np.broadcast_to(np.kron(np.eye(2), link), matrices.shape).copy()
    across = offset - (along @ offset)[:, None] * along
    twisted = -across[:, :, None] * along[:, None, :] / lengths[:, None, None]
    for turned in (slice(3, 6), slice(9, 12)):
        transform[:, turned, 3:6] -= twisted
        transform[:, turned, 9:12] += twisted
    return np.swapaxes(transform, 1, 2) @ matrices @ transform


@dataclass(frozen=True, kw_only=True, eq=False)
class BeamGroup:
    """Hold straight members of one section, offset and orientation.

    Attributes
    ----------
    elements : ndarray of int, shape (n_elements, 2)
        Node numbers of the two ends.
    section : BeamSection
        Cross-section about its own centroid.
    offset : ndarray of float, shape (3,)
        From node to centroid in global axes [m].
    up : ndarray of float, shape (3,)
        Direction of the section's depth; members parallel to it use global x instead, and global z
        where they are along x.
    name : str
        What the group is: ``beam``, ``column`` ...
    """

    elements: Int[Array, "elements 2"]
    section: BeamSection
    offset: Float[Array, " 3"] = field(default_factory=lambda: np.zeros(3))
    up: Float[Array, " 3"] = field(default_factory=lambda: np.array(_UP))
    name: str = "beam"

    def __post_init__(self) -> None:
        """Freeze connectivity and vectors."""
        set_frozen(
            self,
            elements=frozen_array("elements", self.elements, shape=(None, 2), dtype=np.intp),
            offset=frozen_array("offset", self.offset, shape=(3,)),
            up=frozen_array("up", self.up, shape=(3,)),
        )

    @property
    def connectivity(self) -> Int[Array, "elements 2"]:
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
        return self.section.material.damping_ratio

    @property
    def carried(self) -> Bool[Array, " 6"]:
        """All six: stretch, bending, shear and torsion."""
        return np.ones(6, dtype=bool)

    def stiffness_blocks(
        self, xyz: Float[Array, "elements 2 3"]
    ) -> Float[Array, "elements dofs dofs"]:
        """Return the stiffness of each element, see `beam_stiffness`."""
        return beam_stiffness(xyz, self.section, offset=self.offset, up=self.up)

    def mass_blocks(self, xyz: Float[Array, "elements 2 3"]) -> Float[Array, "elements dofs dofs"]:
        """Return the mass of each element, see `beam_mass`."""
        return beam_mass(xyz, self.section, offset=self.offset, up=self.up)

    def locate(self, corners: Float[Array, "n 2 2"], places: Float[Array, "n 2"]) -> Located:
        """Return where along members places lie, see `line_locate`."""
        return line_locate(corners, places)

    def weights(
        self, local: Float[Array, "n 2"], corners: Float[Array, "n 2 2"], shape: ContactShape
    ) -> Weights:
        """Return what the nodes' motion gives at places, see `line_weights`."""
        return line_weights(local, corners, shape)

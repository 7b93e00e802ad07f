"""Hold plates that are not alike in all directions."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
from jaxtyping import Float

from trundle._checks import finite, frozen_array, non_negative, positive, set_frozen
from trundle._typing import Array
from trundle.errors import InputError
from trundle.structure.sections import PlateLaws

__all__ = ["UNSHEARED", "OrthotropicSection"]

UNSHEARED = 1e4
"""Times its shear stiffness, of a plate that other programs let not shear at all."""


@dataclass(frozen=True, kw_only=True, eq=False)
class OrthotropicSection:
    """Hold a plate with stiffnesses of its own along two axes.

    Attributes
    ----------
    bending : tuple of float
        ``(D_x, D_y, D_xy, D_t)``: moments ``M_x = D_x k_x + D_xy k_y``,
        ``M_y = D_xy k_x + D_y k_y``, ``M_xy = D_t k_xy``, of curvatures k with ``k_xy = 2 w,xy``
        [N m].
    membrane : tuple of float
        The same of forces by strains in the plane [N/m].
    shear : tuple of float
        Transverse shear stiffness along x and y [N/m].
    mass_per_area : float
        Plate and what lies on it [kg/m2].
    rotary_inertia : float
        Moment of inertia of the mass about the mid-plane [kg].
    damping_ratio : float or None
        Ratio of critical damping of what it is made of; None where it says nothing.
    axis : ndarray of float, shape (3,)
        Direction of x in space; its part in the plane counts.
    thickness : float
        Depth of the whole, for pictures and for beams that hang below it [m].
    """

    bending: tuple[float, float, float, float]
    membrane: tuple[float, float, float, float]
    shear: tuple[float, float]
    mass_per_area: float
    rotary_inertia: float = 0.0
    damping_ratio: float | None = None
    axis: Float[Array, " 3"] = field(default_factory=lambda: np.array([1.0, 0.0, 0.0]))
    thickness: float = 0.2

    def __post_init__(self) -> None:
        """Check that bending and stretching take energy in every direction."""
        for name in ("bending", "membrane"):
            x, y, both, twist = (finite(name, value) for value in getattr(self, name))
            if min(x, y, twist) <= 0.0 or both**2 >= x * y:
                raise InputError(
                    f"{name} stiffnesses must be above 0, and the coupling below the root of "
                    f"both; got {x:g}, {y:g}, {both:g}, {twist:g}"
                )
        set_frozen(
            self,
            shear=tuple(positive("shear stiffness", value) for value in self.shear),
            mass_per_area=non_negative("mass_per_area", self.mass_per_area),
            rotary_inertia=non_negative("rotary_inertia", self.rotary_inertia),
            axis=frozen_array("axis", self.axis, shape=(3,)),
            thickness=positive("thickness", self.thickness),
        )

    @property
    def poisson_ratio(self) -> float:
        """Geometric mean of both, of stretching."""
        x, y, both, _ = self.membrane
        return both / float(np.sqrt(x * y))

    def laws(self, frames: Float[Array, "elements 3 3"]) -> PlateLaws:
        """Return stiffnesses in the axes of elements, whose frames are rows x, y, z."""
        along = frames @ self.axis
        length = np.hypot(along[:, 0], along[:, 1])
        if np.any(length < 1e-6):
            raise InputError("the axis of an orthotropic plate stands upright on an element")
        cosine, sine = along[:, 0] / length, along[:, 1] / length
        strains = _strain_turn(cosine, sine)
        turn = np.stack([np.stack([cosine, sine], 1), np.stack([-sine, cosine], 1)], axis=1)
        return PlateLaws(
            membrane=_turned(_law(self.membrane), strains),
            bending=_turned(_law(self.bending), strains),
            shear=_turned(np.diag(self.shear), turn),
            drilling=self.membrane[3],
        )

    def turned(self, degrees: float) -> OrthotropicSection:
        """Return the same with its x axis turned in plan, counterclockwise from x [degrees]."""
        angle = np.deg2rad(finite("angle", degrees))
        return replace(self, axis=np.array([np.cos(angle), np.sin(angle), 0.0]))


def _law(stiffness: tuple[float, float, float, float]) -> Array:
    x, y, both, twist = stiffness
    return np.array([[x, both, 0.0], [both, y, 0.0], [0.0, 0.0, twist]])


def _strain_turn(c: Array, s: Array) -> Array:
    """Return strains (x, y, xy) along the plate's axes by those in an element's."""
    rows = [[c * c, s * s, c * s], [s * s, c * c, -c * s], [-2 * c * s, 2 * c * s, c * c - s * s]]
    return np.stack([np.stack(row, axis=1) for row in rows], axis=1)


def _turned(law: Array, turn: Array) -> Array:
    return np.swapaxes(turn, 1, 2) @ law @ turn

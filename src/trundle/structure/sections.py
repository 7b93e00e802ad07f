"""Describe materials and cross-sections as plain values."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float

from trundle._checks import non_negative, positive, set_frozen, within
from trundle._typing import Array

__all__ = ["CONCRETE", "BeamSection", "Material", "PlateLaws", "PlateSection", "ShellSection"]

_SHEAR_CORRECTION = 5.0 / 6.0  # of a solid section, for transverse shear


@dataclass(frozen=True, kw_only=True)
class Material:
    """Hold an isotropic linear elastic material.

    Attributes
    ----------
    elastic_modulus : float
        Young's modulus E [Pa]; for floors the dynamic value.
    poisson_ratio : float
        Poisson's ratio nu, at least 0 and below 0.5.
    density : float
        Mass density [kg/m3].
    damping_ratio : float or None
        Ratio of critical damping of what is made of it, see `ByMaterial`; None where it says
        nothing.
    """

    elastic_modulus: float
    poisson_ratio: float
    density: float
    damping_ratio: float | None = None

    def __post_init__(self) -> None:
        """Check the numbers."""
        if self.damping_ratio is not None:
            within("damping_ratio", self.damping_ratio, 0.0, 0.9999)
        set_frozen(
            self,
            elastic_modulus=positive("elastic_modulus", self.elastic_modulus),
            poisson_ratio=within("poisson_ratio", self.poisson_ratio, 0.0, 0.4999),
            density=non_negative("density", self.density),
        )

    @property
    def shear_modulus(self) -> float:
        """Shear modulus G = E / (2 (1 + nu)) [Pa]."""
        return self.elastic_modulus / (2.0 * (1.0 + self.poisson_ratio))


CONCRETE = Material(elastic_modulus=30e9, poisson_ratio=0.2, density=2450.0)
"""Reinforced concrete of the reference unit (trundle's stand-in for the paper's floor)."""


@dataclass(frozen=True, kw_only=True, eq=False)
class PlateLaws:
    """Hold the stiffnesses of a plate in the axes of elements, one for all or one each.

    Attributes
    ----------
    membrane : ndarray of float, shape (3, 3) or (n_elements, 3, 3)
        Forces by strains (x, y, xy) of the mid-plane [N/m].
    bending : ndarray of float, shape (3, 3) or (n_elements, 3, 3)
        Moments by curvatures (x, y, xy) [N m].
    shear : ndarray of float, shape (2, 2) or (n_elements, 2, 2)
        Transverse shear forces by shear strains (x, y) [N/m].
    drilling : float
        Size of what ties drilling rotations to the rotation in the plane [N/m].
    """

    membrane: Float[Array, "*many 3 3"]
    bending: Float[Array, "*many 3 3"]
    shear: Float[Array, "*many 2 2"]
    drilling: float


@runtime_checkable
class PlateSection(Protocol):
    """What a shell element asks of its section."""

    @property
    def damping_ratio(self) -> float | None:
        """Ratio of critical damping of what it is made of; None where it says nothing."""
        ...

    @property
    def thickness(self) -> float:
        """Whole depth [m]."""
        ...

    @property
    def mass_per_area(self) -> float:
        """Mass of plate and what lies on it [kg/m2]."""
        ...

    @property
    def rotary_inertia(self) -> float:
        """Moment of inertia of the mass about the mid-plane [kg]."""
        ...

    @property
    def poisson_ratio(self) -> float:
        """Ratio of Poisson, of stretching."""
        ...

    def laws(self, frames: Float[Array, "elements 3 3"]) -> PlateLaws:
        """Return stiffnesses in the axes of elements, whose frames are rows x, y, z."""
        ...


@dataclass(frozen=True, kw_only=True)
class ShellSection:
    """Hold a solid slab's thickness and material, and the mass that lies on it.

    Attributes
    ----------
    thickness : float
        Slab thickness [m].
    material : Material
        Material of the slab.
    superimposed_mass : float
        Mass that moves with the slab and adds no stiffness [kg/m2].
    """

    thickness: float
    material: Material
    superimposed_mass: float = 0.0

    def __post_init__(self) -> None:
        """Check thickness and mass."""
        set_frozen(
            self,
            thickness=positive("slab thickness", self.thickness),
            superimposed_mass=non_negative("superimposed_mass", self.superimposed_mass),
        )

    @property
    def damping_ratio(self) -> float | None:
        """Ratio of critical damping of its material, if known."""
        return self.material.damping_ratio

    @property
    def mass_per_area(self) -> float:
        """Translational mass of slab and superimposed load [kg/m2]."""
        return self.material.density * self.thickness + self.superimposed_mass

    @property
    def rotary_inertia(self) -> float:
        """Rotary inertia ``density t^3 / 12`` [kg]."""
        return self.material.density * self.thickness**3 / 12.0

    @property
    def poisson_ratio(self) -> float:
        """Ratio of Poisson, of stretching."""
        return self.material.poisson_ratio

    def laws(self, frames: Float[Array, "elements 3 3"]) -> PlateLaws:
        """Return its stiffnesses, the same in the axes of any element."""
        del frames
        return PlateLaws(
            membrane=self.thickness * self._plane_stress,
            bending=self.thickness**3 / 12.0 * self._plane_stress,
            shear=_SHEAR_CORRECTION * self.material.shear_modulus * self.thickness * np.eye(2),
            drilling=self.material.shear_modulus * self.thickness,
        )

    @property
    def _plane_stress(self) -> Array:
        nu = self.material.poisson_ratio
        factor = self.material.elastic_modulus / (1.0 - nu**2)
        return factor * np.array([[1.0, nu, 0.0], [nu, 1.0, 0.0], [0.0, 0.0, (1.0 - nu) / 2.0]])


@dataclass(frozen=True, kw_only=True)
class BeamSection:
    """Hold the properties of a beam or column cross-section about its own centroid.

    Attributes
    ----------
    area : float
        Cross-section area A [m2].
    inertia_y : float
        Second moment of area about the local y axis: bending in the local x-z plane [m4].
    inertia_z : float
        Second moment of area about the local z axis: bending in the local x-y plane [m4].
    torsion_constant : float
        Saint-Venant torsion constant J [m4].
    shear_area_y, shear_area_z : float
        Effective shear areas for shear along y and z [m2]; infinity gives a
        Bernoulli-Euler beam.
    material : Material
        Material of the section.
    """

    area: float
    inertia_y: float
    inertia_z: float
    torsion_constant: float
    shear_area_y: float
    shear_area_z: float
    material: Material

    def __post_init__(self) -> None:
        """Check every property."""
        names = ("area", "inertia_y", "inertia_z", "torsion_constant")
        set_frozen(self, **{name: positive(name, getattr(self, name)) for name in names})
        for name in ("shear_area_y", "shear_area_z"):
            value = float(getattr(self, name))
            set_frozen(self, **{name: value if value == np.inf else positive(name, value)})

    @classmethod
    def rectangle(cls, width: float, depth: float, material: Material) -> BeamSection:
        """Build a solid rectangle, width along local y and depth along local z [m].

        Shear areas are 5/6 of the area; the torsion constant is Saint-Venant's series in
        the closed form of Roark (Formulas for Stress and Strain, 7th ed., table 10.1, case 4),
        within 0.5 % of the series.
        """
        b, d = positive("width", width), positive("depth", depth)
        long, short = max(b, d) / 2.0, min(b, d) / 2.0
        slender = short / long
        torsion = long * short**3 * (16 / 3 - 3.36 * slender * (1 - slender**4 / 12.0))
        return cls(
            area=b * d,
            inertia_y=b * d**3 / 12.0,
            inertia_z=d * b**3 / 12.0,
            torsion_constant=torsion,
            shear_area_y=5.0 / 6.0 * b * d,
            shear_area_z=5.0 / 6.0 * b * d,
            material=material,
        )

    def scaled(self, factor: float) -> BeamSection:
        """Return the share of the section that belongs to a model cut on a symmetry plane.

        Area, second moments, torsion constant and shear areas are all multiplied, so
        stiffness and mass both are.
        """
        factor = positive("factor", factor)
        return BeamSection(
            area=self.area * factor,
            inertia_y=self.inertia_y * factor,
            inertia_z=self.inertia_z * factor,
            torsion_constant=self.torsion_constant * factor,
            shear_area_y=self.shear_area_y * factor,
            shear_area_z=self.shear_area_z * factor,
            material=self.material,
        )

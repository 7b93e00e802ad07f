"""Make sections of plates of what PSHELL, PCOMP and their materials say.

A plate stretches by ``A = T G1``, bends by ``D = (12 I / T^3) T^3 / 12 G2`` and shears by
``TS G3``; of a laminate these are the sums over its plies, each turned by its angle.

References
----------
MSC Nastran 2021 Quick Reference Guide, PSHELL and PCOMP; R. M. Jones, Mechanics of Composite
Materials (1999), section 4.2 (laminate stiffnesses).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from trundle._typing import Array
from trundle.errors import InputError
from trundle.imports.nastran_deck import Deck, Face, Laminate, PlaneLaw, Plate
from trundle.structure import Material, OrthotropicSection, ShellSection
from trundle.structure.plates import UNSHEARED

__all__ = ["axis_of", "is_turned", "plate_section"]

_SHEAR = 5.0 / 6.0
_ALIKE = 1e-3
_COUPLED = 1e-6  # of the largest stiffness: less couples nothing


def plate_section(deck: Deck, number: int) -> ShellSection | OrthotropicSection:
    """Return the section of a property, with its mass.

    Parameters
    ----------
    deck : Deck
        All cards.
    number : int
        Of a PSHELL or PCOMP that is there.

    Raises
    ------
    InputError
        Materials that are not there, or a laminate that couples stretching and bending.
    """
    plate = deck.shells[number]
    if isinstance(plate, Laminate):
        return _laminate(deck, plate, f"PCOMP {number}")
    where, more = f"PSHELL {number}", plate.more * deck.weight_to_mass
    stretching, _, shear = plate.materials
    if _is_solid(deck, plate):
        material = _material(deck, stretching, where)
        section = ShellSection(thickness=plate.thickness, material=material, superimposed_mass=more)
        return section if shear else _without_shear(section)
    return _plate(deck, plate, where, more)


def is_turned(deck: Deck, number: int) -> bool:
    """Return whether it matters which way the axis of a property's material points."""
    plate = deck.shells[number]
    return isinstance(plate, Laminate) or any(m in deck.laws for m in plate.materials)


def axis_of(face: Face, corners: Array, first: Array | None) -> tuple[float, float, float]:
    """Return the direction of a face's material axis: in its plane, of unit length.

    Parameters
    ----------
    face : Face
        With an angle, or a system.
    corners : ndarray of float, shape (n_corners, 3)
        Its places [m].
    first : ndarray of float, shape (3,), or None
        The x axis of the system, if it has one.
    """
    normal = np.cross(corners[1] - corners[0], corners[-1] - corners[0])
    normal = normal / np.linalg.norm(normal)
    along = first if first is not None else corners[1] - corners[0]
    along = along - (along @ normal) * normal
    if not np.linalg.norm(along) > 0.0:
        raise InputError(f"{face.place}: the axis of its material stands upright on it")
    along = along / np.linalg.norm(along)
    turn = np.deg2rad(face.angle)
    found = np.cos(turn) * along + np.sin(turn) * np.cross(normal, along)
    x, y, z = (np.round(found, 6) + 0.0).tolist()
    return x, y, z


def _is_solid(deck: Deck, plate: Plate) -> bool:
    """Return whether it is a plate of one isotropic material through and through."""
    stretching, bending, shear = plate.materials
    one = bending == stretching and shear in {0, stretching} and stretching in deck.materials
    return one and plate.bending == 1.0 and abs(plate.shear / _SHEAR - 1.0) <= _ALIKE


def _material(deck: Deck, number: int, where: str) -> Material:
    if number not in deck.materials:
        raise InputError(f"{where} names material {number}, which is not there")
    material = deck.materials[number]
    return replace(material, density=material.density * deck.weight_to_mass)


def _law(deck: Deck, number: int, where: str) -> PlaneLaw:
    """Return the law of a material, of an isotropic one too."""
    if number in deck.laws:
        law = deck.laws[number]
        return replace(law, density=law.density * deck.weight_to_mass)
    material = _material(deck, number, where)
    e = material.elastic_modulus / (1.0 - material.poisson_ratio**2)
    g = material.shear_modulus
    return PlaneLaw(
        plane=(e, e, material.poisson_ratio * e, g), across=(g, g), density=material.density
    )


def _without_shear(section: ShellSection) -> OrthotropicSection:
    """Return a plate that does not shear, as one without MID3."""
    laws = section.laws(np.eye(3)[None])
    (d, d_xy), d_t = laws.bending[0, :2], laws.bending[2, 2]
    (c, c_xy), c_t = laws.membrane[0, :2], laws.membrane[2, 2]
    shear = UNSHEARED * float(laws.shear[0, 0])
    return OrthotropicSection(
        bending=(d, d, d_xy, d_t),
        membrane=(c, c, c_xy, c_t),
        shear=(shear, shear),
        mass_per_area=section.mass_per_area,
        rotary_inertia=section.rotary_inertia,
        thickness=section.thickness,
    )


def _plate(deck: Deck, plate: Plate, where: str, more: float) -> OrthotropicSection:
    one, two = (_law(deck, number, where) for number in plate.materials[:2])
    third = _law(deck, plate.materials[2], where).across if plate.materials[2] else None
    thick = plate.thickness
    stiff = UNSHEARED * thick * _SHEAR * one.plane[3]
    shear = (stiff, stiff) if third is None else tuple(plate.shear * thick * g for g in third)
    return OrthotropicSection(
        membrane=_times(one.plane, thick),
        bending=_times(two.plane, plate.bending * thick**3 / 12.0),
        shear=(shear[0], shear[1]),
        mass_per_area=one.density * thick + more,
        rotary_inertia=one.density * thick**3 / 12.0,
        thickness=thick,
    )


def _times(law: tuple[float, ...], factor: float) -> tuple[float, float, float, float]:
    x, y, both, twist = (factor * one for one in law)
    return x, y, both, twist


def _laminate(deck: Deck, laminate: Laminate, where: str) -> OrthotropicSection:
    stretching, coupling, bending = np.zeros((3, 3)), np.zeros((3, 3)), np.zeros((3, 3))
    shear, mass, rotary, low = np.zeros((2, 2)), 0.0, 0.0, laminate.bottom
    shears = True
    for law, thick, angle in _plies(deck, laminate, where):
        high = low + thick
        q, g = _turned(law, np.deg2rad(angle))
        stretching += q * thick
        coupling += q * (high**2 - low**2) / 2.0
        bending += q * (high**3 - low**3) / 3.0
        shears = shears and g is not None
        shear += 0.0 if g is None else _SHEAR * g * thick
        mass += law.density * thick
        rotary += law.density * (high**3 - low**3) / 3.0
        low = high
    thickness = low - laminate.bottom
    size = stretching[0, 0] * np.array([1.0, thickness, thickness**2])
    skew = max(abs(stretching[:2, 2]).max() / size[0], abs(bending[:2, 2]).max() / size[2],
               abs(shear[0, 1]) / size[0])  # fmt: skip
    if abs(coupling).max() > _COUPLED * size[1] or skew > _COUPLED:
        raise InputError(
            f"{where} couples stretching, bending and twist: only laminates that are symmetric and "
            "balanced have an equivalent plate"
        )
    stiff = UNSHEARED * _SHEAR * stretching[2, 2]
    return OrthotropicSection(
        membrane=_four(stretching),
        bending=_four(bending),
        shear=(float(shear[0, 0]), float(shear[1, 1])) if shears else (stiff, stiff),
        mass_per_area=mass + laminate.more * deck.weight_to_mass,
        rotary_inertia=rotary,
        thickness=thickness,
    )


def _plies(deck: Deck, laminate: Laminate, where: str) -> Iterator[tuple[PlaneLaw, float, float]]:
    for number, thick, angle in laminate.plies:
        yield _law(deck, number, where), thick, angle


def _four(law: Array) -> tuple[float, float, float, float]:
    return float(law[0, 0]), float(law[1, 1]), float(law[0, 1]), float(law[2, 2])


def _turned(law: PlaneLaw, angle: float) -> tuple[Array, Array | None]:
    """Return stresses by strains, and shear across, of a ply at an angle."""
    x, y, both, twist = law.plane
    c, s = np.cos(angle), np.sin(angle)
    strains = np.array([[c * c, s * s, c * s], [s * s, c * c, -c * s],
                        [-2 * c * s, 2 * c * s, c * c - s * s]])  # fmt: skip
    plane = strains.T @ np.array([[x, both, 0.0], [both, y, 0.0], [0.0, 0.0, twist]]) @ strains
    if law.across is None:
        return plane, None
    turn = np.array([[c, s], [-s, c]])
    return plane, turn.T @ np.diag(law.across) @ turn

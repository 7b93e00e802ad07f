"""Smear ribs, voids and decks of slabs: ribbed, waffle, hollow-core and composite ones.

Each becomes a plate of the same stiffness in bending, in its plane and in shear, and of its own
mass. What is smeared is right for waves much longer than the ribs are apart.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from trundle._checks import non_negative, positive
from trundle.errors import InputError
from trundle.structure.plates import OrthotropicSection
from trundle.structure.sections import Material

__all__ = ["composite_deck", "hollow_core_slab", "ribbed_slab", "waffle_slab"]

_SHEAR = 5.0 / 6.0  # of a solid section's area


@dataclass(frozen=True, kw_only=True)
class _Strip:
    """A metre of plate seen along one direction: its layers, each wide by a share of the metre."""

    material: Material
    layers: tuple[tuple[float, float, float], ...]  # share of width, bottom, top [m]

    @property
    def area(self) -> float:
        return sum(share * (top - bottom) for share, bottom, top in self.layers)

    @property
    def centre(self) -> float:
        first = sum(share * (top**2 - bottom**2) / 2.0 for share, bottom, top in self.layers)
        return first / self.area

    @property
    def inertia(self) -> float:
        """Second moment of area about the centroid, a metre wide [m3]."""
        about = sum(share * (top**3 - bottom**3) / 3.0 for share, bottom, top in self.layers)
        return about - self.area * self.centre**2


def _plate(
    x: _Strip,
    y: _Strip,
    *,
    plate: float,
    twist: float,
    mass: float,
    rotary: float,
    depth: float,
) -> OrthotropicSection:
    """Join strips along both directions; `plate` is the solid part that both share [m]."""
    material = x.material
    modulus, nu = material.elastic_modulus, material.poisson_ratio
    wide = modulus / (1.0 - nu**2)
    # what bends alone cannot spread sideways in the plate; ribs can
    solid = wide * plate**3 / 12.0
    bending = tuple(
        modulus * strip.inertia + (wide - modulus) * plate**3 / 12.0 for strip in (x, y)
    )
    stretch = tuple(modulus * strip.area + (wide - modulus) * plate for strip in (x, y))
    shear = material.shear_modulus
    return OrthotropicSection(
        bending=(bending[0], bending[1], nu * solid, twist),
        membrane=(stretch[0], stretch[1], nu * wide * plate, shear * plate),
        shear=(_SHEAR * shear * x.area, _SHEAR * shear * y.area),
        mass_per_area=mass,
        damping_ratio=material.damping_ratio,
        rotary_inertia=rotary,
        thickness=depth,
    )


def ribbed_slab(
    *,
    plate: float,
    rib_width: float,
    rib_depth: float,
    spacing: float,
    material: Material,
    superimposed_mass: float = 0.0,
) -> OrthotropicSection:
    """Smear a slab on ribs along its x axis.

    Parameters
    ----------
    plate : float
        Thickness of the slab [m].
    rib_width, rib_depth : float
        Width of a rib, and its depth below the slab [m].
    spacing : float
        Distance of ribs [m].
    material : Material
        Material of both.
    superimposed_mass : float
        Mass that moves with it and adds no stiffness [kg/m2].

    Notes
    -----
    Along the ribs ``E I / s`` of a T about its own centroid, across them the plate alone. The twist
    of a plate is shared by both directions, and ribs along one of them add a quarter of their
    ``G J / s``: ``D_t = G t^3 / 12 + G J / (4 s)``; see S. P. Timoshenko and S. Woinowsky-Krieger,
    Theory of Plates and Shells (1959), chapter 11.
    """
    return _ribbed(plate, (rib_width, rib_depth, spacing), None, material, superimposed_mass)


def waffle_slab(
    *,
    plate: float,
    rib_width: float,
    rib_depth: float,
    spacing: float,
    material: Material,
    superimposed_mass: float = 0.0,
    spacing_y: float | None = None,
) -> OrthotropicSection:
    """Smear a slab on ribs in both directions; parameters as in `ribbed_slab`.

    Parameters
    ----------
    plate, rib_width, rib_depth, spacing : float
        Of the slab and of the ribs along x [m].
    material : Material
        Material of all.
    superimposed_mass : float
        Mass that moves with it [kg/m2].
    spacing_y : float, optional
        Distance of the ribs along y [m]; as of those along x unless given.
    """
    along_y = (rib_width, rib_depth, spacing_y or spacing)
    return _ribbed(plate, (rib_width, rib_depth, spacing), along_y, material, superimposed_mass)


def _ribbed(
    plate: float,
    ribs_x: tuple[float, float, float],
    ribs_y: tuple[float, float, float] | None,
    material: Material,
    superimposed: float,
) -> OrthotropicSection:
    t = positive("plate", plate)
    both = [ribs_x] if ribs_y is None else [ribs_x, ribs_y]
    for width, depth, spacing in both:
        if not 0.0 < positive("rib_width", width) < positive("spacing", spacing):
            raise InputError(f"ribs of {width:g} m cannot stand every {spacing:g} m")
        positive("rib_depth", depth)
    top = (1.0, -t, 0.0)

    def strip(ribs: tuple[float, float, float] | None) -> _Strip:
        """Return a metre of plate with or without ribs under it."""
        if ribs is None:
            return _Strip(material=material, layers=(top,))
        width, depth, spacing = ribs
        return _Strip(material=material, layers=(top, (width / spacing, -t - depth, -t)))

    volume = t + sum(w / s * d for w, d, s in both)
    if len(both) == 2:
        volume -= ribs_x[0] / ribs_x[2] * both[1][0] / both[1][2] * min(r[1] for r in both)
    torsion = sum(_rib_torsion(w, d) / s for w, d, s in both)
    depth = t + max(ribs[1] for ribs in both)
    return _plate(
        strip(ribs_x),
        strip(ribs_y),
        plate=t,
        twist=material.shear_modulus * (t**3 / 12.0 + 0.25 * torsion),
        mass=material.density * volume + non_negative("superimposed_mass", superimposed),
        rotary=material.density * volume * depth**2 / 12.0,
        depth=depth,
    )


def _rib_torsion(width: float, depth: float) -> float:
    """Return Saint-Venant's constant of a rib (Roark, table 10.1, case 4) [m4]."""
    long, short = max(width, depth) / 2.0, min(width, depth) / 2.0
    slender = short / long
    return long * short**3 * (16.0 / 3.0 - 3.36 * slender * (1.0 - slender**4 / 12.0))


def hollow_core_slab(
    *,
    thickness: float,
    void: float,
    spacing: float,
    material: Material,
    topping: float = 0.0,
    superimposed_mass: float = 0.0,
) -> OrthotropicSection:
    """Smear planks with round voids along x, with a topping on them.

    Parameters
    ----------
    thickness : float
        Of the planks [m].
    void : float
        Diameter of the voids [m].
    spacing : float
        Distance of the voids [m].
    material : Material
        Material of planks and topping.
    topping : float
        Thickness of the concrete on top [m].
    superimposed_mass : float
        Mass that moves with it [kg/m2].

    Notes
    -----
    Along the voids the section less its circles; across them what is solid above and below, which
    bends about the common centroid, for webs hold the two together. Joints between planks are taken
    as closed; open ones carry shear but hardly any moment across.
    """
    h, d, s = (
        positive("thickness", thickness),
        positive("void", void),
        positive("spacing", spacing),
    )
    if d >= min(h, s):
        raise InputError(f"voids of {d:g} m do not fit into {h:g} m, every {s:g} m")
    top = non_negative("topping", topping)
    depth, circle = h + top, np.pi * d**2 / 4.0 / s
    area = depth - circle
    centre = (depth**2 / 2.0 - circle * h / 2.0) / area
    inertia = depth**3 / 3.0 - circle * (h**2 / 4.0 + d**2 / 16.0) - area * centre**2
    wall = 0.5 * (h - d)
    across = _Strip(material=material, layers=((1.0, 0.0, wall), (1.0, h - wall, depth)))
    modulus, nu = material.elastic_modulus, material.poisson_ratio
    wide = modulus / (1.0 - nu**2)
    d_x, d_y = wide * inertia, wide * across.inertia
    solid = across.area
    mass = material.density * area + non_negative("superimposed_mass", superimposed_mass)
    shear = material.shear_modulus
    return OrthotropicSection(
        bending=(d_x, d_y, nu * min(d_x, d_y), 0.5 * (1.0 - nu) * float(np.sqrt(d_x * d_y))),
        membrane=(wide * area, wide * solid, nu * wide * solid, shear * solid),
        shear=(_SHEAR * shear * area, _SHEAR * shear * solid),
        mass_per_area=mass,
        damping_ratio=material.damping_ratio,
        rotary_inertia=material.density * area * depth**2 / 12.0,
        thickness=depth,
    )


def composite_deck(
    *,
    depth: float,
    deck_height: float,
    rib_width: float,
    spacing: float,
    material: Material,
    deck_mass: float = 12.0,
    superimposed_mass: float = 0.0,
) -> OrthotropicSection:
    """Smear a concrete slab cast on a profiled steel deck whose ribs run along x.

    Parameters
    ----------
    depth : float
        Whole depth of the slab [m].
    deck_height : float
        Height of the deck's ribs [m].
    rib_width : float
        Mean width of a concrete rib [m].
    spacing : float
        Distance of ribs [m].
    material : Material
        The concrete, with its dynamic modulus; the steel sheet adds mass alone.
    deck_mass : float
        Mass of the sheet [kg/m2].
    superimposed_mass : float
        Mass that moves with it [kg/m2].
    """
    whole, ribs = positive("depth", depth), positive("deck_height", deck_height)
    if ribs >= whole:
        raise InputError(f"a deck of {ribs:g} m leaves nothing of a slab of {whole:g} m")
    section = ribbed_slab(
        plate=whole - ribs,
        rib_width=rib_width,
        rib_depth=ribs,
        spacing=spacing,
        material=material,
        superimposed_mass=superimposed_mass,
    )
    mass = section.mass_per_area + non_negative("deck_mass", deck_mass)
    return replace(section, mass_per_area=mass)

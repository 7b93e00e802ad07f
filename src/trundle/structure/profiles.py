"""Compute cross-sections from their dimensions: I, H, T, box, tube, and rolled ones by name.

All are thin-walled but for their fillets: torsion constants add up the walls of open sections, and
are Bredt's of closed ones; shear areas are those of the walls along the force.
"""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from difflib import get_close_matches
from functools import cache
from importlib import resources
from types import MappingProxyType

import numpy as np

from trundle._checks import non_negative, positive
from trundle.errors import InputError
from trundle.structure.sections import BeamSection, Material

__all__ = [
    "STEEL",
    "box_section",
    "i_section",
    "rolled_section",
    "rolled_sections",
    "rolled_sizes",
    "t_section",
    "tube_section",
]

STEEL = Material(elastic_modulus=210e9, poisson_ratio=0.3, density=7850.0)
"""Structural steel of EN 1993-1-1, 3.2.6."""

_MM = 1e-3
_FILLET = 1.0 - np.pi / 4.0  # area of a fillet over the square of its radius
_FILLET_CENTRE = 0.2234  # of its radius: centroid of a fillet from its straight sides


def i_section(
    depth: float,
    width: float,
    web: float,
    flange: float,
    material: Material,
    *,
    radius: float = 0.0,
) -> BeamSection:
    """Build a doubly symmetric I or H section, its web upright.

    Parameters
    ----------
    depth, width : float
        Whole depth, and width of the flanges [m].
    web, flange : float
        Thicknesses [m].
    material : Material
        Material.
    radius : float
        Radius of the fillets between web and flanges [m].

    Notes
    -----
    The torsion constant is that of the walls, less their ends, plus circles in the two joints: El
    Darwish and Johnston, J. Struct. Div. ASCE 91 (1965) 203-227. The shear area along the depth is
    the web's over the whole depth, across it 5/6 of the flanges'.
    """
    h, b = positive("depth", depth), positive("width", width)
    tw, tf = positive("web", web), positive("flange", flange)
    r = non_negative("radius", radius)
    if 2.0 * (tf + r) >= h or tw + 2.0 * r >= b:
        raise InputError(
            f"flanges of {1e3 * tf:g} mm, a web of {1e3 * tw:g} mm and fillets of {1e3 * r:g} mm "
            f"do not fit into {1e3 * h:g} x {1e3 * b:g} mm"
        )
    clear = h - 2.0 * tf
    fillet = _FILLET * r**2
    arm_y = 0.5 * clear - _FILLET_CENTRE * r
    arm_z = 0.5 * tw + _FILLET_CENTRE * r
    inertia_y = (b * h**3 - (b - tw) * clear**3) / 12.0 + 4.0 * fillet * arm_y**2
    inertia_z = (2.0 * tf * b**3 + clear * tw**3) / 12.0 + 4.0 * fillet * arm_z**2
    return BeamSection(
        area=2.0 * b * tf + clear * tw + 4.0 * fillet,
        inertia_y=inertia_y,
        inertia_z=inertia_z,
        torsion_constant=_open_torsion(b, clear, tw, tf, r),
        shear_area_y=5.0 / 6.0 * 2.0 * b * tf,
        shear_area_z=h * tw,
        material=material,
    )


def _open_torsion(b: float, clear: float, tw: float, tf: float, r: float) -> float:
    walls = 2.0 * b * tf**3 * (1.0 / 3.0 - 0.21 * tf / b * (1.0 - (tf / b) ** 4 / 12.0))
    walls += clear * tw**3 / 3.0
    circle = ((tf + r) ** 2 + tw * (r + 0.25 * tw)) / (2.0 * r + tf)
    share = -0.042 + 0.2204 * tw / tf + 0.1355 * r / tf - 0.0865 * r * tw / tf**2
    share -= 0.0725 * (tw / tf) ** 2
    return walls + 2.0 * max(share, 0.0) * circle**4


def t_section(
    depth: float, width: float, web: float, flange: float, material: Material
) -> BeamSection:
    """Build a T section, its flange on top, about its own centroid.

    Parameters
    ----------
    depth, width : float
        Whole depth, and width of the flange [m].
    web, flange : float
        Thicknesses [m].
    material : Material
        Material.
    """
    h, b = positive("depth", depth), positive("width", width)
    tw, tf = positive("web", web), positive("flange", flange)
    if tf >= h or tw > b:
        raise InputError(
            f"a flange of {1e3 * tf:g} mm and a web of {1e3 * tw:g} mm do not fit into "
            f"{1e3 * h:g} x {1e3 * b:g} mm"
        )
    clear = h - tf
    areas, middles = np.array([b * tf, clear * tw]), np.array([h - 0.5 * tf, 0.5 * clear])
    centre = float(areas @ middles / areas.sum())
    own = (b * tf**3 + tw * clear**3) / 12.0
    return BeamSection(
        area=float(areas.sum()),
        inertia_y=own + float(areas @ (middles - centre) ** 2),
        inertia_z=(tf * b**3 + clear * tw**3) / 12.0,
        torsion_constant=(b * tf**3 + clear * tw**3) / 3.0,
        shear_area_y=5.0 / 6.0 * b * tf,
        shear_area_z=h * tw,
        material=material,
    )


def box_section(
    depth: float, width: float, web: float, flange: float, material: Material
) -> BeamSection:
    """Build a rectangular hollow section with sharp corners.

    Parameters
    ----------
    depth, width : float
        Outer sizes [m].
    web, flange : float
        Thicknesses of the upright and of the level walls [m].
    material : Material
        Material.
    """
    h, b = positive("depth", depth), positive("width", width)
    tw, tf = positive("web", web), positive("flange", flange)
    if 2.0 * tf >= h or 2.0 * tw >= b:
        raise InputError(
            f"walls of {1e3 * tw:g} and {1e3 * tf:g} mm fill {1e3 * h:g} x {1e3 * b:g} mm: it is "
            "no hollow section"
        )
    inner_h, inner_b = h - 2.0 * tf, b - 2.0 * tw
    middle_h, middle_b = h - tf, b - tw
    around = 2.0 * (middle_b / tf + middle_h / tw)
    return BeamSection(
        area=h * b - inner_h * inner_b,
        inertia_y=(b * h**3 - inner_b * inner_h**3) / 12.0,
        inertia_z=(h * b**3 - inner_h * inner_b**3) / 12.0,
        torsion_constant=4.0 * (middle_h * middle_b) ** 2 / around,
        shear_area_y=2.0 * b * tf,
        shear_area_z=2.0 * h * tw,
        material=material,
    )


def tube_section(diameter: float, wall: float, material: Material) -> BeamSection:
    """Build a circular hollow section, or a solid round one with a wall of half the diameter.

    Parameters
    ----------
    diameter, wall : float
        Outer diameter and wall thickness [m].
    material : Material
        Material.
    """
    d, t = positive("diameter", diameter), positive("wall", wall)
    if 2.0 * t > d * (1.0 + 1e-9):
        raise InputError(f"a wall of {1e3 * t:g} mm does not fit into {1e3 * d:g} mm")
    inner = max(d - 2.0 * t, 0.0)
    area = np.pi / 4.0 * (d**2 - inner**2)
    inertia = np.pi / 64.0 * (d**4 - inner**4)
    hollow = inner / d
    # Cowper (1966) without Poisson's ratio: 0.9 for a solid circle, 0.5 for a thin tube
    shear = 6.0 * (1.0 + hollow**2) ** 2 / (7.0 * (1.0 + hollow**2) ** 2 + 20.0 * hollow**2)
    return BeamSection(
        area=float(area),
        inertia_y=float(inertia),
        inertia_z=float(inertia),
        torsion_constant=float(2.0 * inertia),
        shear_area_y=float(shear * area),
        shear_area_z=float(shear * area),
        material=material,
    )


@cache
def _rolled() -> Mapping[str, tuple[float, ...]]:
    file = resources.files("trundle.structure").joinpath("data/rolled_sections.toml")
    tables = tomllib.loads(file.read_text(encoding="utf-8")).values()
    return MappingProxyType(
        {name: tuple(sizes) for table in tables for name, sizes in table["sections"].items()}
    )


def rolled_section(name: str, material: Material = STEEL) -> BeamSection:
    """Return a European or American rolled section by its name.

    Parameters
    ----------
    name : str
        Such as ``IPE 300``, ``HEA 200`` (or ``HE 200 A``) or ``W16x31``; letters large or small.
    material : Material
        Material, steel unless given.

    Raises
    ------
    InputError
        A section that is not listed.
    """
    depth, width, web, flange, radius = rolled_sizes(name)
    return i_section(depth, width, web, flange, material, radius=radius)


def rolled_sizes(name: str) -> tuple[float, ...]:
    """Return depth, flange width, web, flange and root radius of a rolled section [m].

    Raises
    ------
    InputError
        A section that is not listed.
    """
    wanted = _plain(name)
    known = {_plain(listed): listed for listed in _rolled()}
    if wanted not in known:
        near = get_close_matches(wanted, known, n=3, cutoff=0.5)
        said = ", ".join(known[one] for one in near) or "IPE, HEA, HEB and W sections"
        raise InputError(f"no rolled section {name!r}; there is {said}")
    return tuple(_MM * size for size in _rolled()[known[wanted]])


def _plain(name: str) -> str:
    """Write a name as all its spellings: HE 200 A is HEA200, 16X31 is 16x31."""
    text = "".join(name.upper().split()).replace("×", "X")
    if text.startswith("HE") and text[2:3].isdigit() and text[-1:] in {"A", "B"}:
        text = f"HE{text[-1]}{text[2:-1]}"
    return text


def rolled_sections() -> tuple[str, ...]:
    """Return the names of all rolled sections that are known."""
    return tuple(_rolled())

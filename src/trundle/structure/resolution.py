"""Say how far up in frequency a mesh carries the bending waves of a slab."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from trundle._checks import positive
from trundle.structure.plan import FloorPlan, mesh_lines
from trundle.structure.plates import OrthotropicSection
from trundle.structure.sections import PlateSection

__all__ = [
    "ELEMENTS_PER_WAVE",
    "bending_wave",
    "building_mesh_size",
    "building_resolution",
    "resolved_frequency",
    "resolving_mesh_size",
]

ELEMENTS_PER_WAVE = 7
"""Elements that a bending wave needs for its frequency to stay within its one-third-octave band.

A wave along the mesh has, between nodes h apart and with consistent mass, for thin slabs

    (omega_h / omega)^2 = 48 sin^2(k h / 2) tan^2(k h / 2) / ((2 + cos(k h)) (k h)^4),

which makes its frequency 15 % high with 6 elements, 10.9 % with 7, 8 % with 8 and 3.5 % with 12;
from the middle of a band to its edge it is 12.2 %. Waves across the mesh's diagonal do better.
"""


def resolved_frequency(plan: FloorPlan, mesh_size: float) -> float:
    """Return the highest frequency whose bending waves a mesh of a plan carries [Hz].

    Parameters
    ----------
    plan : FloorPlan
        The floor.
    mesh_size : float
        Largest element edge asked for [m]; where lines of the plan make every edge shorter, what
        counts is the longest that is there.

    Returns
    -------
    float
        Frequency at which the slab's bending wave is `ELEMENTS_PER_WAVE` elements long.

    Notes
    -----
    lambda = 2 pi (D / (m omega^2))^(1/4) with D = E t^3 / (12 (1 - nu^2)) and m with what lies on
    the slab. The slab decides: beams that bend with it are stiffer at the mass of the same strip,
    and their waves longer. Below this frequency single modes may still move by the said error;
    point supports and mesh lines near a wheel need more.
    """
    lines = mesh_lines(plan, mesh_size=positive("mesh_size", mesh_size))
    longest = max(float(np.diff(line).max()) for line in lines)
    return bending_wave(plan.slab) / (ELEMENTS_PER_WAVE * longest) ** 2


def resolving_mesh_size(plan: FloorPlan, f: float) -> float:
    """Return the mesh size that carries bending waves up to a frequency [Hz], in metres."""
    return float(np.sqrt(bending_wave(plan.slab) / positive("f", f))) / ELEMENTS_PER_WAVE


def bending_wave(slab: PlateSection) -> float:
    """Return frequency times wavelength squared of bending waves, 2 pi sqrt(D / m) [m2/s].

    Of a plate that is not alike in all directions, along the softer of its axes.
    """
    along = np.array([slab.axis]) if isinstance(slab, OrthotropicSection) else np.eye(3)[:1]
    frame = np.array([[along[0], np.cross([0.0, 0.0, 1.0], along[0]), [0.0, 0.0, 1.0]]])
    bending = np.asarray(slab.laws(frame).bending).reshape(-1, 3, 3)[0]
    return float(2.0 * np.pi * np.sqrt(min(bending[0, 0], bending[1, 1]) / slab.mass_per_area))


def building_resolution(sections: Iterable[PlateSection], size: float) -> float:
    """Return the highest frequency whose bending waves elements of a size carry [Hz].

    Parameters
    ----------
    sections : iterable of PlateSection
        The plates of the building; the one with the shortest waves decides.
    size : float
        Longest edge of an element [m].
    """
    slowest = min((bending_wave(section) for section in sections), default=np.inf)
    return float(slowest / (ELEMENTS_PER_WAVE * positive("size", size)) ** 2)


def building_mesh_size(sections: Iterable[PlateSection], f: float) -> float:
    """Return the size of elements that carry bending waves up to a frequency [Hz], in metres."""
    slowest = min((bending_wave(section) for section in sections), default=np.inf)
    return float(np.sqrt(slowest / positive("f", f))) / ELEMENTS_PER_WAVE

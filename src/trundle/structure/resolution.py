"""Say how far up in frequency a mesh carries the bending waves of a slab."""

from __future__ import annotations

import numpy as np

from trundle._checks import positive
from trundle.structure.plan import FloorPlan, mesh_lines
from trundle.structure.sections import ShellSection

__all__ = ["ELEMENTS_PER_WAVE", "resolved_frequency", "resolving_mesh_size"]

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
    return _speed(plan.slab) / (ELEMENTS_PER_WAVE * longest) ** 2


def resolving_mesh_size(plan: FloorPlan, f: float) -> float:
    """Return the mesh size that carries bending waves up to a frequency [Hz], in metres."""
    return float(np.sqrt(_speed(plan.slab) / positive("f", f))) / ELEMENTS_PER_WAVE


def _speed(slab: ShellSection) -> float:
    """Return frequency times wavelength squared of a bending wave, 2 pi sqrt(D / m) [m2/s]."""
    material = slab.material
    bending = material.elastic_modulus * slab.thickness**3 / 12.0
    bending /= 1.0 - material.poisson_ratio**2
    return float(2.0 * np.pi * np.sqrt(bending / slab.mass_per_area))

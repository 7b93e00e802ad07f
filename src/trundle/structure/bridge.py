"""Build a beam bridge: one line of beam elements between two supports."""

from __future__ import annotations

from typing import Literal, TypeAlias, get_args

import numpy as np

from trundle._checks import count, one_of, positive
from trundle.structure.elements import BeamGroup
from trundle.structure.floor import Floor
from trundle.structure.sections import BeamSection, Material

__all__ = ["BeamEnds", "beam_bridge"]

BeamEnds: TypeAlias = Literal["simple", "clamped", "cantilever"]

_MODULUS = 3.5e10  # Pa; only its product with the second moment of area counts
_THICK = 1e8  # area over root of inertia: rotary inertia and stretching count for nothing


def beam_bridge(
    *,
    length: float,
    bending_stiffness: float,
    line_mass: float,
    ends: BeamEnds = "simple",
    n_elements: int = 40,
) -> Floor:
    """Return a Bernoulli-Euler beam along x, from (0, 0) to (length, 0), that moves up and down.

    Vehicles drive along it on ``Route.straight((0, 0), (length, 0), ...)``; points are read at
    (x, 0). Shear and rotary inertia are left out, as in the closed forms of the literature.

    Parameters
    ----------
    length : float
        Span [m].
    bending_stiffness : float
        ``E I`` [N m2].
    line_mass : float
        Mass of a metre [kg/m].
    ends : {"simple", "clamped", "cantilever"}
        Both ends on bearings, both clamped, or clamped at x = 0 and free at the other.
    n_elements : int
        Elements along the span; a mode needs ten or so for each of its half waves.

    Raises
    ------
    InputError
        A length, stiffness or mass that is not above 0, or other ends.
    """
    length, stiffness = positive("length", length), positive("bending_stiffness", bending_stiffness)
    one_of("ends", ends, get_args(BeamEnds))
    n = count("n_elements", n_elements, at_least=2)
    inertia = stiffness / _MODULUS
    area = _THICK * float(np.sqrt(inertia))
    section = BeamSection(
        area=area,
        inertia_y=inertia,
        inertia_z=inertia,
        torsion_constant=inertia,
        shear_area_y=np.inf,
        shear_area_z=np.inf,
        material=Material(
            elastic_modulus=_MODULUS,
            poisson_ratio=0.2,
            density=positive("line_mass", line_mass) / area,
        ),
    )
    x = np.linspace(0.0, length, n + 1)
    fixed = np.ones((n + 1, 6), dtype=bool)
    fixed[:, [2, 4]] = False
    fixed[0, [2, 4]] = True, ends != "simple"
    fixed[-1, [2, 4]] = ends != "cantilever", ends == "clamped"
    elements = np.column_stack([np.arange(n), np.arange(1, n + 1)])
    return Floor(
        nodes=np.column_stack([x, np.zeros_like(x), np.zeros_like(x)]),
        fixed=fixed,
        beams=(BeamGroup(elements=elements, section=section),),
        name=f"beam bridge of {length:g} m",
    )

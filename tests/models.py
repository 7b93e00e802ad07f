"""Small floors and vehicles that several tests use."""

from __future__ import annotations

import numpy as np

from trundle.structure import (
    CONCRETE,
    BeamGroup,
    BeamSection,
    Floor,
    FloorPlan,
    Material,
    Rectangle,
    ShellSection,
    build_floor,
)


def simple_beam(
    *, length: float, rigidity: float, line_mass: float, n_elements: int, modulus: float = 3.5e10
) -> Floor:
    """Build a simply supported Bernoulli-Euler beam along x that moves in x-z only.

    Rotary inertia is kept negligible by a small density on a large area.
    """
    inertia = rigidity / modulus
    area = 1e8 * np.sqrt(inertia)
    material = Material(elastic_modulus=modulus, poisson_ratio=0.2, density=line_mass / area)
    section = BeamSection(
        area=area,
        inertia_y=inertia,
        inertia_z=inertia,
        torsion_constant=inertia,
        shear_area_y=np.inf,
        shear_area_z=np.inf,
        material=material,
    )
    x = np.linspace(0.0, length, n_elements + 1)
    nodes = np.column_stack([x, np.zeros_like(x), np.zeros_like(x)])
    fixed = np.ones((len(x), 6), dtype=bool)
    fixed[:, [2, 4]] = False
    fixed[[0, -1], 2] = True
    elements = np.column_stack([np.arange(n_elements), np.arange(1, n_elements + 1)])
    return Floor(nodes=nodes, fixed=fixed, beams=(BeamGroup(elements=elements, section=section),))


def small_plan(**changes: object) -> FloorPlan:
    """Describe a storey of two bays by one that a test solves in a moment."""
    values: dict = {
        "x_lines": np.array([0.0, 6.0, 12.0]),
        "y_lines": np.array([0.0, 6.0]),
        "x_extent": (0.0, 12.0),
        "y_extent": (0.0, 6.0),
        "slab": ShellSection(thickness=0.2, material=CONCRETE, superimposed_mass=300.0),
        "material": CONCRETE,
        "beams_x": Rectangle(width=0.3, depth=0.6),
        "beams_y": Rectangle(width=0.3, depth=0.6),
        "column": Rectangle(width=0.4, depth=0.4),
        "storey_below": 4.0,
        "storey_above": 4.0,
    }
    return FloorPlan(**{**values, **changes})


def small_floor(*, mesh_size: float = 1.5, **changes: object) -> Floor:
    """Build the small plan."""
    return build_floor(small_plan(**changes), mesh_size=mesh_size)

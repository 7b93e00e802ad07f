"""Small floors and vehicles that several tests use."""

from __future__ import annotations

import numpy as np

from trundle.structure import (
    CONCRETE,
    Floor,
    FloorPlan,
    Rectangle,
    ShellSection,
    beam_bridge,
    build_floor,
)


def simple_beam(*, length: float, rigidity: float, line_mass: float, n_elements: int) -> Floor:
    """Build a simply supported Bernoulli-Euler beam along x that moves in x-z only."""
    return beam_bridge(
        length=length, bending_stiffness=rigidity, line_mass=line_mass, n_elements=n_elements
    )


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

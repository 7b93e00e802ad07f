"""Build the reference unit: trundle's stand-in for the paper's factory floor.

Pan, Mita and Li (2001) print the plan (52 m x 83.5 m), the bays of the cross-section and the
symmetry planes, but the column grid, member sizes and masses stood in figures that are lost.
The values here are trundle's own, chosen so that the first modes lie where the paper's
Rayleigh coefficients were anchored (3.75 and 5.80 Hz).
"""

from __future__ import annotations

import numpy as np

from trundle.structure.floor import Floor
from trundle.structure.plan import FloorPlan, Rectangle, build_floor
from trundle.structure.sections import CONCRETE, ShellSection

__all__ = ["reference_plan", "reference_unit"]


def reference_plan() -> FloorPlan:
    """Return the plan of the reference unit."""
    return FloorPlan(
        name="reference unit",
        x_lines=np.array([0.0, 13.0, 26.0, 39.0, 52.0]),
        y_lines=np.array([7.5, 27.5, 41.5, 62.5, 83.5]),
        x_extent=(0.0, 52.0),
        y_extent=(0.0, 83.5),
        slab=ShellSection(thickness=0.20, material=CONCRETE, superimposed_mass=500.0),
        material=CONCRETE,
        beams_x=Rectangle(width=1.0, depth=1.8),
        beams_y=Rectangle(width=0.6, depth=1.5),
        secondary_y=Rectangle(width=0.3, depth=0.7),
        column=Rectangle(width=0.8, depth=0.8),
        storey_below=8.5,
        storey_above=8.5,
        edges={"x_min": "symmetry", "x_max": "symmetry", "y_min": "symmetry", "y_max": "free"},
    )


def reference_unit(*, mesh_size: float = 1.0) -> Floor:
    """Build the reference unit's floor.

    Parameters
    ----------
    mesh_size : float
        Largest element edge [m].

    Returns
    -------
    Floor
        52 m x 83.5 m, symmetric about x = 0, x = 52 m and y = 0, free at y = 83.5 m.

    Examples
    --------
    >>> floor = reference_unit(mesh_size=3.5)
    >>> round(floor.moving_mass() / 1e6, 1)
    6.8
    """
    return build_floor(reference_plan(), mesh_size=mesh_size)

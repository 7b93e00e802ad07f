"""Say how much stiffer a floor on hanging beams is where both its ends take thrust."""

from __future__ import annotations

from typing import Literal

import numpy as np
from scipy import optimize

from trundle.structure.plan import FloorPlan

__all__ = ["arching"]


def arching(plan: FloorPlan, axis: Literal["x", "y"]) -> float:
    """Return how many times stiffer the ends of a plan make it by taking thrust.

    Beams that hang below the slab bend with it about an axis below its mid-plane. Ends that rotate
    then draw the mid-plane in; edges that hold the mid-plane answer with a thrust, and one span
    becomes a flat arch.

    Parameters
    ----------
    plan : FloorPlan
        The floor.
    axis : {"x", "y"}
        Along which axis beams span.

    Returns
    -------
    float
        Square of the first frequency over that of the same span on bearings; 1 where nothing
        arches: beams in the mid-plane, no beams along the axis, an end that slides, or two
        clamped ends, which do not rotate.

    Notes
    -----
    A composite span of stiffness EI and EA whose axis lies e below the mid-plane, with no net
    stretch of the mid-plane: the thrust N = 2 EA e theta / L acts at the lever e, like a rotational
    spring 2 EA e^2 / L at each end. The first frequency goes with l^2 in

        2 l + (2 A e^2 / I) (tan(l / 2) + tanh(l / 2)) = 0,    pi < l < 4.730,

    (Blevins, Formulas for Natural Frequency and Mode Shape, 1979, table 8-1: equal springs). A
    plane of symmetry is the middle of a span twice as long, for which the ratio is the same; one
    clamped end leaves half of the thrust, so that this is an upper bound. Floors over several
    spans arch less.
    """
    if not _held(plan, axis):
        return 1.0
    spring = 2.0 * _lever_ratio(plan, axis)
    if spring == 0.0:
        return 1.0

    def condition(root: float) -> float:
        """Return the characteristic function, times the cosine that it would be singular with."""
        half = 0.5 * root
        return (2.0 * root + spring * np.tanh(half)) * np.cos(half) + spring * np.sin(half)

    return float((optimize.brentq(condition, np.pi, 1.5 * np.pi + 0.1) / np.pi) ** 4)


def _held(plan: FloorPlan, axis: str) -> bool:
    """Return whether both ends are held in the plane, and one of them can rotate."""
    ends = {plan.edges.get(f"{axis}_{side}", "free") for side in ("min", "max")}
    return plan.eccentric_beams and "pinned" in ends and ends <= {"symmetry", "pinned", "clamped"}


def _lever_ratio(plan: FloorPlan, axis: str) -> float:
    """Return A e^2 / I of the section across an axis, e from its own axis to the mid-plane."""
    low, high = plan.y_extent if axis == "x" else plan.x_extent
    slab = (high - low) * plan.slab.thickness
    modular = plan.material.elastic_modulus / plan.slab.material.elastic_modulus
    main = plan.beams_x if axis == "x" else plan.beams_y
    rows = [(main, len(plan.y_lines if axis == "x" else plan.x_lines))]
    if axis == "y":
        rows.append((plan.secondary_y, len(plan.secondary_lines)))
    beams = [(modular * n * r.width, r.depth) for r, n in rows if r is not None]
    area = slab + sum(width * depth for width, depth in beams)
    moment = sum(w * d * 0.5 * (plan.slab.thickness + d) for w, d in beams)
    inertia = slab * plan.slab.thickness**2 / 12.0 + sum(
        w * d * (d**2 / 12.0 + 0.25 * (plan.slab.thickness + d) ** 2) for w, d in beams
    )
    lever = moment / area
    return area * lever**2 / (inertia - area * lever**2)

"""Doubt a study before it runs: what is allowed, and yet unlikely to be meant."""

from __future__ import annotations

from collections.abc import Iterator

from trundle.errors import FitnessWarning
from trundle.structure import FloorPlan, arching
from trundle.study.doubts_values import value_doubts
from trundle.study.model import Study

__all__ = ["study_doubts"]


def study_doubts(study: Study) -> tuple[FitnessWarning, ...]:
    """Return every doubt about a study that needs no result.

    Parameters
    ----------
    study : Study
        A study that has passed every check.

    Returns
    -------
    tuple of FitnessWarning
        Each with its numbers and its remedy; empty for a study that nothing is odd about.
    """
    return (*_thrust(study.plan), *value_doubts(study))


def _thrust(plan: FloorPlan) -> Iterator[FitnessWarning]:
    """Doubt edges that make an arch of a floor on hanging beams, or hold its beams' ends."""
    for axis in ("x", "y"):
        kinds = [plan.edges.get(f"{axis}_{side}", "free") for side in ("min", "max")]
        times = arching(plan, axis)
        if times > 1.01:
            yield FitnessWarning(
                subject=f"edges along {axis}",
                message=f"{axis}_min is {kinds[0]} and {axis}_max {kinds[1]}: both ends hold the "
                "slab's mid-plane, and the beams that hang below it arch between them; stiffness "
                f"may be up to {100.0 * (times - 1.0):.0f} % too high, frequencies up to "
                f"{100.0 * (times**0.5 - 1.0):.0f} %: unless the walls do take thrust, make one "
                'end or both "simple", which lets the floor slide across the edge',
            )
        elif kinds == ["clamped", "clamped"] and plan.eccentric_beams and _spans(plan, axis):
            yield FitnessWarning(
                subject=f"edges along {axis}",
                message="both ends are clamped: they hold the hanging beams against any rotation "
                "and take their thrust, which makes a span up to 5.1 times as stiff as on "
                'bearings; unless walls and beams are one frame, make the ends "simple"',
            )


def _spans(plan: FloorPlan, axis: str) -> bool:
    """Return whether beams run along an axis."""
    if axis == "x":
        return plan.beams_x is not None
    return plan.beams_y is not None or len(plan.secondary_lines) > 0

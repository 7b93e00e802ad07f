"""State what a study takes for granted, and how much it matters."""

from __future__ import annotations

import numpy as np

from trundle.errors import FitnessWarning
from trundle.study.model import Study
from trundle.study.plans import Case

__all__ = ["assumption_warnings", "early_end_warnings"]

_ON_BEAM = 0.5  # m from its line


def assumption_warnings(study: Study) -> tuple[FitnessWarning, ...]:
    """Return what a study takes for granted, with its size.

    The sizes were measured on the reference unit: two tracks of an isotropic road under wheels 2 m
    apart press with up to 3 dB less than one track under both; a mirror image of the vehicle
    beyond a plane of symmetry changes levels by 0.9 to 1.4 times.
    """
    found = [FitnessWarning(subject="axis", message=_axis_words(study))]
    if any(np.ptp(drive.vehicle.lateral) == 0.0 for drive in study.drives.values()):
        found.append(
            FitnessWarning(
                subject="wheel tracks",
                message="both wheels of an axle roll on one track: up to 3 dB on the safe side of "
                "two tracks with the coherence of an isotropic road",
            )
        )
    if study.floor.mirrors:
        found.append(
            FitnessWarning(
                subject="planes of symmetry",
                message="every vehicle, walker and machine has a mirror image beyond each plane, "
                "which moves with it on the same road: levels were 0.9 to 1.4 times those of one "
                "vehicle",
            )
        )
    found += _points_on_beams(study)
    return tuple(found)


def _axis_words(study: Study) -> str:
    """Say which motions are computed, and of what."""
    mapped = study.map is not None and bool(study.map.level.any())
    if study.point_ways is None and not mapped:
        return "only vertical motion is computed; curves for each axis hold for it alone"
    return (
        "level motion is that of vertical wheel loads alone: braking, steering and wind are not in "
        "it; points whose names end with x or y read it, maps along x or y show it, and curves for "
        "each axis hold for each"
    )


def _points_on_beams(study: Study) -> list[FitnessWarning]:
    """Return the doubt about points on main beams, the stillest places of a floor."""
    plan, found = study.plan, list[FitnessWarning]()
    if plan is None:
        return found
    for name, spot in study.points.items():
        x, y = spot.x, spot.y
        along_x = plan.beams_x is not None and np.abs(plan.y_lines - y).min() < _ON_BEAM
        along_y = plan.beams_y is not None and np.abs(plan.x_lines - x).min() < _ON_BEAM
        if along_x or along_y:
            message = (
                f"point {name!r} at ({x:g}, {y:g}) m stands on a main beam, where a floor is "
                "stillest; a level ten metres away may be ten times higher: add a point in mid-bay"
            )
            found.append(FitnessWarning(subject=f"point {name}", message=message))
    return found


def early_end_warnings(study: Study, case: Case) -> tuple[FitnessWarning, ...]:
    """Return the doubt about a record that ends while a wheel stands on the floor."""
    if study.duration is None:
        return ()
    sources = study.acting(case, next(iter(study.roads)), study.methods[0])
    leaves = max(source.leaves for source in sources)
    if study.duration >= leaves:
        return ()
    return (
        FitnessWarning(
            subject=f"duration, {case.name}",
            message=f"the vehicle has not left by the end of the record at {study.duration:g} s; "
            f"it leaves at {leaves:.1f} s, and nothing is assessed: lengthen or remove duration",
        ),
    )

"""Doubt a study before it runs: what is allowed, and yet unlikely to be meant."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from trundle._typing import Array
from trundle.criteria import BY_FREQUENCY
from trundle.errors import FitnessWarning
from trundle.signals import band_edges, mid_band_frequencies, nominal_frequency
from trundle.simulate import coverage_of
from trundle.structure import (
    ELEMENTS_PER_WAVE,
    FloorPlan,
    arching,
    building_mesh_size,
    building_resolution,
    resolved_frequency,
    resolving_mesh_size,
)
from trundle.structure.building import Building, in_the_way
from trundle.study.doubts_mesh import gap_doubts, shape_doubts
from trundle.study.doubts_traffic import traffic_doubts
from trundle.study.doubts_values import value_doubts
from trundle.study.model import Study
from trundle.study.plans import MethodPlan

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
    return (
        *(() if study.plan is None else _of_plan(study, study.plan)),
        *(() if study.building is None else _of_building(study, study.building)),
        *value_doubts(study),
        *traffic_doubts(study),
        *study.told,
    )


def _of_plan(study: Study, plan: FloorPlan) -> Iterator[FitnessWarning]:
    yield from _thrust(plan)
    yield from _columns_in_a_slab(plan)
    yield from _mesh(study, plan)


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


def _columns_in_a_slab(plan: FloorPlan) -> Iterator[FitnessWarning]:
    """Doubt columns that no main beam meets: each holds the slab at one node."""
    if not plan.has_columns or plan.beams_x is not None or plan.beams_y is not None:
        return
    if plan.column_heads == "rigid":
        return
    between = " (secondary beams run between the columns)" if plan.secondary_y is not None else ""
    yield FitnessWarning(
        subject="columns",
        message=f"no main beam meets a column{between}: each holds the slab at one node, as a "
        "needle would, and results do not settle as the mesh is refined; on bays of 8 m the first "
        "frequency still fell by 4 % from 1 m to 0.5 m and by 2 % to 0.25 m: set column_heads = "
        '"rigid", which joins a column over its cross-section, or give beams_x or beams_y',
    )


def _of_building(study: Study, building: Building) -> Iterator[FitnessWarning]:
    """Doubt a mesh that is too coarse, and floors that weigh or span what none does."""
    plates = [part.section for part in (*building.slabs, *building.ramps)]
    bands = _bands_assessed(study)
    reach = building_resolution(plates, study.mesh_size)
    if plates and len(bands) and bands[-1] > reach:
        yield _coarse(study, bands, reach, building_mesh_size(plates, float(bands[-1])))
    yield from _ways(study, building)
    yield from gap_doubts(building)
    yield from shape_doubts(study)


def _ways(study: Study, building: Building) -> Iterator[FitnessWarning]:
    """Doubt routes through walls and columns."""
    storeys = [storey.name for storey in building.storeys]
    for name, drive in study.drives.items():
        for visited in drive.route.visited:
            on = visited or next(iter(study.floor.surfaces))
            if on not in storeys:
                continue
            line = study.way_in_plan(drive.route, visited)
            for part, x, y in in_the_way(building, on, line):
                yield FitnessWarning(
                    subject="route",
                    message=f"{name} runs through {part} at ({x:.4g}, {y:.4g}) m, which stands on "
                    f"{on!r}: lead it round, unless there is a gate",
                )


def _mesh(study: Study, plan: FloorPlan) -> Iterator[FitnessWarning]:
    """Doubt a mesh that is too coarse for the highest band that is assessed."""
    bands = _bands_assessed(study)
    reach = resolved_frequency(plan, study.mesh_size)
    if len(bands) and bands[-1] > reach:
        yield _coarse(study, bands, reach, resolving_mesh_size(plan, float(bands[-1])))


def _coarse(study: Study, bands: Array, reach: float, enough: float) -> FitnessWarning:
    """Say up to where a mesh carries bending waves, and which would carry all."""
    top = nominal_frequency(float(bands[-1]))
    fine = bands[bands <= reach]
    lost = f"bands above {nominal_frequency(float(fine[-1])):g} Hz" if len(fine) else "all bands"
    enough = np.floor(100.0 * enough) / 100.0
    return FitnessWarning(
        subject="mesh",
        message=f"elements of {study.mesh_size:g} m carry the slab's bending waves to {reach:.3g} "
        f"Hz ({ELEMENTS_PER_WAVE} elements a wave, whose frequency is then 11 % high); bands to "
        f"{top:g} Hz are asked for, and {lost} change with the mesh: a mesh_size of "
        f"{enough:g} m would carry them all",
    )


def _bands_assessed(study: Study) -> Array:
    """Return the mid-band frequencies that curves, modes, step and roads reach [Hz]."""
    bands = mid_band_frequencies()
    method, highest = study.methods[0], np.inf
    if study.assessment is not None:
        name = study.assessment.method
        method = next((m for m in study.methods if m.name == name), method)
        curves = study.assessment.criteria
        if all(curve.quantity in BY_FREQUENCY for curve in curves):
            highest = max(float(curve.frequencies[-1]) for curve in curves) * 1.01
    integration = method.interaction.integration
    highest = min(highest, 0.4 / integration.dt * 1.01)
    asked = (bands <= highest) & (band_edges(bands)[:, 1] <= integration.f_resolved)
    return bands[asked & _excited(study, method, bands)]


def _excited(study: Study, method: MethodPlan, bands: Array) -> Array:
    """Return which bands any case's roads excite."""
    found = np.zeros(len(bands), dtype=bool)
    for case in study.cases:
        for road in study.roads:
            sources = study.acting(case, road, method)
            found |= coverage_of(sources, study.record_length(sources)).excites(bands)
    return found

"""Say what a study's report takes for granted, with its size, and what it draws on."""

from __future__ import annotations

from collections.abc import Iterator

from trundle.road import FeaturedRoad
from trundle.study.model import Study

__all__ = ["assumption_lines", "source_lines"]


def assumption_lines(study: Study) -> list[str]:
    """Return what the methods take for granted in this study, and what that is worth."""
    return [*_of_vehicles(study), *_of_structure(study), *_of_levels(study)]


def _of_vehicles(study: Study) -> Iterator[str]:
    vehicles = {drive.vehicle.name: drive.vehicle for drive in study.drives.values()}
    straight = [name for name, one in vehicles.items() if one.is_linear]
    if straight:
        yield (
            f"Linear vehicles ({', '.join(straight)}): suspensions have no friction and wheels do "
            "not lift off; a run in which one would pull on the floor is named among the warnings."
        )
    others = [name for name in vehicles if name not in straight]
    if others:
        yield f"Stepped with friction, stops or lifting off as given: {', '.join(others)}."
    if study.drives and study.floor.mirrors:
        yield (
            "A vehicle that drives along a plane of symmetry loads the modelled half with half of "
            "its force; on any other route its mirror image drives beyond the plane (levels 0.9 to "
            "1.4 times those of one vehicle)."
        )


def _of_structure(study: Study) -> Iterator[str]:
    if not study.floor.has_matrices:
        yield "The structure is known by its modes alone, as they were given."
        return
    yield (
        "The structure is linear and elastic, its moduli the dynamic ones; cracking counts as far "
        "as the stiffness given takes it into account. Levels are no better than modulus, damping "
        "and masses that were put in."
    )


def _of_levels(study: Study) -> Iterator[str]:
    if _random(study):
        yield (
            "Percentiles are over random roads of one spectrum; a building has one road. A level "
            "of random motion over 1 s scatters from passage to passage by up to 51 % at 1 Hz, "
            "32 % at 8 Hz, 11 % at 80 Hz; no computation makes one passage more certain."
        )
    yield (
        "What was not computed, what no wave of the road excites, and what a record does not hold "
        "to its end is not assessed, never passed."
    )


def _random(study: Study) -> bool:
    """Return whether somebody drives on a road that differs from run to run."""
    bare = (one.base if isinstance(one, FeaturedRoad) else one for one in study.roads.values())
    return bool(study.drives) and any(not road.is_given for road in bare)


def source_lines(study: Study) -> list[str]:
    """Return the publications, standards and criteria that this study draws on, each once."""
    found = list(study.publications)
    if _random(study):
        found.append(
            "ISO 8608: Mechanical vibration, road surface profiles, reporting of measured data."
        )
    if study.assessment is not None:
        found.append("IEC 61260-1: Octave-band and fractional-octave-band filters.")
    found += [f"Criteria: {criterion.source}" for criterion in study.criteria]
    found += [f"{d.vehicle.name}: {d.vehicle.source}" for d in study.drives.values()]
    return list(dict.fromkeys(found))

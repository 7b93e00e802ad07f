"""Doubt the values of a study that are allowed and yet unlikely to be meant."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator
from itertools import pairwise
from typing import TypeAlias

import numpy as np

from trundle._typing import Array
from trundle.errors import FitnessWarning
from trundle.signals import Isolator
from trundle.structure import FloorPlan, Material, ShellSection
from trundle.structure.building import Building
from trundle.study.model import Study
from trundle.study.plans import Drive, MethodPlan
from trundle.study.typical import doubt_of
from trundle.vehicle import GRAVITY, Vehicle

__all__ = ["value_doubts"]

Typed: TypeAlias = Iterator[tuple[str, str, float]]
"""Place in the study, key of `TYPICAL`, value [SI]."""

_HEAVY = 3500.0  # kg: goods vehicles above it have a class of their own
_DAMPED_AT = (4.0, 8.0, 16.0)  # Hz, where floors answer to vehicles
_OFF_ROAD = ("F", "G", "H")
_ON_EDGE = 0.05  # m


def value_doubts(study: Study) -> tuple[FitnessWarning, ...]:
    """Return a doubt for each value that is out of its usual range, with what may be meant."""
    found = [doubt_of(*typed) for typed in _typed(study)]
    return (
        *dict.fromkeys(doubt for doubt in found if doubt is not None),
        *_rough_roads(study),
        *_still_points(study),
    )


def _typed(study: Study) -> Typed:
    if study.plan is not None:
        yield from _plan(study.plan)
    if study.building is not None:
        yield from _building(study.building)
    for name, vehicle in _vehicles(study):
        yield from _vehicle(f"vehicle.{name}", vehicle)
    for name, drive in study.drives.items():
        yield from _drive(f"route {name!r}", drive)
    for speed in () if study.map is None else study.map.speeds:
        yield "map.speeds", "speed", float(speed)
    for label, road in study.roads.items():
        if (waviness := getattr(road, "waviness", None)) is not None:
            yield f"road {label}.waviness", "waviness", float(waviness)
    yield from _waves("roughness", study.band)
    for name, isolation in study.isolations.items():
        if isinstance(isolation, Isolator):
            yield f"point {name!r}.isolator.frequency", "isolator", isolation.frequency
            place = f"point {name!r}.isolator.damping"
            yield place, "damping of an isolator", isolation.damping_ratio
    for method in study.methods:
        yield from _method(f"method {method.name!r}", method)


def _vehicles(study: Study) -> Iterator[tuple[str, Vehicle]]:
    """Give each vehicle that drives, by its name in the file: all of a kind have one title."""
    routes = tomllib.loads(study.text).get("route", [])
    names = {route["name"]: route["vehicle"] for route in routes}
    yield from dict.fromkeys(
        (names.get(route, drive.vehicle.name), drive.vehicle)
        for route, drive in study.drives.items()
    )


def _plan(plan: FloorPlan) -> Typed:
    yield from _material("floor.material", plan.material)
    yield "floor.slab_thickness", "slab", plan.slab.thickness
    short = min(_widest(plan.x_lines, plan.secondary_lines), _widest(plan.y_lines))
    yield "floor.slab_thickness over its span", "slab over span", plan.slab.thickness / short
    if plan.slab.superimposed_mass > 0.0:
        yield "floor.superimposed_mass", "superimposed mass", plan.slab.superimposed_mass
    spans = {
        "beams_x": _widest(plan.x_lines),
        "beams_y": _widest(plan.y_lines),
        "secondary_y": _widest(plan.y_lines),
    }
    for name, span in spans.items():
        if (beam := getattr(plan, name)) is not None:
            yield f"floor.{name}.width", "beam width", beam.width
            yield f"floor.{name}.depth", "beam depth", beam.depth
            yield f"floor.{name}.depth over its span", "beam over span", beam.depth / span
    if plan.column is not None:
        yield "floor.column.width", "column", plan.column.width
        yield "floor.column.depth", "column", plan.column.depth
    for name in ("storey_below", "storey_above"):
        if (height := getattr(plan, name)) > 0.0:
            yield f"floor.{name}", "storey", height
    for axis in ("x", "y"):
        for gap in np.diff(getattr(plan, f"{axis}_lines")):
            yield f"floor.{axis}_lines, apart", "bay", float(gap)


def _building(building: Building) -> Typed:
    """Give what is plausible or not of slabs, columns and storeys."""
    for i, slab in enumerate(building.slabs, start=1):
        yield f"building.slab[{i}].plate, thickness", "slab", slab.section.thickness
        if isinstance(slab.section, ShellSection):
            yield from _material(f"building.slab[{i}].plate, material", slab.section.material)
            more = slab.section.superimposed_mass
            if more > 0.0:
                yield f"building.slab[{i}].plate, mass that lies on it", "superimposed mass", more
    for i, column in enumerate(building.columns, start=1):
        yield f"building column {i}, width", "column", column.profile.width
        yield f"building column {i}, depth", "column", column.profile.depth
    for low, high in pairwise(building.storeys):
        yield f"storey {high.name!r} above {low.name!r}", "storey", high.level - low.level


def _widest(*lines: Array) -> float:
    """Return the widest distance between lines [m]."""
    return float(np.diff(np.sort(np.concatenate(lines))).max(initial=0.0)) or np.inf


def _material(place: str, material: Material) -> Typed:
    yield f"{place}.elastic_modulus", "modulus", material.elastic_modulus
    yield f"{place}.density", "density", material.density
    ratio = material.elastic_modulus / material.density
    yield f"{place}, elastic_modulus over density", "modulus over density", ratio


def _vehicle(place: str, vehicle: Vehicle) -> Typed:
    yield place, "vehicle mass", vehicle.total_mass
    for name, force in zip(vehicle.contact_names, vehicle.static_forces, strict=True):
        yield f"{place}, {name}", "axle load", float(force) / GRAVITY
    if vehicle.n_contacts > 1:
        yield f"{place}, setback", "wheelbase", vehicle.length
    bounce = "bounce of a truck" if vehicle.total_mass > _HEAVY else "bounce"
    yield f"{place}, stiffness", bounce, float(vehicle.natural_frequencies()[0])
    poles = vehicle.poles()
    slowest = poles[np.argmin(np.abs(poles))]
    yield f"{place}, damping", "damping of a vehicle", float(-slowest.real / abs(slowest))


def _drive(place: str, drive: Drive) -> Typed:
    yield f"{place}.speed", "speed", drive.route.law.fastest
    steps = np.diff(drive.route.line, axis=0)
    yield f"{place}.path", "route", float(np.hypot(*steps.T).sum())
    if drive.run_in:
        yield f"{place}.run_in", "run-in", drive.run_in


def _waves(place: str, band: object) -> Typed:
    for name, key in (
        ("n_min", "longest wave"),
        ("n_max", "shortest wave"),
        ("contact_patch", "contact patch"),
    ):
        if value := float(getattr(band, name)):
            yield f"{place}.{name}", key, value


def _method(place: str, method: MethodPlan) -> Typed:
    if method.band is not None:
        yield from _waves(place, method.band)
    if length := getattr(method.entry, "length", None):
        yield f"{place}.entry_length", "entry", float(length)
    integration, damping = method.interaction.integration, method.interaction.damping
    if integration.f_max is not None:
        yield f"{place}.f_max", "modes", integration.f_max
    ratios = damping.ratios(2.0 * np.pi * np.array(_DAMPED_AT))
    if np.ptp(ratios) == 0.0:
        yield f"{place}.damping.ratio", "damping", float(ratios[0])
        return
    for f, ratio in zip(_DAMPED_AT, ratios, strict=True):
        yield f"{place}.damping at {f:g} Hz", "rayleigh", float(ratio)


def _rough_roads(study: Study) -> Iterator[FitnessWarning]:
    """Doubt classes that no floor has."""
    for label in study.roads:
        if label[:1] in _OFF_ROAD and label[1:2] in ("", " "):
            yield FitnessWarning(
                subject=f"road {label}",
                message=f"class {label[0]} is an unpaved track; floors and ramps are mostly class "
                "A to D: did you mean one of them?",
            )


def _still_points(study: Study) -> Iterator[FitnessWarning]:
    """Doubt points on an edge that cannot move."""
    plan = study.plan
    if plan is None:
        return
    for name, at in study.points.items():
        for edge, (axis, position) in plan.held_edges().items():
            if abs((at.x, at.y)[axis] - position) < _ON_EDGE:
                yield FitnessWarning(
                    subject=f"point {name!r}",
                    message=f"it stands on the edge {edge}, which is {plan.edges[edge]} and cannot "
                    "move: nothing is assessed there; read the response inside the floor",
                )

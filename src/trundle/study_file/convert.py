"""Turn single checked sections into values of the layers below."""

from __future__ import annotations

from typing import Any

import numpy as np

from trundle.errors import InputError
from trundle.road import RoadClass
from trundle.signals import Isolation, Isolator, TransmissibilityTable
from trundle.structure import FloorPlan, Material, Rectangle, ShellSection
from trundle.study_file import schema
from trundle.vehicle import Axle, Body, Hinge, Vehicle, build_vehicle, library_vehicle

__all__ = ["floor_plan_of", "isolation_of", "road_label", "road_of", "vehicle_of"]


def isolation_of(section: schema.IsolatorSection) -> Isolation:
    """Return what stands between floor and tool."""
    if section.table is not None and section.frequency is None and section.damping is None:
        f, ratios = np.array(section.table).T
        return TransmissibilityTable(frequencies=f, ratios=ratios)
    if section.table is None and section.frequency is not None and section.damping is not None:
        return Isolator(frequency=section.frequency, damping_ratio=section.damping)
    raise InputError("an isolator is either a frequency and a damping, or a table")


def road_of(section: schema.RoadSection) -> RoadClass:
    """Return a road class."""
    return RoadClass(section.class_, level=section.level, waviness=section.waviness)


def floor_plan_of(section: schema.PlanFloorSection) -> FloorPlan:
    """Return the plan of a storey."""
    material = Material(**dict(section.material))
    x, y = np.array(section.x_lines), np.array(section.y_lines)

    def size(rectangle: Any) -> Rectangle | None:
        """Return a rectangle, if one is given."""
        return None if rectangle is None else Rectangle(**dict(rectangle))

    return FloorPlan(
        name="plan",
        x_lines=x,
        y_lines=y,
        x_extent=section.x_extent or (float(x[0]), float(x[-1])),
        y_extent=section.y_extent or (float(y[0]), float(y[-1])),
        slab=ShellSection(
            thickness=section.slab_thickness,
            material=material,
            superimposed_mass=section.superimposed_mass,
        ),
        material=material,
        beams_x=size(section.beams_x),
        beams_y=size(section.beams_y),
        secondary_y=size(section.secondary_y),
        secondary_per_bay=section.secondary_per_bay,
        column=size(section.column),
        storey_below=section.storey_below,
        storey_above=section.storey_above,
        edges=dict(section.edges),
        eccentric_beams=section.eccentric_beams,
    )


def vehicle_of(name: str, section: Any) -> Vehicle:
    """Return a vehicle, built or from the library."""
    if isinstance(section, schema.PlanarVehicleSection):
        return build_vehicle(
            name=name,
            bodies=tuple(Body(**dict(b)) for b in section.bodies),
            axles=tuple(Axle(**dict(a)) for a in section.axles),
            hinges=tuple(Hinge(**dict(h)) for h in section.hinges),
            source="study file",
        )
    return library_vehicle(section.kind)


def road_label(section: schema.RoadSection) -> str:
    """Return the short label of a road: the class letter, with its level if not the mean."""
    label = section.class_
    if section.level != "geometric_mean":
        label += f" {section.level}"
    return label if section.waviness == 2.0 else f"{label} w={section.waviness:g}"

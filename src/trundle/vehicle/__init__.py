"""Model linear multi-axle vehicles and build them from parts."""

from trundle.vehicle.library import (
    VEHICLES,
    articulated_truck_5_axle,
    container_truck_40ft,
    quarter_car,
    sprung_mass,
)
from trundle.vehicle.model import GRAVITY, Vehicle
from trundle.vehicle.planar import (
    Axle,
    Body,
    Hinge,
    LumpedMass,
    build_vehicle,
    damping_coefficient,
)

__all__ = [
    "GRAVITY",
    "VEHICLES",
    "Axle",
    "Body",
    "Hinge",
    "LumpedMass",
    "Vehicle",
    "articulated_truck_5_axle",
    "build_vehicle",
    "container_truck_40ft",
    "damping_coefficient",
    "quarter_car",
    "sprung_mass",
]

"""Model linear multi-axle vehicles and build them from parts."""

from trundle.vehicle.data_file import VehicleFile, read_vehicle
from trundle.vehicle.library import (
    RETIRED,
    VEHICLES,
    container_truck_40ft,
    library_vehicle,
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
    wheel_mistake,
)

__all__ = [
    "GRAVITY",
    "RETIRED",
    "VEHICLES",
    "Axle",
    "Body",
    "Hinge",
    "LumpedMass",
    "Vehicle",
    "VehicleFile",
    "build_vehicle",
    "container_truck_40ft",
    "damping_coefficient",
    "library_vehicle",
    "quarter_car",
    "read_vehicle",
    "sprung_mass",
    "wheel_mistake",
]

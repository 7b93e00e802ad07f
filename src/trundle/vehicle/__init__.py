"""Model linear multi-axle vehicles and build them from parts or data sheets."""

from trundle.vehicle.data_file import VehicleFile, read_vehicle
from trundle.vehicle.description import Description, build_vehicle
from trundle.vehicle.excitation import BodyForce, OutOfRound
from trundle.vehicle.library import (
    RETIRED,
    VEHICLES,
    container_truck_40ft,
    describe,
    library_vehicle,
    quarter_car,
    sprung_mass,
)
from trundle.vehicle.model import GRAVITY, Confidence, Vehicle
from trundle.vehicle.nonlinear import Friction, PartLaw, Stop
from trundle.vehicle.parts import (
    Axle,
    Body,
    Bogie,
    Hinge,
    LumpedMass,
    Unit,
    damping_coefficient,
    wheel_mistake,
)
from trundle.vehicle.sheet import DataSheet, quarter_car_springs

__all__ = [
    "GRAVITY",
    "RETIRED",
    "VEHICLES",
    "Axle",
    "Body",
    "BodyForce",
    "Bogie",
    "Confidence",
    "DataSheet",
    "Description",
    "Friction",
    "Hinge",
    "LumpedMass",
    "OutOfRound",
    "PartLaw",
    "Stop",
    "Unit",
    "Vehicle",
    "VehicleFile",
    "build_vehicle",
    "container_truck_40ft",
    "damping_coefficient",
    "describe",
    "library_vehicle",
    "quarter_car",
    "quarter_car_springs",
    "read_vehicle",
    "sprung_mass",
    "wheel_mistake",
]

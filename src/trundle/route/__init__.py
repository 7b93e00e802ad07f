"""Say where vehicles drive, and connect a moving wheel to the floor's dofs."""

from trundle.route.contact import ContactRows, contact_rows, level_rows
from trundle.route.entry import Abrupt, DriveIn, Entry, Ramp, StaticStart, entry_named
from trundle.route.path import Route, Steering
from trundle.route.speed import ConstantSpeed, SpeedLaw, SpeedOverTime, SteadyAcceleration
from trundle.route.steering import Footprint, WheelPlaces, wheel_places
from trundle.route.track import Along, Track, follow

__all__ = [
    "Abrupt",
    "Along",
    "ConstantSpeed",
    "ContactRows",
    "DriveIn",
    "Entry",
    "Footprint",
    "Ramp",
    "Route",
    "SpeedLaw",
    "SpeedOverTime",
    "StaticStart",
    "SteadyAcceleration",
    "Steering",
    "Track",
    "WheelPlaces",
    "contact_rows",
    "entry_named",
    "follow",
    "level_rows",
    "wheel_places",
]

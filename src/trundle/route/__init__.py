"""Say where vehicles drive, and connect a moving wheel to the floor's dofs."""

from trundle.route.contact import ContactRows, contact_rows, level_rows
from trundle.route.entry import Abrupt, DriveIn, Entry, Ramp, StaticStart, entry_named
from trundle.route.path import ConstantSpeed, Route, SpeedLaw, SteadyAcceleration
from trundle.route.track import Along, Track, follow

__all__ = [
    "Abrupt",
    "Along",
    "ConstantSpeed",
    "ContactRows",
    "DriveIn",
    "Entry",
    "Ramp",
    "Route",
    "SpeedLaw",
    "StaticStart",
    "SteadyAcceleration",
    "Track",
    "contact_rows",
    "entry_named",
    "follow",
    "level_rows",
]

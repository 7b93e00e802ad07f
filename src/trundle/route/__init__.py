"""Say where vehicles drive, and connect a moving wheel to the floor's dofs."""

from trundle.route.contact import ContactRows, ContactShape, Hat, Hermite, contact_rows
from trundle.route.entry import Abrupt, DriveIn, Entry, Ramp, StaticStart, entry_named
from trundle.route.locate import Deck, deck_of
from trundle.route.path import ConstantSpeed, Route, SpeedLaw, SteadyAcceleration

__all__ = [
    "Abrupt",
    "ConstantSpeed",
    "ContactRows",
    "ContactShape",
    "Deck",
    "DriveIn",
    "Entry",
    "Hat",
    "Hermite",
    "Ramp",
    "Route",
    "SpeedLaw",
    "StaticStart",
    "SteadyAcceleration",
    "contact_rows",
    "deck_of",
    "entry_named",
]

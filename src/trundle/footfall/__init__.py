"""Describe what people press on a floor when they walk: load functions of the guides."""

from trundle.footfall.library import FOOTFALLS, footfall_load
from trundle.footfall.load import FootfallLoad, Harmonic, Impulse

__all__ = ["FOOTFALLS", "FootfallLoad", "Harmonic", "Impulse", "footfall_load"]

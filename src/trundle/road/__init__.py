"""Describe, draw and read road roughness after ISO 8608."""

from trundle.road.iso8608 import (
    CLASS_NAMES,
    FITTED_RANGE,
    REFERENCE_ANGULAR_FREQUENCY,
    REFERENCE_FREQUENCY,
    RoadClass,
    RoughnessLevel,
    class_limits,
)
from trundle.road.profile import Profile
from trundle.road.synthesis import RoughnessBand, synthesise
from trundle.road.temporal import temporal_psd, temporal_psd_two_sided

__all__ = [
    "CLASS_NAMES",
    "FITTED_RANGE",
    "REFERENCE_ANGULAR_FREQUENCY",
    "REFERENCE_FREQUENCY",
    "Profile",
    "RoadClass",
    "RoughnessBand",
    "RoughnessLevel",
    "class_limits",
    "synthesise",
    "temporal_psd",
    "temporal_psd_two_sided",
]

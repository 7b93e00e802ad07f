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
from trundle.road.plausibility import profile_doubts
from trundle.road.profile import Beyond, Profile, ProfileReader
from trundle.road.survey import RoughnessFit, classify, fit_roughness, roughness_index
from trundle.road.synthesis import RoughnessBand, synthesise, wave_power
from trundle.road.temporal import temporal_psd, temporal_psd_two_sided
from trundle.road.tracks import synthesise_tracks, track_coherence

__all__ = [
    "CLASS_NAMES",
    "FITTED_RANGE",
    "REFERENCE_ANGULAR_FREQUENCY",
    "REFERENCE_FREQUENCY",
    "Beyond",
    "Profile",
    "ProfileReader",
    "RoadClass",
    "RoughnessBand",
    "RoughnessFit",
    "RoughnessLevel",
    "class_limits",
    "classify",
    "fit_roughness",
    "profile_doubts",
    "roughness_index",
    "synthesise",
    "synthesise_tracks",
    "temporal_psd",
    "temporal_psd_two_sided",
    "track_coherence",
    "wave_power",
]

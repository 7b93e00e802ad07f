"""Describe, draw and read road roughness after ISO 8608."""

from trundle.road.features import Feature, Shape, Tread, laid
from trundle.road.flatness import flat_floor
from trundle.road.humps import Bump, CosineHump, RampKink
from trundle.road.iso8608 import (
    CLASS_NAMES,
    FITTED_RANGE,
    REFERENCE_ANGULAR_FREQUENCY,
    REFERENCE_FREQUENCY,
    RoadClass,
    RoadSpectrum,
    RoughnessLevel,
    Spectrum,
    class_limits,
)
from trundle.road.plausibility import check_roughness, profile_doubts
from trundle.road.profile import Beyond, Profile, ProfileReader
from trundle.road.road import FeaturedRoad, MeasuredRoad, Road
from trundle.road.shapes import CableProtector, ExpansionJoint, Patch, Pothole, RailCrossing
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
    "Bump",
    "CableProtector",
    "CosineHump",
    "ExpansionJoint",
    "Feature",
    "FeaturedRoad",
    "MeasuredRoad",
    "Patch",
    "Pothole",
    "Profile",
    "ProfileReader",
    "RailCrossing",
    "RampKink",
    "Road",
    "RoadClass",
    "RoadSpectrum",
    "RoughnessBand",
    "RoughnessFit",
    "RoughnessLevel",
    "Shape",
    "Spectrum",
    "Tread",
    "check_roughness",
    "class_limits",
    "classify",
    "fit_roughness",
    "flat_floor",
    "laid",
    "profile_doubts",
    "roughness_index",
    "synthesise",
    "synthesise_tracks",
    "temporal_psd",
    "temporal_psd_two_sided",
    "track_coherence",
    "wave_power",
]

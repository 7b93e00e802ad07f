"""Drive vehicles over floors, decoupled or coupled, one at a time or together; walk on them."""

from trundle.dynamics import ByMaterial, Damping, ModalRatio, Rayleigh
from trundle.simulate.coverage import Coverage, coverage_of
from trundle.simulate.direct.method import Newmark
from trundle.simulate.ensembles import (
    batches,
    contact_force_histories,
    contact_forces,
    ensemble,
    runs_with_mean,
)
from trundle.simulate.ground import Ground, Integration, PreparedFloor
from trundle.simulate.interaction import Coupled, Decoupled, Interaction
from trundle.simulate.laying_out import lay_out
from trundle.simulate.layout import Layout
from trundle.simulate.modal.method import Modal
from trundle.simulate.modal.residual import StaticFlexibility
from trundle.simulate.point_load import point_load_deflection
from trundle.simulate.prepared import prepare
from trundle.simulate.runs import MeanResponse, Runs
from trundle.simulate.sources.crossing import Crossing
from trundle.simulate.sources.source import Inputs, KnownForces, Source, WaveSet
from trundle.simulate.sources.waves import Waves, place_waves
from trundle.simulate.spectral.footfall_floor import FootfallFloor, footfall_floor
from trundle.simulate.spectral.footfall_response import (
    FootfallLevels,
    FootfallResponse,
    footfall_response,
)
from trundle.simulate.spectral.footfall_rules import (
    AiscBayRule,
    AiscRule,
    CcipRule,
    FootfallQuantity,
    FootfallRule,
    SciRule,
    aisc_bay_acceleration,
    footfall_rule,
)
from trundle.simulate.spectral.footfall_terms import footfall_paces
from trundle.simulate.spectral.harmonics import Harmonics, harmonics, mean_response
from trundle.simulate.spectral.place_spectra import place_spectra
from trundle.simulate.spectral.places import PlaceResponses, lay_out_places
from trundle.simulate.spectral.transfer import TransferFunctions, transfer
from trundle.simulate.truncation import TruncationChange, truncation_change

__all__ = [
    "AiscBayRule",
    "AiscRule",
    "ByMaterial",
    "CcipRule",
    "Coupled",
    "Coverage",
    "Crossing",
    "Damping",
    "Decoupled",
    "FootfallFloor",
    "FootfallLevels",
    "FootfallQuantity",
    "FootfallResponse",
    "FootfallRule",
    "Ground",
    "Harmonics",
    "Inputs",
    "Integration",
    "Interaction",
    "KnownForces",
    "Layout",
    "MeanResponse",
    "Modal",
    "ModalRatio",
    "Newmark",
    "PlaceResponses",
    "PreparedFloor",
    "Rayleigh",
    "Runs",
    "SciRule",
    "Source",
    "StaticFlexibility",
    "TransferFunctions",
    "TruncationChange",
    "WaveSet",
    "Waves",
    "aisc_bay_acceleration",
    "batches",
    "contact_force_histories",
    "contact_forces",
    "coverage_of",
    "ensemble",
    "footfall_floor",
    "footfall_paces",
    "footfall_response",
    "footfall_rule",
    "harmonics",
    "lay_out",
    "lay_out_places",
    "mean_response",
    "place_spectra",
    "place_waves",
    "point_load_deflection",
    "prepare",
    "runs_with_mean",
    "transfer",
    "truncation_change",
]

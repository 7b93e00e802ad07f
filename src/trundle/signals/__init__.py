"""Define bands, spectra and levels once, for simulated and measured signals alike."""

from trundle.signals.bands import (
    HIGHEST_BAND,
    LOWEST_BAND,
    band_delay,
    band_edges,
    band_filter,
    filter_bands,
    filter_zero_phase,
    mid_band_frequencies,
    nominal_frequency,
    usable_bands,
)
from trundle.signals.isolation import Isolation, Isolator, TransmissibilityTable, behind
from trundle.signals.levels import (
    Averaging,
    averaged_rms,
    band_levels,
    band_maxima,
    band_peaks,
    level_scatter,
    running_rms,
)
from trundle.signals.psd import amplitude_spectrum, welch_psd
from trundle.signals.record import Axis, Record, RecordQuantity, axis_of, channel_fault
from trundle.signals.record_doubts import doubtful_channels, record_warnings
from trundle.signals.record_motion import motion_of, wide_motion_of
from trundle.signals.weighting import (
    BASE_ACCELERATION,
    BASE_SIDEWAYS,
    Weighting,
    crest_factor,
    mtvv,
    response_factor,
    vibration_dose_value,
    weight,
    weighting_response,
)

__all__ = [
    "BASE_ACCELERATION",
    "BASE_SIDEWAYS",
    "HIGHEST_BAND",
    "LOWEST_BAND",
    "Averaging",
    "Axis",
    "Isolation",
    "Isolator",
    "Record",
    "RecordQuantity",
    "TransmissibilityTable",
    "Weighting",
    "amplitude_spectrum",
    "averaged_rms",
    "axis_of",
    "band_delay",
    "band_edges",
    "band_filter",
    "band_levels",
    "band_maxima",
    "band_peaks",
    "behind",
    "channel_fault",
    "crest_factor",
    "doubtful_channels",
    "filter_bands",
    "filter_zero_phase",
    "level_scatter",
    "mid_band_frequencies",
    "motion_of",
    "mtvv",
    "nominal_frequency",
    "record_warnings",
    "response_factor",
    "running_rms",
    "usable_bands",
    "vibration_dose_value",
    "weight",
    "weighting_response",
    "welch_psd",
    "wide_motion_of",
]

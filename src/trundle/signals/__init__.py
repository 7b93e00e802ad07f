"""Define bands, spectra and levels once, for simulated and measured signals alike."""

from trundle.signals.bands import (
    HIGHEST_BAND,
    LOWEST_BAND,
    band_edges,
    band_filter,
    filter_bands,
    mid_band_frequencies,
    nominal_frequency,
    usable_bands,
)
from trundle.signals.levels import Averaging, averaged_rms, band_levels, running_rms
from trundle.signals.psd import welch_psd

__all__ = [
    "HIGHEST_BAND",
    "LOWEST_BAND",
    "Averaging",
    "averaged_rms",
    "band_edges",
    "band_filter",
    "band_levels",
    "filter_bands",
    "mid_band_frequencies",
    "nominal_frequency",
    "running_rms",
    "usable_bands",
    "welch_psd",
]

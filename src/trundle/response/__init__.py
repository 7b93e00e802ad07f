"""Reduce histories to spectra, percentiles and bounds."""

from trundle.response.bounds import UpperBounds, percentile_rank, upper_bounds
from trundle.response.spectra import BandSpectra, velocity_spectra

__all__ = ["BandSpectra", "UpperBounds", "percentile_rank", "upper_bounds", "velocity_spectra"]

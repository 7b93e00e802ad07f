"""Reduce histories to spectra, percentiles, bounds and exact statistics."""

from trundle.response.bounds import UpperBounds, percentile_rank, upper_bounds
from trundle.response.floor_maps import FloorMap, floor_map
from trundle.response.isolated import behind_isolators
from trundle.response.level_doubts import few_runs_warnings, level_warnings
from trundle.response.measured import reduce_record
from trundle.response.meter import CurveLimit, Meter, Reading
from trundle.response.peaks import LargestValues
from trundle.response.quantities import QUANTITIES, Quantity, tabled
from trundle.response.reduction import (
    RunLevels,
    join,
    percentile_interval,
    reduce_on_scaled_roads,
    reduce_runs,
)
from trundle.response.sections import SectionLevels, join_sections, reduce_section
from trundle.response.size_doubts import size_warnings
from trundle.response.spectra import (
    BandSpectra,
    SpectrumQuantity,
    spectra_of,
    velocity_spectra,
)
from trundle.response.statistics import ExactStatistics, exact_statistics

__all__ = [
    "QUANTITIES",
    "BandSpectra",
    "CurveLimit",
    "ExactStatistics",
    "FloorMap",
    "LargestValues",
    "Meter",
    "Quantity",
    "Reading",
    "RunLevels",
    "SectionLevels",
    "SpectrumQuantity",
    "UpperBounds",
    "behind_isolators",
    "exact_statistics",
    "few_runs_warnings",
    "floor_map",
    "join",
    "join_sections",
    "level_warnings",
    "percentile_interval",
    "percentile_rank",
    "reduce_on_scaled_roads",
    "reduce_record",
    "reduce_runs",
    "reduce_section",
    "size_warnings",
    "spectra_of",
    "tabled",
    "upper_bounds",
    "velocity_spectra",
]

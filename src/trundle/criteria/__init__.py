"""Hold vibration criteria as data and responses against them."""

from trundle.criteria.assessing import assess, assess_reduced, best_class, spectra_asked_for
from trundle.criteria.class_maps import ClassMap, class_map, envelope_of
from trundle.criteria.curve import (
    BY_FREQUENCY,
    VC,
    Criterion,
    Quantity,
    Shape,
    all_criteria,
    find_criterion,
    shaped,
)
from trundle.criteria.verdict import BandOutcomes, Status, Verdict
from trundle.criteria.watching import watched

__all__ = [
    "BY_FREQUENCY",
    "VC",
    "BandOutcomes",
    "ClassMap",
    "Criterion",
    "Quantity",
    "Shape",
    "Status",
    "Verdict",
    "all_criteria",
    "assess",
    "assess_reduced",
    "best_class",
    "class_map",
    "envelope_of",
    "find_criterion",
    "shaped",
    "spectra_asked_for",
    "watched",
]

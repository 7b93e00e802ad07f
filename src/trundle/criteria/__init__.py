"""Hold vibration criteria as data and responses against them."""

from trundle.criteria.assess import assess, assess_reduced, best_class, spectra_asked_for
from trundle.criteria.class_map import ClassMap, class_map, envelope_of
from trundle.criteria.curve import (
    BY_FREQUENCY,
    VC,
    Criterion,
    Quantity,
    all_criteria,
    find_criterion,
)
from trundle.criteria.verdict import BandOutcomes, Status, Verdict

__all__ = [
    "BY_FREQUENCY",
    "VC",
    "BandOutcomes",
    "ClassMap",
    "Criterion",
    "Quantity",
    "Status",
    "Verdict",
    "all_criteria",
    "assess",
    "assess_reduced",
    "best_class",
    "class_map",
    "envelope_of",
    "find_criterion",
    "spectra_asked_for",
]

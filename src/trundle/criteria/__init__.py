"""Hold vibration criteria as data and responses against them."""

from trundle.criteria.assess import Status, Verdict, assess, assess_spectra, best_class
from trundle.criteria.curve import VC, Criterion, Quantity, all_criteria, find_criterion

__all__ = [
    "VC",
    "Criterion",
    "Quantity",
    "Status",
    "Verdict",
    "all_criteria",
    "assess",
    "assess_spectra",
    "best_class",
    "find_criterion",
]

"""Find the modes of large structures by their parts."""

from trundle.structure.superelements.answers import as_modes_of, questions_of
from trundle.structure.superelements.assembly import Joined
from trundle.structure.superelements.cuts import Cuts
from trundle.structure.superelements.evidence import PartEvidence
from trundle.structure.superelements.pencil import ReducedPencil
from trundle.structure.superelements.reduction import Part, Sorted, reduced_here
from trundle.structure.superelements.regions import Region, middles_of
from trundle.structure.superelements.whole import PartedStructure, Parting

__all__ = [
    "Cuts",
    "Joined",
    "Part",
    "PartEvidence",
    "PartedStructure",
    "Parting",
    "ReducedPencil",
    "Region",
    "Sorted",
    "as_modes_of",
    "middles_of",
    "questions_of",
    "reduced_here",
]

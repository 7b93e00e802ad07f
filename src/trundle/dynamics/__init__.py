"""Reduce vibrating things to matrices and step them through time."""

from trundle.dynamics.answering import (
    AnswerAll,
    AnsweringModes,
    answer_here,
    answering_modes,
    spacing_at_first,
)
from trundle.dynamics.combined_modes import ResponseBasis, response_basis
from trundle.dynamics.damping import ByMaterial, Damping, ModalRatio, Rayleigh
from trundle.dynamics.eigen import (
    count_modes_below,
    dense_is_better,
    intervals_below,
    modes_by_shifts,
    modes_within,
    natural_modes,
    together,
)
from trundle.dynamics.enquiry import Enquiry, Questions
from trundle.dynamics.exact import ExactRecursion, ModalRecursion
from trundle.dynamics.kept_answers import (
    answers_as_arrays,
    answers_from_arrays,
    are_answers_of,
)
from trundle.dynamics.kept_modes import are_modes_of, modes_as_arrays, modes_from_arrays
from trundle.dynamics.kept_parts import is_reduction_of, part_as_arrays, part_from_arrays
from trundle.dynamics.lanczos import Interval
from trundle.dynamics.line_skeleton import few_lines
from trundle.dynamics.modes import Basis, Modes, unit_rows
from trundle.dynamics.newmark import HalfStep, NewmarkParameters, NewmarkPropagator
from trundle.dynamics.pencil import (
    DampedPencil,
    Pencil,
    Product,
    SparsePencil,
    shift_near,
)
from trundle.dynamics.same_bits import repeatable
from trundle.dynamics.sampling import (
    REACH,
    TOP,
    differentiator,
    following_filters,
    image_filters,
    responses_of,
    restoring_filter,
)
from trundle.dynamics.sparse_solver import (
    Factor,
    HalfSolve,
    Solver,
    available_backends,
    factorise,
    factorise_damped,
)
from trundle.dynamics.stepping import Motion, Propagator, State
from trundle.dynamics.superelement import RestingPart, Superelement, reduce_part
from trundle.dynamics.system import LinearSystem, block_diagonal

__all__ = [
    "REACH",
    "TOP",
    "AnswerAll",
    "AnsweringModes",
    "Basis",
    "ByMaterial",
    "DampedPencil",
    "Damping",
    "Enquiry",
    "ExactRecursion",
    "Factor",
    "HalfSolve",
    "HalfStep",
    "Interval",
    "LinearSystem",
    "ModalRatio",
    "ModalRecursion",
    "Modes",
    "Motion",
    "NewmarkParameters",
    "NewmarkPropagator",
    "Pencil",
    "Product",
    "Propagator",
    "Questions",
    "Rayleigh",
    "ResponseBasis",
    "RestingPart",
    "Solver",
    "SparsePencil",
    "State",
    "Superelement",
    "answer_here",
    "answering_modes",
    "answers_as_arrays",
    "answers_from_arrays",
    "are_answers_of",
    "are_modes_of",
    "available_backends",
    "block_diagonal",
    "count_modes_below",
    "dense_is_better",
    "differentiator",
    "factorise",
    "factorise_damped",
    "few_lines",
    "following_filters",
    "image_filters",
    "intervals_below",
    "is_reduction_of",
    "modes_as_arrays",
    "modes_by_shifts",
    "modes_from_arrays",
    "modes_within",
    "natural_modes",
    "part_as_arrays",
    "part_from_arrays",
    "reduce_part",
    "repeatable",
    "response_basis",
    "responses_of",
    "restoring_filter",
    "shift_near",
    "spacing_at_first",
    "together",
    "unit_rows",
]

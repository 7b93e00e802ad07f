"""Reduce vibrating things to matrices and step them through time."""

from trundle.dynamics.damping import ByMaterial, Damping, ModalRatio, Rayleigh
from trundle.dynamics.eigen import count_modes_below, modes_by_shifts, natural_modes
from trundle.dynamics.exact import ExactRecursion, ModalRecursion
from trundle.dynamics.kept_modes import are_modes_of, modes_as_arrays, modes_from_arrays
from trundle.dynamics.modes import Basis, Modes
from trundle.dynamics.newmark import HalfStep, NewmarkParameters, NewmarkPropagator
from trundle.dynamics.pencil import Pencil, Product, SparsePencil, shift_near
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
from trundle.dynamics.sparse_solver import Factor, HalfSolve, available_backends, factorise
from trundle.dynamics.stepping import Motion, Propagator, State
from trundle.dynamics.superelement import Superelement, reduce_part
from trundle.dynamics.system import LinearSystem, block_diagonal

__all__ = [
    "REACH",
    "TOP",
    "Basis",
    "ByMaterial",
    "Damping",
    "ExactRecursion",
    "Factor",
    "HalfSolve",
    "HalfStep",
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
    "Rayleigh",
    "SparsePencil",
    "State",
    "Superelement",
    "are_modes_of",
    "available_backends",
    "block_diagonal",
    "count_modes_below",
    "differentiator",
    "factorise",
    "following_filters",
    "image_filters",
    "modes_as_arrays",
    "modes_by_shifts",
    "modes_from_arrays",
    "natural_modes",
    "reduce_part",
    "repeatable",
    "responses_of",
    "restoring_filter",
    "shift_near",
]

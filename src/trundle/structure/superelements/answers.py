"""Find by what a structure answers, by its parts, in place of all its modes."""

from __future__ import annotations

from dataclasses import replace

from jaxtyping import Int
from scipy import sparse

from trundle._typing import Array, SparseMatrix
from trundle.dynamics import (
    AnsweringModes,
    Modes,
    Questions,
    unit_rows,
)
from trundle.structure.superelements.whole import PartedStructure

__all__ = ["as_modes_of", "questions_of"]

_TOO_MANY = "; these are more than the modes: all modes cost less, without response_tolerance"


def questions_of(
    structure: PartedStructure,
    dofs: Int[Array, " dofs"],
    read: SparseMatrix,
    mapped: SparseMatrix | None = None,
) -> Questions:
    """Return what is asked of a structure, by the coordinates of its parts.

    Parameters
    ----------
    structure : PartedStructure
        The structure, by its parts.
    dofs : ndarray of int
        The free dofs that wheels load, rising.
    read, mapped : sparse array, shape (n, n_dofs)
        Rows of weights that read points, and places of maps.
    """
    nothing = sparse.csr_array((0, structure.n_dofs))
    joined = structure.joined
    return Questions(
        pushed=joined.by_coordinates(unit_rows(dofs, structure.n_dofs)),
        read=joined.by_coordinates(read),
        mapped=joined.by_coordinates(nothing if mapped is None else mapped),
    )


def as_modes_of(structure: PartedStructure, found: AnsweringModes) -> Modes:
    """Return combinations that answer as modes of a structure, with what a result must say of them.

    Parameters
    ----------
    structure : PartedStructure
        The structure, by its parts.
    found : AnsweringModes
        Combinations of their coordinates.
    """
    return replace(found.modes, basis=structure.joined, answering=_told(found))


def _told(found: AnsweringModes) -> str:
    """Return what a result must say of what was found."""
    modes = found.modes
    return (
        f"in place of the {found.n_below} modes below {modes.f_max:g} Hz, {modes.n_modes} "
        f"combinations of motions answer between routes, points and maps, found at "
        f"{found.n_frequencies} frequencies: where they were tried, before these were taken in, "
        f"they were off by {100.0 * found.error:.2g} % at most"
        + (_TOO_MANY if modes.n_modes > found.n_below else "")
    )

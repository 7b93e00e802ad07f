"""Find by what a structure answers, by its parts, in place of all its modes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from jaxtyping import Float, Int
from scipy import sparse

from trundle._progress import Progress
from trundle._typing import Array, SparseMatrix
from trundle.dynamics import (
    AnswerAll,
    AnsweringModes,
    Modes,
    Questions,
    answer_here,
    answering_modes,
    unit_rows,
)
from trundle.structure.superelements.whole import PartedStructure

__all__ = ["answering_by_parts", "questions_of"]

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


def answering_by_parts(
    structure: PartedStructure,
    questions: Questions,
    ratios: Callable[[Float[Array, " lines"]], Float[Array, " lines"]],
    *,
    f_max: float,
    tolerance: float,
    answer_all: AnswerAll = answer_here,
    progress: Progress | None = None,
) -> Modes:
    """Return combinations that answer as a structure does, see `dynamics.answering_modes`.

    Parameters
    ----------
    structure : PartedStructure
        The structure, by its parts.
    questions : Questions
        What is asked of it.
    ratios : callable
        Gives the least damping ratio of any mode at circular frequencies [rad/s].
    f_max : float
        Highest frequency at which it answers [Hz].
    tolerance : float
        Error that is allowed at any frequency.
    answer_all : callable
        Who solves at the frequencies.
    progress : callable, optional
        Told about how much of the work is done, 0 to 1.

    Raises
    ------
    InputError
        The parts are kept to less than 1.2 times that frequency.
    ConvergenceError
        It does not come within the tolerance.
    """
    structure.check_reach(f_max)
    found = answering_modes(
        structure.joined.pencil,
        questions,
        ratios,
        f_max=f_max,
        tolerance=tolerance,
        answer_all=answer_all,
        progress=progress,
    )
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

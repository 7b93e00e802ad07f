"""Find by what a building answers to a study's jobs, or between places, in place of all modes.

Each frequency at which it is solved is a task that any executor computes; they are taken in by
their order, so that results have the same bits whoever computes them.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, TypeGuard

import numpy as np

from trundle._progress import Progress
from trundle._typing import Array, SparseMatrix
from trundle.dynamics import (
    ByMaterial,
    Damping,
    Enquiry,
    Modes,
    Questions,
    answering_modes,
    repeatable,
)
from trundle.run.executor import Executor
from trundle.run.jobs import Job
from trundle.run.kept_answers import Asked, keep_answers, kept_answers
from trundle.run.loose_tasks import compute_loose
from trundle.run.seen import map_rows, seen_by_jobs
from trundle.structure import Structure
from trundle.structure.elements import Damped
from trundle.structure.superelements import PartedStructure, as_modes_of, questions_of

__all__ = ["AnswerTask", "answers_to_jobs", "answers_to_places", "asks_for_answers"]

_REDUCED = 0.3  # of the whole, what is done when parts are reduced, for progress
_AT_ONCE = 1e9  # bytes of answers that are held together


@dataclass(frozen=True, kw_only=True, eq=False)
class AnswerTask:
    """Solve a structure at one frequency.

    Attributes
    ----------
    name : str
        Which frequency.
    shift : complex
        z of it [rad2/s2].
    alone : bool
        Never: frequencies are solved beside each other.
    """

    name: str
    shift: complex
    alone: bool = False

    def compute(self, shared: Any, progress: Progress | None = None) -> Array:  # noqa: ANN401
        """Solve for all forces; `shared` is the enquiry."""
        del progress
        return shared.at(self.shift)


def asks_for_answers(structure: Structure) -> TypeGuard[PartedStructure]:
    """Return whether combinations that answer are wanted in place of all modes."""
    return isinstance(structure, PartedStructure) and structure.parting.response_tolerance > 0.0


def answers_to_jobs(
    structure: PartedStructure,
    jobs: Sequence[Job],
    *,
    f_max: float,
    executor: Executor | None = None,
    progress: Progress | None = None,
) -> Modes:
    """Return by what a structure answers between routes, points and maps of jobs.

    Parameters
    ----------
    structure : PartedStructure
        The structure, by its parts.
    jobs : sequence of Job
        What is computed on it.
    f_max : float
        Highest frequency at which it answers [Hz].
    executor : Executor, optional
        Who solves; threads of this process unless given.
    progress : callable, optional
        Told about how much of the work is done, 0 to 1.

    Raises
    ------
    ConvergenceError
        It does not come within the tolerance of the parting.
    """
    told = _reduced(structure, f_max, progress)
    with repeatable():
        dofs, read = seen_by_jobs(structure, jobs)
        questions = questions_of(structure, dofs, read, map_rows(structure, jobs))
        return _answers(
            structure,
            questions,
            [job.method.interaction.damping for job in jobs],
            f_max=f_max,
            executor=executor,
            progress=told,
        )


def answers_to_places(
    structure: PartedStructure,
    loads: SparseMatrix,
    points: SparseMatrix,
    damping: Damping,
    *,
    f_max: float,
    progress: Progress | None = None,
) -> Modes:
    """Return by what a structure answers between some places.

    Parameters
    ----------
    structure : PartedStructure
        The structure, by its parts.
    loads, points : sparse array, shape (n, n_dofs)
        Rows of weights of where it is pushed, and of where it is read.
    damping : Damping
        Its damping.
    f_max : float
        Highest frequency at which it answers [Hz].
    progress : callable, optional
        Told about how much of the work is done, 0 to 1.

    Raises
    ------
    ConvergenceError
        It does not come within the tolerance of the parting.
    """
    told = _reduced(structure, f_max, progress)
    with repeatable():
        questions = questions_of(structure, np.unique(loads.indices), points)
        return _answers(structure, questions, [damping], f_max=f_max, executor=None, progress=told)


def _reduced(structure: PartedStructure, f_max: float, progress: Progress | None) -> Progress:
    """Reduce the parts, which must reach far enough; return whom to tell of what is left."""
    told = progress or _nobody
    structure.check_reach(f_max)
    structure.reduced(tell=lambda _, share: told(_REDUCED * share))
    told(_REDUCED)
    return lambda share: told(_REDUCED + (1.0 - _REDUCED) * share)


def _answers(
    structure: PartedStructure,
    questions: Questions,
    dampings: Sequence[Damping],
    *,
    f_max: float,
    executor: Executor | None,
    progress: Progress,
) -> Modes:
    """Return what is kept of the same questions, or find it by an executor, and keep it."""

    def answer_all(enquiry: Enquiry, shifts: Sequence[complex]) -> Iterator[Array]:
        """Give the answers in the order of the shifts, a few held at a time."""
        at_once = max(2, int(_AT_ONCE / (16.0 * enquiry.forces.size)))
        for start in range(0, len(shifts), at_once):
            tasks = [
                AnswerTask(name=f"answers {start + i}", shift=shift)
                for i, shift in enumerate(shifts[start : start + at_once])
            ]
            found = compute_loose([(task, enquiry) for task in tasks], executor, _nobody)
            for task in tasks:
                yield found.pop(task.name)

    def ratios(omega: Array) -> Array:
        """Return the least damping ratio of any method and material."""
        return np.minimum.reduce([_least_ratios(structure, one, omega) for one in dampings])

    asked = Asked(structure=structure, questions=questions, ratios=ratios, f_max=f_max)
    found = kept_answers(asked)
    if found is None:
        found = answering_modes(
            structure.joined.pencil,
            questions,
            ratios,
            f_max=f_max,
            tolerance=structure.parting.response_tolerance,
            answer_all=answer_all,
            progress=progress,
        )
        keep_answers(asked, found)
    return as_modes_of(structure, found)


def _least_ratios(structure: Structure, damping: Damping, omega: Array) -> Array:
    """Return the least ratio that a mode at each frequency may have."""
    least = damping.ratios(omega)
    if isinstance(damping, ByMaterial):
        known = (one.damping_ratio for one in structure.elements if isinstance(one, Damped))
        for ratio in known:
            least = least if ratio is None else np.minimum(least, ratio)
    return least


def _nobody(share: float) -> None:
    """Tell nobody."""
    del share

"""Define every error and warning that trundle raises or records.

The tree::

    TrundleError
    ├── InputError (ValueError)      something that came in from outside is wrong
    │   └── StudyError               all that is wrong with one study file, together
    └── ComputationError (ArithmeticError)   the mathematics failed
        ├── ConvergenceError         an iteration did not reach its tolerance
        ├── UnstableStepError        a number stopped being finite; carries step and time
        └── UnrestrainedModeError    the structure is a mechanism

Catch them all with::

    try:
        ...
    except trundle.errors.TrundleError as error:
        ...

A doubt that does not stop the work is a `FitnessWarning` value: it is kept in the result
and printed in the report, never only on the screen.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

__all__ = [
    "ComputationError",
    "ConvergenceError",
    "FitnessWarning",
    "InputError",
    "Problem",
    "StudyError",
    "TrundleError",
    "UnrestrainedModeError",
    "UnstableStepError",
]


class TrundleError(Exception):
    """Root of every error that trundle raises on purpose."""


class InputError(TrundleError, ValueError):
    """Input from outside breaks a rule; the message names place, value, rule and remedy."""


@dataclass(frozen=True, kw_only=True)
class Problem:
    """Hold one mistake of a study file.

    Attributes
    ----------
    place : str
        Where it stands, as a dotted path: ``route[2].speed``.
    value : str
        What stands there.
    rule : str
        What is asked of it.
    remedy : str
        What to do about it.
    line : int or None
        On which line of the file, where that is known.
    """

    place: str
    value: str
    rule: str
    remedy: str
    line: int | None = None

    def __str__(self) -> str:
        """Render the parts as one readable paragraph."""
        at = "" if self.line is None else f"line {self.line}, "
        return (
            f"{at}{self.place}: got {self.value}\n    rule:   {self.rule}\n"
            f"    remedy: {self.remedy}"
        )


class StudyError(InputError):
    """Hold every mistake found in one study file.

    Attributes
    ----------
    source : str
        Path of the file.
    problems : tuple of Problem
        The mistakes, in the order of the file.
    """

    def __init__(self, source: str, problems: Sequence[Problem]) -> None:
        self.source = source
        self.problems = tuple(problems)
        count = len(self.problems)
        head = f"{source}: {count} mistake{'s' if count != 1 else ''}"
        super().__init__("\n".join([head, *(f"  {problem}" for problem in self.problems)]))


class ComputationError(TrundleError, ArithmeticError):
    """The mathematics failed on input that passed every check."""


class ConvergenceError(ComputationError):
    """An iteration stopped before its tolerance.

    Attributes
    ----------
    residual : float
        Largest relative residual reached.
    """

    def __init__(self, message: str, *, residual: float = float("nan")) -> None:
        self.residual = residual
        super().__init__(message)


class UnstableStepError(ComputationError):
    """A state stopped being finite in a time integration.

    Attributes
    ----------
    step : int
        Index of the step at whose end it was seen.
    time : float
        Time of that step [s].
    """

    # Defaults let the error travel between processes, which set the attributes afterwards.
    def __init__(self, message: str, *, step: int = 0, time: float = float("nan")) -> None:
        self.step = step
        self.time = time
        super().__init__(message)


class UnrestrainedModeError(ComputationError):
    """A structure can move without strain (a mechanism, or a missing support)."""


@dataclass(frozen=True, kw_only=True)
class FitnessWarning:
    """State a doubt about a result's fitness for its purpose.

    Attributes
    ----------
    subject : str
        What is in doubt: ``time step``, ``roughness band``, ``mesh passing`` ...
    message : str
        The doubt with its numbers, and what would remove it.
    """

    subject: str
    message: str

    def __str__(self) -> str:
        """Render subject and message on one line."""
        return f"{self.subject}: {self.message}"

"""Find combinations of motions by which a structure answers, without finding its modes.

A route and some points tell few of the thousands of modes of a large building apart
(`dynamics.combined_modes`). Their answers at some frequencies,

    X(z) = (K - z M)^-1 B,      z = omega^2 / (1 + 2 i zeta),

B what pushes and what is read, span nearly all answers between them, at every frequency: transfer
functions of the projected matrices meet the true ones at each such z, twice where both ends of a
transfer are in B (rational interpolation by projection; Grimme 1997). The projected matrices are
diagonalised, so that whatever steps modes steps these.

Where more frequencies are needed is seen from the answers themselves. Each new one is first told by
what is there already: as far as it is off, so is whatever lies between. Where it is more than
is allowed the gaps beside it are halved, and so on. What is told of the error is the largest among
those within the tolerance, as it was before they were taken in.

References
----------
E. J. Grimme, Krylov projection methods for model reduction, University of Illinois (1997);
A. C. Antoulas, C. A. Beattie and S. Gugercin, Interpolatory Methods for Model Reduction (2020).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from jaxtyping import Float

from trundle._progress import Progress
from trundle._typing import Array
from trundle.dynamics.answer_span import Span
from trundle.dynamics.enquiry import Enquiry, Questions
from trundle.dynamics.krylov import BLOCK, Krylov
from trundle.dynamics.modes import Modes
from trundle.dynamics.pencil import DampedPencil, shift_near
from trundle.dynamics.sparse_solver import Factor
from trundle.errors import ConvergenceError

__all__ = ["AnswerAll", "AnsweringModes", "answer_here", "answering_modes", "spacing_at_first"]

AnswerAll: TypeAlias = Callable[[Enquiry, Sequence[complex]], Iterator[Array]]
"""Gives the answers of an enquiry at some shifts, in their order."""

_COARSE = 8.0  # first spacing of frequencies, against the damping ratio: four resonances wide
_FINEST = 0.2  # spacing at which the search is given up
_LEAST_RATIO = 0.002  # of the ratio, for the spacing
_APART = 4.0  # of frequencies about which patterns of forces are looked for
_SHARE = 0.3  # of the tolerance, below which a new direction is left out
_FLOOR = 0.01  # of the loudest answer: what is 40 dB below it need not be known as well
_HALFWAY = 20.0  # frequencies after which half of the work is done, as progress is told
_STEPS = 6  # of the iteration that finds where the spectrum begins


@dataclass(frozen=True, kw_only=True, eq=False)
class AnsweringModes:
    """Hold combinations by which a structure answers, as modes of a smaller system.

    Attributes
    ----------
    modes : Modes
        The combinations: M-orthonormal, and K-orthogonal to each other.
    error : float
        Largest error of a velocity at the frequencies that were within the tolerance, as it was
        before these were taken in: between the routes and any reading, of the routes' own motion
        and of maps. RMS over the route or the map of the difference, over that of the answer, or
        over a hundredth of the answer where it is loudest.
    n_frequencies : int
        At how many frequencies the structure was solved.
    n_below : int
        How many modes there are below `modes.f_max`, by inertia.
    """

    modes: Modes
    error: float
    n_frequencies: int
    n_below: int


def spacing_at_first(ratio: float) -> float:
    """Return the spacing of the first frequencies at a damping ratio, of their logarithm."""
    return _COARSE * max(ratio, _LEAST_RATIO)


def answer_here(enquiry: Enquiry, shifts: Sequence[complex]) -> Iterator[Array]:
    """Give the answers at some shifts, one after the other."""
    return map(enquiry.at, shifts)


def answering_modes(
    pencil: DampedPencil,
    questions: Questions,
    ratios: Callable[[Float[Array, " lines"]], Float[Array, " lines"]],
    *,
    f_max: float,
    tolerance: float,
    answer_all: AnswerAll = answer_here,
    progress: Progress | None = None,
) -> AnsweringModes:
    """Return combinations that answer as the whole structure does, within a tolerance.

    Parameters
    ----------
    pencil : DampedPencil
        Stiffness and mass, positive definite.
    questions : Questions
        Where the structure is pushed and looked at.
    ratios : callable
        Gives the damping ratio at circular frequencies [rad/s]: the smallest that any mode there
        may have.
    f_max : float
        Highest frequency at which it answers [Hz].
    tolerance : float
        Error that is allowed at any frequency, see `AnsweringModes`.
    answer_all : callable
        Who solves at the frequencies.
    progress : callable, optional
        Told about how much of the work is done, 0 to 1.

    Raises
    ------
    ConvergenceError
        Frequencies come closer to each other than a resonance is wide, and it is not within the
        tolerance yet.
    """
    high = 2.0 * np.pi * f_max
    n_below = shift_near(pencil, high).below
    rest = pencil.factorise(0.0)
    low = 0.5 * min(_first_omega(pencil, rest), high)
    search = _Search(ratios=ratios, low=low, high=high)
    enquiry = Enquiry.of(
        pencil, questions, rest, shifts=[*map(search.shift, search.few())], tolerance=tolerance
    )
    span, told = Span(enquiry=enquiry), progress or _nobody
    lines, known, error = search.first(), np.zeros(0), 0.0
    small = _SHARE * tolerance
    loudest = np.zeros((2, enquiry.probed.shape[1]))
    while len(lines):
        basis = enquiry.motions(*span.diagonal()) if len(known) else None
        off, sizes = (np.zeros((len(lines), *loudest.shape)) for _ in range(2))
        shifts = [search.shift(omega) for omega in lines]
        for i, found in enumerate(answer_all(enquiry, shifts)):
            off[i], sizes[i] = lines[i] * enquiry.difference(basis, shifts[i], found)
            span.take(found, small)
            told(1.0 - 0.5 ** ((len(known) + i + 1) / _HALFWAY))
        loudest = np.maximum(loudest, sizes.max(axis=0))
        errors = _largest(off, np.maximum(sizes, _FLOOR * loudest))
        known = np.sort(np.concatenate([known, lines]))
        passed = errors <= tolerance
        error = max(error, float(errors[passed].max(initial=0.0)))
        lines = search.next(known, lines if basis is None else lines[~passed])
    omega, shapes = span.diagonal()
    modes = Modes(omega=omega, shapes=shapes, residuals=np.full(len(omega), error), f_max=f_max)
    return AnsweringModes(modes=modes, error=error, n_frequencies=len(known), n_below=n_below)


@dataclass(frozen=True, kw_only=True, eq=False)
class _Search:
    """Say at which frequencies to look."""

    ratios: Callable[[Array], Array]
    low: float
    high: float

    def shift(self, omega: float) -> complex:
        """Return z of a circular frequency."""
        return complex(omega**2 / (1.0 + 2j * self._ratio(np.array([omega]))[0]))

    def first(self) -> Array:
        """Return the first frequencies, rising by a like share."""
        step = spacing_at_first(float(self.ratios(np.geomspace(self.low, self.high, 50)).min()))
        count = max(3, int(np.ceil(np.log(self.high / self.low) / step)) + 1)
        return np.geomspace(self.low, self.high, count)

    def few(self) -> Array:
        """Return frequencies about which patterns of forces are looked for, falling."""
        return self.high * _APART ** -np.arange(
            1.0 + np.log(self.high / self.low) // np.log(_APART)
        )

    def next(self, known: Array, failed: Array) -> Array:
        """Return the middles of the gaps beside frequencies that failed."""
        index = np.searchsorted(known, failed)
        gaps = np.unique(np.concatenate([index - 1, index]))
        gaps = gaps[(gaps >= 0) & (gaps < len(known) - 1)]
        left, right = known[gaps], known[gaps + 1]
        narrow = np.log(right / left) < _FINEST * self._ratio(left)
        if len(gaps) and narrow.any():
            at = float(left[narrow][0]) / (2.0 * np.pi)
            raise ConvergenceError(
                f"answers at {at:.4g} Hz do not come within the tolerance from those beside it: "
                "allow more, or find all modes",
                residual=float("nan"),
            )
        return np.sqrt(left * right)

    def _ratio(self, omega: Array) -> Array:
        return np.maximum(self.ratios(omega), _LEAST_RATIO)


def _largest(off: Array, sizes: Array) -> Array:
    """Return the largest relative error at each frequency."""
    shares = np.divide(off, sizes, out=np.zeros_like(off), where=sizes > 0.0)
    return shares.reshape(len(off), -1).max(axis=1)


def _first_omega(pencil: DampedPencil, rest: Factor) -> float:
    """Return about the lowest circular frequency, from above [rad/s]."""
    krylov = Krylov(pencil.mass, rest, (_STEPS + 2) * BLOCK)
    while krylov.size < _STEPS * BLOCK and krylov.extend():
        pass
    return float(1.0 / np.sqrt(krylov.ritz_pairs()[0][-1]))


def _nobody(share: float) -> None:
    """Tell nobody."""
    del share

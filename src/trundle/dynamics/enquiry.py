"""Ask a structure how it answers: which forces push it, and where it is looked at.

The dynamic part of an answer at a frequency, what it is beyond the static one,

    (K - z M)^-1 b - K^-1 b = z (K - z M)^-1 M K^-1 b,      z = omega^2 / (1 + 2 i zeta),

is smooth over a route: what only bends a slab under one wheel has gone. The many forces of a route
are therefore few combinations, found from what a random motion does to all of them (Halko,
Martinsson and Tropp, SIAM Review 53 (2011) 217-288). What is small is told against the whole answer
at its own frequency: static answers of the lowest modes are far larger than anything that moves at
high frequencies, and all patterns there would be small beside them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Complex, Float

from trundle._typing import Array, SparseMatrix
from trundle.dynamics.pencil import DampedPencil
from trundle.dynamics.sparse_solver import Factor

__all__ = ["Enquiry", "Motions", "Questions"]

_DRAWN = 160  # random motions by which the combinations of forces are found, at first
_FILLED = 0.8  # of them, that may be needed before more are drawn
_PROBES = 12  # random combinations of all forces by which errors are told
_SHARE = 0.2  # of the tolerance, at which a combination of forces is small


@dataclass(frozen=True, kw_only=True, eq=False)
class Questions:
    """Say where a structure is pushed and where it is looked at, by its coordinates.

    Attributes
    ----------
    pushed : sparse array, shape (n_pushed, n_coordinates)
        How each place of all routes sees the coordinates: by reciprocity, what a unit force there
        does to them.
    read : sparse array, shape (n_read, n_coordinates)
        The same of each reading.
    mapped : sparse array, shape (n_mapped, n_coordinates)
        The same of the places of maps, which are looked at only.
    """

    pushed: SparseMatrix
    read: SparseMatrix
    mapped: SparseMatrix


@dataclass(frozen=True, kw_only=True, eq=False)
class Motions:
    """Hold what routes, maps, readings and probes see of the motions of a basis.

    Attributes
    ----------
    omega : ndarray of float, shape (n_motions,)
        Their circular frequencies [rad/s].
    seen : ndarray of float, shape (n_seen, n_motions)
        What routes see of them, then maps.
    probed : ndarray of float, shape (n_probes, n_motions)
        What readings and probes see of them.
    """

    omega: Float[Array, " motions"]
    seen: Float[Array, "seen motions"]
    probed: Float[Array, "probes motions"]


@dataclass(frozen=True, kw_only=True, eq=False)
class Enquiry:
    """Hold all forces whose answers are asked for, few for many.

    Attributes
    ----------
    pencil : DampedPencil
        The structure.
    questions : Questions
        What is asked of it.
    forces : ndarray of float, shape (n_coordinates, n_forces)
        Combinations of what pushes, then what reads, then probes.
    still : ndarray of float, shape (n_coordinates, n_forces)
        Their static answers.
    n_combined : int
        How many of them are combinations of what pushes.
    """

    pencil: DampedPencil
    questions: Questions
    forces: Float[Array, "coordinates forces"]
    still: Float[Array, "coordinates forces"]
    n_combined: int

    @classmethod
    def of(
        cls,
        pencil: DampedPencil,
        questions: Questions,
        rest: Factor,
        *,
        shifts: Sequence[complex],
        tolerance: float,
    ) -> Enquiry:
        """Find the combinations of what pushes that matter at some shifts, and about them."""
        small, pushed = _SHARE * tolerance, questions.pushed
        told = [_patterns(pencil, pushed, rest, shift, small) for shift in shifts]
        patterns, sizes, _ = np.linalg.svd(np.hstack(told), full_matrices=False)
        return cls._of(pencil, questions, rest, pushed.T @ patterns[:, sizes > small])

    @classmethod
    def of_probes(cls, pencil: DampedPencil, questions: Questions, rest: Factor) -> Enquiry:
        """Ask for what is read and for probes alone: enough to tell errors."""
        return cls._of(pencil, questions, rest, np.zeros((pencil.mass.shape[0], 0)))

    @classmethod
    def _of(cls, pencil: DampedPencil, questions: Questions, rest: Factor, few: Array) -> Enquiry:
        """Ask for some combinations, what is read, and probes."""
        count = questions.pushed.shape[0]
        drawn = np.random.default_rng(count).standard_normal((count, _PROBES)) / np.sqrt(count)
        forces = np.hstack([few, questions.read.T.toarray(), questions.pushed.T @ drawn])
        return cls(
            pencil=pencil,
            questions=questions,
            forces=forces,
            still=rest.solve(forces),
            n_combined=few.shape[1],
        )

    @cached_property
    def still_loaded(self) -> Float[Array, "coordinates forces"]:
        """The mass times the static answers."""
        return self.pencil.mass @ self.still

    @cached_property
    def still_mapped(self) -> Float[Array, "mapped forces"]:
        """What maps see of the static answers."""
        return self.questions.mapped @ self.still

    @property
    def probed(self) -> Float[Array, "coordinates probes"]:
        """What is read and what is probed with: forces whose answers tell errors."""
        return self.forces[:, self.n_combined :]

    @cached_property
    def at_rest(self) -> Float[Array, "seen probes"]:
        """Static answers of the probes, as they are seen."""
        return self.seen(self.still[:, self.n_combined :])

    def seen(self, motion: Array) -> Array:
        """Return what routes and maps see of motions of the coordinates."""
        return np.concatenate([self.questions.pushed @ motion, self.questions.mapped @ motion])

    def motions(self, omega: Array, shapes: Array) -> Motions:
        """Return what is seen of motions with some circular frequencies [rad/s]."""
        return Motions(omega=omega, seen=self.seen(shapes), probed=self.probed.T @ shapes)

    @cached_property
    def groups(self) -> tuple[slice, slice]:
        """Which of what is seen lies on routes, and which on maps."""
        n, more = self.questions.pushed.shape[0], self.questions.mapped.shape[0]
        return slice(0, n), slice(n, n + more)

    def difference(
        self, basis: Motions | None, shift: complex, answers: Array
    ) -> Float[Array, "2 2 probes"]:
        """Return by how much a basis is off answers that are known, and how large these are.

        Both over the routes and over the maps, for each of what is read and probed with: first
        how far off, then how large.

        Parameters
        ----------
        basis : Motions or None
            What is seen of the basis; None for nothing but what is at rest.
        shift : complex
            At which the answers are [rad2/s2].
        answers : ndarray of complex, shape (n_coordinates, n_forces)
            All of them.
        """
        true = self.seen(answers[:, self.n_combined :])
        told = np.zeros_like(true)
        if basis is not None:
            # statics are known: modes left out follow without delay
            dynamic = 1.0 / (basis.omega**2 - shift) - 1.0 / basis.omega**2
            told = self.at_rest + basis.seen @ (dynamic[:, None] * basis.probed.T)
        both = np.array(
            [[np.linalg.norm(x[rows], axis=0) for rows in self.groups] for x in (told - true, true)]
        )
        both[:, 1, : self.questions.read.shape[0]] = 0.0  # from points to maps nothing leads
        return both

    def at(self, shift: complex) -> Complex[Array, "coordinates forces"]:
        """Return the answers to all forces at a shift."""
        return self.pencil.factorise_damped(shift).solve(self.forces)


def _patterns(
    pencil: DampedPencil, pushed: SparseMatrix, rest: Factor, shift: complex, small: float
) -> Float[Array, "pushed patterns"]:
    """Return patterns of forces, so that others move nothing to speak of at a shift.

    Each is as large as what random motions do to it, over the largest that they do at all, static
    or not.
    """
    solver, drawn = pencil.factorise_damped(shift), _DRAWN
    n_pushed, n = pushed.shape
    while True:
        loads = pencil.mass @ np.random.default_rng(drawn).standard_normal((n, min(drawn, n)))
        whole = solver.solve(loads)
        moved = pushed @ (whole - rest.solve(loads))
        largest = np.linalg.norm(pushed @ whole, ord=2)
        told = np.hstack([np.real(moved), np.imag(moved)]) / largest
        patterns, sizes, _ = np.linalg.svd(told, full_matrices=False)
        kept = int(np.count_nonzero(sizes > small))
        if kept <= _FILLED * drawn or kept == n_pushed or drawn >= n:
            return patterns[:, :kept] * sizes[:kept]
        drawn *= 2

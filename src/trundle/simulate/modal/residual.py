"""Give back the static share of the modes that a truncated basis leaves out.

A few hundred modes show how a floor vibrates, but not how it sinks under a wheel, nor that
it hardly moves far from one: the modes left out sum up to a static flexibility

    R = K^-1 - Phi Omega^-2 Phi^T,

which follows the contact force without delay as long as that varies slowly against the
first mode left out.

References
----------
R. R. Craig, Structural Dynamics (1981), section 15.2 (mode-acceleration method).
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float, Int

from trundle._typing import Array, SparseMatrix
from trundle.dynamics import Factor, Modes, unit_rows
from trundle.errors import InputError
from trundle.structure import Structure

__all__ = [
    "StaticFlexibility",
    "point_residual",
    "residual_block",
    "unit_loads",
]

_COLUMNS = 64  # right-hand sides solved at once


@runtime_checkable
class Selective(Protocol):
    """A factor that answers for few places without a solution of all dofs."""

    def between(self, rows: SparseMatrix, columns: SparseMatrix) -> Float[Array, "rows columns"]:
        """Return ``rows K^-1 columns^T`` for rows of weights over all dofs."""
        ...


def unit_loads(
    dofs: Int[Array, " dofs"], n_dofs: int
) -> Iterator[tuple[slice, Float[Array, "all columns"]]]:
    """Give unit loads at dofs, a block of columns at a time, with the block's place."""
    for start in range(0, len(dofs), _COLUMNS):
        part = slice(start, start + _COLUMNS)
        columns = dofs[part]
        unit = np.zeros((n_dofs, len(columns)))
        unit[columns, np.arange(len(columns))] = 1.0
        yield part, unit


class StaticFlexibility:
    """Answer for a structure's static flexibility.

    What is asked for depends on the question and on what was covered alone, not on earlier
    questions: solutions of several right-hand sides at once differ in their last bits by which
    ones stand together.
    """

    def __init__(self, floor: Structure) -> None:
        self._floor = floor
        self._factor: Factor | None = None
        self._dofs = np.zeros(0, dtype=np.intp)
        self._block = np.zeros((0, 0))

    def cover(self, dofs: Int[Array, " dofs"]) -> None:
        """Solve for all dofs of some routes, rising, that several layouts will ask about."""
        if self.known:
            self._dofs = dofs
            self._block = self._between(self._dofs, self._dofs)

    def block(self, dofs: Int[Array, " dofs"]) -> Float[Array, "dofs dofs"]:
        """Return the part of K^-1 between some dofs, rising [m/N]."""
        known = np.isin(dofs, self._dofs)
        out = np.empty((len(dofs), len(dofs)))
        at, place = np.searchsorted(self._dofs, dofs[known]), np.flatnonzero(known)
        out[np.ix_(place, place)] = self._block[np.ix_(at, at)]
        if not known.all():
            new = self._between(dofs, dofs[~known])
            out[:, ~known], out[~known] = new, new.T
        return out

    def _between(self, rows: Array, columns: Array) -> Array:
        if self.known and isinstance(self._factor, Selective):
            n = self._floor.n_dofs
            return self._factor.between(unit_rows(rows, n), unit_rows(columns, n))
        out = np.empty((len(rows), len(columns)))
        for part, unit in unit_loads(columns, self._floor.n_dofs):
            out[:, part] = self.solve(unit)[rows]
        return out

    @property
    def known(self) -> bool:
        """Whether the structure can say how it deflects; one that is known by its modes cannot."""
        if self._factor is None:
            self._factor = self._floor.flexibility()
        return self._factor is not None

    def seen(self, points: SparseMatrix, dofs: Int[Array, " dofs"]) -> Float[Array, "points dofs"]:
        """Return how far points move under unit forces at some dofs [m/N]."""
        if self.known and isinstance(self._factor, Selective):
            return self._factor.between(points, unit_rows(dofs, self._floor.n_dofs))
        return self.solve(np.ascontiguousarray(points.T.toarray())).T[:, dofs]

    def solve(self, load: Float[Array, "all columns"]) -> Float[Array, "all columns"]:
        """Return the static deflections under loads.

        Raises
        ------
        InputError
            The structure is known by its modes alone.
        """
        if not self.known or self._factor is None:
            raise InputError(f"{self._floor.name} is known by its modes: nothing says how it sinks")
        return self._factor.solve(load)


def residual_block(
    flexibility: StaticFlexibility, modes: Modes, dofs: Int[Array, " dofs"]
) -> Float[Array, "dofs dofs"]:
    """Return R between some dofs [m/N]."""
    shapes = modes.at(dofs) / modes.omega
    return flexibility.block(dofs) - shapes @ shapes.T


def point_residual(
    flexibility: StaticFlexibility, modes: Modes, points: SparseMatrix, dofs: Int[Array, " dofs"]
) -> Float[Array, "points dofs"]:
    """Return the rows of R that give the response at points to forces at some dofs [m/N]."""
    exact = flexibility.seen(points, dofs)
    return exact - (modes.seen(points) / modes.omega**2) @ modes.at(dofs).T

"""Hold all motions by which a structure answered so far, without what is small of them."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from scipy import linalg

from trundle._typing import Array
from trundle.dynamics.enquiry import Enquiry

__all__ = ["Span"]

_LEAST_COMING = 1e-3  # of what would come, below which a reading counts no more for it
_LEAST_KEPT = 3e-6  # of answers, below which directions are round-off


@dataclass(kw_only=True, eq=False)
class Span:
    """Hold a growing M-orthonormal basis V of all answers, with M V and what maps see of V.

    Attributes
    ----------
    enquiry : Enquiry
        What is asked.
    size : int
        How many vectors it has.
    """

    enquiry: Enquiry
    size: int = 0
    _vectors: Array = field(init=False)
    _loaded: Array = field(init=False)
    _mapped: Array = field(init=False)

    def __post_init__(self) -> None:
        n_mapped, n = self.enquiry.questions.mapped.shape
        self._vectors, self._loaded = (np.empty((n, 256), order="F") for _ in range(2))
        self._mapped = np.empty((n_mapped, 256), order="F")

    def take(self, answers: Array, small: float) -> None:
        """Take in the dynamic part of answers, but for directions that are small beside the whole.

        Parameters
        ----------
        answers : ndarray of complex, shape (n_coordinates, n_forces)
            At one frequency.
        small : float
            Share of the whole answer, below which a direction is left out.

        Notes
        -----
        Of the dynamic part most may be what low modes no longer follow: beside that whatever
        moves at a high frequency would be small. Of a reading to which little comes it is small
        directions that bring it: they count by so much more as less comes. From a map nothing is
        solved: there directions count by what it sees of them, too.
        """
        enquiry = self.enquiry
        block = np.hstack([np.real(answers), np.imag(answers)])
        loaded = enquiry.pencil.mass @ block
        mapped = enquiry.questions.mapped @ block
        squares = np.einsum("ij,ij->j", block, loaded).reshape(2, -1).sum(axis=0)
        few = enquiry.n_combined
        squares[:few] = squares[:few].sum()  # combinations as large as they are
        sizes = np.sqrt(np.where(squares > 0.0, squares, 1.0))
        still = enquiry.still.shape[1]  # as many as there are forces
        both = np.hstack([mapped[:, :few], mapped[:, still : still + few]])
        on_maps = np.linalg.norm(both) / sizes[0]
        block[:, :still] -= enquiry.still
        loaded[:, :still] -= enquiry.still_loaded
        mapped[:, :still] -= enquiry.still_mapped
        across = np.linalg.norm(enquiry.forces[:, :few].T @ answers, axis=0)
        comes = across * sizes[0] / (sizes * np.linalg.norm(across[:few]))
        comes[:few] = 1.0
        scale = np.tile(1.0 / (sizes * np.clip(comes, _LEAST_COMING, 1.0)), 2)
        weight = 1.0 / on_maps if on_maps > 0.0 else 0.0
        self._append(block * scale, loaded * scale, mapped * scale, (small**2, weight))

    def _append(
        self, block: Array, loaded: Array, mapped: Array, limits: tuple[float, float]
    ) -> None:
        """Append the directions of a block that are new and large.

        By their mass, or by what maps see of them: `limits` are the least square, and the weight of
        maps. What is new of the block is told from products alone: with an M-orthonormal basis it
        is as large as the block less what it has along the basis. Only what is kept is formed.
        """
        least, weight = limits
        basis = slice(0, self.size)
        along = self._loaded[:, basis].T @ block
        own = block.T @ loaded - along.T @ along
        there = weight * (mapped - self._mapped[:, basis] @ along)
        squares, turned = linalg.eigh(own + there.T @ there)
        large = turned[:, squares > least]
        if not large.size:
            return
        squares, turned = linalg.eigh(large.T @ own @ large)
        kept = squares > _LEAST_KEPT**2
        if not kept.any():
            return
        few = large @ (turned[:, kept] / np.sqrt(squares[kept]))
        new = block @ few - self._vectors[:, basis] @ (along @ few)
        heavy = self.enquiry.pencil.mass @ new
        for _ in range(2):  # small directions bring back what was taken off
            new, heavy = self._apart(new, heavy)
            lower = linalg.cholesky(new.T @ heavy, lower=True)
            back = linalg.solve_triangular(lower, np.eye(len(lower)), lower=True).T
            new, heavy = new @ back, heavy @ back
        self._make_room(new.shape[1])
        here = slice(self.size, self.size + new.shape[1])
        self._vectors[:, here], self._loaded[:, here] = new, heavy
        self._mapped[:, here] = self.enquiry.questions.mapped @ new
        self.size += new.shape[1]

    def _apart(self, block: Array, loaded: Array) -> tuple[Array, Array]:
        """Take off what lies in the basis already."""
        basis, heavy = self._vectors[:, : self.size], self._loaded[:, : self.size]
        along = heavy.T @ block
        return block - basis @ along, loaded - heavy @ along

    def _make_room(self, more: int) -> None:
        while self.size + more > self._vectors.shape[1]:
            self._vectors, self._loaded, self._mapped = (
                np.asfortranarray(np.hstack([one, one]))
                for one in (self._vectors, self._loaded, self._mapped)
            )

    def diagonal(self) -> tuple[Array, Array]:
        """Return circular frequencies and shapes of the structure within the span."""
        basis = self._vectors[:, : self.size]
        square, turned = linalg.eigh(basis.T @ (self.enquiry.pencil.stiffness @ basis))
        return np.sqrt(np.maximum(square, 0.0)), basis @ turned

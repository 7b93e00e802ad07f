"""Reduce a structure by its pieces: equal ones once."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from jaxtyping import Float, Int
from scipy import sparse

from trundle._progress import Progress, Tell, silent
from trundle._typing import Array, SparseMatrix
from trundle.dynamics import RestingPart, Superelement, reduce_part
from trundle.structure.assembly import ElementBlocks, blocks_of
from trundle.structure.elements.protocol import Elements
from trundle.structure.floor import Floor
from trundle.structure.superelements.assembly import Joined, join
from trundle.structure.superelements.cuts import Share
from trundle.structure.superelements.nearness import Nearness
from trundle.structure.superelements.pieces import Alike, Piece, like, pieces_of, places_of
from trundle.structure.superelements.seams import Placed

__all__ = ["Part", "Reducer", "Sorted", "joined_parts", "reduced_here", "sorted_pieces"]


@dataclass(frozen=True, kw_only=True, eq=False)
class Sorted:
    """Hold the distinct pieces of a structure, and where all of them stand.

    Attributes
    ----------
    distinct : tuple of Piece
        Each by its own.
    boundaries : tuple of ndarray of int
        Rows of each at which any of its copies meets others, rising.
    placed : tuple of Placed
        All pieces.
    where : ndarray of float, shape (n_dofs, 3)
        Place of each free dof's node [m].
    """

    distinct: tuple[Piece, ...]
    boundaries: tuple[Array, ...]
    placed: tuple[Placed, ...]
    where: Float[Array, "dofs 3"]

    def shares(self, nearness: Nearness | None) -> Float[Array, " pieces"]:
        """Return the share of the whole band to which each piece is kept; 1 near to anything."""
        if nearness is None:
            return np.ones(len(self.placed))
        return nearness.shares([self.where[own.dofs] for own in self.placed])

    def reach(self, nearness: Nearness | None) -> Float[Array, " distinct"]:
        """Return the share that the nearest copy of each distinct piece is kept to."""
        most = np.zeros(len(self.distinct))
        np.maximum.at(most, [own.kind for own in self.placed], self.shares(nearness))
        return most

    def part(self, number: int) -> Part:
        """Return what a reduction needs of one of the distinct ones."""
        piece = self.distinct[number]
        return Part(mass=piece.mass, stiffness=piece.stiffness, boundary=self.boundaries[number])


@dataclass(frozen=True, kw_only=True, eq=False)
class Part:
    """Hold what a reduction needs: it can then be done anywhere.

    Attributes
    ----------
    mass, stiffness : sparse array, shape (n_dofs, n_dofs)
        Of the part alone [kg], [N/m].
    boundary : ndarray of int, shape (n_boundary,)
        Rows at which it meets others, rising.
    """

    mass: SparseMatrix
    stiffness: SparseMatrix
    boundary: Int[Array, " boundary"]

    @property
    def content_hash(self) -> str:
        """Hash of all that decides its reduction; equal parts share it."""
        digest = hashlib.sha256(self.boundary.astype(np.int64).tobytes())
        for matrix in (self.mass, self.stiffness):
            ordered = sparse.csc_array(matrix, copy=True)
            ordered.sort_indices()
            for values in (ordered.indptr, ordered.indices):
                digest.update(values.astype(np.int64).tobytes())
            digest.update(ordered.data.tobytes())
        return digest.hexdigest()[:24]

    def reduced(self, f_max: float, *, progress: Progress | None = None) -> Superelement:
        """Reduce it, its own modes kept below a frequency [Hz]."""
        return reduce_part(self.mass, self.stiffness, self.boundary, f_max=f_max, progress=progress)


def sorted_pieces(floor: Floor, shares: Sequence[Share], *, tell: Tell = silent) -> Sorted:
    """Assemble all pieces of a structure, and sort out those that are alike.

    Parameters
    ----------
    floor : Floor
        The structure.
    shares : sequence of Share
        Which elements belong to which piece, a group each.
    tell : callable
        Told what is being done, and the share done.
    """
    mass = [_blocks(floor, group, mass=True) for group in floor.elements]
    stiffness = [_blocks(floor, group, mass=False) for group in floor.elements]
    count = 1 + max(int(share.piece.max(initial=0)) for share in shares)
    distinct: list[Piece] = []
    placed: list[Placed] = []
    met = np.zeros(floor.n_dofs, dtype=np.int32)
    for number in range(count):
        tell("pieces of the structure", number / count)
        piece = pieces_of(floor, shares, mass, stiffness, number)
        met[piece.dofs] += 1
        kind, alike = _found(piece, distinct, turned=floor.angles is None)
        if alike is None:
            distinct.append(piece)
            alike = Alike(order=np.arange(len(piece.dofs)), sign=np.ones(len(piece.dofs)))
        placed.append(Placed(kind=kind, dofs=piece.dofs[alike.order], sign=alike.sign))
    shared = [np.zeros(len(piece.dofs), dtype=bool) for piece in distinct]
    for own in placed:
        shared[own.kind] |= met[own.dofs] > 1
    return Sorted(
        distinct=tuple(distinct),
        boundaries=tuple(np.flatnonzero(rows) for rows in shared),
        placed=tuple(placed),
        where=places_of(floor)[0],
    )


def _blocks(floor: Floor, group: Elements, *, mass: bool) -> ElementBlocks | None:
    """Return the matrices of a group's elements; None where it has none."""

    def form(some: Elements, xyz: Array) -> Array | None:
        return some.mass_blocks(xyz) if mass else some.stiffness_blocks(xyz)

    return next(iter(blocks_of([group], floor.nodes, form)), None)


def _found(piece: Piece, distinct: Sequence[Piece], *, turned: bool) -> tuple[int, Alike | None]:
    """Return which of the pieces a piece is like, and how; a new number where it is like none."""
    for number, other in enumerate(distinct):
        alike = like(piece, other, turned=turned)
        if alike is not None:
            return number, alike
    return len(distinct), None


Reducer: TypeAlias = Callable[[Sorted, Sequence[float], Tell], Sequence[Superelement]]
"""Who reduces the distinct parts, keeping the own modes of each below its frequency [Hz]."""


def reduced_here(
    pieces: Sorted, f_parts: Sequence[float], tell: Tell = silent
) -> list[Superelement]:
    """Reduce every distinct part, one after the other.

    Parameters
    ----------
    pieces : Sorted
        The pieces.
    f_parts : sequence of float
        Own modes of each distinct part below are kept [Hz].
    tell : callable
        Told what is being done, and the share done.
    """
    found: list[Superelement] = []
    for number, (piece, f_max) in enumerate(zip(pieces.distinct, f_parts, strict=True)):
        what = f"part {number + 1} of {len(pieces.distinct)}, {len(piece.dofs)} dofs"

        def progress(share: float, what: str = what) -> None:
            tell(what, share)

        found.append(pieces.part(number).reduced(f_max, progress=progress))
    return found


def joined_parts(
    pieces: Sorted,
    parts: Sequence[Superelement],
    *,
    n_dofs: int,
    f_seams: float,
    nearness: Nearness | None = None,
    tell: Tell = silent,
) -> Joined:
    """Join pieces of which the distinct ones are reduced.

    Parameters
    ----------
    pieces : Sorted
        The pieces.
    parts : sequence of Superelement
        The distinct ones, reduced.
    n_dofs : int
        Number of free dofs of the structure.
    f_seams : float
        Own modes of long seams below are kept [Hz].
    nearness : Nearness, optional
        What pieces are near to; those far from it are kept to less.
    tell : callable
        Told what is being done, and the share done.
    """
    return join(
        [
            RestingPart(reduced=part, stiffness=piece.stiffness)
            for part, piece in zip(parts, pieces.distinct, strict=True)
        ],
        pieces.placed,
        n_dofs=n_dofs,
        f_seams=f_seams,
        shares=pieces.shares(nearness),
        tell=lambda share: tell("seams between parts", share),
    )

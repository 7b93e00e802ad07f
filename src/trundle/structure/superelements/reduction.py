"""Reduce a structure by its pieces: equal ones once."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from trundle._progress import Tell, silent
from trundle._typing import Array
from trundle.dynamics import Superelement, reduce_part
from trundle.structure.assembly import ElementBlocks, blocks_of
from trundle.structure.elements.protocol import Elements
from trundle.structure.floor import Floor
from trundle.structure.superelements.assembly import Joined, join
from trundle.structure.superelements.cuts import Share
from trundle.structure.superelements.pieces import Alike, Piece, like, pieces_of
from trundle.structure.superelements.seams import Placed

__all__ = ["Sorted", "reduced_structure", "sorted_pieces"]


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
    """

    distinct: tuple[Piece, ...]
    boundaries: tuple[Array, ...]
    placed: tuple[Placed, ...]


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


def reduced_structure(
    pieces: Sorted, *, n_dofs: int, f_parts: float, f_seams: float, tell: Tell = silent
) -> Joined:
    """Reduce every distinct piece, and join all.

    Parameters
    ----------
    pieces : Sorted
        The pieces.
    n_dofs : int
        Number of free dofs of the structure.
    f_parts, f_seams : float
        Own modes of pieces, and of long seams, below are kept [Hz].
    tell : callable
        Told what is being done, and the share done.
    """
    parts: list[Superelement] = []
    for number, (piece, boundary) in enumerate(
        zip(pieces.distinct, pieces.boundaries, strict=True)
    ):
        what = f"part {number + 1} of {len(pieces.distinct)}, {len(piece.dofs)} dofs"
        parts.append(
            reduce_part(
                piece.mass,
                piece.stiffness,
                boundary,
                f_max=f_parts,
                progress=lambda share, what=what: tell(what, share),
            )
        )
    return join(
        parts,
        pieces.placed,
        n_dofs=n_dofs,
        f_seams=f_seams,
        tell=lambda share: tell("seams between parts", share),
    )

"""Join reduced parts to the reduced matrices of a whole structure."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float
from scipy import sparse

from trundle._typing import Array, SparseMatrix
from trundle.dynamics import RestingPart, Superelement
from trundle.structure.superelements.pencil import (
    PieceCoordinates,
    ReducedPencil,
    ReducedPiece,
)
from trundle.structure.superelements.piece_bases import PieceBasis, WrittenSeam, piece_bases
from trundle.structure.superelements.seams import (
    Boundary,
    Placed,
    RelaxedParts,
    Seam,
    SeamShapes,
    ends_of,
    seam_shapes,
    seams_of,
)

__all__ = ["Joined", "join"]

_SHORT = 150  # dofs of a seam that keeps them all


@dataclass(frozen=True, kw_only=True, eq=False)
class Joined:
    """Hold a structure by its reduced parts; a basis for what is written by its coordinates.

    Attributes
    ----------
    resting : tuple of RestingPart
        The distinct parts.
    placed : tuple of Placed
        All pieces.
    pencil : ReducedPencil
        Its reduced matrices.
    bases : tuple of PieceBasis
        By what the boundary of each piece is written.
    n_dofs : int
        Number of free dofs of the structure.
    n_seams, n_long : int
        How many seams there are, and how many of them are written by shapes of their own.
    f_parts, f_seams : float
        Own modes of parts, and of long seams, are kept to these frequencies [Hz].
    n_far : int
        How many pieces are kept to less, for they lie far from all that matters.
    """

    resting: tuple[RestingPart, ...]
    placed: tuple[Placed, ...]
    pencil: ReducedPencil
    bases: tuple[PieceBasis, ...]
    n_dofs: int
    n_seams: int
    n_long: int
    f_parts: float
    f_seams: float
    n_far: int = 0

    @property
    def parts(self) -> tuple[Superelement, ...]:
        """The distinct parts, reduced."""
        return tuple(part.reduced for part in self.resting)

    @property
    def told(self) -> str:
        """What a result must say of modes that are found by parts."""
        seams = f", and of {self.n_long} seams to {self.f_seams:g} Hz" if self.n_long else ""
        if self.n_far:
            seams += f" ({self.n_far} parts far from routes and points to less)"
        return (
            f"modes are found by {len(self.placed)} parts, {len(self.resting)} of them distinct, "
            f"whose own modes are kept to {self.f_parts:g} Hz{seams}: frequencies are a little too "
            "high (on four storeys of the reference unit 0.4 % at most below half of that); wider "
            "bands show by how much"
        )

    def seen(
        self, reader: SparseMatrix, q: Float[Array, "coordinates columns"]
    ) -> Float[Array, "rows columns"]:
        """Return what rows of weights (n_rows, n_dofs) see of motions by coordinates."""
        by_column = _once(sparse.csc_array(reader), self)
        out = np.zeros((reader.shape[0], q.shape[1]))
        for number, (own, columns) in enumerate(zip(self.placed, by_column, strict=True)):
            if not columns.nnz:
                continue
            signed = sparse.csc_array(columns @ sparse.diags_array(own.sign))
            rows = np.unique(signed.indices)
            modes, boundary = self.resting[own.kind].seen(sparse.csr_array(signed)[rows])
            mine, moved = self._of_piece(number, q)
            out[rows] += modes[:, : len(mine)] @ mine + boundary @ moved
        return out

    def seams_seen(self, reader: SparseMatrix) -> Float[Array, "rows seams"]:
        """Return what rows of weights (n_rows, n_dofs) see of the seams' coordinates at rest."""
        out = np.zeros((reader.shape[0], self.pencil.n_seams))
        for number, columns in enumerate(_once(sparse.csc_array(reader), self)):
            if not columns.nnz:
                continue
            own = self.placed[number]
            signed = sparse.csr_array(columns @ sparse.diags_array(own.sign))
            rows = np.flatnonzero(np.diff(signed.indptr))
            _, boundary = self.resting[own.kind].seen(signed[rows])
            seams = self.pencil.pieces[number].seams
            out[np.ix_(rows, seams)] += boundary @ self.bases[number].shapes
        return out

    def by_coordinates(self, reader: SparseMatrix) -> SparseMatrix:
        """Return how rows of weights (n_rows, n_dofs) see each coordinate: ``reader T``."""
        pencil, found = self.pencil, []
        shape = (reader.shape[0], pencil.n_coordinates)
        for number, columns in enumerate(_once(sparse.csc_array(reader), self)):
            if not columns.nnz:
                continue
            own, at = self.placed[number], pencil.pieces[number]
            signed = sparse.csr_array(columns @ sparse.diags_array(own.sign))
            rows = np.flatnonzero(np.diff(signed.indptr))
            modes, boundary = self.resting[own.kind].seen(signed[rows])
            n = pencil.n_own(number)
            mine = np.hstack([modes[:, :n], boundary @ self.bases[number].shapes])
            which = np.concatenate([at.first + np.arange(n), pencil.n_modes + at.seams])
            places = (np.repeat(rows, len(which)), np.tile(which, len(rows)))
            found.append(sparse.csr_array((mine.ravel(), places), shape=shape))
        return sum(found, sparse.csr_array(shape))

    def expanded(self, q: Float[Array, "coordinates columns"]) -> Float[Array, "dofs columns"]:
        """Return the motion of all dofs."""
        out = np.empty((self.n_dofs, q.shape[1]))
        for number, own in enumerate(self.placed):
            moved = self.resting[own.kind].expanded(*self._of_piece(number, q))
            out[own.dofs] = moved * own.sign[:, None]
        return out

    def forces(self, load: Float[Array, " dofs"]) -> Float[Array, " coordinates"]:
        """Return what a load on the dofs does to each coordinate."""
        out = np.zeros(self.pencil.n_coordinates)
        taken = np.zeros(self.n_dofs, dtype=bool)
        for number, own in enumerate(self.placed):
            mine = np.where(taken[own.dofs], 0.0, load[own.dofs]) * own.sign
            taken[own.dofs] = True
            if not mine.any():
                continue
            resting, at = self.resting[own.kind], self.pencil.pieces[number]
            part, n = resting.reduced, self.pencil.n_own(number)
            inner = mine[part.interior]
            out[at.first : at.first + n] += part.shapes[:, :n].T @ inner
            boundary = mine[part.boundary] + resting.at_boundary(inner[:, None])[:, 0]
            seams = self.pencil.n_modes + at.seams
            out[seams] += self.bases[number].shapes.T @ boundary
        return out

    def _of_piece(self, number: int, q: Array) -> tuple[Array, Array]:
        """Return the own modes of a piece and the motion of its boundary, by its own signs."""
        at = self.pencil.pieces[number]
        own = q[at.first : at.first + self.pencil.n_own(number)]
        return own, self.bases[number].shapes @ q[self.pencil.n_modes + at.seams]


def _once(reader: SparseMatrix, joined: Joined) -> list[SparseMatrix]:
    """Return the columns of each piece; what several pieces share is the first one's."""
    taken = np.zeros(joined.n_dofs, dtype=bool)
    found = []
    for own in joined.placed:
        first = sparse.diags_array((~taken[own.dofs]).astype(float))
        found.append(sparse.csc_array(reader[:, own.dofs] @ first))
        found[-1].eliminate_zeros()
        taken[own.dofs] = True
    return found


def join(
    resting: Sequence[RestingPart],
    placed: Sequence[Placed],
    *,
    n_dofs: int,
    f_seams: float,
    shares: Float[Array, " pieces"],
    tell: Callable[[float], None],
) -> Joined:
    """Join reduced parts at their seams.

    Parameters
    ----------
    resting : sequence of RestingPart
        The distinct parts.
    placed : sequence of Placed
        Where they stand.
    n_dofs : int
        Number of free dofs of the structure.
    f_seams : float
        Own modes of long seams below are kept [Hz].
    shares : ndarray of float, shape (n_pieces,)
        Share of its part's band to which each piece is kept; a seam, that of the nearer one.
    tell : callable
        Told the share done.
    """
    parts = [part.reduced for part in resting]
    boundaries = [Boundary(own.dofs[parts[own.kind].boundary]) for own in placed]
    seams = seams_of(boundaries)
    short, long = _by_length(seams)
    kept = np.concatenate([*(seam.dofs for seam in short), np.zeros(0, dtype=np.intp)])
    known: dict[tuple[object, ...], SeamShapes] = {}
    written: list[WrittenSeam] = []
    count, relaxed = len(kept), RelaxedParts(parts)
    for done, seam in enumerate(long):
        most = float(shares[list(seam.pieces)].max())
        key = (most, *_seam_key(seam, ends_of(seam, short), parts, placed, boundaries))
        if key not in known:
            most_kept = most * f_seams
            known[key] = seam_shapes(seam, short, relaxed, placed, boundaries, f_max=most_kept)
        shapes = replace(known[key], ends=ends_of(seam, short))
        written.append(WrittenSeam(seam=seam, shapes=shapes, key=key, first=count))
        count += shapes.own.shape[1]
        tell(0.3 * done / len(long))
    bases = piece_bases(parts, placed, boundaries, kept, written)
    tell(0.5)
    return Joined(
        resting=tuple(resting),
        placed=tuple(placed),
        pencil=_pencil(parts, placed, bases, shares, n_seams=count),
        bases=bases,
        n_dofs=n_dofs,
        n_seams=len(seams),
        n_long=len(long),
        f_parts=min(part.f_max for part in parts),
        f_seams=f_seams,
        n_far=int(np.count_nonzero(shares < 1.0)),
    )


def _by_length(seams: Sequence[Seam]) -> tuple[list[Seam], list[Seam]]:
    """Return the seams that keep their dofs, and those that are written by shapes of their own.

    A seam at which others end keeps them, whatever its length: they could not move with it
    otherwise. The free edge of one part ends at no seam but follows it.
    """
    sets = [set(seam.pieces) for seam in seams]
    short, long = [], []
    for seam, here in zip(seams, sets, strict=True):
        is_end = any(len(other) > 1 and other < here for other in sets)
        (short if is_end or len(seam.dofs) <= _SHORT else long).append(seam)
    return short, long


def _seam_key(
    seam: Seam,
    ends: Array,
    parts: Sequence[Superelement],
    placed: Sequence[Placed],
    boundaries: Sequence[Boundary],
) -> tuple[object, ...]:
    """Return what two seams have in common that are written by the same shapes."""
    both, found = np.concatenate([seam.dofs, ends]), []
    for number in seam.pieces:
        own, rows = placed[number], boundaries[number].rows(both)
        sign = own.sign[parts[own.kind].boundary[rows]]
        found.append((own.kind, rows.tobytes(), (sign < 0.0).tobytes()))
    return tuple(found)


def _pencil(
    parts: Sequence[Superelement],
    placed: Sequence[Placed],
    bases: Sequence[PieceBasis],
    shares: Float[Array, " pieces"],
    *,
    n_seams: int,
) -> ReducedPencil:
    """Return the reduced matrices; pieces of one kind with equal seams are formed once."""
    numbers: dict[tuple[object, ...], int] = {}
    kinds: list[ReducedPiece] = []
    pieces, first = [], 0
    reach = max(part.f_max for part in parts)  # of the nearest; others may be kept to less
    for own, basis, share in zip(placed, bases, shares.tolist(), strict=True):
        part = parts[own.kind]
        part, key = part.below(share * reach), (share, basis.key)
        if key not in numbers:
            numbers[key] = len(kinds)
            kinds.append(_reduced(part, basis.shapes))
        pieces.append(PieceCoordinates(kind=numbers[key], first=first, seams=basis.seams))
        first += len(part.omega)
    return ReducedPencil(kinds=tuple(kinds), pieces=tuple(pieces), n_seams=n_seams)


def _reduced(part: Superelement, shapes: Array) -> ReducedPiece:
    """Return a part's matrices by the coordinates of its seams."""
    return ReducedPiece(
        omega=part.omega,
        coupling=part.coupling @ shapes,
        stiffness=shapes.T @ (part.stiffness @ shapes),
        mass=shapes.T @ (part.mass @ shapes),
    )

"""Reduce the seams at which pieces meet to few coordinates.

All dofs at which the same pieces meet are a seam. A short one, such as the ends of some columns,
keeps its dofs. A long one, such as the edge between two units, is written by

    u_seam = V q + X u_ends

with V its own modes and X how it follows, at rest, the ends that it has in common with other
pieces; the pieces that meet there are taken together, and all their other seams follow freely: were
they held, a floor that sways as a whole would be locked. Both come from the reduced matrices of the
pieces, so that seams of equal pieces are equal, and are reduced once.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int
from scipy import linalg

from trundle._typing import Array
from trundle.dynamics import Superelement
from trundle.errors import UnrestrainedModeError

_SHIFT = 1.0  # rad2/s2: keeps K + s M definite for what can move freely

__all__ = [
    "Boundary",
    "Placed",
    "RelaxedParts",
    "Seam",
    "SeamShapes",
    "ends_of",
    "seam_shapes",
    "seams_of",
]


@dataclass(frozen=True, kw_only=True, eq=False)
class Placed:
    """Hold a reduced part where it stands in a structure.

    Attributes
    ----------
    kind : int
        Which of the distinct parts it is.
    dofs : ndarray of int, shape (n_dofs,)
        Free dof of the structure that stands for each of the part's.
    sign : ndarray of float, shape (n_dofs,)
        -1 where the part's moves the opposite way, 1 elsewhere.
    """

    kind: int
    dofs: Int[Array, " dofs"]
    sign: Float[Array, " dofs"]


class Boundary:
    """Find the row in a piece's boundary of free dofs of the structure."""

    def __init__(self, dofs: Int[Array, " boundary"]) -> None:
        """`dofs` are those of the structure, row by row."""
        self.dofs = dofs
        self._order = np.argsort(dofs, kind="stable")
        self._rising = dofs[self._order]

    def rows(self, dofs: Int[Array, " some"]) -> Int[Array, " some"]:
        """Return their rows; each must be there."""
        return self._order[np.searchsorted(self._rising, dofs)]


@dataclass(frozen=True, kw_only=True, eq=False)
class Seam:
    """Hold dofs at which the same pieces meet.

    Attributes
    ----------
    pieces : tuple of int
        Which meet, rising.
    dofs : ndarray of int, shape (n,)
        Free dofs of the structure.
    """

    pieces: tuple[int, ...]
    dofs: Int[Array, " dofs"]


@dataclass(frozen=True, kw_only=True, eq=False)
class SeamShapes:
    """Hold by what the motion of a long seam is written.

    Attributes
    ----------
    own : ndarray of float, shape (n, n_modes)
        V, of unit modal mass.
    omega : ndarray of float, shape (n_modes,)
        Their circular frequencies [rad/s].
    ends : ndarray of int, shape (n_ends,)
        Free dofs of the structure that the seam follows.
    follow : ndarray of float, shape (n, n_ends)
        X.
    """

    own: Float[Array, "dofs modes"]
    omega: Float[Array, " modes"]
    ends: Int[Array, " ends"]
    follow: Float[Array, "dofs ends"]


def seams_of(boundaries: Sequence[Boundary]) -> tuple[Seam, ...]:
    """Return all seams; their dofs stand in the order of the first piece's boundary."""
    dofs = np.concatenate([b.dofs for b in boundaries])
    pieces = np.concatenate([np.full(len(b.dofs), i) for i, b in enumerate(boundaries)])
    order = np.lexsort((pieces, dofs))
    dofs, pieces = dofs[order], pieces[order]
    known, first = np.unique(dofs, return_index=True)
    meeting: dict[tuple[int, ...], list[int]] = {}
    for dof, those in zip(known.tolist(), np.split(pieces, first[1:]), strict=True):
        meeting.setdefault(tuple(those.tolist()), []).append(dof)
    found = []
    for those, some in meeting.items():
        here = np.array(some, dtype=np.intp)
        order = np.argsort(boundaries[those[0]].rows(here))
        found.append(Seam(pieces=those, dofs=here[order]))
    return tuple(found)


def ends_of(seam: Seam, short: Sequence[Seam]) -> Int[Array, " ends"]:
    """Return the dofs of short seams at which all pieces of a long one meet, and others too."""
    here = set(seam.pieces)
    meets = [s.dofs for s in short if here <= set(s.pieces)]
    return np.concatenate([*meets, np.zeros(0, dtype=np.intp)])


def seam_shapes(
    seam: Seam,
    short: Sequence[Seam],
    parts: RelaxedParts,
    placed: Sequence[Placed],
    boundaries: Sequence[Boundary],
    *,
    f_max: float,
) -> SeamShapes:
    """Return by what a long seam is written.

    Parameters
    ----------
    seam : Seam
        The seam.
    short : sequence of Seam
        Those that keep their dofs.
    parts : RelaxedParts
        The distinct parts.
    placed : sequence of Placed
        Each piece.
    boundaries : sequence of Boundary
        Of each piece.
    f_max : float
        Modes of its own below are kept [Hz].

    Raises
    ------
    UnrestrainedModeError
        Held at its ends, it can still move without strain.
    """
    ends = ends_of(seam, short)
    n, m = len(seam.dofs), len(seam.dofs) + len(ends)
    beyond, times = np.unique(
        np.concatenate([boundaries[number].dofs for number in seam.pieces]), return_counts=True
    )
    others = np.setdiff1d(beyond[times > 1], np.concatenate([seam.dofs, ends]))
    stiffness, mass = _meeting(
        np.concatenate([seam.dofs, ends, others]), seam, parts, placed, boundaries
    )
    stiffness, mass = _relaxed(stiffness, mass, m)
    held, moved = stiffness[:n, :n], mass[:n, :n]
    try:
        # M v = nu (K + s M) v allows dofs without mass, and motions without strain
        nu, vectors = linalg.eigh(moved, held + _SHIFT * moved)
        follow = -linalg.solve(held, stiffness[:n, n:], assume_a="pos") if len(ends) else None
    except linalg.LinAlgError as error:
        raise UnrestrainedModeError(
            "a seam between pieces can move without strain while its ends are held"
        ) from error
    keep = nu > 1.0 / ((2.0 * np.pi * f_max) ** 2 + _SHIFT)
    nu, vectors = nu[keep][::-1], vectors[:, keep][:, ::-1]
    return SeamShapes(
        own=vectors / np.sqrt(nu),
        omega=np.sqrt(np.maximum(1.0 / nu - _SHIFT, 0.0)),
        ends=ends,
        follow=np.zeros((n, 0)) if follow is None else follow,
    )


def _meeting(
    dofs: Array,
    seam: Seam,
    parts: RelaxedParts,
    placed: Sequence[Placed],
    boundaries: Sequence[Boundary],
) -> tuple[Array, Array]:
    """Return reduced stiffness and mass of the pieces that meet at a seam, at some dofs.

    All else of a piece follows them at rest, piece by piece: no other piece has it.
    """
    order = np.argsort(dofs)
    rising = dofs[order]
    stiffness, mass = np.zeros((len(dofs), len(dofs))), np.zeros((len(dofs), len(dofs)))
    for number in seam.pieces:
        own, mine = placed[number], boundaries[number].dofs
        at = np.minimum(np.searchsorted(rising, mine), len(rising) - 1)
        held = np.flatnonzero(rising[at] == mine)
        k, m = parts.held_at(own.kind, held)
        sign = own.sign[parts.reduced[own.kind].boundary[held]]
        at, signs = order[at[held]], sign[:, None] * sign
        stiffness[np.ix_(at, at)] += k * signs
        mass[np.ix_(at, at)] += m * signs
    return stiffness, mass


class RelaxedParts:
    """Reduce parts to some of their boundary, the rest of which follows; each part once."""

    def __init__(self, reduced: Sequence[Superelement]) -> None:
        """`reduced` are the distinct parts."""
        self.reduced = reduced
        self._known: dict[tuple[int, bytes], tuple[Array, Array]] = {}

    def held_at(self, kind: int, rows: Int[Array, " some"]) -> tuple[Array, Array]:
        """Return stiffness and mass of a part at some rows of its boundary, by its own signs."""
        key = (kind, rows.tobytes())
        if key not in self._known:
            part = self.reduced[kind]
            order = np.concatenate([rows, np.setdiff1d(np.arange(len(part.boundary)), rows)])
            at = np.ix_(order, order)
            self._known[key] = _relaxed(part.stiffness[at], part.mass[at], len(rows))
        return self._known[key]


def _relaxed(stiffness: Array, mass: Array, kept: int) -> tuple[Array, Array]:
    """Return both at the first dofs, where all others follow them at rest."""
    if kept == len(stiffness):
        return stiffness, mass
    inside, across = stiffness[kept:, kept:], stiffness[kept:, :kept]
    try:
        follow = -linalg.solve(inside, across, assume_a="pos")
    except linalg.LinAlgError as error:
        raise UnrestrainedModeError(
            "a piece can move without strain while one of its seams is held"
        ) from error
    coupled = mass[:kept, kept:] @ follow
    moved = mass[:kept, :kept] + coupled + coupled.T + follow.T @ mass[kept:, kept:] @ follow
    held = stiffness[:kept, :kept] + across.T @ follow
    return 0.5 * (held + held.T), 0.5 * (moved + moved.T)

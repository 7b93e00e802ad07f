"""Say by what the boundary of each piece is written: dofs of short seams, shapes of long ones."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from trundle._typing import Array
from trundle.dynamics import Superelement
from trundle.structure.superelements.seams import Boundary, Placed, Seam, SeamShapes

__all__ = ["PieceBasis", "WrittenSeam", "piece_bases"]


@dataclass(frozen=True, kw_only=True, eq=False)
class PieceBasis:
    """Hold by what the boundary of a piece is written.

    Attributes
    ----------
    key : tuple
        Pieces of one kind with equal keys have the same shapes.
    shapes : ndarray of float, shape (n_boundary, n_seams)
        Motion of its boundary, by its own signs, by the coordinates of its seams.
    seams : ndarray of int, shape (n_seams,)
        Which coordinates these are, counted from the first of all seams.
    """

    key: tuple[object, ...]
    shapes: Float[Array, "boundary seams"]
    seams: Array


@dataclass(frozen=True, kw_only=True, eq=False)
class WrittenSeam:
    """Hold a long seam, by what it is written, and its first coordinate among all seams'.

    Attributes
    ----------
    seam : Seam
        The seam.
    shapes : SeamShapes
        By what it is written.
    key : tuple
        Seams with equal keys are written by the same shapes.
    first : int
        Its first coordinate.
    """

    seam: Seam
    shapes: SeamShapes
    key: tuple[object, ...]
    first: int


def piece_bases(
    parts: Sequence[Superelement],
    placed: Sequence[Placed],
    boundaries: Sequence[Boundary],
    kept: Array,
    written: Sequence[WrittenSeam],
) -> tuple[PieceBasis, ...]:
    """Return by what the boundary of each piece is written; equal ones share their shapes.

    Parameters
    ----------
    parts : sequence of Superelement
        The distinct parts.
    placed : sequence of Placed
        Each piece.
    boundaries : sequence of Boundary
        Of each piece.
    kept : ndarray of int, shape (n,)
        Free dofs of the structure that short seams keep; the first coordinates.
    written : sequence of WrittenSeam
        The long seams.
    """
    order = np.argsort(kept, kind="stable")
    shared: dict[tuple[object, ...], Array] = {}
    touching: list[list[WrittenSeam]] = [[] for _ in placed]
    for one in written:
        for number in one.seam.pieces:
            touching[number].append(one)
    found = []
    for own, boundary, mine in zip(placed, boundaries, touching, strict=True):
        place = np.searchsorted(kept[order], boundary.dofs)
        place = order[np.minimum(place, len(kept) - 1)] if len(kept) else place * 0
        whole = np.flatnonzero(kept[place] == boundary.dofs) if len(kept) else place[:0]
        sign = own.sign[parts[own.kind].boundary]
        followed = [boundary.rows(one.shapes.ends) for one in mine]
        key = (
            own.kind,
            whole.tobytes(),
            (sign < 0.0).tobytes(),
            *((one.key, boundary.rows(one.seam.dofs).tobytes()) for one in mine),
        )
        if key not in shared:
            shared[key] = _shapes(boundary, whole, sign, mine, followed)
        seams = [place[whole], *(np.arange(o.shapes.own.shape[1]) + o.first for o in mine)]
        found.append(PieceBasis(key=key, shapes=shared[key], seams=np.concatenate(seams)))
    return tuple(found)


def _shapes(
    boundary: Boundary,
    whole: Array,
    sign: Array,
    long: Sequence[WrittenSeam],
    followed: Sequence[Array],
) -> Array:
    """Return the motion of a piece's boundary by the coordinates of its seams."""
    n_own = [one.shapes.own.shape[1] for one in long]
    out = np.zeros((len(boundary.dofs), len(whole) + sum(n_own)))
    out[whole, np.arange(len(whole))] = 1.0
    column = np.full(len(boundary.dofs), -1, dtype=np.intp)
    column[whole] = np.arange(len(whole))
    first = len(whole)
    for one, ends, n in zip(long, followed, n_own, strict=True):
        rows = boundary.rows(one.seam.dofs)
        out[np.ix_(rows, column[ends])] = one.shapes.follow
        out[rows, first : first + n] = one.shapes.own
        first += n
    return out * sign[:, None]

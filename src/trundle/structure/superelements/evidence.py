"""Show that reduced parts are what they were: mass, rigid motion, own modes, what these carry."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from trundle._typing import Array
from trundle.dynamics import RestingPart, Superelement
from trundle.structure.superelements.pieces import Piece

__all__ = ["PartEvidence", "evidence_of"]

_FREE = 1e-6  # of the stiffness on the boundary, that a motion without strain may seem to take


@dataclass(frozen=True, kw_only=True, eq=False)
class PartEvidence:
    """Hold what a reduced part shows of itself, for six motions of a rigid body.

    The motions are x, y, z, and turns about axes through the middle of its nodes.

    Attributes
    ----------
    n_dofs, n_boundary, n_modes : int
        Of the part, of its boundary, and how many modes of its own are kept.
    first, last : float
        Frequencies of the lowest and highest of them [Hz]; NaN of none.
    mass : ndarray of float, shape (6,)
        Mass and moments of inertia of the whole part, as far as its dofs are free [kg], [kg m2].
    mass_error : ndarray of float, shape (6,)
        By what share those of the reduced part differ.
    strain : ndarray of float, shape (6,)
        Stiffness against each motion of the boundary, over that of the boundary's dofs alone: 0
        but for round-off where the part is free, more where it is held to the ground.
    effective : ndarray of float, shape (6,)
        Share of what moves inside that the kept modes carry (effective mass); 1 of all modes.
    """

    n_dofs: int
    n_boundary: int
    n_modes: int
    first: float
    last: float
    mass: Float[Array, " 6"]
    mass_error: Float[Array, " 6"]
    strain: Float[Array, " 6"]
    effective: Float[Array, " 6"]

    @property
    def grounded(self) -> tuple[str, ...]:
        """Name the motions against which the part is held by supports of its own."""
        names = ("x", "y", "z", "about x", "about y", "about z")
        return tuple(name for name, s in zip(names, self.strain, strict=True) if s > _FREE)


def evidence_of(piece: Piece, part: Superelement) -> PartEvidence:
    """Return what a reduced part shows of itself.

    Parameters
    ----------
    piece : Piece
        The part before its reduction.
    part : Superelement
        The same, reduced.

    Notes
    -----
    A free part follows a rigid motion of its boundary without strain, so that its reduced mass is
    exact; `mass_error` of a part that is held to the ground says how much of it stays behind. What
    follows inside, f, is carried by own modes as far as ``sum (phi^T M f)^2`` of ``f^T M f``.
    """
    rigid = _rigid(piece)
    whole = np.einsum("ij,ij->j", rigid, piece.mass @ rigid)
    at = rigid[part.boundary]
    reduced = np.einsum("ij,ij->j", at, part.mass @ at)
    held = np.einsum("ij,ij->j", at, part.stiffness @ at)
    alone = np.einsum("ij,i,ij->j", at, np.diag(part.stiffness), at)
    following = RestingPart(reduced=part, stiffness=piece.stiffness).following(at)
    carried = piece.mass[part.interior][:, part.interior] @ following
    inside = np.einsum("ij,ij->j", following, carried)
    modes = part.shapes.T @ carried
    f = part.omega / (2.0 * np.pi)
    return PartEvidence(
        n_dofs=part.n_dofs,
        n_boundary=len(part.boundary),
        n_modes=len(f),
        first=float(f[0]) if len(f) else float("nan"),
        last=float(f[-1]) if len(f) else float("nan"),
        mass=whole,
        mass_error=_over(reduced, whole) - 1.0,
        strain=_over(held, alone),
        effective=_over(np.sum(modes**2, axis=0), inside),
    )


def _rigid(piece: Piece) -> Float[Array, "dofs 6"]:
    """Return the six motions of a rigid body at the dofs of a part."""
    x, y, z = (piece.places - piece.places.mean(axis=0)).T
    out = np.zeros((len(piece.dofs), 6))
    out[np.arange(len(piece.dofs)), piece.kinds] = 1.0
    turned = {(0, 4): z, (0, 5): -y, (1, 3): -z, (1, 5): x, (2, 3): y, (2, 4): -x}
    for (kind, turn), arm in turned.items():
        moved = piece.kinds == kind
        out[moved, turn] = arm[moved]
    return out


def _over(values: Array, of: Array) -> Array:
    """Return a share; 0 of nothing."""
    return np.divide(values, of, out=np.zeros_like(values), where=of > 0.0)

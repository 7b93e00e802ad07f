"""Modes above half the sampling frequency: they answer the forces through filters, without steps.

Steps of such a mode would put its resonance, folded, within the bands. Below it the mode follows
the force, a little more than by its statics; a short filter says how much (`following_filters`).
Under the wheels of a coupled crossing these modes answer statically, like those left out.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float, Int

from trundle._typing import Array, SparseMatrix
from trundle.dynamics import ModalRecursion, Modes, following_filters

__all__ = ["Followers", "followers_of"]


@dataclass(frozen=True, kw_only=True, eq=False)
class Followers:
    """Hold the modes that are not stepped, at the points and on the route.

    Attributes
    ----------
    modes : ModalRecursion
        The modes with the time step; at least one.
    points : ndarray of float, shape (n_points, n_modes)
        Their shapes at the points.
    route_shapes : ndarray of float, shape (n_dofs, n_modes)
        Their shapes at the route's dofs.
    """

    modes: ModalRecursion
    points: Float[Array, "points modes"]
    route_shapes: Float[Array, "dofs modes"]

    def taps(self) -> Float[Array, "3 taps points dofs"]:
        """Return what unit forces at the dofs add to the motion of the points, as filters."""
        read = following_filters(self.modes)[:, :, None, :] * self.points
        flat = read.reshape(-1, read.shape[-1]) @ self.route_shapes.T
        return flat.reshape(*read.shape[:3], len(self.route_shapes))

    def below(self, f: float) -> Followers | None:
        """Return those below a frequency [Hz], None if there are none."""
        n = self._count_below(f)
        if n == 0:
            return None
        return replace(
            self,
            modes=self.modes.part(slice(n)),
            points=self.points[:, :n],
            route_shapes=self.route_shapes[:, :n],
        )

    def static_share_above(self, f: float) -> Float[Array, "points dofs"]:
        """Return what those above a frequency [Hz] add statically, at points by dofs [m/N]."""
        rest = slice(self._count_below(f), None)
        return (self.points[:, rest] / self.modes.square[rest]) @ self.route_shapes[:, rest].T

    def _count_below(self, f: float) -> int:
        return int(np.searchsorted(self.modes.square, (2.0 * np.pi * f) ** 2))


def followers_of(
    modes: Modes,
    propagator: ModalRecursion,
    n_stepped: int,
    reader: SparseMatrix,
    dofs: Int[Array, " dofs"],
) -> Followers | None:
    """Return the modes that are not stepped, None if all are.

    Parameters
    ----------
    modes : Modes
        All modes.
    propagator : ModalRecursion
        Their steps.
    n_stepped : int
        How many of them are stepped.
    reader : sparse matrix, shape (n_points, n_floor_dofs)
        Where the response is read.
    dofs : ndarray of int, shape (n_dofs,)
        The route's dofs.
    """
    rest = slice(n_stepped, None)
    if n_stepped == modes.n_modes:
        return None
    late = modes.part(rest)
    return Followers(
        modes=propagator.part(rest),
        points=late.seen(reader),
        route_shapes=late.at(dofs),
    )

"""Say how much of each piece is kept, by its distance from where wheels drive and points are read.

A bending wave of a floor travels at ``c = 2 kappa sqrt(omega)``, ``kappa = (D / m)^(1/4)``, and on
its way through d decays by ``exp(-zeta omega d / c)``. What it loses on the way out to a piece and
back is thus ``exp(-zeta d sqrt(omega) / kappa)``: alike wherever ``f d^2`` is. A piece twice as far
matters to a quarter of the frequency.

References
----------
L. Cremer, M. Heckl and B. A. T. Petersson, Structure-Borne Sound, 3rd ed. (2005), chapter 4.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from trundle._checks import frozen_array, positive, set_frozen
from trundle._typing import Array

__all__ = ["Nearness"]

_LEAST = 0.1  # of the whole band, that the farthest piece keeps
_STEPS = 4  # of shares an octave, so that equal pieces at like distances stay equal


@dataclass(frozen=True, kw_only=True, eq=False)
class Nearness:
    """Hold what pieces are near to, and how near.

    Attributes
    ----------
    places : ndarray of float, shape (n, 3)
        Where wheels drive and points are read [m].
    near : float
        Pieces within this distance are kept to the whole band [m].
    """

    places: Float[Array, "places 3"]
    near: float

    def __post_init__(self) -> None:
        """Check both."""
        set_frozen(
            self,
            places=frozen_array("places", self.places, shape=(None, 3)),
            near=positive("near", self.near),
        )

    def shares(self, pieces: Sequence[Float[Array, "_ 3"]]) -> Float[Array, " pieces"]:
        """Return the share of the whole band to which each piece is kept.

        Parameters
        ----------
        pieces : sequence of ndarray, shape (n_nodes, 3)
            Places of each piece's nodes [m].
        """
        away = np.array([_distance(self.places, nodes) for nodes in pieces])
        share = (self.near / np.maximum(away, self.near)) ** 2
        steps = np.ceil(_STEPS * np.log2(np.maximum(share, _LEAST)))
        return np.minimum(1.0, 2.0 ** (steps / _STEPS))


def _distance(places: Array, nodes: Array) -> float:
    """Return how far the nearest of some places lies from the box round some nodes [m]."""
    outside = np.maximum(nodes.min(axis=0) - places, places - nodes.max(axis=0))
    return float(np.linalg.norm(np.maximum(outside, 0.0), axis=1).min())

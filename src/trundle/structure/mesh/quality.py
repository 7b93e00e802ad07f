"""Measure the shape of elements."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from trundle._typing import Array

__all__ = ["MeshQuality", "angles", "aspects", "squareness"]


@dataclass(frozen=True, kw_only=True)
class MeshQuality:
    """Hold how well elements are shaped.

    Attributes
    ----------
    n_quads, n_triangles : int
        How many there are.
    least_angle, largest_angle : float
        Of all corners [degrees].
    largest_aspect : float
        Longest side over shortest.
    share_of_quads : float
        Part of the area that quadrilaterals cover.
    """

    n_quads: int
    n_triangles: int
    least_angle: float
    largest_angle: float
    largest_aspect: float
    share_of_quads: float


def angles(corners: Float[Array, "elements n 2"]) -> Float[Array, "elements n"]:
    """Return the angle inside each corner [rad], above pi where an element folds in."""
    ahead = np.roll(corners, -1, axis=1) - corners
    back = np.roll(corners, 1, axis=1) - corners
    cosine = np.einsum("eij,eij->ei", ahead, back)
    sine = ahead[..., 0] * back[..., 1] - ahead[..., 1] * back[..., 0]
    return np.mod(np.arctan2(sine, cosine), 2.0 * np.pi)


def aspects(corners: Float[Array, "elements n 2"]) -> Float[Array, " elements"]:
    """Return longest over shortest side."""
    sides = np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2)
    return sides.max(axis=1) / np.maximum(sides.min(axis=1), 1e-300)


def squareness(corners: Float[Array, "elements 4 2"]) -> Float[Array, " elements"]:
    """Return 1 for right angles, down to 0 at an angle of 0 or 180 degrees and below beyond."""
    return 1.0 - np.abs(angles(corners) - 0.5 * np.pi).max(axis=1, initial=0.0) / (0.5 * np.pi)

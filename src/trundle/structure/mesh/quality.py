"""Measure the shape of elements."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from trundle._typing import Array

__all__ = ["MeshQuality", "angles", "aspects", "quality_of", "signed_areas", "squareness"]


_RIGHT = 1e-4  # of a right angle, by which those of a rectangle may be off


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
    share_of_rectangles : float
        Part of the area that rectangles cover.
    """

    n_quads: int
    n_triangles: int
    least_angle: float
    largest_angle: float
    largest_aspect: float
    share_of_quads: float
    share_of_rectangles: float


def quality_of(shapes: Iterable[Float[Array, "_ _ 2"]]) -> MeshQuality:
    """Measure groups of elements, given the corners of each in their plane [m]."""
    groups = [shape for shape in shapes if len(shape)]
    turns = np.degrees(np.concatenate([angles(shape).ravel() for shape in groups]))
    areas = dict.fromkeys((3, 4), 0.0)
    counts = dict.fromkeys(areas, 0)
    square = 0.0
    for shape in groups:
        if shape.shape[1] == 4:
            right = squareness(shape) > 1.0 - _RIGHT
            square += float(np.abs(signed_areas(shape[right])).sum())
        areas[shape.shape[1]] += float(np.abs(signed_areas(shape)).sum())
        counts[shape.shape[1]] += len(shape)
    return MeshQuality(
        n_quads=counts[4],
        n_triangles=counts[3],
        least_angle=float(turns.min()),
        largest_angle=float(turns.max()),
        largest_aspect=float(max(aspects(shape).max() for shape in groups)),
        share_of_quads=areas[4] / sum(areas.values()),
        share_of_rectangles=square / sum(areas.values()),
    )


def signed_areas(corners: Float[Array, "elements n 2"]) -> Float[Array, " elements"]:
    """Return areas [m2], negative for elements that run clockwise."""
    x, y = np.moveaxis(corners - corners.mean(axis=1, keepdims=True), 2, 0)
    return 0.5 * np.sum(x * np.roll(y, -1, axis=1) - y * np.roll(x, -1, axis=1), axis=1)


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

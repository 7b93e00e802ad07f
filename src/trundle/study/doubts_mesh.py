"""Doubt elements of a building that lines which nearly touch leave hardly any room."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from jaxtyping import Float

from trundle._typing import Array
from trundle.errors import FitnessWarning
from trundle.structure import Surface
from trundle.structure.building import Building, gaps_of
from trundle.structure.mesh import MeshQuality, angles, aspects, quality_of
from trundle.study.model import Study

__all__ = ["gap_doubts", "quality_of_mesh", "shape_doubts"]

_SHARP, _FLAT = np.radians([5.0, 175.0])
_TOLD = 5  # gaps one by one
_LONG = 20.0  # longest side over shortest


def quality_of_mesh(study: Study) -> MeshQuality:
    """Return how well the elements of all storeys and ramps of a study are shaped."""
    return quality_of(
        corners for surface in study.floor.surfaces.values() for corners in _shapes(surface)
    )


def shape_doubts(study: Study) -> Iterator[FitnessWarning]:
    """Doubt the slivers of each storey and ramp."""
    for name, surface in study.floor.surfaces.items():
        slivers = [corners[_sliver(corners)] for corners in _shapes(surface)]
        many = sum(map(len, slivers))
        if many:
            found = quality_of(slivers)
            x, y = next(some for some in slivers if len(some))[0].mean(axis=0)
            yield FitnessWarning(
                subject="mesh",
                message=f"{many} {'element' if many == 1 else 'elements'} of {name!r} with hardly "
                f"any room, one at ({x:.4g}, {y:.4g}) m: corners of {found.least_angle:.2g} to "
                f"{found.largest_angle:.4g} degrees, sides up to {found.largest_aspect:.3g} to 1; "
                "they are stiffer than the slab. Lines run beside each other there: put them onto "
                "each other, or further apart",
            )


def gap_doubts(building: Building) -> Iterator[FitnessWarning]:
    """Doubt ends that come near to a part of their storey and do not meet it."""
    found = list(gaps_of(building))
    for gap in found[:_TOLD]:
        x, y = gap.place
        yield FitnessWarning(
            subject="gap",
            message=f"{gap.part} ends at ({x:.6g}, {y:.6g}) m on {gap.storey!r}, "
            f"{1e3 * gap.distance:.2g} mm from {gap.other}, and is not joined to it: ends within "
            "1 mm are; move it there, or further away",
        )
    if len(found) > _TOLD:
        more = f"{len(found) - _TOLD} more ends within 50 mm of a part that they do not meet"
        yield FitnessWarning(subject="gap", message=more)


def _shapes(surface: Surface) -> Iterator[Float[Array, "elements corners 2"]]:
    """Give the corners in plan of a surface's elements, those of each kind [m]."""
    places = surface.frame.coordinates(surface.nodes)
    for _, elements in surface.parts:
        if elements.shape[1] > 2:
            yield places[elements][:, :, :2]


def _sliver(corners: Array) -> Array:
    turns = angles(corners)
    return (turns.min(axis=1) < _SHARP) | (turns.max(axis=1) > _FLAT) | (aspects(corners) > _LONG)

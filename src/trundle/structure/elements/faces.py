"""Faces between nodes of which nothing is known but how they move: stood on, and nothing else."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Int

from trundle._checks import frozen_array, set_frozen
from trundle._typing import Array
from trundle.errors import InputError
from trundle.structure.elements.standing import (
    ContactShape,
    Hat,
    Located,
    Weights,
    line_locate,
    line_weights,
    quad_locate,
    quad_weights,
    triangle_locate,
    triangle_weights,
)

__all__ = ["FaceGroup"]

_LOCATE = {2: line_locate, 3: triangle_locate, 4: quad_locate}
_WEIGHTS = {2: line_weights, 3: triangle_weights, 4: quad_weights}


@dataclass(frozen=True, kw_only=True, eq=False)
class FaceGroup:
    """Hold lines, triangles or quadrilaterals between nodes, without stiffness or mass.

    Attributes
    ----------
    connectivity : ndarray of int, shape (n_elements, n_corners)
        Node numbers, two to four, in order round each.
    smooth : bool
        Whether the nodes' rotations are known: without them deflection runs straight from node to
        node.
    name : str
        What the group is.
    """

    connectivity: Int[Array, "elements corners"]
    smooth: bool = True
    name: str = "face"

    def __post_init__(self) -> None:
        """Freeze the corners, and refuse what is no face."""
        faces = frozen_array("faces", self.connectivity, shape=(None, None), dtype=np.intp)
        if faces.shape[1] not in _LOCATE:
            raise InputError(f"a face has two to four corners; got {faces.shape[1]}")
        set_frozen(self, connectivity=faces)

    @property
    def stands_on_ground(self) -> bool:
        """Whether a corner may be rigid ground."""
        return False

    @property
    def carried(self) -> Bool[Array, " 6"]:
        """Nothing: it gives neither stiffness nor mass."""
        return np.zeros(6, dtype=bool)

    def stiffness_blocks(self, xyz: Float[Array, "elements nodes 3"]) -> None:
        """Return nothing."""
        del xyz

    def mass_blocks(self, xyz: Float[Array, "elements nodes 3"]) -> None:
        """Return nothing."""
        del xyz

    def locate(self, corners: Float[Array, "n nodes 2"], places: Float[Array, "n 2"]) -> Located:
        """Return where in faces places lie."""
        return _LOCATE[corners.shape[1]](corners, places)

    def weights(
        self, local: Float[Array, "n 2"], corners: Float[Array, "n nodes 2"], shape: ContactShape
    ) -> Weights:
        """Return what the nodes' motion gives at places; straight where rotations are unknown."""
        return _WEIGHTS[corners.shape[1]](local, corners, shape if self.smooth else Hat())

"""Hold what results keep of a floor's natural modes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from trundle._typing import Array
from trundle.dynamics import Modes
from trundle.structure import Structure, node_motion

__all__ = ["FirstModes", "first_modes"]

_KEPT = 8  # shapes that are drawn
_ON_A_PAGE = 25_000  # nodes: some 2 MB of a page


@dataclass(frozen=True, kw_only=True, eq=False)
class FirstModes:
    """Hold all natural frequencies below a limit, and the shapes of the first modes.

    Attributes
    ----------
    frequencies : ndarray of float, shape (n_modes,)
        Natural frequencies, rising [Hz].
    vertical : ndarray of float, shape (n_nodes, n_kept)
        Vertical motion of every node in the first, normalised to unit modal mass.
    motion : ndarray of float, shape (n_nodes, 6, n_kept), or None
        All of their motion, for a view in space; None of models too large for a page.
    """

    frequencies: Float[Array, " modes"]
    vertical: Float[Array, "nodes kept"]
    motion: Float[Array, "nodes 6 kept"] | None = None

    @property
    def n_modes(self) -> int:
        """Number of modes."""
        return len(self.frequencies)


def first_modes(modes: Modes, floor: Structure) -> FirstModes:
    """Return what results keep of a floor's modes."""
    few = modes.first(_KEPT)
    vertical = few.seen(node_motion(floor, 2))
    motion = None
    if len(floor.nodes) <= _ON_A_PAGE:
        motion = np.stack([few.seen(node_motion(floor, dof)) for dof in range(6)], axis=1)
    return FirstModes(frequencies=modes.frequencies, vertical=vertical, motion=motion)

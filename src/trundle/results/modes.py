"""Hold what results keep of a floor's natural modes."""

from __future__ import annotations

from dataclasses import dataclass

from jaxtyping import Float

from trundle._typing import Array
from trundle.dynamics import Modes
from trundle.structure import Structure, node_motion

__all__ = ["FirstModes", "first_modes"]

_KEPT = 8  # shapes that are drawn


@dataclass(frozen=True, kw_only=True, eq=False)
class FirstModes:
    """Hold all natural frequencies below a limit, and the shapes of the first modes.

    Attributes
    ----------
    frequencies : ndarray of float, shape (n_modes,)
        Natural frequencies, rising [Hz].
    vertical : ndarray of float, shape (n_nodes, n_kept)
        Vertical motion of every node in the first, normalised to unit modal mass.
    """

    frequencies: Float[Array, " modes"]
    vertical: Float[Array, "nodes kept"]

    @property
    def n_modes(self) -> int:
        """Number of modes."""
        return len(self.frequencies)


def first_modes(modes: Modes, floor: Structure) -> FirstModes:
    """Return what results keep of a floor's modes."""
    vertical = modes.first(_KEPT).seen(node_motion(floor, 2))
    return FirstModes(frequencies=modes.frequencies, vertical=vertical)

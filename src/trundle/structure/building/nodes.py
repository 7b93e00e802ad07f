"""Gather the nodes of a building: those of its sheets, and those between storeys."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float, Int

from trundle._typing import Array
from trundle.errors import InputError
from trundle.structure.building.parts import Building
from trundle.structure.mesh.merging import first_there
from trundle.structure.mesh.sheet_mesh import SheetMesh

__all__ = ["Nodes"]

_SAME = 5e-4  # m, within which nodes that walls share between storeys are one


class Nodes:
    """Gathers nodes; those that members make between storeys are made one where they coincide."""

    def __init__(self, building: Building, mesh: SheetMesh) -> None:
        self._mesh = mesh
        self._number = {name: i for i, name in enumerate(building.floors)}
        self._places = [mesh.nodes]
        self._maker = [np.zeros(len(mesh.nodes), dtype=np.intp)]
        self._n = len(mesh.nodes)

    def at(self, on: str, place: Float[Array, " 2"], what: str) -> int:
        """Return the node of a storey or ramp at a place.

        Raises
        ------
        InputError
            There is none: nothing is there.
        """
        found = self._mesh.at(self._number[on], place)
        if found is None:
            raise InputError(
                f"{what} meets nothing on {on!r} at ({place[0]:g}, {place[1]:g}) m: no slab and no "
                "beam is there"
            )
        return found

    def rows_between(
        self, low: Int[Array, " n"], high: Int[Array, " n"], size: float, fewest: int
    ) -> Int[Array, "rows n"]:
        """Return rows of nodes between two lines, evenly spaced and no further apart than a size.

        Rows between the same levels stand at the same heights, whatever asks for them.
        """
        start, end = self._mesh.nodes[low], self._mesh.nodes[high]
        height = float(np.abs(end - start)[:, 2].max())
        n = max(fewest, int(np.ceil(height / size - 1e-6)))
        shares = np.arange(1, n) / n
        places = start + shares[:, None, None] * (end - start)
        inner = self._n + np.arange((n - 1) * len(low)).reshape(n - 1, len(low))
        self._places.append(places.reshape(-1, 3))
        self._maker.append(np.full(inner.size, len(self._maker)))
        self._n += inner.size
        return np.vstack([low, inner, high])

    def merged(self) -> tuple[Float[Array, "nodes 3"], Int[Array, " made"]]:
        """Return the places of all nodes [m], and the number of each as it was given out."""
        places, maker = np.concatenate(self._places), np.concatenate(self._maker)
        one = np.arange(len(places))
        # nodes of the sheets come first, keep their numbers, and are joined to nothing by chance
        made = np.flatnonzero(maker > 0)
        one[made] = made[first_there(places[made], _SAME, apart=maker[made])]
        first, number = np.unique(one, return_inverse=True)
        return places[first], number

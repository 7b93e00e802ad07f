"""Tell static deflections of a structure by its parts, without a factor of the whole.

A part deflects under what stands on it while its boundary is held, and follows its boundary:

    K^-1 = K_ii^-1 + Psi K_seams^-1 Psi^T,

so that a question about few places, such as the dofs under a route, costs solutions within the
parts on which they lie, and one with all seams.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np
from jaxtyping import Float
from scipy import sparse

from trundle._typing import Array, SparseMatrix
from trundle.dynamics import Factor, HalfSolve, factorise
from trundle.structure.superelements.assembly import Joined

__all__ = ["PartedFlexibility"]


class PartedFlexibility:
    """Solve for static deflections part by part; long seams deflect as their shapes do."""

    n_negative = 0

    def __init__(self, joined: Joined) -> None:
        """Take a structure by its parts."""
        self._joined = joined

    @cached_property
    def _seams(self) -> Factor:
        return factorise(self._joined.pencil.seam_stiffness)

    def solve(self, right_hand_side: Array) -> Array:
        """Return the deflection of all dofs under loads, (n_dofs,) or (n_dofs, n_loads)."""
        load = right_hand_side.reshape(len(right_hand_side), -1)
        joined, out = self._joined, np.zeros(load.shape)
        pushed = np.stack([joined.forces(one) for one in load.T], axis=1)
        moved = np.zeros_like(pushed)
        n = joined.pencil.n_modes
        moved[n:] = self._seams.solve(pushed[n:])
        out = joined.expanded(moved)
        for own in joined.placed:
            resting = joined.resting[own.kind]
            rows = own.dofs[resting.reduced.interior]
            if np.any(load[rows]):
                sign = own.sign[resting.reduced.interior][:, None]
                out[rows] += sign * resting.under(sign * load[rows])
        return out.reshape(right_hand_side.shape)

    def between(self, rows: SparseMatrix, columns: SparseMatrix) -> Float[Array, "rows columns"]:
        """Return ``rows K^-1 columns^T``; both are rows of weights over all dofs."""
        joined = self._joined
        seen, pushed = joined.seams_seen(rows), joined.seams_seen(columns)
        out = seen @ self._seams.solve(np.ascontiguousarray(pushed.T))
        by_row, by_column = sparse.csc_array(rows), sparse.csc_array(columns)
        for own in joined.placed:
            inner = joined.resting[own.kind].reduced.interior
            mine, theirs = by_row[:, own.dofs[inner]], by_column[:, own.dofs[inner]]
            if mine.nnz and theirs.nnz:
                sign = own.sign[inner]
                loads = np.flatnonzero(np.diff(sparse.csr_array(theirs).indptr))
                full = sparse.csr_array(theirs)[loads].toarray().T * sign[:, None]
                moved = joined.resting[own.kind].under(full)
                out[:, loads] += (mine @ sparse.diags_array(sign)) @ moved
        return out

    def halves(self) -> tuple[HalfSolve, HalfSolve] | None:
        """Return nothing: there is no factor of the whole."""
        return None

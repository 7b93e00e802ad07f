"""Hold a floor in its modes as the wheels of a crossing find it."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float
from scipy import sparse

from trundle._typing import Array, SparseMatrix
from trundle.dynamics import ModalRecursion, Modes
from trundle.route import ContactRows
from trundle.simulate._residual import StaticFlexibility, residual_block

__all__ = ["ModalFloor"]

_CHUNK = 256  # steps whose contact shapes are formed at once


class ModalFloor:
    """A floor in its modal coordinates under the wheels of one crossing.

    Steps are those of the record; wheels, where they are and how much of their force the model
    carries come from the rows of the contact operator.
    """

    def __init__(
        self,
        modes: Modes,
        propagator: ModalRecursion,
        rows: ContactRows,
        speed: Float[Array, "steps contacts"],
        points: SparseMatrix,
        *,
        flexibility: StaticFlexibility | None,
    ) -> None:
        self.propagator, self.dt = propagator, propagator.dt
        self.n_modes = modes.n_modes
        self.speed = speed
        self.points = np.ascontiguousarray(points @ modes.shapes)
        self._modes, self._rows, self._n = modes, rows, speed.shape[1]
        # Only the route's dofs are read; together they stay in cache.
        used = rows.used_dofs()
        self._route_shapes = np.ascontiguousarray(modes.shapes[used])
        self._at = np.minimum(np.searchsorted(used, rows.dofs), max(0, len(used) - 1))
        self._load_share = rows.load_share.reshape(-1, self._n)
        self._chunks: dict[int, tuple[Array, Array]] = {}
        self._residual = (
            None if flexibility is None else _Residual(rows, self._n, modes, flexibility)
        )

    def shapes(self, start: int, stop: int) -> tuple[Array, Array]:
        """Return mode shapes and slopes under the wheels, (n_steps, n_contacts, n_modes)."""
        first, last = start // _CHUNK, (stop - 1) // _CHUNK
        for number in [number for number in self._chunks if number < first]:
            del self._chunks[number]
        for number in range(first, last + 1):
            if number not in self._chunks:
                self._chunks[number] = self._chunk(number * _CHUNK)
        parts = [self._chunks[number] for number in range(first, last + 1)]
        here = slice(start - first * _CHUNK, stop - first * _CHUNK)
        if len(parts) == 1:
            return parts[0][0][here], parts[0][1][here]
        value, slope = (np.concatenate(pair) for pair in zip(*parts, strict=True))
        return value[here], slope[here]

    def loads(self, start: int, stop: int) -> Array:
        """Return the modal load of a unit force of each wheel, (n_steps, n_contacts, n_modes)."""
        value, _ = self.shapes(start, stop)
        return value * self._load_share[start:stop, :, None]

    def residual_sinking(self, start: int, stop: int) -> Array | None:
        """Return what the modes left out add to the sinking, (n_steps, n_contacts, n_contacts)."""
        return None if self._residual is None else self._residual.sinking(start, stop)

    def static_sinking(self) -> Array:
        """Return the static sinking under wheel i for a unit force of wheel j, at time 0."""
        value, _ = self.shapes(0, 1)
        square = self._modes.omega**2
        sinking = (value[0] / square) @ value[0].T * self._load_share[0]
        residual = self.residual_sinking(0, 1)
        return sinking if residual is None else sinking + residual[0]

    def static_state(self, forces: Float[Array, "contacts runs"]) -> Float[Array, "state runs"]:
        """Return the state at rest under static forces of the wheels at time 0."""
        q = -(self.loads(0, 1)[0].T @ forces) / (self._modes.omega**2)[:, None]
        return np.vstack([q, np.zeros_like(q)])

    def _chunk(self, start: int) -> tuple[Array, Array]:
        part = slice(start * self._n, (start + _CHUNK) * self._n)
        weights = np.concatenate([self._rows.value[part], self._rows.slope[part]])
        at = np.concatenate([self._at[part]] * 2)
        starts = np.arange(0, at.size + 1, at.shape[1])
        shape = (len(at), len(self._route_shapes))
        matrix = sparse.csr_array((weights.ravel(), at.ravel(), starts), shape=shape)
        both = (matrix @ self._route_shapes).reshape(2, -1, self._n, self.n_modes)
        return both[0], both[1]


class _Residual:
    """The static flexibility of the modes left out, between the wheels."""

    def __init__(
        self, rows: ContactRows, n_wheels: int, modes: Modes, flexibility: StaticFlexibility
    ) -> None:
        dofs = rows.used_dofs()
        self._block = residual_block(flexibility, modes, dofs)
        at = np.minimum(np.searchsorted(dofs, rows.dofs), len(dofs) - 1)
        shape = (-1, n_wheels, rows.dofs.shape[1])
        self._at, self._value = at.reshape(shape), rows.value.reshape(shape)
        self._load_share = rows.load_share.reshape(-1, n_wheels)

    def sinking(self, start: int, stop: int) -> Array:
        at, value = self._at[start:stop], self._value[start:stop]
        out = np.empty((stop - start, at.shape[1], at.shape[1]))
        for i in range(at.shape[1]):
            for j in range(at.shape[1]):
                between = self._block[at[:, i, :, None], at[:, j, None, :]]
                out[:, i, j] = np.einsum("sa,sab,sb->s", value[:, i], between, value[:, j])
        return out * self._load_share[start:stop, None, :]

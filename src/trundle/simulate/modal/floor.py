"""Hold a floor in its modes as the wheels of a crossing find it."""

from __future__ import annotations

from copy import copy

import numpy as np
from jaxtyping import Float, Int
from scipy import sparse

from trundle._typing import Array, SparseMatrix
from trundle.dynamics import ModalRecursion, Modes
from trundle.route import ContactRows
from trundle.simulate.modal.residual import StaticFlexibility, residual_block

__all__ = ["ModalFloor"]

_CHUNK = 256  # steps whose contact shapes are formed at once


class ModalFloor:
    """A floor in its modal coordinates under the wheels of one crossing.

    Steps are those of the record; wheels, where they are and how much of their force the model
    carries come from the rows of the contact operator. `dtype` is that of the state that is carried
    over the steps, and of the large maps that carry it.
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
        single: bool = False,
    ) -> None:
        self.dtype = np.dtype(np.float32 if single else np.float64)
        self.propagator, self.dt = propagator, propagator.dt
        self.n_modes = modes.n_modes
        self.speed = speed
        self.points = np.ascontiguousarray(modes.seen(points))
        self.n_contacts = self._n = speed.shape[1]
        self._square, self.rows = modes.omega**2, rows
        # Only the route's dofs are read; together they stay in cache.
        used = rows.used_dofs()
        self.route_shapes = np.ascontiguousarray(modes.at(used))
        self._at = np.minimum(np.searchsorted(used, rows.dofs), max(0, len(used) - 1))
        self._load_share = rows.load_share.reshape(-1, self._n)
        stands = (rows.value != 0.0) | (rows.slope != 0.0)
        self._stands = stands.any(axis=1).reshape(-1, self._n)
        self._chunks: dict[int, tuple[Array, Array]] = {}
        self._residual = (
            None if flexibility is None else _Residual(rows, self._n, modes, flexibility)
        )

    def for_one_drive(self) -> ModalFloor:
        """Return the floor with room of its own for shapes; two drives at once do not share it."""
        own = copy(self)
        own._chunks = {}
        return own

    def with_first(self, n_modes: int) -> ModalFloor:
        """Return the floor in its first modes; the others answer statically if any do."""
        fewer = self.for_one_drive()
        fewer.n_modes, fewer.propagator = n_modes, self.propagator.part(slice(n_modes))
        fewer.points = np.ascontiguousarray(self.points[:, :n_modes])
        fewer._square = self._square[:n_modes]
        fewer.route_shapes = np.ascontiguousarray(self.route_shapes[:, :n_modes])
        if self._residual is not None:
            fewer._residual = self._residual.with_more(
                self.route_shapes[:, n_modes:] / np.sqrt(self._square[n_modes:])
            )
        return fewer

    def count_below(self, f: float) -> int:
        """Return how many of the modes lie below a frequency [Hz]."""
        return int(np.searchsorted(self._square, (2.0 * np.pi * f) ** 2))

    def static_share(self, first: int) -> Float[Array, "points dofs"]:
        """Return what modes from a first on add statically, at the points by the route's dofs."""
        return (self.points[:, first:] / self._square[first:]) @ self.route_shapes[:, first:].T

    def shapes(self, start: int, stop: int) -> tuple[Array, Array]:
        """Return mode shapes and slopes under the wheels, (n_steps, n_contacts, n_modes)."""
        first, last = start // _CHUNK, (stop - 1) // _CHUNK
        for number in [number for number in self._chunks if number < first]:
            del self._chunks[number]
        for number in range(first, last + 1):
            if number not in self._chunks:
                self._chunks[number] = self._chunk(number * _CHUNK)
        parts = []
        for number in range(first, last + 1):
            at = number * _CHUNK
            here = slice(max(0, start - at), min(_CHUNK, stop - at))
            parts.append([values[here] for values in self._chunks[number]])
        if len(parts) == 1:
            return parts[0][0], parts[0][1]
        value, slope = (np.concatenate(pair) for pair in zip(*parts, strict=True))
        return value, slope

    def on_floor(self, start: int, stop: int) -> Int[Array, " standing"]:
        """Return the contacts that stand on the floor at some of these steps."""
        return np.flatnonzero(self._stands[start:stop].any(axis=0))

    def loads(self, start: int, stop: int, wheels: Int[Array, " wheels"] | None = None) -> Array:
        """Return the modal load of a unit force of each wheel, (n_steps, n_wheels, n_modes)."""
        value, _ = self.shapes(start, stop)
        share = self._load_share[start:stop, :, None]
        return value * share if wheels is None else value[:, wheels] * share[:, wheels]

    def residual_sinking(self, start: int, stop: int) -> Array | None:
        """Return what the modes left out add to the sinking, (n_steps, n_contacts, n_contacts)."""
        return None if self._residual is None else self._residual.sinking(start, stop)

    def static_sinking(self) -> Array:
        """Return the static sinking under wheel i for a unit force of wheel j, at time 0."""
        value, _ = self.shapes(0, 1)
        sinking = (value[0] / self._square) @ value[0].T * self._load_share[0]
        residual = self.residual_sinking(0, 1)
        return sinking if residual is None else sinking + residual[0]

    def static_state(self, forces: Float[Array, "contacts runs"]) -> Float[Array, "state runs"]:
        """Return the state at rest under static forces of the wheels at time 0."""
        q = -(self.loads(0, 1)[0].T @ forces) / self._square[:, None]
        return np.vstack([q, np.zeros_like(q)])

    def _chunk(self, start: int) -> tuple[Array, Array]:
        part = slice(start * self._n, (start + _CHUNK) * self._n)
        weights = np.concatenate([self.rows.value[part], self.rows.slope[part]])
        at = np.concatenate([self._at[part]] * 2)
        starts = np.arange(0, at.size + 1, at.shape[1])
        shape = (len(at), len(self.route_shapes))
        matrix = sparse.csr_array((weights.ravel(), at.ravel(), starts), shape=shape)
        matrix.eliminate_zeros()  # wheels that are not on the floor
        both = (matrix @ self.route_shapes).reshape(2, -1, self._n, self.n_modes)
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

    def with_more(self, flexible: Float[Array, "dofs modes"]) -> _Residual:
        """Return the residual with further modes left out, given as shapes over frequencies."""
        more = copy(self)
        more._block = self._block + flexible @ flexible.T
        return more

    def sinking(self, start: int, stop: int) -> Array:
        at, value = self._at[start:stop], self._value[start:stop]
        n_steps, n, width = at.shape
        starts = np.arange(0, at.size + 1, width)
        shape = (n_steps * n, len(self._block))
        pressing = sparse.csr_array((value.ravel(), at.ravel(), starts), shape=shape)
        deflected = (pressing @ self._block).reshape(n_steps, n, -1)  # by each wheel, everywhere
        under = np.take_along_axis(deflected, at.reshape(n_steps, 1, -1), axis=2)
        out = np.einsum("sia,sjia->sij", value, under.reshape(n_steps, n, n, width))
        return out * self._load_share[start:stop, None, :]

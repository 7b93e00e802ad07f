"""Hold a floor in its modes as the wheels of a crossing find it."""

from __future__ import annotations

from copy import copy
from typing import NamedTuple

import numpy as np
from jaxtyping import Float, Int

from trundle._typing import Array, SparseMatrix
from trundle.dynamics import ModalRecursion, Modes
from trundle.route import ContactRows
from trundle.simulate.modal.kept_maps import KeptMaps
from trundle.simulate.modal.powers import FloorPowers
from trundle.simulate.modal.residual import StaticFlexibility, residual_block
from trundle.simulate.wheels.standing import StandingWheels

__all__ = ["ModalFloor"]

_CHUNK = 256  # steps whose contact shapes are formed at once


class _Under(NamedTuple):
    """What is under the wheels at some steps: (n_steps, n_contacts) and, of shapes, n_modes."""

    value: Array
    slope: Array
    load_share: Array
    speed: Array


class ModalFloor:
    """A floor in its modal coordinates under the wheels of one crossing.

    Steps are those of the record; wheels, where they are and how much of their force the model
    carries come from the rows of the contact operator. `dtype` is that of the state that is carried
    over the steps, and of the large maps that carry it. `kept` holds what drives share of blocks.
    """

    def __init__(
        self,
        modes: Modes,
        propagator: ModalRecursion,
        standing: StandingWheels,
        points: SparseMatrix,
        *,
        flexibility: StaticFlexibility | None,
        single: bool = False,
    ) -> None:
        self.dtype = np.dtype(np.float32 if single else np.float64)
        self.propagator, self.dt = propagator, propagator.dt
        self.n_modes, self.n_contacts = modes.n_modes, standing.n_contacts
        self.standing = standing
        self.points = np.ascontiguousarray(modes.seen(points))
        self._square = modes.omega**2
        # Only the route's dofs are read; together they stay in cache.
        self._used = standing.used_dofs()
        self.route_shapes = np.ascontiguousarray(modes.at(self._used))
        self._chunks: dict[int, _Under] = {}
        self.kept, self._powers = KeptMaps(), dict[int, FloorPowers]()
        self._residual = None if flexibility is None else _Residual(standing, modes, flexibility)

    def for_one_drive(self) -> ModalFloor:
        """Return the floor with room of its own for shapes; two drives at once do not share it."""
        own = copy(self)
        own._chunks = {}
        return own

    def with_first(self, n_modes: int) -> ModalFloor:
        """Return the floor in its first modes; the others answer statically if any do."""
        fewer = self.for_one_drive()
        fewer.kept, fewer._powers = KeptMaps(), {}
        fewer.n_modes, fewer.propagator = n_modes, self.propagator.part(slice(n_modes))
        fewer.points = np.ascontiguousarray(self.points[:, :n_modes])
        fewer._square = self._square[:n_modes]
        fewer.route_shapes = np.ascontiguousarray(self.route_shapes[:, :n_modes])
        if self._residual is not None:
            fewer._residual = self._residual.with_more(
                self.route_shapes[:, n_modes:] / np.sqrt(self._square[n_modes:])
            )
        return fewer

    def powers(self, n_steps: int) -> FloorPowers:
        """Return the floor's powers over blocks of so many steps, the same for every drive."""
        if n_steps not in self._powers:
            single = self.dtype == np.float32
            self._powers[n_steps] = FloorPowers(
                self.propagator, self.points, n_steps, single=single
            )
        return self._powers[n_steps]

    def count_below(self, f: float) -> int:
        """Return how many of the modes lie below a frequency [Hz]."""
        return int(np.searchsorted(self._square, (2.0 * np.pi * f) ** 2))

    def static_share(self, first: int) -> Float[Array, "points dofs"]:
        """Return what modes from a first on add statically, at the points by the route's dofs."""
        return (self.points[:, first:] / self._square[first:]) @ self.route_shapes[:, first:].T

    def shapes(self, start: int, stop: int) -> tuple[Array, Array]:
        """Return mode shapes and slopes under the wheels, (n_steps, n_contacts, n_modes)."""
        under = self._under(start, stop)
        return under.value, under.slope

    def speeds(self, start: int, stop: int) -> Float[Array, "steps contacts"]:
        """Return the speeds of the wheels [m/s]."""
        return self._under(start, stop).speed

    def on_floor(self, start: int, stop: int) -> Int[Array, " standing"]:
        """Return the contacts that stand on the floor at some of these steps."""
        return np.flatnonzero(self.standing.stands[start:stop].any(axis=0))

    def loads(self, start: int, stop: int, wheels: Int[Array, " wheels"] | None = None) -> Array:
        """Return the modal load of a unit force of each wheel, (n_steps, n_wheels, n_modes)."""
        under = self._under(start, stop)
        value, share = under.value, under.load_share[:, :, None]
        return value * share if wheels is None else value[:, wheels] * share[:, wheels]

    def residual_sinking(self, start: int, stop: int) -> Array | None:
        """Return what the modes left out add to the sinking, (n_steps, n_contacts, n_contacts)."""
        return None if self._residual is None else self._residual.sinking(start, stop)

    def static_sinking(self) -> Array:
        """Return the static sinking under wheel i for a unit force of wheel j, at time 0."""
        under = self._under(0, 1)
        sinking = (under.value[0] / self._square) @ under.value[0].T * under.load_share[0]
        residual = self.residual_sinking(0, 1)
        return sinking if residual is None else sinking + residual[0]

    def static_state(self, forces: Float[Array, "contacts runs"]) -> Float[Array, "state runs"]:
        """Return the state at rest under static forces of the wheels at time 0."""
        q = -(self.loads(0, 1)[0].T @ forces) / self._square[:, None]
        return np.vstack([q, np.zeros_like(q)])

    def _under(self, start: int, stop: int) -> _Under:
        """Return what is under the wheels; chunks behind `start` are let go of."""
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
            return _Under(*parts[0])
        return _Under(*(np.concatenate(values) for values in zip(*parts, strict=True)))

    def _chunk(self, start: int) -> _Under:
        stop = min(start + _CHUNK, self.standing.n_steps)
        rows, speed = self.standing.window(start, stop)
        shape = (len(speed), self.n_contacts, self.n_modes)
        value, slope = (
            self._seen(rows, weights).reshape(shape) for weights in (rows.value, rows.slope)
        )
        return _Under(value, slope, rows.load_share.reshape(shape[:2]), speed)

    def _seen(self, rows: ContactRows, weights: Array) -> Array:
        matrix = rows.matrix(weights, self._used)
        matrix.eliminate_zeros()  # wheels that are not on the floor
        return matrix @ self.route_shapes


class _Residual:
    """The static flexibility of the modes left out, between the wheels."""

    def __init__(
        self, standing: StandingWheels, modes: Modes, flexibility: StaticFlexibility
    ) -> None:
        self._standing, self._used = standing, standing.used_dofs()
        self._block = residual_block(flexibility, modes, self._used)

    def with_more(self, flexible: Float[Array, "dofs modes"]) -> _Residual:
        """Return the residual with further modes left out, given as shapes over frequencies."""
        more = copy(self)
        more._block = self._block + flexible @ flexible.T
        return more

    def sinking(self, start: int, stop: int) -> Array:
        rows, _ = self._standing.window(start, stop)
        n_steps, n, width = stop - start, self._standing.n_contacts, rows.dofs.shape[1]
        at, value = (
            part.reshape(n_steps, n, width) for part in (rows.among(self._used), rows.value)
        )
        pressing = rows.matrix(rows.value, self._used)
        deflected = (pressing @ self._block).reshape(n_steps, n, -1)  # by each wheel, everywhere
        under = np.take_along_axis(deflected, at.reshape(n_steps, 1, -1), axis=2)
        out = np.einsum("sia,sjia->sij", value, under.reshape(n_steps, n, n, width))
        return out * rows.load_share.reshape(n_steps, 1, n)

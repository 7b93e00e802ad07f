"""Raise the free motion of a floor's modes and of a vehicle to the powers that blocks need.

A step is ``x_1 = phi x_0 + s f_0 + e f_1``, for forces that are straight between samples. So a
force acts twice: at the end of a step, and at the start of the next. Seen from a later step it has
added ``lag[0] = e`` at its own, and ``lag[l] = phi^(l-1) (phi e + s)`` after l steps; the force
before a block, whose end is in the state already, has added ``start[k] = phi^k s``. These depend on
the lag alone, which is why a block's maps are formed from one table of powers.

The state of hundreds of modes is the large thing that is carried on for every run. A *frame* of
several blocks carries it once: within it, the state that is kept is the one at the frame's start,
and a force at a later step is traced back to what it would have been there, by powers of
``phi^-1``. Going back makes numbers larger as modes decay, and so loses digits; a frame is only so
long that nine (in single precision five) powers of e are lost. Where one block decays by more there
is no way back, and every block advances the state itself.
"""

from __future__ import annotations

import numpy as np

from trundle._typing import Array
from trundle.dynamics import ExactRecursion, ModalRecursion

__all__ = ["FloorPowers", "VehiclePowers", "rows_on_state"]

_MOST_DECAY = 9.0  # powers of e over a frame: the way back loses as many
_MOST_DECAY_SINGLE = 5.0  # so that single precision keeps five digits
_MOST_STEPS = 256  # in a frame
_MOST_KEPT = 64e6  # bytes of point rows, which come back in every frame


class FloorPowers:
    """Hold a modal floor's powers over a block, and over a frame of several blocks.

    Within a frame the state is kept as what it would have been at the frame's start: a force at a
    later step is traced back to then. So modes advance once a frame, not at every block.
    """

    def __init__(
        self, propagator: ModalRecursion, points: Array, n_steps: int, *, single: bool = False
    ) -> None:
        phi = propagator.phi.transpose(1, 2, 0)
        start, end = propagator.from_start.T, propagator.from_end.T
        gamma = np.einsum("abm,bm->am", phi, end) + start
        self.n_steps = n_steps
        most = _MOST_DECAY_SINGLE if single else _MOST_DECAY
        self.frame, goes_back = _frame_length(propagator, n_steps, most)
        powers = [np.broadcast_to(np.eye(2)[:, :, None], phi.shape)]
        for _ in range(self.frame):
            powers.append(np.einsum("abm,bcm->acm", phi, powers[-1]))
        self.phi = np.array(powers[1:])  # (frame, 2, 2, modes)
        block = powers[:n_steps]
        self.start = np.array([_apply(power, start) for power in block])  # (steps, 2, modes)
        self.lag = np.array([end, *(_apply(power, gamma) for power in block[:-1])])
        self._back: tuple[Array, ...] | None = None
        if goes_back:
            inverse = np.linalg.inv(propagator.phi).transpose(1, 2, 0)
            self._back = tuple(_backwards(inverse, v, self.frame + 1) for v in (start, gamma, end))
        self._by_state: dict[tuple[int, int], Array] = {}
        self.points = points
        self.point_rows = _point_rows(propagator, points)  # (2, 3 points, modes)
        self.points_lag = np.array([_read(self.point_rows, g) for g in self.lag])
        self.points_start = np.array([_read(self.point_rows, g) for g in self.start])

    def points_by_state(self, first: int, n_steps: int) -> Array:
        """Return the outputs at the points by the frame's state, (n_outputs, 2 n_modes)."""
        key = (self.place(first), n_steps)
        if key in self._by_state:
            return self._by_state[key]
        rows = rows_on_state(self.point_rows, self.phi[key[0] : key[0] + n_steps])
        rows = rows.reshape(-1, 2 * self.phi.shape[-1])
        if rows.nbytes * self.frame <= _MOST_KEPT * n_steps:
            self._by_state[key] = rows
        return rows

    def place(self, first: int) -> int:
        """Return how many steps of its frame have gone before the block after a step."""
        return first % self.frame

    def up_to(self, step: int) -> Array | None:
        """Return the power from the state that is kept behind a step to that at it, if any."""
        at = self.place(step)
        return None if self._back is None or at == 0 else self.phi[at - 1]

    def advance(self, first: int, n_steps: int) -> Array | None:
        """Return the power that ends a frame after a block, (2, 2, modes); None within it."""
        if self._back is None:
            return self.phi[n_steps - 1]
        return None if self.place(first) + n_steps < self.frame else self.phi[-1]

    def early(self, first: int, n_steps: int) -> Array | None:
        """Return what states at the frame's start the forces of a block stand for.

        Returns
        -------
        ndarray of float, shape (n_steps + 1, 2, n_modes), or None
            Forces at the step before the block, and at each of its steps but for what the last
            adds after the block. None where there is no way back.
        """
        if self._back is None:
            return None
        at = self.place(first)
        start, gamma, end = self._back
        inner = gamma[at + 2 : at + n_steps + 1]
        return np.concatenate([start[at + 1 : at + 2], inner, end[at + n_steps : at + n_steps + 1]])

    def gains(self, first: int, n_steps: int) -> Array:
        """Return what the forces of a block add to the state, (n_steps + 1, 2, n_modes).

        The state is that at the frame's start, or after the block if that ends the frame.
        """
        if self.advance(first, n_steps) is None:
            early = self.early(first, n_steps)
            assert early is not None  # frames of several blocks have a way back
            return early
        return np.concatenate([self.start[n_steps - 1][None], self.lag[:n_steps][::-1]])


class VehiclePowers:
    """Hold a vehicle's powers over a block, on its contact springs, as its contacts feel them."""

    def __init__(
        self, vehicle: ExactRecursion, contact_map: Array, push: Array, n_steps: int
    ) -> None:
        """`push` (n_contacts, 2 n_dofs) is what a state takes off the contact forces."""
        self.n_contacts, self.push = len(contact_map), push
        powers = [np.eye(len(vehicle.phi))]
        for _ in range(n_steps):
            powers.append(vehicle.phi @ powers[-1])
        start, end = vehicle.from_start @ contact_map.T, vehicle.from_end @ contact_map.T
        gamma = vehicle.phi @ end + start
        self.phi = np.array(powers[1:])
        self.start = np.array([power @ start for power in powers[:-1]])
        self.lag = np.array([end, *(power @ gamma for power in powers[: n_steps - 1])])
        self.push_by_state = np.concatenate([push @ power for power in self.phi])
        self._push_start, self._push_lag = push @ self.start, push @ self.lag
        self._laid_out: dict[int, Array] = {}

    def push_by_forces(self, n_steps: int) -> Array:
        """Return what pushes take off later forces by moving the vehicle: (steps, c, steps + 1, c).

        They depend on the lag alone.
        """
        if n_steps not in self._laid_out:
            n = self._push_lag.shape[1]
            out = np.zeros((n_steps, n, n_steps + 1, n))
            out[:, :, 0] = self._push_start[:n_steps]
            for lag in range(n_steps):
                at = np.arange(n_steps - lag)
                out[at + lag, :, at + 1] = self._push_lag[lag]
            self._laid_out[n_steps] = out
        return self._laid_out[n_steps]

    def last_state(self, n_steps: int) -> Array:
        """Return the state after a block by the state before, and by all pushes."""
        lags = self.lag[:n_steps][::-1]
        return np.hstack([self.phi[n_steps - 1], self.start[n_steps - 1], *lags])


def rows_on_state(rows: Array, power: Array) -> Array:
    """Return rows of later states as rows of the frame's state: (steps, rows, 2 modes).

    Parameters
    ----------
    rows : ndarray of float, shape (2, n_rows, n_modes) or (2, n_steps, n_rows, n_modes)
        What is read of displacement and of velocity, the same at every step or not.
    power : ndarray of float, shape (n_steps, 2, 2, n_modes)
        Free motion from the frame's state to each step.
    """
    n_modes = rows.shape[-1]
    out = np.empty((len(power), rows.shape[-2], 2 * n_modes))
    for i in range(2):
        half = out[..., i * n_modes : (i + 1) * n_modes]
        np.multiply(rows[0], power[:, 0, i, None], out=half)
        half += rows[1] * power[:, 1, i, None]
    return out


def _frame_length(propagator: ModalRecursion, n_steps: int, decays: float) -> tuple[int, bool]:
    """Return the steps of a frame, whole blocks, and whether one can go back over it."""
    slowest = np.abs(np.linalg.eigvals(propagator.phi)).min()
    decay = -np.log(slowest) if slowest > 0.0 else np.inf
    most = min(_MOST_STEPS, decays / max(decay, 1e-12))
    return max(1, int(most // n_steps)) * n_steps, bool(most >= n_steps)


def _backwards(inverse: Array, vector: Array, count: int) -> Array:
    """Return inverse powers 0, 1, ... of a step applied to a vector, (count, 2, modes)."""
    out = [vector]
    for _ in range(count - 1):
        out.append(_apply(inverse, out[-1]))
    return np.array(out)


def _point_rows(propagator: ModalRecursion, points: Array) -> Array:
    """Return displacement, velocity, acceleration at points: (2, 3 points, modes)."""
    zero = np.zeros_like(points)
    on_displacement = np.concatenate([points, zero, -points * propagator.square])
    on_velocity = np.concatenate([zero, points, -points * propagator.double])
    return np.stack([on_displacement, on_velocity])


def _read(rows: Array, state: Array) -> Array:
    return np.einsum("apm,am->pm", rows, state)


def _apply(power: Array, vector: Array) -> Array:
    return np.einsum("abm,bm->am", power, vector)

"""Complete the motion at the points: what steps lose of it, and what modes left out add.

Both are short filters in time of what is recorded (`dynamics.sampling`): the recorded motion is
multiplied by the inverse of what a line straight between samples keeps; the forces by what
completes the modes there, and by the static flexibility of the modes left out, differentiated for
velocity and acceleration. The forces are known at all steps by then, coupled or not. Over a block
of steps that is a product with a band of a matrix, formed once for all runs.
"""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import partial

import numpy as np
from jaxtyping import Float, Int
from scipy import linalg, sparse

from trundle._threads import n_threads
from trundle._typing import Array
from trundle.dynamics import REACH, differentiator, image_filters, restoring_filter
from trundle.simulate.modal.floor import ModalFloor
from trundle.simulate.modal.followers import Followers
from trundle.simulate.wheels.driven import Driven
from trundle.simulate.wheels.standing import StandingWheels

__all__ = ["PointFilters", "complete", "point_filters"]

_BLOCK = 32  # steps completed at once
_COLUMNS = 128  # runs in one product; the same whatever the machine, so that bits are too


@dataclass(frozen=True, kw_only=True, eq=False)
class PointFilters:
    """Hold what contact forces add to the recorded motion at the points.

    Attributes
    ----------
    standing : StandingWheels
        The contacts at every step.
    dofs : ndarray of int, shape (n_dofs,)
        Dofs of the route, rising.
    taps : ndarray of float, shape (3, 2 REACH + 1, n_points, n_dofs)
        What unit forces at the dofs add, upwards, to displacement, velocity and acceleration of
        the points, by how many steps they come later, from -REACH on [m/N], [m/s/N], [m/s2/N].
    """

    standing: StandingWheels
    dofs: Int[Array, " dofs"]
    taps: Float[Array, "3 taps points dofs"]


def point_filters(
    floor: ModalFloor,
    residual: Float[Array, "points dofs"] | None,
    followers: Followers | None = None,
) -> PointFilters:
    """Form the filters of a floor in its modes.

    Parameters
    ----------
    floor : ModalFloor
        The floor under the wheels.
    residual : ndarray of float or None, shape (n_points, n_dofs)
        Static flexibility of the modes left out, at the points by the route's dofs [m/N].
    followers : Followers, optional
        Modes that are not stepped, at the same points and dofs.
    """
    images, shapes = image_filters(floor.propagator), floor.route_shapes
    read = images[:, :, None, :] * floor.points  # (3, taps, points, modes)
    taps = (read.reshape(-1, floor.n_modes) @ shapes.T).reshape(*read.shape[:3], len(shapes))
    if residual is not None:
        taps[0, REACH] += residual
        for order in (1, 2):
            rate = differentiator(order)[:, None, None] / floor.dt**order
            taps[order] += rate * residual
    if followers is not None:
        taps += followers.taps()
    return PointFilters(standing=floor.standing, dofs=floor.standing.used_dofs(), taps=taps)


def complete(record: Driven, filters: PointFilters) -> Driven:
    """Complete the motion at the points, whose arrays are used again.

    Before the record everything was at rest, or in the static state of its first step; `record`
    holds the motion REACH steps longer than the forces, of which the last stays.
    """
    motion = (record.displacement, record.velocity, record.acceleration)
    n_steps, _, n_runs = record.forces.shape
    slices = [slice(i, i + _COLUMNS) for i in range(0, n_runs, _COLUMNS)]
    before = [np.repeat(part[:1], REACH, axis=0) for part in motion]
    influence = _Influence(filters, n_steps)
    with ThreadPoolExecutor(n_threads()) as pool:
        for first in range(0, n_steps, _BLOCK):
            steps = slice(first, min(first + _BLOCK, n_steps))
            block = (_band(steps.stop - first), influence.of(steps), _around(steps, n_steps))
            finish = partial(_finish, motion, before, record.forces, (steps, block))
            for _ in pool.map(finish, slices):
                pass
    displacement, velocity, acceleration = (part[:n_steps] for part in motion)
    return Driven(
        displacement=displacement,
        velocity=velocity,
        acceleration=acceleration,
        forces=record.forces,
    )


def _finish(
    motion: tuple[Array, ...],
    before: list[Array],
    forces: Array,
    block: tuple[slice, tuple[Array, Array, Array]],
    runs: slice,
) -> None:
    """Complete some runs over a block of steps; `before` is what was recorded before it."""
    steps, (band, added, around) = block
    here = [
        np.concatenate([old[..., runs], part[steps.start : steps.stop + REACH, :, runs]])
        for old, part in zip(before, motion, strict=True)
    ]
    for old, window in zip(before, here, strict=True):
        old[..., runs] = window[steps.stop - steps.start :][:REACH]
    whole = np.stack(here, axis=1)  # (window, 3, points, runs)
    pressing = forces[:, :, runs][around]
    done = band @ whole.reshape(len(whole), -1)
    done += (added @ pressing.reshape(-1, pressing.shape[2])).reshape(done.shape)
    done = done.reshape(-1, *whole.shape[1:])
    for i, part in enumerate(motion):
        part[steps, :, runs] = done[:, i]


def _around(steps: slice, n_steps: int) -> Int[Array, " window"]:
    return np.clip(np.arange(steps.start - REACH, steps.stop + REACH), 0, n_steps - 1)


def _band(n_steps: int) -> Float[Array, "steps window"]:
    taps = restoring_filter()
    return linalg.toeplitz(
        np.r_[taps[0], np.zeros(n_steps - 1)], np.r_[taps, np.zeros(n_steps - 1)]
    )


class _Influence:
    """Gives what forces around a block add to the points in it."""

    def __init__(self, filters: PointFilters, n_steps: int) -> None:
        self._standing, self._dofs = filters.standing, filters.dofs
        self._n_steps, self._n = n_steps, filters.standing.n_contacts
        self._shape = filters.taps.shape[:3]
        self._taps = -filters.taps.reshape(-1, len(filters.dofs)).T  # forces press downwards

    def of(self, steps: slice) -> Float[Array, "outputs forces"]:
        """Return (steps, 3, points) flat by (window, contacts) flat."""
        around, n = _around(steps, self._n_steps), self._n
        first, last = int(around[0]), int(around[-1])
        contacts = ((around - first)[:, None] * n + np.arange(n)).ravel()
        weights = self._weights(first, last + 1)[contacts]
        by_tap = (weights @ self._taps).reshape(len(around), n, *self._shape)
        n_steps, (_, n_taps, n_points) = steps.stop - steps.start, self._shape
        out = np.zeros((n_steps, 3, n_points, len(around), n))
        at = np.arange(n_steps)
        for tap in range(n_taps):
            late = by_tap[at + tap, :, :, tap]  # (steps, contacts, 3, points)
            out[at, :, :, at + tap] = late.transpose(0, 2, 3, 1)
        return out.reshape(n_steps * 3 * n_points, -1)

    def _weights(self, start: int, stop: int) -> sparse.csr_array:
        """Return what contacts at some steps press on the route's dofs."""
        rows, _ = self._standing.window(start, stop)
        matrix = rows.matrix(rows.load_share[:, None] * rows.value, self._dofs)
        matrix.sort_indices()
        return matrix

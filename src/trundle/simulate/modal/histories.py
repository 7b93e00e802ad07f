"""Collect the histories of a drive in blocks, and stop it where they are no longer finite."""

from __future__ import annotations

import numpy as np

from trundle._typing import Array
from trundle.dynamics import REACH
from trundle.errors import UnstableStepError
from trundle.simulate.modal.floor import ModalFloor
from trundle.simulate.wheels.driven import Driven
from trundle.simulate.wheels.timeline import Timeline

__all__ = ["Histories"]


class Histories:
    """Collect forces and outputs block by block, and stop at the first that is not finite."""

    def __init__(self, floor: ModalFloor | None, timeline: Timeline, forces: Array) -> None:
        self._floor, self._time = floor, timeline.time[timeline.n_run_in :]
        n_points = 0 if floor is None else len(floor.points)
        self._motion = np.zeros((3, len(self._time) + REACH, n_points, forces.shape[2]))
        self._forces = forces

    def begin(self, states: list[Array]) -> None:
        """Read the points before the first step."""
        if self._floor is not None:
            x = np.hstack(states)
            half, points = len(x) // 2, self._floor.points
            self._motion[0, 0] = points @ x[:half]
            load = self._floor.loads(0, 1)[0].T @ self._forces[0]
            held = (points * self._floor.propagator.square) @ x[:half]
            self._motion[2, 0] = -points @ load - held

    def put(self, step: int, runs: slice, seen: Array) -> None:
        """Keep what the points do in some runs from a step on."""
        n_points, n_runs = self._motion.shape[2], seen.shape[1]
        motion = seen.reshape(-1, 3, n_points, n_runs)
        rows = slice(step, step + len(motion))
        self._motion[:, rows, :, runs] = motion.swapaxes(0, 1)
        if not np.isfinite(seen).all():
            self._stop(step, self._forces[rows, :, runs])
        self.check(step, step + len(motion), runs)

    def behind(self, late: int, runs: slice, seen: Array) -> None:
        """Keep what the points do so many steps behind the record."""
        self._motion[:, len(self._time) + late, :, runs] = seen.reshape(3, -1, seen.shape[1])

    def check(self, start: int = 0, stop: int | None = None, runs: slice = slice(None)) -> None:
        """Stop at the first contact force that is not finite."""
        forces = self._forces[start:stop, :, runs]
        if not np.isfinite(forces).all():
            self._stop(start, forces)

    def _stop(self, step: int, forces: Array) -> None:
        bad = ~np.isfinite(forces).all(axis=(1, 2))
        late = step + (int(np.argmax(bad)) if bad.any() else len(forces) - 1)
        time = float(self._time[late])
        raise UnstableStepError(
            f"a number stopped being finite at step {late}, t = {time:g} s; shorten the time step",
            step=late,
            time=time,
        )

    def done(self) -> Driven:
        """Return all that was collected."""
        return Driven(
            displacement=self._motion[0],
            velocity=self._motion[1],
            acceleration=self._motion[2],
            forces=self._forces,
        )

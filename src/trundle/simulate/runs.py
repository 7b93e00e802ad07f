"""Hold what an ensemble of runs gives: histories, forces, doubts."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from trundle._typing import Array
from trundle.errors import FitnessWarning, InputError

__all__ = ["Runs"]


@dataclass(frozen=True, kw_only=True, eq=False)
class Runs:
    """Hold the runs of one set of crossings by one method.

    Attributes
    ----------
    time : ndarray of float, shape (n_steps,)
        Time since the start of the record [s].
    displacement, velocity, acceleration : ndarray of float, shape (n_runs, n_steps, n_points)
        Vertical response at the points, up positive [m], [m/s], [m/s2].
    contact_forces : ndarray of float, shape (n_runs, n_steps, n_contacts)
        Forces under the wheels, positive when pressing on the floor [N].
    point_names, contact_names : tuple of str
        Names along the last axes.
    seed : int
        Seed from which every run's road was drawn.
    method : str
        Interaction, integration, damping and contact, in words.
    f_max : float
        Highest frequency that the computation contains [Hz].
    warnings : tuple of FitnessWarning
        Doubts about the result's fitness.
    """

    time: Float[Array, " steps"]
    displacement: Float[Array, "runs steps points"]
    velocity: Float[Array, "runs steps points"]
    acceleration: Float[Array, "runs steps points"]
    contact_forces: Float[Array, "runs steps contacts"]
    point_names: tuple[str, ...]
    contact_names: tuple[str, ...]
    seed: int
    method: str
    f_max: float
    warnings: tuple[FitnessWarning, ...] = ()

    @property
    def n_runs(self) -> int:
        """Number of runs."""
        return int(self.acceleration.shape[0])

    @property
    def dt(self) -> float:
        """Time step [s]."""
        return float(self.time[1] - self.time[0])

    @property
    def sampling_frequency(self) -> float:
        """Sampling frequency [Hz]."""
        return 1.0 / self.dt

    def point(self, name: str) -> int:
        """Return the place of a point along the last axis, by its name."""
        if name not in self.point_names:
            raise InputError(f"no point {name!r}; the points are {', '.join(self.point_names)}")
        return self.point_names.index(name)

    def peak_acceleration(self) -> Float[Array, "runs points"]:
        """Return the largest absolute acceleration of each run [m/s2]."""
        return np.abs(self.acceleration).max(axis=1)

    def record_rms_velocity(self) -> Float[Array, "runs points"]:
        """Return the RMS velocity over the whole record of each run [m/s].

        This is the paper's measure; it falls as the record is made longer.
        """
        return np.sqrt(np.mean(self.velocity**2, axis=1))

    def __str__(self) -> str:
        """Summarise the ensemble in a few lines."""
        lines = [
            f"{self.n_runs} runs, {len(self.time)} steps of {1e3 * self.dt:g} ms, seed {self.seed}",
            self.method,
        ]
        for i, name in enumerate(self.point_names):
            peak = np.median(self.peak_acceleration()[:, i])
            rms = np.median(self.record_rms_velocity()[:, i])
            lines.append(f"{name}: median peak {peak:.3g} m/s2, record RMS {rms:.3g} m/s")
        return "\n".join([*lines, *(f"warning: {w}" for w in self.warnings)])

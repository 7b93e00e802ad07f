"""Hold what an ensemble of runs gives: histories, forces, doubts."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
from jaxtyping import Bool, Float

from trundle._typing import Array
from trundle.errors import FitnessWarning, InputError
from trundle.signals import band_limit
from trundle.simulate.coverage import Coverage

__all__ = ["MeanResponse", "Runs"]


@dataclass(frozen=True, kw_only=True, eq=False)
class MeanResponse:
    """Hold the response without roughness: the static loads that move over the floor.

    Attributes
    ----------
    time : ndarray of float, shape (n_steps,)
        Time of the record [s].
    displacement, velocity, acceleration : ndarray of float, shape (n_steps, n_points)
        Response at the points, up positive.
    contact_forces : ndarray of float, shape (n_steps, n_contacts)
        Forces under the wheels [N].
    point_names : tuple of str
        Names of the points.
    """

    time: Float[Array, " steps"]
    displacement: Float[Array, "steps points"]
    velocity: Float[Array, "steps points"]
    acceleration: Float[Array, "steps points"]
    contact_forces: Float[Array, "steps contacts"]
    point_names: tuple[str, ...]


@dataclass(frozen=True, kw_only=True, eq=False)
class Runs:
    """Hold the runs of one set of crossings by one method.

    Attributes
    ----------
    time : ndarray of float, shape (n_steps,)
        Time since the start of the record [s].
    displacement, velocity, acceleration : ndarray of float, shape (n_runs, n_steps, n_points)
        Response at the points [m], [m/s], [m/s2]: vertical, up positive; level at those that are
        `horizontal`.
    contact_forces : ndarray of float, shape (n_runs, n_steps, n_contacts)
        Forces under the wheels, positive when pressing on the floor [N].
    point_names, contact_names : tuple of str
        Names along the last axes.
    seed : int
        Seed from which every run's road was drawn.
    method : str
        Interaction, integration, damping and contact, in words.
    f_max : float
        Highest frequency that modes and step show as it is [Hz].
    warnings : tuple of FitnessWarning
        Doubts about the result's fitness.
    coverage : Coverage
        Which bands the road excites, and whether the vehicles have left.
    lifts : tuple of bool
        Which contacts would leave the floor rather than pull; all unless given.
    horizontal : tuple of int
        Numbers of the points that are read along an axis of the plan; none unless given.
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
    coverage: Coverage = field(default_factory=Coverage)
    lifts: tuple[bool, ...] | None = None
    horizontal: tuple[int, ...] = ()

    @property
    def n_runs(self) -> int:
        """Number of runs."""
        return int(self.acceleration.shape[0])

    @property
    def dt(self) -> float:
        """Time step [s]."""
        return float(self.time[1] - self.time[0])

    @property
    def f_resolved(self) -> float:
        """Highest mid-band frequency that modes, step and sampling show as it is [Hz]."""
        return min(self.f_max, band_limit(self.sampling_frequency))

    @property
    def sampling_frequency(self) -> float:
        """Sampling frequency [Hz]."""
        return 1.0 / self.dt

    @property
    def lifting(self) -> Bool[Array, " contacts"]:
        """Which contacts would leave the floor rather than pull."""
        if self.lifts is None:
            return np.ones(self.contact_forces.shape[2], dtype=bool)
        return np.array(self.lifts, dtype=bool)

    @property
    def ways(self) -> tuple[str, ...] | None:
        """Whether each point's motion is vertical or horizontal; None where all are vertical."""
        if not self.horizontal:
            return None
        points = range(len(self.point_names))
        return tuple("horizontal" if i in self.horizontal else "vertical" for i in points)

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

    def tension_share(self) -> Float[Array, " contacts"]:
        """Return the share of runs in which each contact would have to pull at some time."""
        return np.mean((self.contact_forces < 0.0).any(axis=1) & self.lifting, axis=0)

    def part(self, which: slice) -> Runs:
        """Return some of the runs, without holding on to the others' histories."""
        return replace(
            self,
            displacement=self.displacement[which].copy(),
            velocity=self.velocity[which].copy(),
            acceleration=self.acceleration[which].copy(),
            contact_forces=self.contact_forces[which].copy(),
        )

    def on_scaled_road(self, mean: MeanResponse, factor: float) -> Runs:
        """Return what the same runs give on roads whose elevations are so many times larger.

        Exact, for the system is linear: what a road adds to the response without roughness is
        proportional to it.
        """
        if factor == 1.0:
            return self
        return replace(
            self,
            displacement=_about(mean.displacement, self.displacement, factor),
            velocity=_about(mean.velocity, self.velocity, factor),
            acceleration=_about(mean.acceleration, self.acceleration, factor),
            contact_forces=_about(mean.contact_forces, self.contact_forces, factor),
        )

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


def _about(still: Array, values: Array, factor: float) -> Array:
    return still + factor * (values - still)

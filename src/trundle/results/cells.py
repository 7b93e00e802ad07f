"""Hold what is kept of each cell of a study: what drove, on what road, by which method."""

from __future__ import annotations

from dataclasses import dataclass

from jaxtyping import Float

from trundle._typing import Array
from trundle.errors import FitnessWarning
from trundle.response import BandSpectra, ExactStatistics, RunLevels
from trundle.simulate import Coverage, TruncationChange

__all__ = ["EXACT_SHARES", "Cell", "CellKey", "DayKey", "History"]

EXACT_SHARES = (50.0, 95.0)
"""Percentiles of the peak that exact statistics are asked for."""


@dataclass(frozen=True)
class CellKey:
    """Name a cell: what drove, on what road, by which method."""

    case: str
    road: str
    method: str


@dataclass(frozen=True)
class DayKey:
    """Name a day: by what schedule, on what road."""

    schedule: str
    road: str


@dataclass(frozen=True, kw_only=True, eq=False)
class History:
    """Hold the time histories of one run (the first) at every point.

    Attributes
    ----------
    time : ndarray of float, shape (n_steps,)
        Time [s].
    displacement, velocity, acceleration : ndarray of float, shape (n_steps, n_points)
        Response, up positive [m], [m/s], [m/s2].
    contact_forces : ndarray of float, shape (n_steps, n_contacts)
        Forces on the floor, positive when pressing [N].
    """

    time: Float[Array, " steps"]
    displacement: Float[Array, "steps points"]
    velocity: Float[Array, "steps points"]
    acceleration: Float[Array, "steps points"]
    contact_forces: Float[Array, "steps contacts"]


@dataclass(frozen=True, kw_only=True, eq=False)
class Cell:
    """Hold what is kept of one cell's ensemble.

    Attributes
    ----------
    key : CellKey
        Which cell.
    reduced : RunLevels
        What is kept of every run.
    contact_names : tuple of str
        Names of the contacts.
    exact : ExactStatistics or None
        Exact statistics over all roads of the class; only modes have them.
    exact_peaks : ndarray of float or None, shape (n_shares, n_points)
        Peak accelerations that `EXACT_SHARES` of all roads stay below [m/s2].
    truncation : TruncationChange or None
        What some more modes left out would change, on the first road of its waviness.
    history : History
        The first run in time.
    f_resolved : float
        Highest frequency that its levels can be trusted to [Hz].
    coverage : Coverage
        Which bands the road excites, and whether the vehicles have left.
    warnings : tuple of FitnessWarning
        Doubts about the cell.
    """

    key: CellKey
    reduced: RunLevels
    contact_names: tuple[str, ...]
    exact: ExactStatistics | None
    exact_peaks: Float[Array, "shares points"] | None
    truncation: TruncationChange | None
    history: History
    f_resolved: float
    coverage: Coverage
    warnings: tuple[FitnessWarning, ...]

    @property
    def peak_acceleration(self) -> Float[Array, "runs points"]:
        """Largest absolute acceleration of every run [m/s2]."""
        return self.reduced.peak_acceleration

    @property
    def rms_velocity(self) -> Float[Array, "runs points"]:
        """RMS velocity of every run over its record [m/s]."""
        return self.reduced.rms_velocity

    @property
    def spectra(self) -> BandSpectra:
        """One-third-octave velocity levels of every run [m/s]."""
        return self.reduced.spectra

    @property
    def peak_contact_force(self) -> Float[Array, "runs contacts"]:
        """Largest contact force of every run, static load included [N]."""
        return self.reduced.peak_contact_force

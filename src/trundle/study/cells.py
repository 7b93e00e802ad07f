"""Hold what is kept of each cell of a study: what drove, on what road, by which method."""

from __future__ import annotations

from dataclasses import dataclass

from jaxtyping import Float

from trundle._typing import Array
from trundle.errors import FitnessWarning
from trundle.response import BandSpectra, ExactStatistics
from trundle.simulate import TruncationChange

__all__ = ["EXACT_SHARES", "Cell", "CellKey", "History"]

EXACT_SHARES = (50.0, 95.0)
"""Percentiles of the peak that exact statistics are asked for."""


@dataclass(frozen=True)
class CellKey:
    """Name a cell: what drove, on what road, by which method."""

    case: str
    road: str
    method: str


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
    peak_acceleration : ndarray of float, shape (n_runs, n_points)
        Largest absolute acceleration [m/s2].
    rms_velocity : ndarray of float, shape (n_runs, n_points)
        RMS velocity over the record [m/s].
    spectra : BandSpectra
        One-third-octave velocity levels [m/s].
    peak_contact_force : ndarray of float, shape (n_runs, n_contacts)
        Largest contact force, static load included [N].
    contact_names : tuple of str
        Names of the contacts.
    tension_share : ndarray of float, shape (n_contacts,)
        Share of runs in which a contact would have had to pull.
    exact : ExactStatistics or None
        Exact statistics over all roads of the class; only modes have them.
    exact_peaks : ndarray of float or None, shape (n_shares, n_points)
        Peak accelerations that `EXACT_SHARES` of all roads stay below [m/s2].
    truncation : TruncationChange or None
        What some more modes left out would change, on the first road of its waviness.
    history : History
        The first run in time.
    top : float
        Highest frequency that its levels can be trusted to [Hz].
    warnings : tuple of FitnessWarning
        Doubts about the cell.
    """

    key: CellKey
    peak_acceleration: Float[Array, "runs points"]
    rms_velocity: Float[Array, "runs points"]
    spectra: BandSpectra
    peak_contact_force: Float[Array, "runs contacts"]
    contact_names: tuple[str, ...]
    tension_share: Float[Array, " contacts"]
    exact: ExactStatistics | None
    exact_peaks: Float[Array, "shares points"] | None
    truncation: TruncationChange | None
    history: History
    top: float
    warnings: tuple[FitnessWarning, ...]

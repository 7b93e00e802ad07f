"""Hold what the parts of a job leave, and put cells together from them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias

from jaxtyping import Float

from trundle._typing import Array
from trundle.errors import FitnessWarning
from trundle.response import ExactStatistics, RunLevels, join
from trundle.results.cells import EXACT_SHARES, Cell, CellKey, History
from trundle.results.maps import StudyMap
from trundle.simulate import Coverage, Runs, TruncationChange
from trundle.simulate.fitness import LOST_CONTACT, contact_warnings
from trundle.traffic import Day

__all__ = [
    "ChangesPart",
    "DayPart",
    "ExactPart",
    "MapPart",
    "Part",
    "RunsPart",
    "cell_of",
    "exact_part",
    "joined",
    "runs_part",
]

_COARSE = 0.05  # change of an RMS by half the waves above which exact statistics are doubted


@dataclass(frozen=True, kw_only=True, eq=False)
class RunsPart:
    """Hold what some runs leave, on every road of their job.

    Attributes
    ----------
    reduced : tuple of RunLevels
        What is kept of every run, by road.
    histories : tuple of History
        The first run in time, by road; nothing but in a job's first part.
    contact_names : tuple of str
        Names of the contacts.
    truncation : TruncationChange or None
        What some more modes left out would change; in a job's first part.
    coverage : Coverage
        Which bands the road excites, and whether the vehicles have left.
    f_resolved : float
        Highest frequency that levels can be trusted to [Hz].
    ends : float
        Time at which the record ends [s].
    warnings : tuple of FitnessWarning
        Doubts, but for lost contact, which depends on the road.
    """

    reduced: tuple[RunLevels, ...]
    histories: tuple[History, ...]
    contact_names: tuple[str, ...]
    truncation: TruncationChange | None
    coverage: Coverage
    f_resolved: float
    ends: float
    warnings: tuple[FitnessWarning, ...]

    def doubts(self, road: int) -> tuple[FitnessWarning, ...]:
        """Return the doubts about the runs on one of the roads."""
        pulling = contact_warnings(float(self.reduced[road].tension.any(axis=1).mean()))
        return (*pulling, *self.warnings)


@dataclass(frozen=True, kw_only=True, eq=False)
class ExactPart:
    """Hold exact statistics on the first road of a job, and the peaks on every road.

    Attributes
    ----------
    exact : ExactStatistics
        On the first road.
    peaks : tuple of ndarray of float, shape (n_shares, n_points)
        Peak accelerations that `EXACT_SHARES` of all roads stay below, by road [m/s2].
    """

    exact: ExactStatistics
    peaks: tuple[Float[Array, "shares points"], ...]


@dataclass(frozen=True, kw_only=True, eq=False)
class MapPart:
    """Hold the maps of a job, by road."""

    maps: tuple[StudyMap, ...]


@dataclass(frozen=True, kw_only=True, eq=False)
class ChangesPart:
    """Hold what the same runs leave behind each kind of isolator."""

    variants: tuple[RunsPart, ...]


@dataclass(frozen=True, kw_only=True, eq=False)
class DayPart:
    """Hold one day of a schedule, by road."""

    days: tuple[Day, ...]


Part: TypeAlias = RunsPart | ExactPart | MapPart | ChangesPart | DayPart
"""What a task leaves."""


def runs_part(
    runs: Runs,
    reduced: Sequence[RunLevels],
    histories: Sequence[Runs],
    *,
    truncation: TruncationChange | None,
) -> RunsPart:
    """Return what some runs leave on every road; `histories` hold the first run, or nothing."""
    return RunsPart(
        reduced=tuple(reduced),
        histories=tuple(
            History(
                time=runs.time,
                displacement=one.displacement[0],
                velocity=one.velocity[0],
                acceleration=one.acceleration[0],
                contact_forces=one.contact_forces[0],
            )
            for one in histories
        ),
        contact_names=tuple(runs.contact_names),
        truncation=truncation,
        coverage=runs.coverage,
        f_resolved=runs.f_resolved,
        ends=float(runs.time[-1]),
        warnings=tuple(w for w in runs.warnings if w.subject != LOST_CONTACT),
    )


def exact_part(exact: ExactStatistics, factors: Sequence[float]) -> ExactPart:
    """Return exact statistics on the first road, and the peaks on every road."""
    return ExactPart(
        exact=exact,
        peaks=tuple(exact.on_scaled_road(factor).peaks(EXACT_SHARES) for factor in factors),
    )


def joined(parts: Sequence[RunsPart]) -> RunsPart:
    """Return the runs of several parts as those of one; the first keeps what is kept once."""
    first = parts[0]
    roads = range(len(first.reduced))
    return RunsPart(
        reduced=tuple(join([part.reduced[road] for part in parts]) for road in roads),
        **{name: getattr(first, name) for name in _ONCE},
    )


_ONCE = ("histories", "contact_names", "truncation", "coverage", "f_resolved", "ends", "warnings")


def cell_of(key: CellKey, road: int, factor: float, parts: Sequence[Part]) -> Cell:
    """Put the parts of a job together to the cell of one of its roads.

    Parameters
    ----------
    key : CellKey
        Which cell.
    road : int
        Place of the road in the job.
    factor : float
        How many times rougher it is than the job's first.
    parts : sequence of Part
        All parts of the job, in their order.
    """
    runs = joined([part for part in parts if isinstance(part, RunsPart)])
    exact = next((part for part in parts if isinstance(part, ExactPart)), None)
    doubts = runs.doubts(road)
    return Cell(
        key=key,
        reduced=runs.reduced[road],
        contact_names=runs.contact_names,
        exact=None if exact is None else exact.exact.on_scaled_road(factor),
        exact_peaks=None if exact is None else exact.peaks[road],
        truncation=runs.truncation,
        history=runs.histories[road],
        f_resolved=runs.f_resolved,
        coverage=runs.coverage,
        warnings=(
            *(w for w in doubts if w.subject == LOST_CONTACT),
            *_quadrature_warnings(key, exact),
            *(w for w in doubts if w.subject != LOST_CONTACT),
        ),
    )


def _quadrature_warnings(key: CellKey, part: ExactPart | None) -> tuple[FitnessWarning, ...]:
    error = 0.0 if part is None else part.exact.quadrature_error
    if error <= _COARSE:
        return ()
    return (
        FitnessWarning(
            subject=f"exact statistics, {key.case}",
            message=f"their waves are sparse: half of them change an RMS by {100 * error:.0f} %; "
            "trust the runs beside them",
        ),
    )

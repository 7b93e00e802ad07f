"""Turn what the parts of a job leave into plain arrays and notes, and back into cells."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal, TypeAlias

from trundle._typing import Array
from trundle.errors import FitnessWarning
from trundle.response import (
    BandSpectra,
    ExactStatistics,
    LargestValues,
    Reduced,
    SpectrumQuantity,
    join,
)
from trundle.results.cells import EXACT_SHARES, Cell, CellKey, History
from trundle.simulate import Coverage, Runs, TruncationChange
from trundle.simulate.fitness import LOST_CONTACT, contact_warnings

__all__ = ["Piece", "SampledRuns", "cell_of", "exact_piece", "runs_piece", "sampled_runs"]

Role: TypeAlias = Literal["runs", "exact", "map", "changes"]

_RUNS = (
    "peak_acceleration",
    "peak_time",
    "rms_velocity",
    "response_factor",
    "vdv",
    "peak_contact_force",
    "tension",
)
_LINES = ("mid_band", "resolved")
_LEVELS = ("values", "times")
_COARSE = 0.05  # change of an RMS by half the waves above which exact statistics are doubted
_HISTORY = ("displacement", "velocity", "acceleration", "contact_forces")
_TRUNCATION = ("velocity", "acceleration")
_LARGEST = ("mean", "random")


@dataclass(frozen=True, kw_only=True, eq=False)
class Piece:
    """Hold what one part of a job leaves.

    Attributes
    ----------
    role : {"runs", "exact", "map", "changes"}
        What it holds.
    arrays : mapping of str to ndarray
        Numbers; those of one road bear its place before a full stop.
    notes : mapping of str
        What can be written as JSON.
    """

    role: Role
    arrays: Mapping[str, Array]
    notes: Mapping[str, Any]


def runs_piece(
    runs: Runs,
    reduced: Sequence[Reduced],
    histories: Sequence[Runs],
    *,
    truncation: TruncationChange | None,
) -> Piece:
    """Return what some runs leave on every road; `histories` hold the first run, or nothing."""
    arrays: dict[str, Array] = {"time": runs.time}
    for spectra in _spectra(reduced[0]):
        arrays |= {f"{spectra.quantity}.{name}": getattr(spectra, name) for name in _LINES}
    for i, kept in enumerate(reduced):
        arrays |= {f"{i}.{name}": getattr(kept, name) for name in _RUNS}
        for spectra in _spectra(kept):
            arrays |= {f"{i}.{spectra.quantity}.{n}": getattr(spectra, n) for n in _LEVELS}
    for i, history in enumerate(histories):
        arrays |= {f"{i}.history.{name}": getattr(history, name)[0] for name in _HISTORY}
    notes: dict[str, Any] = {
        "averaging": reduced[0].spectra.averaging,
        "quantities": [spectra.quantity for spectra in _spectra(reduced[0])],
        "point_names": list(runs.point_names),
        "contact_names": list(runs.contact_names),
        "coverage": runs.coverage.as_notes(),
        "top": min(runs.f_max, runs.sampling_frequency / 2.5),
        "warnings": [[w.subject, w.message] for w in runs.warnings if w.subject != LOST_CONTACT],
    }
    if truncation is not None:
        arrays |= {f"truncation.{name}": getattr(truncation, name) for name in _TRUNCATION}
        notes["truncation_f_max"] = truncation.f_max
    return Piece(role="runs", arrays=arrays, notes=notes)


def exact_piece(exact: ExactStatistics, factors: Sequence[float]) -> Piece:
    """Return exact statistics on the first road, and the peaks on every road."""
    arrays: dict[str, Array] = {"time": exact.time, "mid_band": exact.mid_band}
    arrays["resolved"] = exact.resolved
    arrays |= {f"mean.{name}": value for name, value in exact.mean.items()}
    arrays |= {f"variance.{name}": value for name, value in exact.variance.items()}
    for quantity, values in exact.largest.items():
        arrays |= {f"largest.{quantity}.{name}": getattr(values, name) for name in _LARGEST}
    arrays |= {"band_mean": exact.band_mean, "band_variance": exact.band_variance}
    for i, factor in enumerate(factors):
        arrays[f"{i}.peaks"] = exact.rougher(factor).peaks(EXACT_SHARES)
    notes = {
        "quadrature_error": exact.quadrature_error,
        "n_waves": exact.n_waves,
        "point_names": list(exact.point_names),
    }
    return Piece(role="exact", arrays=arrays, notes=notes)


@dataclass(frozen=True, kw_only=True, eq=False)
class SampledRuns:
    """Hold what is kept of all runs on one road.

    Attributes
    ----------
    reduced : Reduced
        What is kept of every run.
    top : float
        Highest frequency that levels can be trusted to [Hz].
    coverage : Coverage
        Which bands the road excites, and whether the vehicles have left.
    ends : float
        Time at which the record ends [s].
    warnings : tuple of FitnessWarning
        Doubts, that of lost contact first.
    """

    reduced: Reduced
    top: float
    coverage: Coverage
    ends: float
    warnings: tuple[FitnessWarning, ...]


def sampled_runs(pieces: Sequence[Piece], road: int) -> SampledRuns:
    """Put the pieces of runs together, for one of their roads.

    Parameters
    ----------
    pieces : sequence of Piece
        What runs left, in their order.
    road : int
        Place of the road in the job.
    """
    notes = pieces[0].notes
    runs = join([_reduced(piece, road) for piece in pieces])
    return SampledRuns(
        reduced=runs,
        top=float(notes["top"]),
        coverage=Coverage.from_notes(notes["coverage"]),
        ends=float(pieces[0].arrays["time"][-1]),
        warnings=(
            *contact_warnings(float(runs.tension.any(axis=1).mean())),
            *(FitnessWarning(subject=s, message=text) for s, text in notes["warnings"]),
        ),
    )


def cell_of(key: CellKey, road: int, factor: float, pieces: Sequence[Piece]) -> Cell:
    """Put the pieces of a job together to the cell of one of its roads.

    Parameters
    ----------
    key : CellKey
        Which cell.
    road : int
        Place of the road in the job.
    factor : float
        How many times rougher it is than the job's first.
    pieces : sequence of Piece
        All pieces of the job, in their order.
    """
    sampled = [piece for piece in pieces if piece.role == "runs"]
    exact = [piece for piece in pieces if piece.role == "exact"]
    first, notes = sampled[0].arrays, sampled[0].notes
    runs = sampled_runs(sampled, road)
    pulling = [w for w in runs.warnings if w.subject == LOST_CONTACT]
    others = [w for w in runs.warnings if w.subject != LOST_CONTACT]
    return Cell(
        key=key,
        reduced=runs.reduced,
        contact_names=tuple(notes["contact_names"]),
        exact=_exact(exact[0]).rougher(factor) if exact else None,
        exact_peaks=exact[0].arrays[f"{road}.peaks"] if exact else None,
        truncation=_truncation(sampled[0]),
        history=History(
            time=first["time"], **{name: first[f"{road}.history.{name}"] for name in _HISTORY}
        ),
        top=runs.top,
        coverage=runs.coverage,
        warnings=(*pulling, *_quadrature_warnings(key, exact), *others),
    )


def _quadrature_warnings(key: CellKey, exact: Sequence[Piece]) -> tuple[FitnessWarning, ...]:
    error = float(exact[0].notes["quadrature_error"]) if exact else 0.0
    if error <= _COARSE:
        return ()
    return (
        FitnessWarning(
            subject=f"exact statistics, {key.case}",
            message=f"their waves are sparse: half of them change an RMS by {100 * error:.0f} %; "
            "trust the runs beside them",
        ),
    )


def _truncation(piece: Piece) -> TruncationChange | None:
    if "truncation_f_max" not in piece.notes:
        return None
    return TruncationChange(
        f_max=float(piece.notes["truncation_f_max"]),
        **{name: piece.arrays[f"truncation.{name}"] for name in _TRUNCATION},
    )


def _spectra(reduced: Reduced) -> tuple[BandSpectra, ...]:
    return (reduced.spectra, *reduced.more.values())


def _reduced(piece: Piece, road: int) -> Reduced:
    arrays = piece.arrays
    first, *more = (_spectrum(piece, road, name) for name in piece.notes["quantities"])
    return Reduced(
        spectra=first,
        more={spectra.quantity: spectra for spectra in more},
        **{name: arrays[f"{road}.{name}"] for name in _RUNS},
    )


def _spectrum(piece: Piece, road: int, quantity: SpectrumQuantity) -> BandSpectra:
    arrays = piece.arrays
    return BandSpectra(
        quantity=quantity,
        averaging=piece.notes["averaging"],
        point_names=tuple(piece.notes["point_names"]),
        **{name: arrays[f"{quantity}.{name}"] for name in _LINES},
        **{name: arrays[f"{road}.{quantity}.{name}"] for name in _LEVELS},
    )


def _exact(piece: Piece) -> ExactStatistics:
    arrays = piece.arrays

    def named(prefix: str) -> dict[str, Array]:
        start = f"{prefix}."
        return {n.removeprefix(start): v for n, v in arrays.items() if n.startswith(start)}

    mean = named("mean")
    return ExactStatistics(
        time=arrays["time"],
        mean=mean,
        variance=named("variance"),
        largest={
            quantity: LargestValues(
                **{name: arrays[f"largest.{quantity}.{name}"] for name in _LARGEST}
            )
            for quantity in ("velocity", "acceleration")
        },
        mid_band=arrays["mid_band"],
        resolved=arrays["resolved"],
        band_mean=arrays["band_mean"],
        band_variance=arrays["band_variance"],
        quadrature_error=float(piece.notes["quadrature_error"]),
        n_waves=int(piece.notes["n_waves"]),
        point_names=tuple(piece.notes["point_names"]),
    )

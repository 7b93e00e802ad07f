"""Hold an ensemble against criteria: pass, fail or not assessed, margin, governing band."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np
from jaxtyping import Float

from trundle._checks import within
from trundle._typing import Array
from trundle.criteria.curve import Criterion
from trundle.response import BandSpectra, velocity_spectra
from trundle.signals import Averaging, nominal_frequency
from trundle.simulate import Runs

__all__ = ["Status", "Verdict", "assess", "assess_spectra", "best_class"]

Status: TypeAlias = Literal["pass", "fail", "not assessed"]
"""Outcome of a comparison. What was not computed is never a pass."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Verdict:
    """Hold the outcome of one criterion at one point.

    Attributes
    ----------
    criterion : Criterion
        The curve.
    point : str
        Name of the point.
    status : {"pass", "fail", "not assessed"}
        ``fail`` where any value exceeds its limit; ``pass`` where all bands of the curve
        were computed and none does; ``not assessed`` otherwise.
    percentile : float
        Share of runs that the compared value covers, 0 to 100.
    unresolved : tuple of float
        Nominal frequencies of bands in the curve's range that were not computed [Hz].
    averaging : str
        Averaging rule of the value.
    margin : float
        Smallest limit over value in the bands computed; below 1 fails. This and the rest are
        NaN where nothing was computed.
    governing_band : float
        Mid-band frequency where the margin is smallest [Hz]; NaN for peak values.
    value, limit : float
        Value and limit there [m/s] or [m/s2].
    share_exceeding : float
        Share of the runs that exceed the limit in any band, 0 to 1.
    """

    criterion: Criterion
    point: str
    status: Status
    percentile: float
    unresolved: tuple[float, ...]
    averaging: str
    margin: float = np.nan
    governing_band: float = np.nan
    value: float = np.nan
    limit: float = np.nan
    share_exceeding: float = np.nan

    def __str__(self) -> str:
        """State the verdict in one line."""
        at = "" if np.isnan(self.governing_band) else f" at {self.governing_band:.3g} Hz"
        return f"{self.point}, {self.criterion.title}: {self.status}, margin {self.margin:.2f}{at}"


def assess(
    runs: Runs,
    criteria: Criterion | Sequence[Criterion],
    *,
    percentile: float = 95.0,
    averaging: Averaging = "max_1s",
) -> tuple[Verdict, ...]:
    """Hold every point of an ensemble against every criterion.

    Parameters
    ----------
    runs : Runs
        The ensemble.
    criteria : Criterion or sequence of Criterion
        The curves.
    percentile : float
        Share of runs that the compared level must cover, 0 to 100.
    averaging : {"max_1s", "slow", "fast", "event"}
        Averaging rule of band levels.

    Returns
    -------
    tuple of Verdict
        By point, then by criterion.
    """
    spectra = velocity_spectra(runs, averaging=averaging)
    return assess_spectra(
        spectra,
        runs.peak_acceleration(),
        criteria,
        percentile=percentile,
        top=min(runs.f_max, runs.sampling_frequency / 2.5),
    )


def assess_spectra(
    spectra: BandSpectra,
    peak_acceleration: Float[Array, "runs points"],
    criteria: Criterion | Sequence[Criterion],
    *,
    percentile: float,
    top: float,
) -> tuple[Verdict, ...]:
    """Hold band levels and peaks against criteria.

    Parameters
    ----------
    spectra : BandSpectra
        Velocity levels.
    peak_acceleration : ndarray of float, shape (n_runs, n_points)
        Largest absolute acceleration of each run [m/s2].
    criteria : Criterion or sequence of Criterion
        The curves.
    percentile : float
        Share of runs that the compared level must cover, 0 to 100.
    top : float
        Highest frequency that the peak accelerations contain [Hz].
    """
    within("percentile", percentile, 0.0, 100.0)
    many = (criteria,) if isinstance(criteria, Criterion) else tuple(criteria)
    verdicts = []
    for i, point in enumerate(spectra.point_names):
        for criterion in many:
            if criterion.quantity == "band_rms_velocity":
                verdicts.append(_by_band(spectra, i, point, criterion, percentile))
            else:
                peaks = peak_acceleration[:, i]
                verdicts.append(_by_peak(peaks, point, criterion, percentile, top))
    return tuple(verdicts)


def best_class(verdicts: Sequence[Verdict]) -> str:
    """Return the strictest criterion passed, given verdicts from the widest to the strictest."""
    passed = [verdict.criterion.name for verdict in verdicts if verdict.status == "pass"]
    return passed[-1] if passed else "none"


def _by_band(
    spectra: BandSpectra, point: int, name: str, criterion: Criterion, percentile: float
) -> Verdict:
    limits = criterion.limit(spectra.mid_band)
    asked = np.isfinite(limits)
    usable = asked & spectra.resolved
    values = spectra.values[:, point]
    missing = tuple(nominal_frequency(f) for f in spectra.mid_band[asked & ~spectra.resolved])
    if not usable.any():
        return Verdict(
            criterion=criterion,
            point=name,
            status="not assessed",
            percentile=percentile,
            unresolved=missing,
            averaging=spectra.averaging,
        )
    level = np.percentile(values[:, usable], percentile, axis=0)
    margins = limits[usable] / np.maximum(level, np.finfo(float).tiny)
    worst = int(margins.argmin())
    exceeding = float((values[:, usable] > limits[usable]).any(axis=1).mean())
    if margins[worst] < 1.0:
        status: Status = "fail"
    else:
        status = "not assessed" if missing else "pass"
    return Verdict(
        criterion=criterion,
        point=name,
        status=status,
        percentile=percentile,
        unresolved=missing,
        averaging=spectra.averaging,
        margin=float(margins[worst]),
        governing_band=float(spectra.mid_band[usable][worst]),
        value=float(level[worst]),
        limit=float(limits[usable][worst]),
        share_exceeding=exceeding,
    )


def _by_peak(
    peaks: Float[Array, " runs"], point: str, criterion: Criterion, percentile: float, top: float
) -> Verdict:
    if criterion.axis == "horizontal":
        return Verdict(
            criterion=criterion,
            point=point,
            status="not assessed",
            percentile=percentile,
            unresolved=(),
            averaging="peak",
        )
    limit = float(criterion.limits[0])
    value = float(np.percentile(peaks, percentile))
    margin = limit / max(value, np.finfo(float).tiny)
    # A broadband peak covers the curve only as far as the computation reaches.
    reach = min(criterion.frequencies[-1], 80.0)
    missing = () if top >= reach * (1 - 1e-6) else (float(reach),)
    status: Status = "fail" if margin < 1.0 else ("not assessed" if missing else "pass")
    return Verdict(
        criterion=criterion,
        point=point,
        status=status,
        percentile=percentile,
        unresolved=missing,
        averaging="peak",
        margin=margin,
        value=value,
        limit=limit,
        share_exceeding=float((peaks > limit).mean()),
    )

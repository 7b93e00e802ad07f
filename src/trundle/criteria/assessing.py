"""Hold an ensemble against criteria: pass, fail or not assessed, margin, governing band."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np
from jaxtyping import Float

from trundle._checks import within
from trundle._kinds import kinds_checked
from trundle._typing import Array
from trundle.criteria.curve import BY_FREQUENCY, Criterion
from trundle.criteria.verdict import STILL, BandOutcomes, Status, Verdict
from trundle.errors import ComputationError
from trundle.response import (
    BandSpectra,
    RunLevels,
    SpectrumQuantity,
    percentile_interval,
    reduce_runs,
)
from trundle.signals import TOP_FREQUENCY, Averaging, nominal_frequency
from trundle.simulate import Coverage, Runs

__all__ = ["assess", "assess_reduced", "best_class", "single_numbers", "spectra_asked_for"]


@kinds_checked
def assess(
    runs: Runs,
    criteria: Criterion | Sequence[Criterion],
    *,
    percentile: float = 95.0,
    averaging: Averaging = "max_1s",
    events: float = 1.0,
) -> tuple[Verdict, ...]:
    """Hold every point of an ensemble against every criterion.

    Parameters
    ----------
    runs : Runs
        The ensemble; each point is held against the limits of the direction it is read in.
    criteria : Criterion or sequence of Criterion
        The curves.
    percentile : float
        Share of runs that the compared level must cover, 0 to 100.
    averaging : {"max_1s", "slow", "fast", "event"}
        Averaging rule of band levels.
    events : float
        How many such events a vibration dose is for.

    Returns
    -------
    tuple of Verdict
        By point, then by criterion.
    """
    many = (criteria,) if isinstance(criteria, Criterion) else tuple(criteria)
    return assess_reduced(
        reduce_runs(runs, averaging=averaging, quantities=spectra_asked_for(many)),
        many,
        percentile=percentile,
        f_resolved=runs.f_resolved,
        events=events,
        coverage=runs.coverage,
        axes=runs.ways,
    )


def spectra_asked_for(criteria: Iterable[Criterion]) -> tuple[SpectrumQuantity, ...]:
    """Return the spectra that criteria need, each once."""
    names = (c.quantity for c in criteria)
    found = (n for n in names if n not in {"peak_acceleration", "response_factor", "vdv"})
    return tuple(dict.fromkeys(found))  # pyright: ignore[reportReturnType] - what is left are spectra


@kinds_checked
def assess_reduced(
    reduced: RunLevels,
    criteria: Criterion | Sequence[Criterion],
    *,
    percentile: float,
    f_resolved: float,
    events: float = 1.0,
    coverage: Coverage | None = None,
    axes: Sequence[str] | None = None,
) -> tuple[Verdict, ...]:
    """Hold what was kept of every run against criteria.

    Parameters
    ----------
    reduced : RunLevels
        Levels and peaks of every run; with the spectra that the criteria need.
    criteria : Criterion or sequence of Criterion
        The curves.
    percentile : float
        Share of runs that the compared level must cover, 0 to 100.
    f_resolved : float
        Highest frequency that single numbers contain [Hz].
    events : float
        How many such events a vibration dose is for.
    coverage : Coverage, optional
        Which bands the road excites, and whether the vehicles have left; without it all do.
    axes : sequence of {"vertical", "horizontal", ""}, optional
        Directions of the points, as `Runs.ways` gives them; vertical is what is not known, and all
        unless given.
    """
    coverage = coverage or Coverage()
    ways = ("",) * len(reduced.spectra.point_names) if axes is None else axes
    within("percentile", percentile, 0.0, 100.0)
    many = (criteria,) if isinstance(criteria, Criterion) else tuple(criteria)
    verdicts = []
    for i, (point, way) in enumerate(zip(reduced.spectra.point_names, ways, strict=True)):
        axis = way or "vertical"
        for criterion in many:
            if criterion.axis not in {axis, "each axis"}:
                reason = f"the channel is {axis}" if axes else "horizontal motion is not computed"
                verdicts.append(_of_another_axis(criterion, point, percentile, reason))
                continue
            if criterion.quantity in BY_FREQUENCY:
                spectra = {"band_rms_velocity": reduced.spectra, **reduced.more}
                one = spectra[criterion.quantity]
                verdict = _by_band(one, i, point, criterion, percentile, coverage=coverage)
            else:
                values, times = _numbers(reduced, i, criterion, events)
                reach = (f_resolved, coverage)
                verdict = _by_number(values, times, point, criterion, percentile, reach=reach)
            verdicts.append(replace(verdict, axis=axis))
    return tuple(verdicts)


def best_class(verdicts: Sequence[Verdict]) -> str:
    """Return the strictest criterion passed, given verdicts from the widest to the strictest."""
    passed = [verdict.criterion.name for verdict in verdicts if verdict.status == "pass"]
    return passed[-1] if passed else "none"


def _of_another_axis(criterion: Criterion, point: str, percentile: float, reason: str) -> Verdict:
    """Return the verdict by a limit on motion in another direction, of which nothing is known."""
    return Verdict(
        criterion=criterion,
        point=point,
        status="not assessed",
        percentile=percentile,
        unresolved=(),
        averaging=criterion.averaging,
        axis=criterion.axis,
        reasons=(reason,),
    )


def _numbers(
    reduced: RunLevels, point: int, criterion: Criterion, events: float
) -> tuple[Array, Array]:
    """Return a single number of every run, and when it occurred."""
    values = single_numbers(reduced, point, criterion, events)
    if criterion.quantity == "peak_acceleration":
        return values, reduced.peak_time[:, point]
    return values, np.full_like(values, np.nan)


def single_numbers(
    reduced: RunLevels, point: int, criterion: Criterion, events: float
) -> Float[Array, " runs"]:
    """Return what a criterion of a single number is held against, of every run at a point.

    The dose of many equal events is that of one times the fourth root of their number.
    """
    values = reduced.numbers[criterion.quantity][:, point]
    return events**0.25 * values if criterion.quantity == "vdv" else values


def _by_band(
    spectra: BandSpectra,
    point: int,
    name: str,
    criterion: Criterion,
    percentile: float,
    *,
    coverage: Coverage,
) -> Verdict:
    limits = criterion.limit(spectra.mid_band)
    asked = np.isfinite(limits)
    excited = coverage.excites(spectra.mid_band)
    values = spectra.values[:, point]
    known = spectra.resolved
    _refuse_non_finite(values[:, asked & known], criterion, name)
    level, finite = np.full(len(limits), np.nan), known & np.isfinite(values).all(axis=0)
    level[finite] = np.percentile(values[:, finite], percentile, axis=0)
    # where some of several sources excite, what they give is a lower bound: it can fail
    louder = np.nan_to_num(level) > np.where(asked, limits, np.inf)
    usable = asked & known & (excited | (louder & coverage.excites_partly(spectra.mid_band)))
    missing = _missing(spectra, criterion, asked)
    unexcited = _named(spectra, spectra.mid_band[asked & spectra.resolved & ~excited])
    reasons = (
        *_between(criterion, asked=bool(asked.any() or missing)),
        *_not_shown(missing),
        *coverage.reasons(waves=bool(unexcited)),
        *_still(values[:, usable]),
    )
    shown = Verdict(
        criterion=criterion,
        point=name,
        status="not assessed",
        percentile=percentile,
        unresolved=missing,
        unexcited=unexcited,
        reasons=reasons,
        averaging=spectra.averaging,
        bands=_outcomes(spectra, level, np.where(asked, limits, np.nan), usable),
    )
    if not usable.any() or _still(values[:, usable]):
        return shown
    margins = limits[usable] / np.maximum(level[usable], np.finfo(float).tiny)
    worst = int(np.flatnonzero(usable)[margins.argmin()])
    margin = float(margins.min())
    nearest = int(np.abs(values[:, worst] - level[worst]).argmin())
    return replace(
        shown,
        status=_status(margin, reasons),
        margin=margin,
        interval=_interval(values[:, worst], percentile, float(limits[worst])),
        governing_band=float(spectra.mid_band[worst]),
        value=float(level[worst]),
        limit=float(limits[worst]),
        share_exceeding=float((values[:, usable] > limits[usable]).any(axis=1).mean()),
        time=float(spectra.times[nearest, point, worst]),
    )


def _status(margin: float, reasons: tuple[str, ...]) -> Status:
    """Return "fail" where a limit is exceeded; "pass" only if nothing speaks against it."""
    if margin < 1.0:
        return "fail"
    return "not assessed" if reasons else "pass"


def _refuse_non_finite(levels: Array, criterion: Criterion, point: str) -> None:
    """Stop at a level that is no number: it compares as met with any limit."""
    if not np.isfinite(levels).all():
        raise ComputationError(
            f"the level at {point!r} for {criterion.name} is not a finite number; the motion there "
            "has overflowed"
        )


def _missing(spectra: BandSpectra, criterion: Criterion, asked: Array) -> tuple[float, ...]:
    """Return nominal frequencies that the curve asks for and nobody computed."""
    lost = spectra.mid_band[asked & ~spectra.resolved]
    if spectra.quantity == "narrow_band_acceleration":
        return _named(spectra, lost)
    return _named(spectra, np.concatenate([lost, criterion.bands_beyond()]))


def _named(spectra: BandSpectra, frequencies: Array) -> tuple[float, ...]:
    """Return bands by their nominal frequencies, lines as they are."""
    if spectra.quantity == "narrow_band_acceleration":
        return tuple(float(f) for f in frequencies)
    return tuple(nominal_frequency(f) for f in frequencies)


def _between(criterion: Criterion, *, asked: bool) -> tuple[str, ...]:
    """Say that a curve asks for nothing: it lies between two bands."""
    if asked:
        return ()
    first, last = criterion.frequencies[[0, -1]]
    return (f"no band has its middle within the curve, {first:g} to {last:g} Hz: draw it on",)


def _not_shown(missing: tuple[float, ...]) -> tuple[str, ...]:
    """Say which bands step or modes do not show."""
    if not missing:
        return ()
    names = ", ".join(f"{f:g}" for f in missing[:4]) + (" ..." if len(missing) > 4 else "")
    return (
        f"{names} Hz are not shown: shorten dt, or raise f_max to 1.25 times the end of the "
        "highest, if bands reach that far at all",
    )


def _still(values: Array) -> tuple[str, ...]:
    """Say that nothing moves, which is no low level: something is held, or has a wrong unit."""
    if not values.size or float(np.abs(values).max()) > STILL:
        return ()
    return (
        "nothing moves there: an edge or a support holds it, a sensor is dead, or a unit is wrong",
    )


def _interval(values: Array, percentile: float, limit: float) -> tuple[float, float]:
    """Return where a margin lies with 95 % confidence."""
    if len(values) < 2:
        return (np.nan, np.nan)
    low, high = percentile_interval(values, percentile)
    tiny = np.finfo(float).tiny
    return limit / max(high, tiny), limit / max(low, tiny) if np.isfinite(low) else np.inf


def _outcomes(spectra: BandSpectra, level: Array, limits: Array, usable: Array) -> BandOutcomes:
    statuses: list[Status] = []
    for value, limit, known in zip(level, limits, usable, strict=True):
        statuses.append("not assessed" if not known else "fail" if value > limit else "pass")
    return BandOutcomes(
        frequencies=spectra.mid_band, values=level, limits=limits, statuses=tuple(statuses)
    )


def _by_number(
    values: Float[Array, " runs"],
    times: Float[Array, " runs"],
    point: str,
    criterion: Criterion,
    percentile: float,
    *,
    reach: tuple[float, Coverage],
) -> Verdict:
    limit = float(criterion.limits[0])
    _refuse_non_finite(values, criterion, point)
    value = float(np.percentile(values, percentile))
    margin = limit / max(value, np.finfo(float).tiny)
    # A broadband number covers the curve only as far as the computation reaches.
    f_resolved, coverage = reach
    asked = float(min(criterion.frequencies[-1], TOP_FREQUENCY)) * (1 - 1e-6)
    missing = () if f_resolved >= asked else (round(asked, 1),)
    unexcited = () if coverage.excited_to >= asked else (round(asked, 1),)
    reasons = (
        *_not_shown(missing),
        *coverage.reasons(waves=bool(unexcited)),
        *_still(values),
    )
    return Verdict(
        criterion=criterion,
        point=point,
        status=_status(margin, reasons),
        percentile=percentile,
        unresolved=missing,
        unexcited=unexcited,
        reasons=reasons,
        averaging=criterion.averaging,
        margin=margin,
        interval=_interval(values, percentile, limit),
        value=value,
        limit=limit,
        share_exceeding=float((values > limit).mean()),
        time=float(times[np.abs(values - value).argmin()]),
    )

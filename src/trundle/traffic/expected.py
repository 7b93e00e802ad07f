"""Say what to expect of a day from counts by hour and the distribution of one passage.

Whether a passage exceeds a limit is a trial whose chance p its runs estimate: k of n. A route with
N passages a day gives N p events in the mean, whatever the days are like. What is not known is p:
its interval is Clopper and Pearson's, which holds for few runs and for none that exceeds. Intervals
of several routes are put together by the method of recovered variances: distances of limits from
their estimates add by squares, those below and those above each for themselves.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float
from scipy import stats

from trundle._checks import within
from trundle._typing import Array
from trundle.errors import InputError

__all__ = ["Expected", "OnePassage", "binomial_interval", "expected_day"]

_CONFIDENCE = 0.95


@dataclass(frozen=True, kw_only=True, eq=False)
class OnePassage:
    """Hold what the runs of one route gave, at one point beside one criterion.

    Attributes
    ----------
    exceeds : ndarray of bool, shape (n_runs,)
        Whether each run exceeded the limit.
    seconds : ndarray of float, shape (n_runs,)
        For how long its running level lay above [s]; NaN where there is no running level.
    """

    exceeds: Bool[Array, " runs"]
    seconds: Float[Array, " runs"]


@dataclass(frozen=True, kw_only=True, eq=False)
class Expected:
    """Hold what to expect of a day at one point beside one criterion.

    Attributes
    ----------
    events : float
        Passages a day that exceed the limit, in the mean.
    events_interval : tuple of float
        Where that mean lies with 95 % confidence, for that many runs.
    events_on_days : tuple of float
        Numbers that 95 % of days lie between, if passages exceed independently of one another.
    any_event : float
        Chance that a day has at least one, 0 to 1, on the same condition.
    by_hour : ndarray of float, shape (24,)
        Events in each hour of the day, in the mean.
    minutes : float
        Minutes a day that the running level lies above the limit, in the mean; passages that
        overlap count for both.
    minutes_interval : tuple of float
        Where that mean lies with 95 % confidence; the upper end is NaN where no run exceeds, for
        then nobody knows how long one that does would last.
    """

    events: float
    events_interval: tuple[float, float]
    events_on_days: tuple[float, float]
    any_event: float
    by_hour: Float[Array, " hours"]
    minutes: float
    minutes_interval: tuple[float, float]


def expected_day(
    passages: Mapping[str, OnePassage],
    counts: Mapping[str, Float[Array, " hours"]],
    *,
    random: bool,
) -> Expected:
    """Return what to expect of a day.

    Parameters
    ----------
    passages : mapping of str to OnePassage
        One passage on each route.
    counts : mapping of str to ndarray of float, shape (24,)
        Passages on each route in each hour, in the mean.
    random : bool
        Whether they come at random (a Poisson stream), or always as many.

    References
    ----------
    C. J. Clopper, E. S. Pearson, Biometrika 26 (1934) 404-413. G. Y. Zou, A. Donner, Statistics in
    Medicine 27 (2008) 1693-1702 (method of variance estimates recovery).
    """
    missing = set(counts) - set(passages)
    if missing:
        raise InputError(f"no runs of {', '.join(sorted(missing))}")
    by_hour = np.zeros(24)
    events, minutes = _Sum(), _Sum()
    trials: list[tuple[float, float]] = []
    for name, hours in counts.items():
        one, total = passages[name], float(np.sum(hours))
        share = float(np.mean(one.exceeds))
        by_hour += share * hours
        low, high = binomial_interval(int(one.exceeds.sum()), len(one.exceeds))
        events.add(total * share, total * low, total * high)
        minutes.add(*(total / 60.0 * t for t in _duration(one)))
        trials.append((total, share))
    return Expected(
        events=events.mean,
        events_interval=events.interval,
        events_on_days=_on_days(trials, random=random),
        any_event=_any(trials, random=random),
        by_hour=by_hour,
        minutes=minutes.mean,
        minutes_interval=minutes.interval,
    )


def binomial_interval(k: int, n: int, *, confidence: float = _CONFIDENCE) -> tuple[float, float]:
    """Return where the chance of a trial lies that came out k times of n (Clopper and Pearson)."""
    within("k", k, 0, n)
    tail = 0.5 * (1.0 - confidence)
    low = 0.0 if k == 0 else float(stats.beta.ppf(tail, k, n - k + 1))
    high = 1.0 if k == n else float(stats.beta.ppf(1.0 - tail, k + 1, n - k))
    return low, high


class _Sum:
    """A sum of estimates with their intervals, by recovered variances."""

    def __init__(self) -> None:
        self.mean = 0.0
        self._below = self._above = 0.0

    def add(self, mean: float, low: float, high: float) -> None:
        """Add an estimate that lies between two limits."""
        self.mean += mean
        self._below += (mean - low) ** 2
        self._above += (high - mean) ** 2

    @property
    def interval(self) -> tuple[float, float]:
        """Where the sum lies."""
        return max(0.0, self.mean - np.sqrt(self._below)), float(self.mean + np.sqrt(self._above))


def _duration(one: OnePassage) -> tuple[float, float, float]:
    """Return the mean time above [s], and where it lies by Student's distribution."""
    seconds, n = one.seconds, len(one.seconds)
    mean = float(np.mean(seconds))
    if n < 2 or mean == 0.0:
        return mean, 0.0, np.nan
    half = float(stats.t.ppf(0.5 + 0.5 * _CONFIDENCE, n - 1) * np.std(seconds, ddof=1) / np.sqrt(n))
    return mean, max(0.0, mean - half), mean + half


def _on_days(trials: list[tuple[float, float]], *, random: bool) -> tuple[float, float]:
    """Return numbers of events that 95 % of days lie between.

    A Poisson stream of which each passage is kept with chance p is one of rate N p. Of a timetable
    the number is a sum of binomial ones, here by its mean and variance where several differ.
    """
    ends = (0.5 * (1.0 - _CONFIDENCE), 0.5 * (1.0 + _CONFIDENCE))
    mean = sum(n * p for n, p in trials)
    if random:
        law = stats.poisson(mean)
    elif len(trials) == 1:
        law = stats.binom(round(trials[0][0]), trials[0][1])
    else:
        spread = np.sqrt(sum(n * p * (1.0 - p) for n, p in trials))
        most = sum(n for n, _ in trials)
        if spread == 0.0:
            return mean, mean
        found = stats.norm(mean, spread).ppf(ends)
        return float(max(0.0, np.floor(found[0]))), float(min(most, np.ceil(found[1])))
    return float(law.ppf(ends[0])), float(law.ppf(ends[1]))


def _any(trials: list[tuple[float, float]], *, random: bool) -> float:
    """Return the chance of at least one event on a day."""
    if random:
        return float(-np.expm1(-sum(n * p for n, p in trials)))
    return float(1.0 - np.prod([(1.0 - p) ** n for n, p in trials]))

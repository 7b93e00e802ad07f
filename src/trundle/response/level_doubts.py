"""Raise the doubts that levels of a few seconds, of a few runs, must carry with them."""

from __future__ import annotations

import numpy as np

from trundle._typing import Array
from trundle.errors import FitnessWarning
from trundle.response.spectra import BandSpectra
from trundle.signals import Averaging, level_scatter, nominal_frequency

__all__ = ["few_runs_warnings", "level_warnings"]

_TIME = {"max_1s": 1.0, "slow": 1.0, "fast": 0.125}  # s: window or time constant
_STRONG = {"max_1s": 1.0, "slow": 3.0, "fast": 0.5}  # s: that motion must last, see Notes
_BANDS = 10.0 ** np.array([0.0, 0.9, 1.9])  # Hz: spoken of
_ENVELOPE = np.sqrt(4.0 / np.pi - 1.0)  # scatter of the amplitude of a narrow band (Rayleigh)
_MANY = 30  # runs whose scatter is itself known within about 15 %
_LIKELY = 0.95  # of the interval of a percentile


def level_warnings(
    averaging: Averaging, record_length: float, *, levels: BandSpectra | None = None
) -> tuple[FitnessWarning, ...]:
    """Return the doubts about levels of one passage.

    Parameters
    ----------
    averaging : {"max_1s", "slow", "fast", "event"}
        Averaging rule.
    record_length : float
        Length of the record [s].
    levels : BandSpectra, optional
        Levels of many runs, whose scatter is said; without them, or with few, that of steady
        Gaussian noise at one time is.

    Notes
    -----
    The scatter of steady noise is a limit, within 15 %, for motion that stays above half its
    greatest size for 1 s (3 s by rule ``slow``, 0.5 s by ``fast``). Shorter events have less to
    average over: a burst of half a second in all scatters by up to 2.8 times as much, and one
    shorter than half a period of the band by more than an envelope's 52 %. The largest level of a
    long record scatters by as little as a quarter as much.
    """
    if averaging == "event":
        message = (
            f"levels are averaged over the whole record of {record_length:g} s, rest included; "
            "a record twice as long has levels 3 dB lower"
        )
        return (FitnessWarning(subject="averaging", message=message),)
    if levels is not None and len(levels.values) >= _MANY:
        text, beyond = "over the runs levels scatter by", ""
        mid_band, scatter = levels.mid_band, _over_runs(levels)
    else:
        lasting = f"random motion that stays strong for {_STRONG[averaging]:g} s"
        text = f"a level of {lasting} scatters by up to about"
        beyond, mid_band = "; of a shorter event, by more", _BANDS
        # the largest of all times rides on a crest, never between two
        scatter = np.minimum(
            level_scatter(_BANDS, _TIME[averaging], exponential=averaging != "max_1s"), _ENVELOPE
        )
    found = {
        f"{nominal_frequency(f):g} Hz": value
        for f, value in zip(mid_band, scatter, strict=True)
        if np.isfinite(value) and np.isclose(f, _BANDS, rtol=1e-3).any()
    }
    if not found:
        return ()
    sizes = ", ".join(f"{100.0 * value:.0f} % at {name}" for name, value in found.items())
    message = f"one event is one sample: averaged by rule {averaging}, {text} {sizes}{beyond}"
    return (FitnessWarning(subject="scatter", message=message),)


def _over_runs(levels: BandSpectra) -> Array:
    """Return the relative standard deviation in each band, the largest of all points."""
    mean = levels.values.mean(axis=0)
    shown = levels.resolved & (mean > 0.0).all(axis=0)
    spread = levels.values.std(axis=0, ddof=1) / np.where(shown, mean, 1.0)
    return np.where(shown, spread.max(axis=0), np.nan)


def few_runs_warnings(n_runs: int, percentile: float) -> tuple[FitnessWarning, ...]:
    """Return the doubt about a percentile of so few runs that nothing limits it from above.

    Parameters
    ----------
    n_runs : int
        Number of runs.
    percentile : float
        Share of all roads that the level is to cover, 0 to 100.
    """
    p = percentile / 100.0
    if not 0.0 < p < 1.0:
        return ()
    # all of them may be below it with a probability of p^n
    needed = int(np.ceil(np.log(0.5 * (1.0 - _LIKELY)) / np.log(p)))
    if n_runs >= needed:
        return ()
    message = (
        f"the {percentile:g} % level of {n_runs} runs has no upper limit at "
        f"{100 * _LIKELY:g} % confidence; {needed} runs give it one"
    )
    return (FitnessWarning(subject="number of runs", message=message),)

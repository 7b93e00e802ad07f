"""Raise the doubts that levels of a few seconds, of a few runs, must carry with them."""

from __future__ import annotations

import numpy as np

from trundle.errors import FitnessWarning
from trundle.signals import Averaging, level_scatter

__all__ = ["few_runs_warnings", "level_warnings"]

_TIME = {"max_1s": 1.0, "slow": 2.0, "fast": 0.25}  # s: that an average is worth
_LIKELY = 0.95  # of the interval of a percentile


def level_warnings(averaging: Averaging, record_length: float) -> tuple[FitnessWarning, ...]:
    """Return the doubts about levels of one passage.

    Parameters
    ----------
    averaging : {"max_1s", "slow", "fast", "event"}
        Averaging rule.
    record_length : float
        Length of the record [s].

    Notes
    -----
    An exponential average is worth a linear one over twice its time constant (Bendat and Piersol,
    Random Data, 4th ed. 2010, section 11.5.4).
    """
    if averaging == "event":
        message = (
            f"levels are averaged over the whole record of {record_length:g} s, rest included; "
            "a record twice as long has levels 3 dB lower"
        )
        return (FitnessWarning(subject="averaging", message=message),)
    time = _TIME[averaging]
    one, eight, eighty = 100.0 * level_scatter(10.0 ** np.array([0.0, 0.9, 1.9]), time)
    message = (
        f"one event is one sample: averaged by rule {averaging}, a level of random motion scatters "
        f"by about {one:.0f} % in the 1 Hz band, {eight:.0f} % at 8 Hz and {eighty:.0f} % at 80 Hz"
    )
    return (FitnessWarning(subject="scatter", message=message),)


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

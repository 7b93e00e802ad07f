"""Bound the response to several vehicles at once from those to single ones."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from trundle._typing import ArrayLike
from trundle.errors import InputError

__all__ = ["UpperBounds", "percentile_rank", "upper_bounds"]


@dataclass(frozen=True, kw_only=True)
class UpperBounds:
    """Hold three ways to combine the responses to single vehicles.

    Attributes
    ----------
    largest : float
        The largest single response.
    absolute_sum : float
        Sum of all: they peak at one instant with one sign. No combination exceeds it.
    root_sum_square : float
        Root of the sum of squares: independent responses. Not a strict bound.
    """

    largest: float
    absolute_sum: float
    root_sum_square: float


def upper_bounds(single: ArrayLike) -> UpperBounds:
    """Combine responses of single vehicles (peaks, or RMS values of one record length).

    Notes
    -----
    In the paper's Table 3 the "absolute maximum" accelerations are the sums of its Table 2,
    and its velocities are close to the root sums of squares.

    Examples
    --------
    >>> round(upper_bounds([0.040, 0.32, 0.070, 1.93]).absolute_sum, 2)
    2.36
    """
    values = np.abs(np.asarray(single, float))
    if values.size == 0:
        raise InputError("an upper bound needs at least one response")
    return UpperBounds(
        largest=float(values.max()),
        absolute_sum=float(values.sum()),
        root_sum_square=float(np.sqrt(np.sum(values**2))),
    )


def percentile_rank(value: float, samples: ArrayLike) -> float:
    """Return the share of samples below a value, 0 to 100; ties count half."""
    array = np.asarray(samples, float)
    if array.size == 0:
        raise InputError("a rank needs at least one sample to be among")
    below = np.count_nonzero(array < value) + 0.5 * np.count_nonzero(array == value)
    return float(100.0 * below / array.size)

"""Turn criteria into limits that a meter reads, as far as anything is known."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from trundle.criteria.curve import BY_FREQUENCY, Criterion
from trundle.response.meter import CurveLimit
from trundle.signals import TOP_FREQUENCY, band_edges, mid_band_frequencies, usable_bands
from trundle.simulate import Coverage

__all__ = ["watched"]


def watched(
    criteria: Sequence[Criterion], *, f_max: float, sampling_frequency: float, coverage: Coverage
) -> tuple[tuple[CurveLimit, ...], tuple[bool, ...]]:
    """Return limits in the bands that are computed and excited, and whether those are all.

    Parameters
    ----------
    criteria : sequence of Criterion
        The curves.
    f_max : float
        Highest frequency that modes and step show as it is [Hz].
    sampling_frequency : float
        Steps a second [Hz].
    coverage : Coverage
        Which bands are excited, and whether everybody has left.

    Returns
    -------
    limits : tuple of CurveLimit
        One for each criterion.
    complete : tuple of bool
        Whether each knows everything that it asks for.
    """
    found = [_limit(one, f_max, sampling_frequency, coverage) for one in criteria]
    return tuple(limit for limit, _ in found), tuple(whole for _, whole in found)


def _limit(
    criterion: Criterion, f_max: float, fs: float, coverage: Coverage
) -> tuple[CurveLimit, bool]:
    if criterion.quantity not in BY_FREQUENCY:
        asked = float(min(criterion.frequencies[-1], TOP_FREQUENCY)) * (1 - 1e-6)
        whole = min(f_max, coverage.excited_to) >= asked and coverage.left
        limits = np.array([float(criterion.limits[0])])
        return CurveLimit(name=criterion.name, quantity=criterion.quantity, limits=limits), whole
    bands = mid_band_frequencies()
    limits = criterion.limit(bands)
    asked = np.isfinite(limits)
    known = usable_bands(bands, fs) & (band_edges(bands)[:, 1] <= f_max) & coverage.excites(bands)
    whole = (
        asked.any()
        and not (asked & ~known).any()
        and not len(criterion.bands_beyond())
        and coverage.left
    )
    return (
        CurveLimit(
            name=criterion.name,
            quantity=criterion.quantity,
            limits=np.where(asked & known, limits, np.nan),
        ),
        bool(whole),
    )

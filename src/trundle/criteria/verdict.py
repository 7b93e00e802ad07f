"""Hold the outcome of a comparison, as a whole and band by band."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np
from jaxtyping import Float

from trundle._typing import Array
from trundle.criteria.curve import Criterion

__all__ = ["BandOutcomes", "Status", "Verdict"]

Status: TypeAlias = Literal["pass", "fail", "not assessed"]
"""Outcome of a comparison. What was not computed is never a pass."""


@dataclass(frozen=True, kw_only=True, eq=False)
class BandOutcomes:
    """Hold the outcome in every band that was asked for or computed.

    Attributes
    ----------
    frequencies : ndarray of float, shape (n_bands,)
        Mid-band frequencies, or lines [Hz].
    values, limits : ndarray of float, shape (n_bands,)
        Level and limit in SI units; NaN where there is none.
    statuses : tuple of {"pass", "fail", "not assessed"}
        ``not assessed`` outside the curve's range, and where nothing was computed.
    """

    frequencies: Float[Array, " bands"]
    values: Float[Array, " bands"]
    limits: Float[Array, " bands"]
    statuses: tuple[Status, ...]


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
        Mid-band frequency where the margin is smallest [Hz]; NaN for single numbers.
    value, limit : float
        Value and limit there, in SI units.
    share_exceeding : float
        Share of the runs that exceed the limit in any band, 0 to 1.
    time : float
        When the value occurred in the run that is nearest to it [s]; NaN where it has no time.
    bands : BandOutcomes or None
        Band by band; None for single numbers.
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
    time: float = np.nan
    bands: BandOutcomes | None = None

    def __str__(self) -> str:
        """State the verdict in one line."""
        at = "" if np.isnan(self.governing_band) else f" at {self.governing_band:.3g} Hz"
        return f"{self.point}, {self.criterion.title}: {self.status}, margin {self.margin:.3g}{at}"

"""Hold the outcome of a comparison, as a whole and band by band."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np
from jaxtyping import Float

from trundle._typing import Array
from trundle.criteria.curve import Criterion
from trundle.signals import nominal_frequency

__all__ = ["STILL", "BandOutcomes", "Status", "Verdict", "frequency_name"]

STILL = 1e-12
"""Level [m/s, m/s2] below which nothing moves under a vehicle, and no sensor sees it."""

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
        Nominal frequencies of bands in the curve's range that step or modes do not show [Hz].
    unexcited : tuple of float
        Nominal frequencies of bands that the road does not excite; for a single number, how far it
        is asked to reach [Hz].
    reasons : tuple of str
        Why something is not assessed, and what would help.
    axis : str
        Direction of the motion that was compared.
    averaging : str
        Averaging rule of the value.
    margin : float
        Smallest limit over value in the bands computed and excited; below 1 fails. This and the
        rest are NaN where nothing was.
    interval : tuple of float
        Where the margin at the governing band lies with 95 % confidence, for that many runs; 0 or
        infinite where there are too few of them for a limit.
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
    unexcited: tuple[float, ...] = ()
    reasons: tuple[str, ...] = ()
    axis: str = "vertical"
    margin: float = np.nan
    interval: tuple[float, float] = (np.nan, np.nan)
    governing_band: float = np.nan
    value: float = np.nan
    limit: float = np.nan
    share_exceeding: float = np.nan
    time: float = np.nan
    bands: BandOutcomes | None = None

    @property
    def uncertain(self) -> bool:
        """Whether it is a pass whose interval reaches below 1: more runs might fail it."""
        return self.status == "pass" and bool(self.interval[0] < 1.0)

    @property
    def roughest(self) -> float:
        """Road roughness Gd(n0) that is still passed, over that of the road; NaN if unknown.

        The square of the margin. A passed margin gives a lower bound, for the part of the level
        that the static loads give does not grow with the road; a failed one an upper bound.
        """
        return self.margin**2

    @property
    def words(self) -> str:
        """State outcome, margin, its interval and band in a few words."""
        if np.isnan(self.margin):
            return self.status
        at = (
            "" if np.isnan(self.governing_band) else f" at {frequency_name(self.governing_band)} Hz"
        )
        low, high = self.interval
        between = f" ({low:.3g} to {high:.3g})" if np.isfinite(low) and 0.0 < low < high else ""
        few = ", too few runs to be sure" if low == 0.0 else ", not surely"
        sure = few if self.uncertain else ""
        return f"{self.status}{sure}, margin {self.margin:.3g}{between}{at}"

    def __str__(self) -> str:
        """State the verdict in one line."""
        why = f"; {'; '.join(self.reasons)}" if self.status == "not assessed" else ""
        return f"{self.point} {self.axis}, {self.criterion.title}: {self.words}{why}"


def frequency_name(f: float) -> str:
    """Write a mid-band frequency [Hz] by its name, and another, of a line, as it is."""
    middle = 10.0 ** (round(10.0 * np.log10(f)) / 10.0)
    return f"{nominal_frequency(f) if abs(f - middle) < 0.003 * f else f:.3g}"

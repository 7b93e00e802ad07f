"""Hold sources that act together beside each of them alone: who governs, and bounds.

Each source of a case is a case by itself too, so that its levels are known. Independent sources add
by energy in every band, and no combination exceeds the sum of their largest levels.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from trundle._typing import Array
from trundle.criteria import BY_FREQUENCY, Verdict
from trundle.criteria.assessing import single_numbers
from trundle.results.cells import Cell, CellKey
from trundle.results.study_result import StudyResult

__all__ = ["Together", "together_rows"]


@dataclass(frozen=True, kw_only=True, eq=False)
class Together:
    """Hold a case of several sources beside one criterion at one point.

    Attributes
    ----------
    case, road, point : str
        The cell.
    verdict : Verdict
        Of all together.
    alone : mapping of str to float
        Margin of each source alone, in the bands that are known of it; NaN where none is.
    by_energy, by_sum : float
        Margin if their levels add by energy, or one to one, in every band.
    band : float
        Where the margin by energy is smallest [Hz]; NaN for single numbers.
    shares : mapping of str to float
        Share of the energy that each has there, 0 to 1.
    """

    case: str
    road: str
    point: str
    verdict: Verdict
    alone: Mapping[str, float]
    by_energy: float
    by_sum: float
    band: float
    shares: Mapping[str, float]

    @property
    def governs(self) -> str:
        """Name of the source with most of the energy; nothing where none is known."""
        known = {name: share for name, share in self.shares.items() if np.isfinite(share)}
        return max(known, key=lambda name: known[name]) if known else ""


def together_rows(result: StudyResult) -> Iterator[Together]:
    """Give every case of several sources beside every criterion at every point.

    Parameters
    ----------
    result : StudyResult
        A finished study.

    Yields
    ------
    Together
        By case, road, point and criterion; criteria that are held against other motion left out.
    """
    for case in result.study.cases:
        if len(case.routes) < 2:
            continue
        names = list(dict.fromkeys(case.routes))
        times = np.array([case.routes.count(name) for name in names], dtype=float)
        for key, verdicts in result.verdicts.items():
            if key.case != case.name:
                continue
            cells = [result.cells[CellKey(name, key.road, key.method)] for name in names]
            events = 1.0 if result.study.assessment is None else result.study.assessment.events
            for verdict in verdicts:
                if np.isfinite(verdict.margin):
                    yield _row(key, verdict, dict(zip(names, cells, strict=True)), times, events)


def _row(
    key: CellKey, verdict: Verdict, cells: Mapping[str, Cell], times: Array, events: float
) -> Together:
    """Add up the levels of sources, each as often as it is there."""
    point = next(iter(cells.values())).spectra.point_names.index(verdict.point)
    levels, limits, bands = _levels(verdict, cells, point, events)
    weights = times[:, None]
    energy = np.sqrt(np.nansum(weights * levels**2, axis=0))
    total = np.nansum(weights * levels, axis=0)
    tiny = np.finfo(float).tiny
    margins = limits / np.maximum(energy, tiny)
    worst = int(margins.argmin())
    squares = times * np.nan_to_num(levels[:, worst]) ** 2
    shares = squares / max(squares.sum(), tiny)
    with np.errstate(divide="ignore"):
        alone = np.nanmin(np.where(levels > 0.0, limits / levels, np.inf), axis=1)
    return Together(
        case=key.case,
        road=key.road,
        point=verdict.point,
        verdict=verdict,
        alone=dict(zip(cells, alone.tolist(), strict=True)),
        by_energy=float(margins[worst]),
        by_sum=float((limits / np.maximum(total, tiny)).min()),
        band=float(bands[worst]),
        shares=dict(zip(cells, shares.tolist(), strict=True)),
    )


def _levels(
    verdict: Verdict, cells: Mapping[str, Cell], point: int, events: float
) -> tuple[Float[Array, "sources bands"], Float[Array, " bands"], Float[Array, " bands"]]:
    """Return what the share of runs stays below of each source, with limits and bands.

    A dose is of as many events as that of the verdict, which it stands beside.
    """
    criterion, share = verdict.criterion, verdict.percentile
    if criterion.quantity not in BY_FREQUENCY:
        values = [single_numbers(c.reduced, point, criterion, events) for c in cells.values()]
        levels = np.array([[np.percentile(one, share)] for one in values])
        return levels, np.array([verdict.limit]), np.array([np.nan])
    spectra = [
        {"band_rms_velocity": c.reduced.spectra, **c.reduced.more}[criterion.quantity]
        for c in cells.values()
    ]
    bands = spectra[0].mid_band
    limits = criterion.limit(bands)
    known = np.isfinite(limits) & np.logical_or.reduce([one.resolved for one in spectra])
    levels = np.array([np.percentile(one.values[:, point], share, axis=0) for one in spectra])
    return levels[:, known], limits[known], bands[known]

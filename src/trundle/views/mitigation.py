"""Arrange what would help: the strictest criterion met by each combination, and every margin."""

from __future__ import annotations

from typing import Any

from trundle.mitigate.outcome import Outcome, Sweep
from trundle.units import KMH
from trundle.views.verdicts import strictest_passed

__all__ = [
    "MARGIN_HEADINGS",
    "NONE",
    "PARTLY",
    "UNKNOWN",
    "margin_rows",
    "middle_curve",
    "mitigation_rows",
    "strictest",
]

NONE, UNKNOWN = "none", "not assessed"
"""What stands where no criterion is met, and where it is not known whether one is."""

PARTLY = (
    "not assessed: the road's waves end below the criterion's bands at this speed (raise n_max), "
    "or step and modes do not reach them; margins are those of the bands computed and excited"
)
"""What is not assessed, and why."""


def strictest(outcome: Outcome, point: str) -> str:
    """Return the title of the strictest velocity criterion that is passed at a point, if any."""
    some = [
        v
        for v in outcome.verdicts
        if v.point == point and v.criterion.quantity == "band_rms_velocity"
    ]
    best = strictest_passed(some)
    if best is not None:
        return best.criterion.title
    return UNKNOWN if any(v.status == "not assessed" for v in some) else NONE


def mitigation_rows(sweep: Sweep) -> list[dict[str, Any]]:
    """Return one row a combination and point: the strictest criterion met."""
    return [
        {
            "change": one.change,
            "case": one.case,
            "speed_kmh": one.speed / KMH,
            "road": one.road,
            "point": point,
            "strictest": strictest(one, point),
        }
        for one in sweep.outcomes
        for point in sweep.study.points
    ]


def middle_curve(sweep: Sweep) -> str:
    """Return the velocity criterion whose margins lie nearest to 1, to draw curves for."""
    by_curve: dict[str, list[float]] = {}
    for one in sweep.outcomes:
        for v in one.verdicts:
            if v.criterion.quantity == "band_rms_velocity" and v.margin == v.margin:
                by_curve.setdefault(v.criterion.name, []).append(v.margin)
    if not by_curve:
        return ""
    shares = {name: sum(m >= 1.0 for m in ms) / len(ms) for name, ms in by_curve.items()}
    return min(shares, key=lambda name: abs(shares[name] - 0.5))


MARGIN_HEADINGS = (
    "change",
    "case",
    "speed_kmh",
    "road",
    "point",
    "criterion",
    "verdict",
    "margin",
    "governing_band_hz",
    "share_exceeding",
    "excited_to_hz",
)
"""Columns of `margin_rows`."""


def margin_rows(sweep: Sweep) -> list[list[str]]:
    """Return every margin, one row a combination, point and criterion."""
    rows = []
    for one in sweep.outcomes:
        for v in one.verdicts:
            key = [one.change, one.case, f"{one.speed / KMH:g}", one.road, v.point]
            known = (v.margin, v.governing_band, v.share_exceeding, one.excited_to)
            rows.append([*key, v.criterion.name, v.status, *(f"{x:.6g}" for x in known)])
    return rows

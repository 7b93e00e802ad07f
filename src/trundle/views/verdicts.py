"""Arrange verdicts: one line a case, road and point, and every criterion in a matrix."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from trundle.criteria import Verdict
from trundle.results.cells import CellKey
from trundle.results.maps import MapKey
from trundle.results.study_result import StudyResult, positions_at, wheels_at
from trundle.results.together import Together, together_rows
from trundle.views.words import roughest_words

__all__ = ["headline", "strictest_passed", "verdict_matrix"]


def headline(result: StudyResult) -> list[dict[str, Any]]:
    """State for each case and road the strictest velocity criterion that is met."""
    lines: list[dict[str, Any]] = []
    meetings = {
        (row.case, row.road, row.point, row.verdict.criterion.name): row
        for row in together_rows(result)
    }
    for key, verdicts in result.verdicts.items():
        for point in result.study.points:
            bands = [
                v
                for v in verdicts
                if v.point == point and v.criterion.quantity == "band_rms_velocity"
            ]
            best = strictest_passed(bands)
            failed = [v for v in bands if v.status == "fail"]
            first = max(failed, key=lambda v: float(v.criterion.limits.min()), default=None)
            line = {
                "case": key.case,
                "road": key.road,
                "point": point,
                "best": best,
                "first": first,
                "where": _where(result, key, first or best),
                "governs": _governs(meetings, key, first or best),
                "worst": _worst_place(result, key, first or best),
                "road_passed": roughest_words(result.study, key.road, best) if best else "",
                "unmet": _unmet(bands),
                "reasons": _reasons(verdicts, point),
            }
            lines.append(line | {"notes": _notes(line)})
    return lines


def _notes(line: Mapping[str, Any]) -> list[str]:
    """Say when and where a level governs, who of several governs, and what road still passes."""
    words = {
        "where": "largest at ",
        "governs": "",
        "worst": "smallest margin on the map ",
        "road_passed": "what is met holds on a road of ",
    }
    return [f"{before}{line[name]}" for name, before in words.items() if line[name]]


def _governs(
    meetings: Mapping[tuple[str, str, str, str], Together], key: CellKey, verdict: Verdict | None
) -> str:
    """Say which of several sources governs; nothing where one acts alone."""
    if verdict is None:
        return ""
    row = meetings.get((key.case, key.road, verdict.point, verdict.criterion.name))
    if row is None or not row.governs:
        return ""
    return f"governed by {row.governs}, {100.0 * row.shares[row.governs]:.0f} % of the energy"


def strictest_passed(verdicts: Sequence[Verdict]) -> Verdict | None:
    """Return the verdict on the strictest of some velocity criteria that are passed, if any."""
    passed = [v for v in verdicts if v.status == "pass"]
    return min(passed, key=lambda v: float(v.criterion.limits.min()), default=None)


def _unmet(bands: Sequence[Verdict]) -> str:
    """Say what stands in the place of a velocity criterion where none is known to be met."""
    if not bands:
        return "none asked for"
    return "not assessed" if any(v.status == "not assessed" for v in bands) else "none"


def _reasons(verdicts: tuple[Verdict, ...], point: str) -> str:
    """Say why criteria at a point are not assessed, if some are not."""
    found = (
        reason
        for v in verdicts
        if v.point == point and v.status == "not assessed"
        for reason in v.reasons
    )
    return "; ".join(dict.fromkeys(found))


def _worst_place(result: StudyResult, key: CellKey, verdict: Verdict | None) -> str:
    """Say where on the map the margin to a criterion is smallest."""
    mapped = result.maps.get(MapKey(key.case, key.road))
    if mapped is None or verdict is None:
        return ""
    names = [c.name for c in mapped.classes.criteria]
    if verdict.criterion.name not in names:
        return ""
    margin = mapped.classes.margin[names.index(verdict.criterion.name)]
    if np.isnan(margin).all():
        return ""
    worst = int(np.nanargmin(margin))
    plan = result.study.map
    assert plan is not None  # there are maps
    x, y, label = plan.where(worst)
    return f"{margin[worst]:.3g} at ({x:.1f}, {y:.1f}) m" + (f" ({label})" if label else "")


def _where(result: StudyResult, key: CellKey, verdict: Verdict | None) -> str:
    """Say when the governing level occurred, and where the vehicles were."""
    if verdict is None or not np.isfinite(verdict.time):
        return ""
    places = positions_at(result, key, verdict.time)
    on_floor = wheels_at(result, key, verdict.time)
    there = [
        f"{name} at ({place[0]:.1f}, {place[1]:.1f}) m"
        if place is not None
        else f"{name} is off the floor"
        if not on_floor[name]
        else f"{name}'s front axle is off, {on_floor[name]} "
        f"{'wheel is' if on_floor[name] == 1 else 'wheels are'} on the floor"
        for name, place in places.items()
    ]
    return f"{verdict.time:.1f} s, {', '.join(there)}"


def verdict_matrix(result: StudyResult) -> tuple[list[str], list[tuple[str, list[Verdict]]]]:
    """Return column titles (case, road, point) and one row of verdicts a criterion."""
    if result.study.assessment is None:
        return [], []
    many_points = len(result.study.points) > 1
    columns: list[str] = []
    rows: dict[str, list[Verdict]] = {}  # by name: titles may be alike
    for key, verdicts in result.verdicts.items():
        for point in result.study.points:
            columns.append(f"{key.case}, {key.road}" + (f", {point}" if many_points else ""))
            for verdict in verdicts:
                if verdict.point == point:
                    rows.setdefault(verdict.criterion.name, []).append(verdict)
    return columns, [(found[0].criterion.title, found) for found in rows.values()]

"""Conclude: a sentence a point and one for all, and the worst of all cells for each criterion."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from trundle.criteria import Criterion, Status, Verdict
from trundle.criteria.verdict import frequency_name
from trundle.results.cells import CellKey
from trundle.results.study_result import StudyResult
from trundle.views.verdicts import strictest_passed
from trundle.views.words import between

__all__ = ["Conclusion", "Light", "concluded", "conclusion_of_all", "lights"]

_NAMED = 3  # points called by name in a sentence


@dataclass(frozen=True, kw_only=True, eq=False)
class Light:
    """Hold the worst that one criterion meets at one point, over all cases and roads.

    Attributes
    ----------
    verdict : Verdict
        The failed one of the smallest margin; else one that is not assessed; else the passed one
        of the smallest margin.
    where : str
        Its case, and its road where there are several.
    applies : bool
        Whether the criterion is for the motion that is read there.
    """

    verdict: Verdict
    where: str
    applies: bool

    @property
    def status(self) -> Status:
        """What the worst is."""
        return self.verdict.status


@dataclass(frozen=True, kw_only=True, eq=False)
class Conclusion:
    """Hold what is concluded at one point.

    Attributes
    ----------
    point : str
        Its name.
    status : {"pass", "fail", "not assessed"}
        Whether a velocity criterion is met everywhere; ``fail`` where none of them is.
    met : Light or None
        The strictest velocity criterion that is met in every case on every road.
    words : str
        The sentence, without the point's name.
    """

    point: str
    status: Status
    met: Light | None
    words: str


def lights(result: StudyResult) -> dict[str, dict[str, Light]]:
    """Return by point, then by the criterion's name, the worst over all cases and roads.

    Notes
    -----
    A fail anywhere is a fail; a criterion that is not assessed in one cell is not passed by the
    others.
    """
    found: dict[str, dict[str, Light]] = {}
    points = result.study.points
    ways = dict(zip(points, result.study.point_ways or ("vertical",) * len(points), strict=True))
    many_roads = len(result.study.roads) > 1 and bool(result.study.drives)
    for key, verdicts in result.verdicts.items():
        for verdict in verdicts:
            name = verdict.criterion.name
            light = Light(
                verdict=verdict,
                where=_where(key, many_roads=many_roads),
                applies=verdict.criterion.axis in {ways[verdict.point], "each axis"},
            )
            mine = found.setdefault(verdict.point, {})
            if name not in mine or _order(verdict) < _order(mine[name].verdict):
                mine[name] = light
    return {point: found[point] for point in points if point in found}


def _where(key: CellKey, *, many_roads: bool) -> str:
    return f"{key.case}, road {key.road}" if many_roads else key.case


def _order(verdict: Verdict) -> tuple[int, float]:
    """Return what sorts verdicts from the worst on."""
    rank = {"fail": 0, "not assessed": 1, "pass": 2}[verdict.status]
    return rank, np.inf if np.isnan(verdict.margin) else verdict.margin


def concluded(result: StudyResult) -> list[Conclusion]:
    """Return a conclusion for every point; none where nothing is held against criteria."""
    return [
        Conclusion(point=point, status=_status(mine), met=_met(mine), words=_words(mine))
        for point, mine in ((p, _applying(found)) for p, found in lights(result).items())
    ]


def _applying(found: Mapping[str, Light]) -> list[Light]:
    return [light for light in found.values() if light.applies]


def _velocity(mine: Iterable[Light]) -> list[Light]:
    """Return the lights of velocity criteria, from the widest to the strictest."""
    some = [one for one in mine if one.verdict.criterion.quantity == "band_rms_velocity"]
    return sorted(some, key=lambda one: -_strictness(one.verdict.criterion))


def _strictness(criterion: Criterion) -> float:
    return float(criterion.limits.min())


def _met(mine: Sequence[Light]) -> Light | None:
    best = strictest_passed([one.verdict for one in _velocity(mine)])
    return next((one for one in mine if one.verdict is best), None)


def _status(mine: Sequence[Light]) -> Status:
    considered = _velocity(mine) or mine
    known: set[Status] = {one.status for one in considered}
    return "pass" if "pass" in known else "fail" if "fail" in known else "not assessed"


def _words(mine: Sequence[Light]) -> str:
    """Say what is met, with its margin and what governs it; then what fails, what is not known."""
    if not mine:
        return "no criterion asked for is for this motion"
    return "; ".join((*_of_velocity(mine), *_of_others(mine), *_unknown(mine)))


def _of_velocity(mine: Sequence[Light]) -> Iterator[str]:
    curves, met = _velocity(mine), _met(mine)
    failed = [one for one in curves if one.status == "fail"]
    if met is not None:
        sure = ", though more runs might fail it" if met.verdict.uncertain else ""
        yield f"{met.verdict.criterion.title} is met{_margin(met)}{sure}"
        yield f"governing: {_governing(met)}"
    elif failed:
        widest = failed[0]
        known = "known to be " if len(failed) < len(curves) else ""
        none = f"no velocity criterion is {known}met: " if len(curves) > 1 else ""
        yield f"{none}{widest.verdict.criterion.title} fails{_margin(widest)}"
        yield f"governing: {_governing(widest)}"


def _margin(light: Light) -> str:
    return f" with margin {between(light.verdict)}"


def _governing(light: Light) -> str:
    """Say which case governs, on which road, and in which band."""
    band = light.verdict.governing_band
    return light.where + ("" if np.isnan(band) else f", {frequency_name(band)} Hz")


def _of_others(mine: Sequence[Light]) -> Iterator[str]:
    """Say which criteria that are not of velocity fail; a single one is told with its margin."""
    others = [one for one in mine if one.verdict.criterion.quantity != "band_rms_velocity"]
    failed = [one for one in others if one.status == "fail"]
    passed = [one for one in others if one.status == "pass"]
    if passed and not failed:
        least = min(passed, key=lambda one: one.verdict.margin)
        which = least.verdict.criterion.title
        more = f" and {len(passed) - 1} more" if len(passed) > 1 else ""
        yield f"{which}{more} met{_margin(least)}"
    if failed:
        worst = min(failed, key=lambda one: one.verdict.margin)
        more = f" and {len(failed) - 1} more" if len(failed) > 1 else ""
        name = worst.verdict.criterion.title
        yield f"{name}{more} not met{_margin(worst)}, {_governing(worst)}"


def _unknown(mine: Sequence[Light]) -> Iterator[str]:
    """Say what is not assessed: in which bands, or which criteria and why."""
    unknown = [one for one in mine if one.status == "not assessed"]
    if not unknown:
        return
    bands = {f for one in unknown for f in (*one.verdict.unresolved, *one.verdict.unexcited)}
    names = [one.verdict.criterion.title for one in unknown]
    if len(names) == len(mine):
        reasons = dict.fromkeys(r for one in unknown for r in one.verdict.reasons)
        yield "not assessed: " + "; ".join(reasons)
        return
    curves = [one for one in unknown if one.verdict.bands is not None]
    gap = _gap(curves, bands) if len(curves) == len(unknown) else ""
    listed = ", ".join(names[:_NAMED]) + (
        f" and {len(names) - _NAMED} more" * (len(names) > _NAMED)
    )
    least = min((one.verdict.margin for one in unknown), default=np.nan)
    kept = f" (kept below it, margin {least:.3g})" if gap and least >= 1.0 else ""
    yield f"not assessed{gap}: {listed}{kept}"


def _gap(unknown: Sequence[Light], bands: set[float]) -> str:
    """Say above which band nothing is known, where what is missing is the top of the curves."""
    known = {
        float(f)
        for one in unknown
        if one.verdict.bands is not None
        for f, s in zip(one.verdict.bands.frequencies, one.verdict.bands.statuses, strict=True)
        if s != "not assessed"
    }
    if not known or not bands or min(bands) <= max(known):
        return ""
    return f" above {frequency_name(max(known))} Hz"


def conclusion_of_all(found: Sequence[Conclusion]) -> str:
    """Say in one sentence what holds for all points."""
    if not found:
        return ""
    if len(found) == 1:
        return f"{found[0].point}: {found[0].words}."
    return _of_many(found)


def _of_many(found: Sequence[Conclusion]) -> str:
    n = len(found)
    unmet = [one for one in found if one.met is None]
    if not unmet:
        weakest = max(found, key=_how_wide)
        assert weakest.met is not None  # none is unmet
        criterion = weakest.met.verdict.criterion.title
        return (
            f"{criterion}, or stricter, is met at all {n} points; the weakest is "
            f"{weakest.point}: {weakest.words}."
        )
    failed = [one.point for one in unmet if one.status == "fail"]
    unknown = [one.point for one in unmet if one.status == "not assessed"]
    parts = [f"a velocity criterion is met at {n - len(unmet)} of {n} points"]
    if len(unmet) == n:
        known = (
            "known to be " if unknown or any("known to be" in one.words for one in unmet) else ""
        )
        parts = [f"no velocity criterion is {known}met at any of {n} points"]
        failed = [] if not unknown else failed
    if failed:
        parts.append(f"none at {_listed(failed)}")
    if unknown:
        parts.append(f"not assessed at {_listed(unknown)}")
    text = "; ".join(parts)
    return f"{text[0].upper()}{text[1:]}."


def _how_wide(one: Conclusion) -> tuple[float, float]:
    """Return what sorts points: by the criterion they meet, then by its margin."""
    if one.met is None:
        return np.inf, 0.0
    return _strictness(one.met.verdict.criterion), -one.met.verdict.margin


def _listed(names: Sequence[str]) -> str:
    if len(names) <= _NAMED:
        return ", ".join(names)
    return f"{', '.join(names[:_NAMED])} and {len(names) - _NAMED} more"

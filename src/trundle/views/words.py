"""Say values in words: numbers, ranges, roads, rules."""

from __future__ import annotations

import numpy as np

from trundle.criteria import BY_FREQUENCY, Criterion, Verdict
from trundle.criteria.verdict import frequency_name
from trundle.road import CLASS_NAMES, RoadClass, class_limits
from trundle.signals import Averaging
from trundle.study.model import Study
from trundle.study.report_plan import ReportPlan
from trundle.units import PRINTED

__all__ = [
    "USUAL",
    "Range",
    "between",
    "hertz",
    "limit_words",
    "margin_words",
    "rank",
    "road_words",
    "roughest_words",
    "roughness_words",
    "rule_name",
    "shown",
    "spread",
    "written",
]

USUAL = ReportPlan()
"""Units of a report whose study does not choose them."""

Range = tuple[float, float, float]
"""5 %, 50 % and 95 % of the runs."""


def spread(values: np.ndarray, unit: float) -> Range:
    """Return 5, 50 and 95 % of some values in a unit."""
    low, middle, high = np.percentile(values, [5.0, 50.0, 95.0]) / unit
    return float(low), float(middle), float(high)


def written(value: float, digits: int = 3) -> str:
    """Write a number with so many digits as people do: 1320, not 1.32e+03."""
    short = float(f"{value:.{digits}g}")
    return f"{short:.0f}" if 10.0**digits <= abs(short) < 1e6 else f"{value:.{digits}g}"


def margin_words(value: float) -> str:
    """Write a margin to two places, where little room is: below 0.01 nobody asks how far."""
    if np.isnan(value):
        return ""
    if value < 0.01:
        return "<0.01"
    return f"{value:.2f}" if value < 10.0 else f"{value:.0f}" if value < 100.0 else ">99"


def roughness_words(value: float) -> str:
    """Write a Gd(n0) [m3] as people do: in 1e-6 m3, without a second power of ten."""
    short = float(f"{1e6 * value:.3g}")
    if short >= 1e6:
        return f"{value:.3g} m3"
    return f"{short:.0f}e-6 m3" if short >= 1e3 else f"{short:g}e-6 m3"


def shown(units: str, report: ReportPlan = USUAL) -> tuple[str, float]:
    """Return the unit that a report writes a quantity of motion in, and its size in SI."""
    asked = {
        "m/s2": report.acceleration,
        "m/s": report.velocity,
        "m": report.displacement,
    }
    if units in asked:
        return asked[units], PRINTED[asked[units]]
    return {"m/s1.75": ("m/s^1.75", 1.0)}.get(units, (units, 1.0))


_LIMITED = {
    "band_rms_velocity": "m/s",
    "band_rms_displacement": "m",
    "response_factor": "",
    "vdv": "m/s1.75",
}
"""SI unit of what a criterion limits; of all that is not here, that of acceleration."""


def limit_words(criterion: Criterion, report: ReportPlan = USUAL) -> str:
    """Say what a criterion allows at each of its corners, in the units of a report."""
    unit, size = shown(_LIMITED.get(criterion.quantity, "m/s2"), report)
    if criterion.quantity not in BY_FREQUENCY:
        return f"{criterion.limits[0] / size:.4g} {unit}".rstrip()
    return ", ".join(
        f"{limit / size:.4g} {unit} at {f:g} Hz"
        for f, limit in zip(criterion.frequencies, criterion.limits, strict=True)
    )


def between(verdict: Verdict) -> str:
    """Write a margin with its interval."""
    low, high = verdict.interval
    if not np.isfinite(low) or not np.isfinite(high):
        return f"{verdict.margin:.3g}"
    span = f"{low:.3g}-{high:.3g}" if low > 0.0 else f"at most {high:.3g}"
    return f"{verdict.margin:.3g} ({span})"


def hertz(f: float) -> str:
    """Write a mid-band frequency by its name, a line as it is; nothing for a single number."""
    return frequency_name(f) if np.isfinite(f) else ""


def rank(value: float) -> str:
    """Name a percentile; below the lowest run it is 'below all', above the highest 'above all'."""
    if value <= 0.0:
        return "below all"
    if value >= 100.0:
        return "above all"
    return f"{value:.0f} %"


def rule_name(averaging: Averaging) -> str:
    """Return an averaging rule in words."""
    names = {
        "max_1s": "largest 1 s average",
        "slow": "slow",
        "fast": "fast",
        "event": "whole event",
    }
    return names[averaging]


def road_words(study: Study) -> list[str]:
    """Return what each road is: its label, level and Gd(n0)."""
    if not study.drives:
        return ["none: nobody drives"]
    return [
        f"{label}: {road.level.replace('_', ' ')} of class {road.name}, Gd(n0) = "
        f"{roughness_words(road.roughness)}"
        if isinstance(road, RoadClass)
        else f"{label}: {'level and smooth' if label == 'smooth' else road}"
        for label, road in study.roads.items()
    ]


def roughest_words(study: Study, road: str, verdict: Verdict) -> str:
    """Return up to what road a criterion is passed, as far as the margin tells."""
    if np.isnan(verdict.roughest) or verdict.criterion.quantity != "band_rms_velocity":
        return ""
    spectrum = study.roads[road].spectrum
    if spectrum is None or study.roads[road].is_given:
        return ""  # no other road differs from it by a factor alone
    value = verdict.roughest * spectrum.roughness
    within = [name for name in CLASS_NAMES if class_limits(name)[2] <= value]
    name = f"all of class {within[-1]}" if within else "less than class A"
    bound = "at least" if verdict.margin >= 1.0 else "at most"
    return f"{bound} {roughness_words(value)} ({name})"

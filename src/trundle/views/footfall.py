"""Arrange what people who walk give a floor: rows of its table, words, and the worst places."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from trundle.run.footfall import StudyFootfall
from trundle.views.words import shown

__all__ = [
    "FootfallDose",
    "footfall_rows",
    "level_unit",
    "level_words",
    "worst_places",
    "worst_rows",
]

_WORDS = {"response_factor": "response factor", "peak_acceleration": "peak acceleration"}


@dataclass(frozen=True, kw_only=True)
class FootfallDose:
    """Hold what a vibration dose is for: so many passages of so long [s]."""

    passages: float
    duration: float


def level_unit(found: StudyFootfall) -> tuple[str, float]:
    """Return the unit that levels are shown in, and its size; no unit for a factor.

    Accelerations of people who walk are told in m/s2, as the guides do, unless the study's report
    asks for another unit.
    """
    if found.response.quantity == "response_factor":
        return "", 1.0
    report = found.study.report
    return shown("m/s2", report) if "acceleration" in report.chosen else ("m/s2", 1.0)


def level_words(found: StudyFootfall) -> str:
    """Return what levels are, with their unit."""
    name, (unit, _) = _WORDS[found.response.quantity], level_unit(found)
    return f"{name} [{unit}]" if unit else name


def footfall_rows(
    found: StudyFootfall, dose: FootfallDose | None
) -> tuple[list[str], list[list[object]]]:
    """Return headings and rows of the table of all places, for programs: in SI."""
    response, quantity = found.response, found.response.quantity
    name = quantity if quantity == "response_factor" else f"{quantity}_m_s2"
    headings = ["surface", "x_m", "y_m", name, "steady_state", "transient", "pace_hz"]
    headings += ["harmonic", "frequency_hz", "walker_surface", "walker_x_m", "walker_y_m"]
    doses = None if dose is None else response.dose(dose.duration, dose.passages)
    rows: list[list[object]] = []
    governing, transient = response.governing, response.transient
    for i in range(len(governing.level)):
        x, y, on = found.where(i)
        at_x, at_y, at_on = found.where(int(governing.walker[i]))
        later = "" if transient is None else _short(transient.level[i])
        row: list[object] = [on, _short(x), _short(y), _short(governing.level[i])]
        row += [_short(response.steady.level[i]), later, _short(governing.pace[i])]
        row += [int(governing.harmonic[i]), _short(governing.frequency[i])]
        row += [at_on, _short(at_x), _short(at_y)]
        rows.append(row if doses is None else [*row, _short(doses[i])])
    return (headings if doses is None else [*headings, "vdv_m_s1.75"]), rows


def worst_places(found: StudyFootfall) -> list[int]:
    """Return the place with the largest level of every surface."""
    level = found.response.governing.level
    return [part.start + int(level[part].argmax()) for _, part in found.parts()]


def worst_rows(found: StudyFootfall) -> Iterator[tuple[str, ...]]:
    """Give surface, level, place, pace, what governs and walker of each surface's worst place."""
    governing, (_, size) = found.response.governing, level_unit(found)
    for (grid, _), i in zip(found.parts(), worst_places(found), strict=True):
        x, y, _ = found.where(i)
        at_x, at_y, at_on = found.where(int(governing.walker[i]))
        h = int(governing.harmonic[i])
        yield (
            grid.label or "floor",
            f"{governing.level[i] / size:.3g}",
            f"{x:.2f}, {y:.2f}",
            f"{governing.pace[i]:.3f}",
            f"harmonic {h}" if h else "impulses",
            f"{governing.frequency[i]:.2f}",
            f"{at_x:.2f}, {at_y:.2f}" + (f" on {at_on}" if at_on != grid.label else ""),
        )


def _short(value: float) -> float:
    return float(f"{value:.6g}")

"""Hold the outcomes of many changes to one study."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from trundle._html import html_table
from trundle.criteria import Verdict
from trundle.errors import FitnessWarning
from trundle.study.model import Study

__all__ = ["Outcome", "Sweep"]


@dataclass(frozen=True, kw_only=True, eq=False)
class Outcome:
    """Hold the verdicts of one combination.

    Attributes
    ----------
    change : str
        Label of the change.
    case : str
        What drives.
    speed : float
        Speed of every vehicle [m/s].
    road : str
        Road class.
    verdicts : tuple of Verdict
        By point, then by criterion.
    excited_to : float
        Frequency at which the waves of the road end at this speed [Hz].
    warnings : tuple of FitnessWarning
        Doubts about it.
    """

    change: str
    case: str
    speed: float
    road: str
    verdicts: tuple[Verdict, ...]
    excited_to: float
    warnings: tuple[FitnessWarning, ...]


@dataclass(frozen=True, kw_only=True, eq=False)
class Sweep:
    """Hold all combinations that were tried.

    Attributes
    ----------
    study : Study
        What was changed.
    changes, speeds, roads : tuple
        What was combined: labels, speeds [m/s], road classes.
    runs : int
        Runs of each combination.
    outcomes : tuple of Outcome
        One for each combination.
    resonances : mapping of (str, str) to tuple of float
        By change and case, speeds [m/s] at which axles pass at the floor's first frequency, or a
        half or a third of it.
    """

    study: Study
    changes: tuple[str, ...]
    speeds: tuple[float, ...]
    roads: tuple[str, ...]
    runs: int
    outcomes: tuple[Outcome, ...]
    resonances: Mapping[tuple[str, str], tuple[float, ...]]

    def __repr__(self) -> str:
        """Say in a line what was tried."""
        return (
            f"<Sweep of {self.study.title!r}: {len(self.changes)} changes at {len(self.speeds)} "
            f"speeds on {len(self.roads)} road classes, {self.runs} runs each>"
        )

    def _repr_html_(self) -> str:
        """Show every verdict as a table."""
        return html_table(
            self.study.title,
            ("change", "vehicle on", "speed [m/s]", "road", "point", "criterion", "verdict"),
            (
                (o.change, o.case, f"{o.speed:.3g}", o.road, v.point, v.criterion.title, v.status)
                for o in self.outcomes
                for v in o.verdicts
            ),
        )

    def warnings(self) -> tuple[str, ...]:
        """Return every doubt once, with the speeds and roads that it is about if not all."""
        places: dict[str, tuple[dict[float, None], dict[str, None]]] = {}
        for one in self.outcomes:
            for warning in one.warnings:
                speeds, roads = places.setdefault(str(warning), ({}, {}))
                speeds[one.speed], roads[one.road] = None, None
        found: list[str] = []
        for text, (speeds, roads) in places.items():
            at = f"{', '.join(f'{3.6 * v:.3g}' for v in sorted(speeds))} km/h"
            on = f"class {', '.join(sorted(roads))}"
            about = [at] * (len(speeds) < len(self.speeds)) + [on] * (len(roads) < len(self.roads))
            found.append(": ".join([*([", ".join(about)] if about else []), text]))
        return tuple(found)

    def margin(self, change: str, case: str, road: str, point: str, criterion: str) -> np.ndarray:
        """Return the margin to a criterion at every speed, (n_speeds,)."""
        found = {
            o.speed: v.margin
            for o in self.outcomes
            if (o.change, o.case, o.road) == (change, case, road)
            for v in o.verdicts
            if (v.point, v.criterion.name) == (point, criterion)
        }
        return np.array([found[speed] for speed in self.speeds])

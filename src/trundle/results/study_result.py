"""Hold what a whole study gave."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from trundle._html import html_table
from trundle.criteria import Verdict
from trundle.errors import FitnessWarning
from trundle.response import BandSpectra, few_runs_warnings, level_warnings, size_warnings
from trundle.results.cells import Cell, CellKey, DayKey
from trundle.results.maps import MapKey, StudyMap
from trundle.results.mesh_change import MeshChange, mesh_warnings
from trundle.results.modes import FirstModes
from trundle.results.parts_change import PartsChange, parts_warnings
from trundle.simulate import Source
from trundle.study.assumptions import assumption_warnings, early_end_warnings
from trundle.study.doubts import study_doubts
from trundle.study.model import Study
from trundle.traffic import Day

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["StudyResult", "positions_at", "presence", "wheels_at"]


@dataclass(frozen=True, kw_only=True, eq=False)
class StudyResult:
    """Hold the results of a study.

    Attributes
    ----------
    study : Study
        What was run.
    cells : mapping of CellKey to Cell
        Every cell.
    verdicts : mapping of CellKey to tuple of Verdict
        Verdicts of the cells of the assessed method.
    maps : mapping of MapKey to StudyMap
        Maps by the assessed method, where the study asks for them: at the study's speeds and at
        those that its map names.
    days : mapping of DayKey to Day
        Days of the schedules, run passage by passage.
    modes : FirstModes or None
        Natural modes of the floor, where a method used them.
    mesh : MeshChange or None
        What a mesh twice as coarse changes, where that was looked at: of buildings.
    provenance : mapping of str
        Where the result comes from: versions, hashes, seed.
    parts : PartsChange or None
        What less of each part changes, where that was looked at: of structures cut into parts.
    """

    study: Study
    cells: Mapping[CellKey, Cell]
    verdicts: Mapping[CellKey, tuple[Verdict, ...]]
    maps: Mapping[MapKey, StudyMap]
    days: Mapping[DayKey, Day]
    modes: FirstModes | None
    mesh: MeshChange | None
    provenance: Mapping[str, Any]
    parts: PartsChange | None = None

    def __repr__(self) -> str:
        """Say in a line what came out."""
        verdicts = [v for found in self.verdicts.values() for v in found]
        told = {s: sum(v.status == s for v in verdicts) for s in ("pass", "fail", "not assessed")}
        said = ", ".join(f"{n} {status}" for status, n in told.items()) if verdicts else "none"
        return (
            f"<StudyResult of {self.study.title!r}: {len(self.cells)} cells, {len(self.maps)} "
            f"maps; verdicts: {said}>"
        )

    def _repr_html_(self) -> str:
        """Show the verdicts as a table."""
        return html_table(
            self.study.title,
            ("vehicle on", "road", "point", "criterion", "verdict", "margin"),
            (
                (key.case, key.road, v.point, v.criterion.title, v.status, f"{v.margin:.3g}")
                for key, found in self.verdicts.items()
                for v in found
            ),
        )

    def to_xarray(self) -> xr.DataTree:
        """Return everything as labelled arrays with units, as ``results.zarr`` holds it."""
        import xarray as xr  # noqa: PLC0415 - slow to import

        from trundle.results.datasets import result_groups  # noqa: PLC0415 - it arranges this

        return xr.DataTree.from_dict(result_groups(self))

    def warnings(self) -> dict[str, tuple[FitnessWarning, ...]]:
        """Return the doubts of each method, each once."""
        by_method: dict[str, dict[FitnessWarning, None]] = {}
        for key, cell in self.cells.items():
            sizes = size_warnings({f"{key.case}, class {key.road}": cell.reduced})
            doubts = dict.fromkeys((*cell.warnings, *sizes))
            by_method.setdefault(key.method, {}).update(doubts)
        assessment = self.study.assessment
        if assessment is not None and assessment.method in by_method:
            doubts = (
                *level_warnings(
                    assessment.averaging,
                    self.study.longest_record,
                    levels=self._governing_levels(),
                ),
                *few_runs_warnings(self.study.runs, assessment.percentile),
                *_map_warnings(self.study, assessment.percentile),
                *assumption_warnings(self.study),
                *study_doubts(self.study),
                *(() if self.study.building is None else mesh_warnings(self.mesh)),
                *(() if self.study.parting is None else parts_warnings(self.parts)),
                *(w for case in self.study.cases for w in early_end_warnings(self.study, case)),
            )
            by_method[assessment.method].update(dict.fromkeys(doubts))
        return {method: tuple(found) for method, found in by_method.items()}

    def _governing_levels(self) -> BandSpectra | None:
        """Return the levels of the assessed cell with the smallest margin."""
        margins = {
            key: min((v.margin for v in verdicts if np.isfinite(v.margin)), default=np.inf)
            for key, verdicts in self.verdicts.items()
        }
        if not margins:
            return None
        return self.cells[min(margins, key=lambda key: margins[key])].reduced.spectra


def _map_warnings(study: Study, percentile: float) -> tuple[FitnessWarning, ...]:
    """Return the doubt about a map of fewer runs than the study's."""
    if study.map is None or study.map.runs == study.runs:
        return ()
    found = few_runs_warnings(study.map.runs, percentile)
    return tuple(FitnessWarning(subject="runs of the map", message=w.message) for w in found)


def positions_at(result: StudyResult, key: CellKey, time: float) -> dict[str, list[float] | None]:
    """Return where each vehicle's front axle stands at a time [m]; None off its route.

    Parameters
    ----------
    result : StudyResult
        A finished study.
    key : CellKey
        Which cell.
    time : float
        Time of the record [s]; NaN gives nothing.
    """
    if np.isnan(time):
        return {}
    places = {source.name: source.stands_at(time)[0] for source in _acting(result, key)}
    return {name: None if place is None else list(place) for name, place in places.items()}


def wheels_at(result: StudyResult, key: CellKey, time: float) -> dict[str, int]:
    """Return how many wheels of each vehicle stand on the floor at a time [s]."""
    return {source.name: source.stands_at(time)[1] for source in _acting(result, key)}


def presence(
    result: StudyResult, key: CellKey, times: Sequence[float]
) -> dict[str, list[tuple[tuple[float, float] | None, int]]]:
    """Return by source where its front stands [m], and how many wheels are on the floor, at times.

    Parameters
    ----------
    result : StudyResult
        A finished study.
    key : CellKey
        Which cell.
    times : sequence of float
        Times of the record [s].
    """
    acting = _acting(result, key)
    return {source.name: [source.stands_at(float(t)) for t in times] for source in acting}


def _acting(result: StudyResult, key: CellKey) -> tuple[Source, ...]:
    """Return what acts in a cell."""
    study = result.study
    case = next(case for case in study.cases if case.name == key.case)
    method = next(method for method in study.methods if method.name == key.method)
    return study.acting(case, key.road, method)

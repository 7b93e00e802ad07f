"""Turn the section of a map into a plan of it, and check that it can be mapped."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from trundle._typing import Array
from trundle.dynamics import Modal
from trundle.errors import Problem
from trundle.road import RoughnessBand
from trundle.route import StaticStart
from trundle.structure import FloorPlan, mesh_lines
from trundle.study.map_plan import MapPlan, map_places
from trundle.study.model import Assessment, Drive, MethodPlan
from trundle.study_file.read import StudyFile
from trundle.study_file.schema import MapSection

__all__ = ["MapInput", "map_plan_of"]

_MAPPED = ("band_rms_velocity", "peak_acceleration")  # quantities that a map can be held against
_RUNS = 200  # of a map, unless the study says otherwise
_MOST_PLACES = 20_000
_MOST_BYTES = 4e9  # of levels, or of contact forces, held at once
_LEVEL_BYTES = 100.0  # of all levels of one run at one place


@dataclass(frozen=True, kw_only=True, eq=False)
class MapInput:
    """Hold what a map is planned from; what is None was not sound.

    Attributes
    ----------
    file : StudyFile
        The study file.
    plan : FloorPlan or None
        The floor.
    mesh_size : float
        Largest edge of an element [m].
    assessment : Assessment or None
        What the response is held against.
    drives : mapping of str to Drive
        Routes by name.
    methods : mapping of str to MethodPlan
        Methods by name.
    band : RoughnessBand or None
        Waves that roads contain.
    band_follows_dt : bool
        Whether the band ends where the time step can no longer follow.
    """

    file: StudyFile
    plan: FloorPlan | None
    mesh_size: float
    assessment: Assessment | None
    drives: Mapping[str, Drive]
    methods: Mapping[str, MethodPlan]
    band: RoughnessBand | None
    band_follows_dt: bool


def map_plan_of(given: MapInput) -> tuple[MapPlan | None, list[Problem]]:
    """Return the plan of a map, if there is to be one, and its mistakes."""
    file, section = given.file, given.file.tables.get("map")
    if section is None or file.general is None:
        return None, []
    if "criteria" not in file.tables:
        problem = Problem(
            place="map",
            value="no [criteria]",
            rule="a map holds the floor against criteria",
            remedy="add [criteria] with method and curves",
        )
        return None, [problem]
    if given.plan is None or given.assessment is None or given.band is None:
        return None, []
    checked = _Checked(
        section=section,
        plan=given.plan,
        mesh_size=given.mesh_size,
        assessment=given.assessment,
        drives=given.drives,
        method=given.methods.get(given.assessment.method),
        band=given.band,
        band_follows_dt=given.band_follows_dt,
        runs=min(section.runs or _RUNS, file.general.runs),
        n_roads=max(1, len(file.items("road"))),
    )
    problems = list(_problems(checked))
    return (None if problems else _plan(checked)), problems


@dataclass(frozen=True, kw_only=True, eq=False)
class _Checked:
    """What a map is planned from, all of it sound by itself."""

    section: MapSection
    plan: FloorPlan
    mesh_size: float
    assessment: Assessment
    drives: Mapping[str, Drive]
    method: MethodPlan | None
    band: RoughnessBand
    band_follows_dt: bool
    runs: int
    n_roads: int

    @property
    def curves(self) -> list[str]:
        """Names of the criteria that a map can be held against."""
        some = (c for c in self.assessment.criteria if c.quantity in _MAPPED)
        return [c.name for c in some if c.axis != "horizontal"]

    def lines(self) -> tuple[Array, Array]:
        """Return the lines of the grid of places along x and along y [m]."""
        plan, spacing = self.plan, self.section.spacing
        if self.section.places == "nodes":
            return mesh_lines(plan, mesh_size=self.mesh_size)
        return (
            map_places(plan.x_extent, spacing, plan.y_extent),
            map_places(plan.y_extent, spacing, plan.x_extent),
        )


def _problems(given: _Checked) -> Iterator[Problem]:
    """Give the mistakes of a map: what it is held against, how it is averaged, how fine it is."""
    yield from _criterion(given)
    if given.assessment.averaging not in {"max_1s", "event"}:
        yield Problem(
            place="map",
            value=f"averaging {given.assessment.averaging!r}",
            rule="a map is averaged by max_1s or event",
            remedy='set criteria.averaging = "max_1s", or remove [map]',
        )
    method = given.method
    if method is not None and (
        not isinstance(method.interaction.integration, Modal)
        or isinstance(method.entry, StaticStart)
    ):
        yield Problem(
            place="map",
            value=f"method {method.name!r}",
            rule="a map needs modal superposition and a floor at rest at time 0",
            remedy='assess by a method with integration = "modal" and entry = "drive_in"',
        )
    if given.section.places == "nodes" and given.section.spacing is not None:
        yield Problem(
            place="map.spacing",
            value=f"{given.section.spacing:g} m",
            rule="the nodes of the mesh have a spacing of their own",
            remedy='remove it, or set places = "grid"',
        )
    yield from _sizes(given)
    yield from _speeds(given)


def _plan(given: _Checked) -> MapPlan:
    section, names = given.section, given.curves
    x, y = given.lines()
    criteria = tuple(c for c in given.assessment.criteria if c.quantity in _MAPPED)
    return MapPlan(
        x=x,
        y=y,
        runs=given.runs,
        criteria=criteria,
        criterion=section.criterion or ("VC-B" if "VC-B" in names else names[-1]),
        percentile=given.assessment.percentile,
        averaging=given.assessment.averaging,  # pyright: ignore[reportArgumentType] - checked
        traffic=section.traffic,
        every_step=section.every_step,
        peaks=section.peaks or any(c.quantity == "peak_acceleration" for c in criteria),
        speeds=tuple(sorted(set(section.speeds))),
    )


def _criterion(given: _Checked) -> Iterator[Problem]:
    wanted, names = given.section.criterion, given.curves
    if wanted is not None and wanted not in names:
        yield Problem(
            place="map.criterion",
            value=repr(wanted),
            rule="must be one of the study's curves of velocity in bands, or of peak acceleration",
            remedy=f"there are: {', '.join(names) or 'none'}",
        )
    elif not names:
        yield Problem(
            place="map",
            value="no curve that can be mapped",
            rule="a map needs a curve of velocity in bands, or of peak acceleration",
            remedy='add one to criteria.curves, such as "VC-B"',
        )


def _sizes(given: _Checked) -> Iterator[Problem]:
    plan, section = given.plan, given.section
    spacing = given.mesh_size if section.places == "nodes" else section.spacing or 1e9
    places = float(np.prod([np.ceil((b - a) / spacing) for a, b in (plan.x_extent, plan.y_extent)]))
    if places > _MOST_PLACES:
        yield Problem(
            place="map.places" if section.places == "nodes" else "map.spacing",
            value=f"{spacing:g} m",
            rule=f"a map may have {_MOST_PLACES} places; this one would have {places:.3g}",
            remedy="use a larger spacing; 2 m shows every bay of most floors",
        )
        return
    needed = given.runs * given.n_roads * places * _LEVEL_BYTES
    if needed > _MOST_BYTES:
        yield Problem(
            place="map.runs",
            value=str(given.runs),
            rule=f"levels of {given.runs} runs on {given.n_roads} roads at {places:.4g} places "
            "would not fit in memory",
            remedy=f"use at most {int(_MOST_BYTES / needed * given.runs)} runs, or fewer places",
        )


def _speeds(given: _Checked) -> Iterator[Problem]:
    if given.method is None:
        return
    dt = given.method.interaction.integration.dt
    longest = max(
        (drive.route.length + drive.vehicle.length for drive in given.drives.values()), default=0.0
    )
    contacts = sum(drive.vehicle.n_contacts for drive in given.drives.values())
    for i, speed in enumerate(given.section.speeds):
        place, value = f"map.speeds[{i + 1}]", f"{3.6 * speed:g} km/h"
        limit = 0.5 / (speed * dt)
        if not given.band_follows_dt and given.band.n_max > limit * (1 + 1e-9):
            yield Problem(
                place=place,
                value=value,
                rule=f"the step of {1e3 * dt:g} ms can follow waves to {limit:.3g} 1/m at it, and "
                f"the road's end at {given.band.n_max:g} 1/m",
                remedy="lower the speed, shorten dt, or set roughness.n_max_follows_dt = true",
            )
        needed = 8.0 * longest / speed / dt * contacts * given.runs * given.n_roads
        if needed > _MOST_BYTES:
            yield Problem(
                place=place,
                value=value,
                rule="contact forces of so long a crossing would not fit in memory",
                remedy="raise the speed, or lower map.runs",
            )

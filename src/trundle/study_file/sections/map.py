"""Maps: what is mapped over the floor, by the method that carries the verdict."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Field

from trundle._words import in_kmh
from trundle.errors import Problem
from trundle.road import RoughnessBand
from trundle.structure import Axis, FloorPlan, Surface, mesh_lines
from trundle.study.map_plan import MapGrid, MapPlan, map_places
from trundle.study.model import Extent
from trundle.study.plans import Assessment, Drive, MethodPlan
from trundle.study_file.draft import Draft, no_sway, still_axes, surface_at
from trundle.study_file.fields import (
    Flag,
    Name,
    PositiveLength,
    Section,
    Speed,
    Whole,
)
from trundle.study_file.kinds import SectionKind
from trundle.study_file.sections.general import MAX_STEPS

__all__ = ["MAP", "build", "fields"]

_MANY = 1_000_000
# quantities that a map can be held against
_MAPPED = ("band_rms_velocity", "peak_acceleration", "response_factor")
_RUNS = 200  # of a map, unless the study says otherwise
_MOST_PLACES = 20_000
_MOST_BYTES = 4e9  # of levels, or of contact forces, held at once
_LEVEL_BYTES = 100.0  # of all levels of one run at one place


class MapSection(Section):
    """What is mapped over the whole floor, by the method that carries the verdict."""

    on: Name | Annotated[tuple[Name, ...], Field(min_length=1)] | None = None
    """Surfaces that are mapped; every one unless given."""
    axes: Annotated[tuple[Axis, ...], Field(min_length=1)] = ("z",)
    """Motions that are mapped."""
    places: Literal["grid", "nodes"] = "grid"
    """A grid over every surface, or every node of the mesh."""
    spacing: PositiveLength | None = None
    """Of the grid; some 300 places unless given."""
    runs: Annotated[Whole, Field(ge=1, le=_MANY)] | None = None
    """The first of the study's runs; 200 at most unless given."""
    criterion: str | None = None
    """Whose margin is drawn."""
    traffic: Flag = False
    """Whether several vehicles at once are mapped too."""
    speeds: Annotated[tuple[Speed, ...], Field(max_length=20)] = ()
    """Mapped beside those of the routes; the envelope holds them too."""
    every_step: Flag = False
    """Whether the largest 1 s is looked for at every step, as at a point; slower."""
    peaks: Flag = False
    """Whether peak accelerations are mapped too."""
    people: Flag = False
    """Whether response factors and vibration doses are mapped too."""


MAP = SectionKind(name="map", schema=MapSection, form="table")


def build(draft: Draft) -> tuple[Draft, list[Problem]]:
    """Return the draft with the plan of its map."""
    file, section = draft.file, draft.file.tables.get("map")
    if section is None or file.general is None:
        return draft, []
    if "criteria" not in file.tables:
        problem = Problem(
            place="map",
            value="no [criteria]",
            rule="a map holds the floor against criteria",
            remedy="add [criteria] with method and curves",
        )
        return draft, [problem]
    if draft.extent is None or draft.assessment is None or draft.band is None:
        return draft, []
    surfaces, found = _surfaces(draft, section.on)
    method = draft.methods.get(draft.assessment.method)
    if found:
        return draft, found
    checked = _Checked(
        section=section,
        extent=draft.extent,
        plan=draft.plan,
        mesh_size=draft.mesh_size,
        assessment=draft.assessment,
        drives=draft.drives,
        method=method,
        band=draft.band if method is None or method.band is None else method.band,
        band_follows_dt=draft.band_follows_dt,
        runs=min(section.runs or _RUNS, file.general.runs),
        n_roads=max(1, len(file.items("road"))),
        known=() if draft.model is None else tuple(draft.model.surfaces),
        surfaces=surfaces,
        sways="building" in file.given,
    )
    found = [*still_axes(draft, "map.axes", section.axes), *_problems(checked)]
    return (draft if found else replace(draft, map=_plan(checked))), found


def _surfaces(
    draft: Draft, on: str | tuple[str, ...] | None
) -> tuple[tuple[Surface, ...], list[Problem]]:
    """Return the surfaces that are mapped, each once: those named, or all."""
    if on is None:
        return (() if draft.model is None else tuple(draft.model.surfaces.values())), []
    found, problems = list[Surface](), list[Problem]()
    for name in (on,) if isinstance(on, str) else dict.fromkeys(on):
        surface, mistakes = surface_at(draft, "map.on", name)
        problems += mistakes
        found += [] if surface is None else [surface]
    return tuple(found), problems


def fields(draft: Draft) -> dict[str, Any]:
    """Return what a study takes from the section."""
    return {"map": draft.map}


@dataclass(frozen=True, kw_only=True, eq=False)
class _Checked:
    """What a map is planned from, all of it sound by itself."""

    section: MapSection
    extent: Extent
    plan: FloorPlan | None
    mesh_size: float
    assessment: Assessment
    drives: Mapping[str, Drive]
    method: MethodPlan | None
    band: RoughnessBand
    band_follows_dt: bool
    runs: int
    n_roads: int
    known: tuple[str, ...]
    surfaces: tuple[Surface, ...]
    sways: bool

    @property
    def curves(self) -> list[str]:
        """Names of the criteria that a map can be held against."""
        some = (c for c in self.assessment.criteria if c.quantity in _MAPPED)
        mapped = {"each axis", *("vertical" if a == "z" else "horizontal" for a in self.axes)}
        return [c.name for c in some if c.axis in mapped]

    @property
    def axes(self) -> tuple[Axis, ...]:
        """Motions that are mapped, each once."""
        return tuple(dict.fromkeys(self.section.axes))

    @cached_property
    def grids(self) -> tuple[MapGrid, ...]:
        """Places of every surface that is mapped."""
        spacing = self.section.spacing
        if self.section.places == "nodes" and self.plan is not None:
            x, y = mesh_lines(self.plan, mesh_size=self.mesh_size)
            return (MapGrid.over(x, y, None, None),)
        if not self.surfaces:
            x, y = self.extent
            lines = map_places(x, spacing, y), map_places(y, spacing, x)
            return (MapGrid.over(*lines, None, None),)
        several = len(self.known) > 1
        grids: list[MapGrid] = []
        for surface in self.surfaces:
            low, high = (surface.frame.to_plan(corner[None])[0] for corner in surface.extent)
            x, y = (float(low[0]), float(high[0])), (float(low[1]), float(high[1]))
            lines = map_places(x, spacing, y), map_places(y, spacing, x)
            on = surface.name if several else None
            grids += [MapGrid.over(*lines, surface, on, axis) for axis in self.axes]
        return tuple(grids)


def _problems(given: _Checked) -> Iterator[Problem]:
    """Give the mistakes of a map: what it is held against, how it is averaged, how fine it is."""
    yield from _criterion(given)
    if set(given.axes) != {"z"} and not given.sways:
        yield no_sway("map.axes", given.axes)
    if given.assessment.averaging not in {"max_1s", "event"}:
        yield Problem(
            place="map",
            value=f"averaging {given.assessment.averaging!r}",
            rule="a map is averaged by max_1s or event",
            remedy='set criteria.averaging = "max_1s", or remove [map]',
        )
    method = given.method
    if method is not None and (
        method.interaction.integration.f_max is None or method.entry.standing
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
    if given.section.places == "nodes" and given.plan is None:
        yield Problem(
            place="map.places",
            value="nodes",
            rule="nodes of a model that came as a mesh stand in no grid",
            remedy='set places = "grid", with a spacing',
        )
    yield from _sizes(given)
    yield from _speeds(given)


def _plan(given: _Checked) -> MapPlan:
    section, names = given.section, given.curves
    criteria = tuple(c for c in given.assessment.criteria if c.quantity in _MAPPED)
    return MapPlan(
        grids=given.grids,
        runs=given.runs,
        criteria=criteria,
        criterion=section.criterion or ("VC-B" if "VC-B" in names else names[-1]),
        percentile=given.assessment.percentile,
        averaging=given.assessment.averaging,  # pyright: ignore[reportArgumentType] - checked
        traffic=section.traffic,
        every_step=section.every_step,
        peaks=section.peaks or any(c.quantity == "peak_acceleration" for c in criteria),
        people=section.people or any(c.quantity == "response_factor" for c in criteria),
        speeds=tuple(sorted(set(section.speeds))),
    )


def _criterion(given: _Checked) -> Iterator[Problem]:
    wanted, names = given.section.criterion, given.curves
    if wanted is not None and wanted not in names:
        yield Problem(
            place="map.criterion",
            value=repr(wanted),
            rule="must be one of the study's curves of velocity in bands, peak acceleration or "
            "response factor",
            remedy=f"there are: {', '.join(names) or 'none'}",
        )
    elif not names:
        yield Problem(
            place="map",
            value="no curve that can be mapped",
            rule="a map needs a curve of velocity in bands, peak acceleration or response factor",
            remedy='add one to criteria.curves, such as "VC-B"',
        )


def _sizes(given: _Checked) -> Iterator[Problem]:
    section = given.section
    spacing = given.mesh_size if section.places == "nodes" else section.spacing or 1e9
    places = float(np.prod([np.ceil((b - a) / spacing) for a, b in given.extent]))
    places *= max(1, len(given.surfaces)) * len(given.axes)
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
    """Give speeds whose waves no step follows, and those at which a crossing takes too long."""
    if given.method is None:
        return
    dt = given.method.interaction.integration.dt
    longest = max(
        (drive.route.length + drive.vehicle.length for drive in given.drives.values()), default=0.0
    )
    contacts = sum(drive.vehicle.n_contacts for drive in given.drives.values())
    for i, speed in enumerate(given.section.speeds):
        place, value = f"map.speeds[{i + 1}]", f"{in_kmh(speed, 6)}"
        if said := _waves(given, 0.5 / (speed * dt)):
            yield Problem(
                place=place,
                value=value,
                rule=f"the step of {1e3 * dt:g} ms can follow waves to {0.5 / (speed * dt):.3g} "
                f"1/m at it, and {said[0]}",
                remedy=f"lower the speed, shorten dt, or {said[1]}",
            )
        steps = longest / speed / dt
        needed = 8.0 * steps * contacts * given.runs * given.n_roads
        if steps > MAX_STEPS or needed > _MOST_BYTES:
            yield Problem(
                place=place,
                value=value,
                rule="contact forces of so long a crossing would not fit in memory"
                if needed > _MOST_BYTES
                else f"a crossing would take {steps:.3g} steps; the limit is {MAX_STEPS}",
                remedy="raise the speed, or lower map.runs",
            )


def _waves(given: _Checked, limit: float) -> tuple[str, str] | None:
    """Return what waves of the road a limit [1/m] leaves out that it must not, and what helps."""
    band = given.band
    if given.band_follows_dt:
        return None if limit > band.n_min else (
            f"the road's begin at {band.n_min:g} 1/m", "lower roughness.n_min"
        )  # fmt: skip
    return None if band.n_max <= limit * (1 + 1e-9) else (
        f"the road's end at {band.n_max:g} 1/m", "set roughness.n_max_follows_dt = true"
    )  # fmt: skip

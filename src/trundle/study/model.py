"""Hold a whole study in SI: what is run, on what, and what it is held against."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TypeAlias

import numpy as np
from jaxtyping import Float

from trundle._html import html_table
from trundle._typing import Array
from trundle.criteria import Criterion
from trundle.errors import FitnessWarning, InputError
from trundle.road import Road, RoughnessBand
from trundle.route import ConstantSpeed, Route
from trundle.signals import Isolation
from trundle.simulate import Crossing
from trundle.simulate.sources.crossing import TAIL
from trundle.simulate.sources.passage import Passage
from trundle.simulate.sources.source import Source
from trundle.structure import Floor, FloorPlan, Spot, Structure, build_floor
from trundle.structure.building import Building, Meshing, build_building
from trundle.structure.superelements import Parting
from trundle.study.map_plan import MapPlan
from trundle.study.plans import Assessment, Case, Drive, MethodPlan, Note, Printed, PrintedBound
from trundle.study.report_plan import ReportPlan
from trundle.traffic import Schedule

__all__ = [
    "Extent",
    "Study",
    "directions",
    "extent_of",
]


Extent: TypeAlias = tuple[tuple[float, float], tuple[float, float]]
"""Range along x and along y [m]."""


def extent_of(floor: Structure) -> Extent:
    """Return the range of a structure's surfaces along x and along y [m]."""
    both = [surface.extent for surface in floor.surfaces.values()]
    low = np.min([one for one, _ in both], axis=0)
    high = np.max([one for _, one in both], axis=0)
    return (float(low[0]), float(high[0])), (float(low[1]), float(high[1]))


def directions(points: Mapping[str, Spot]) -> tuple[str, ...] | None:
    """Return whether each point's motion is vertical or horizontal; None where all are vertical."""
    if all(spot.axis == "z" for spot in points.values()):
        return None
    return tuple("vertical" if s.axis == "z" else "horizontal" for s in points.values())


@dataclass(frozen=True, kw_only=True, eq=False)
class Study:
    """Hold a study that has passed every check.

    Attributes
    ----------
    title, source, text, content_hash : str
        Title, path, text and hash of the study file.
    files : mapping of str to bytes
        Content of the files that it names, by these names.
    seed, runs : int
        Seed of all roads, and runs a cell.
    duration : float or None
        Length of every record [s]; None lets each last until its vehicles have left and the floor
        has come to rest.
    floor : Structure
        The meshed floor.
    plan : FloorPlan or None
        The plan that it was meshed from; None for a model that came as it is.
    building : Building or None
        The building that it was meshed from, if it was.
    meshing : Meshing or None
        How that was meshed.
    parting : Parting or None
        How the floor is cut into parts by which its modes are found, if it is.
    told : tuple of FitnessWarning
        What was noticed when files were read: what a drawing shows that was not taken.
    mesh_size : float
        Largest edge of an element [m].
    drives : mapping of str to Drive
        Routes by name.
    sources : mapping of str to Source
        Other sources of vibration by name.
    schedules : mapping of str to Schedule
        Who drives on a day, by name.
    cases : tuple of Case
        Single routes first, then traffic.
    roads : mapping of str to Road
        Roads by label.
    band : RoughnessBand
        Waves that synthetic roads contain.
    band_follows_dt : bool
        Whether the band ends where a method's time step can no longer follow.
    points : mapping of str to Spot
        Where the response is read [m].
    isolations : mapping of str to Isolator or TransmissibilityTable
        What stands between floor and tool at some of the points.
    methods : tuple of MethodPlan
        The methods, in the order of the file.
    assessment : Assessment or None
        What the response is held against.
    map : MapPlan or None
        What is mapped over the floor.
    printed, printed_bounds, notes : tuple
        Published values to hold beside ours, and notes.
    numbering : mapping of str to str
        Numbers that figures and tables bear in a publication, by their names in the report.
    force_speeds : tuple of float
        Speeds at which axle forces are drawn beside those of the routes [m/s].
    publications : tuple of str
        Publications that the study draws on.
    report : ReportPlan
        What stands on the front of its report, and the report's units.
    """

    title: str
    source: str
    text: str
    content_hash: str
    files: Mapping[str, bytes]
    seed: int
    runs: int
    duration: float | None
    floor: Structure
    plan: FloorPlan | None
    building: Building | None
    meshing: Meshing | None
    parting: Parting | None
    told: tuple[FitnessWarning, ...]
    mesh_size: float
    drives: Mapping[str, Drive]
    sources: Mapping[str, Source]
    schedules: Mapping[str, Schedule]
    cases: tuple[Case, ...]
    roads: Mapping[str, Road]
    band: RoughnessBand
    band_follows_dt: bool
    points: Mapping[str, Spot]
    isolations: Mapping[str, Isolation]
    methods: tuple[MethodPlan, ...]
    assessment: Assessment | None
    map: MapPlan | None
    printed: tuple[Printed, ...]
    printed_bounds: tuple[PrintedBound, ...]
    notes: tuple[Note, ...]
    numbering: Mapping[str, str]
    force_speeds: tuple[float, ...]
    publications: tuple[str, ...]
    report: ReportPlan

    def __repr__(self) -> str:
        """Say in a line what is studied."""
        return (
            f"<Study {self.title!r}: {len(self.cases)} cases on {len(self.roads)} roads by "
            f"{len(self.methods)} methods, {self.runs} runs each, {len(self.points)} points, "
            f"{self.floor.n_dofs} degrees of freedom>"
        )

    def _repr_html_(self) -> str:
        """Show what is studied as a table."""
        return html_table(
            self.title,
            ("what", "which"),
            (
                ("cases", ", ".join(case.name for case in self.cases)),
                ("roads", ", ".join(self.roads)),
                ("methods", "; ".join(f"{m.name}: {m.interaction}" for m in self.methods)),
                ("points", ", ".join(self.points)),
                ("criteria", ", ".join(c.title for c in self.criteria)),
                ("runs", self.runs),
                ("floor", f"{self.floor.name}, {self.floor.n_dofs} degrees of freedom"),
            ),
        )

    @property
    def extent(self) -> Extent:
        """Range of the floor along x and along y [m]."""
        if self.plan is not None:
            return self.plan.x_extent, self.plan.y_extent
        return extent_of(self.floor)

    @property
    def point_ways(self) -> tuple[str, ...] | None:
        """Whether each point is vertical or horizontal; None where all are vertical."""
        return directions(self.points)

    @property
    def motion(self) -> str:
        """What points read, in words."""
        axes = dict.fromkeys(spot.axis for spot in self.points.values())
        words = {"z": "vertical", "x": "along x", "y": "along y"}
        return ", ".join(words[axis] for axis in axes)

    @property
    def storeys(self) -> tuple[str | None, ...]:
        """All surfaces by name; None for the only one."""
        names = tuple(self.floor.surfaces)
        return names if len(names) > 1 else (None,)

    def is_on(self, name: str | None, on: str | None) -> bool:
        """Return whether two names mean one surface: the only one need not be named."""
        return name == on or len(self.floor.surfaces) == 1

    def in_plan(self, xy: Float[Array, "n 2"], on: str | None) -> Float[Array, "n 2"]:
        """Return where in plan places of a surface are [m]."""
        return self.floor.surface(on).frame.to_plan(np.asarray(xy, dtype=float))

    def way_in_plan(self, route: Route, on: str | None = None) -> Float[Array, "places 2"]:
        """Return where in plan a route runs [m]: all of it, or what of it lies on a surface."""
        line = route.line_on(on)
        return line if route.surfaces or not len(line) else self.in_plan(line, route.on)

    def way_in_space(self, route: Route) -> Float[Array, "places 3"]:
        """Return where in space a route runs [m]."""
        if not route.surfaces:
            return self.floor.surface(route.on).frame.in_space(np.asarray(route.line))
        parts = [(self.floor.surface(on).frame, route.line_on(on)) for on in route.visited]
        return np.concatenate([f.in_space(f.from_plan(line)) for f, line in parts])

    def meshed(self, factor: float) -> Study:
        """Return the study on a mesh whose sizes are times a factor.

        Raises
        ------
        InputError
            The floor came as a mesh.
        """
        size = self.mesh_size * factor
        if self.plan is not None:
            floor = build_floor(self.plan, mesh_size=size)
            return replace(self, floor=self._parted(floor), mesh_size=size)
        if self.building is None or self.meshing is None:
            raise InputError(f"{self.floor.name} came as a mesh: it cannot be meshed anew")
        meshing = self.meshing.scaled(factor)
        floor = self._parted(build_building(self.building, meshing))
        return replace(self, floor=floor, meshing=meshing, mesh_size=size)

    def _parted(self, floor: Floor) -> Structure:
        """Return a floor cut into parts, if the study cuts it."""
        return floor if self.parting is None else self.parting.of(floor)

    @property
    def criteria(self) -> tuple[Criterion, ...]:
        """What the response is held against; nothing without an assessment."""
        return () if self.assessment is None else self.assessment.criteria

    def acting(self, case: Case, road: str, method: MethodPlan) -> tuple[Source, ...]:
        """Return what acts in one cell: passages on the road, and other sources as they are."""
        before: Counter[str] = Counter()
        found: list[Source] = []
        for name, depart in zip(case.routes, case.departs, strict=True):
            before[name] += 1
            source = self.sources.get(name)
            if source is None:
                crossing = self._crossing(self.drives[name], road, method)
                source = Passage(crossing=crossing, number=before[name])
            found.append(source.later(depart))
        return tuple(found)

    def _crossing(self, drive: Drive, road: str, method: MethodPlan) -> Crossing:
        return Crossing(
            vehicle=drive.vehicle,
            route=drive.route,
            road=self.roads[road],
            band=self.band_for(drive, method),
            entry=method.entry,
            run_in=drive.run_in,
        )

    def at_speed(self, speed: float) -> Study:
        """Return the study with every vehicle at a constant speed [m/s]."""
        drives = {
            name: replace(drive, route=replace(drive.route, law=ConstantSpeed(speed)))
            for name, drive in self.drives.items()
        }
        return replace(self, drives=drives)

    def record_length(self, sources: Sequence[Source]) -> float:
        """Return the length of a record of some sources [s]: what was asked for, or enough."""
        return self.long_enough(sources) if self.duration is None else self.duration

    def long_enough(self, sources: Sequence[Source]) -> float:
        """Return the length of a record in which sources end and the floor comes to rest [s]."""
        enough = max(one.leaves for one in sources) + TAIL
        return max(self.duration or 0.0, float(np.ceil(enough)))

    @property
    def longest_record(self) -> float:
        """Length of the longest record [s]."""
        road = next(iter(self.roads))
        return max(
            self.record_length(self.acting(case, road, self.methods[0])) for case in self.cases
        )

    def band_for(self, drive: Drive, method: MethodPlan) -> RoughnessBand:
        """Return a method's waves, as far as its time step can follow at a route's speed."""
        band = method.band or self.band
        if not self.band_follows_dt:
            return band
        speed = drive.route.law.fastest
        limit = 0.5 / (speed * method.interaction.integration.dt)
        return replace(band, n_max=min(band.n_max, limit))

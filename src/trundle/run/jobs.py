"""Cut a study into jobs: what shares a layout."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from trundle.criteria import Criterion, spectra_asked_for
from trundle.response import (
    SpectrumQuantity,
)
from trundle.road import FeaturedRoad, Road
from trundle.run.departures import departures_of
from trundle.signals import Averaging, Isolation
from trundle.simulate import (
    Layout,
    PlaceResponses,
    PreparedFloor,
    Source,
    lay_out,
    lay_out_places,
)
from trundle.simulate.ensembles import runs_at_once
from trundle.simulate.sources.crossing import TAIL
from trundle.structure import Spot
from trundle.study.map_plan import MapPlan
from trundle.study.model import Study
from trundle.study.plans import Case, MethodPlan
from trundle.traffic import Schedule, lay_out_meeting

__all__ = ["Job", "PreparedJob", "plan_jobs", "prepare_job"]


_WAVES = 400  # shared among the roads of a case: 800 runs' worth; fewer miss sharp answers


@dataclass(frozen=True, kw_only=True, eq=False)
class Job:
    """Hold what shares a layout: one case by one method on roads of one waviness.

    Roads of one waviness differ by a factor alone, and the system is linear; so they share one
    ensemble, whose response without roughness is subtracted, scaled about, and added again.

    Attributes
    ----------
    name : str
        Name of the job, unique in the study and fit for a file.
    case : Case
        What drives.
    method : MethodPlan
        By what method.
    sources : tuple of Source
        What acts, passages on the first of the roads.
    factors : mapping of str to float
        How many times rougher each road is than the first.
    parts : tuple of range
        Numbers of the runs that are computed together.
    n_waves : int
        Waves of each road for exact statistics, 0 for none.
    points : mapping of str to Spot
        Where the response is read [m].
    duration : float
        Length of the record [s].
    seed : int
        Seed of all roads.
    averaging : {"max_1s", "slow", "fast", "event"}
        Averaging rule of band levels.
    quantities : tuple of SpectrumQuantity
        Spectra that the criteria ask for.
    isolations : mapping of str to Isolation
        What stands between floor and tool at some of the points.
    map : MapPlan or None
        What is mapped over the floor, by the method that carries the verdict.
    speed : float or None
        Speed of every vehicle if it is not the study's [m/s]; such a job leaves a map alone.
    watched : tuple of Criterion
        Curves above which time is counted, where a day is asked for.
    schedule : Schedule or None
        A day whose passages the job runs; the case then names its routes, none of them at once.
    """

    name: str
    case: Case
    method: MethodPlan
    sources: tuple[Source, ...]
    factors: Mapping[str, float]
    parts: tuple[range, ...]
    n_waves: int
    points: Mapping[str, Spot]
    duration: float
    seed: int
    averaging: Averaging
    quantities: tuple[SpectrumQuantity, ...]
    isolations: Mapping[str, Isolation]
    map: MapPlan | None
    speed: float | None
    watched: tuple[Criterion, ...] = ()
    schedule: Schedule | None = None

    @property
    def sideways(self) -> tuple[int, ...]:
        """Which points read level motion."""
        return tuple(i for i, spot in enumerate(self.points.values()) if spot.axis != "z")

    @property
    def modal(self) -> bool:
        """Whether the floor is stepped in its modes."""
        return self.method.interaction.integration.f_max is not None


def plan_jobs(study: Study) -> tuple[Job, ...]:
    """Return the jobs of a study, in the order of its methods and cases."""
    return tuple(
        job
        for i, method in enumerate(study.methods)
        for j, case in enumerate(study.cases)
        for k, roads in enumerate(_groups(study, case))
        for job in _jobs(study, f"method{i}-case{j}-roads{k}", (case, method), roads)
    ) + tuple(_days(study))


def _days(study: Study) -> Iterator[Job]:
    """Give a job for each day that is run, by the method that carries the verdict."""
    assessment = study.assessment
    if assessment is None:
        return
    method = next(m for m in study.methods if m.name == assessment.method)
    for i, (name, schedule) in enumerate(study.schedules.items()):
        case = Case(name=name, routes=schedule.routes)
        for k, roads in enumerate(_groups(study, case)):
            job = next(_jobs(study, f"day{i}-roads{k}", (case, method), roads))
            yield replace(job, parts=(), n_waves=0, map=None, schedule=schedule)


def _groups(study: Study, case: Case) -> list[list[str]]:
    """Return roads together whose random parts differ by a factor, and by nothing else.

    Over vehicles that are not linear no response follows from that on another road; nor does it
    where something else is random too, which no road scales. Without a vehicle no road counts.
    """
    drives = [study.drives[name] for name in case.routes if name in study.drives]
    if not drives:
        return [list(study.roads)]
    others = (study.sources[name] for name in case.routes if name in study.sources)
    linear = all(drive.vehicle.is_linear for drive in study.drives.values())
    if not linear or any(source.varies for source in others):
        return [[name] for name in study.roads]
    groups: dict[object, list[str]] = {}
    for name, road in study.roads.items():
        features = road.features if isinstance(road, FeaturedRoad) else ()
        base = road.base if isinstance(road, FeaturedRoad) else road
        alike = None if base.is_given or base.spectrum is None else base.spectrum.waviness
        groups.setdefault((name if alike is None else alike, features), []).append(name)
    return list(groups.values())


def _factors(study: Study, case: Case, roads: list[str]) -> dict[str, float]:
    """Return how many times rougher each road is than the first; all alike where nobody drives."""
    if not any(name in study.drives for name in case.routes):
        return dict.fromkeys(roads, 1.0)
    first = _roughness(study.roads[roads[0]])
    return {name: float(np.sqrt(_roughness(study.roads[name]) / first)) for name in roads}


def _roughness(road: Road) -> float:
    """Return Gd(n0) of a road's random part [m3]; 1 of a road that has none."""
    return 1.0 if road.spectrum is None else road.spectrum.roughness


def _jobs(
    study: Study, name: str, what: tuple[Case, MethodPlan], roads: list[str]
) -> Iterator[Job]:
    """Give the job at the study's own speeds, and one for each further speed that is mapped."""
    case, method = what
    sources = study.acting(case, roads[0], method)
    length = study.record_length(sources)
    dt = method.interaction.integration.dt
    size = runs_at_once(sources, dt, length, len(study.points))
    n_parts = -(-study.runs // size)
    edges = np.linspace(0, study.runs, n_parts + 1).astype(int)
    modal = method.interaction.integration.f_max is not None
    # waves of a road answer for nothing else that is random
    varies = any(source.varies for source in sources)
    n_random = 0 if varies else sum(source.random for source in sources)
    job = Job(
        name=name,
        case=case,
        method=method,
        sources=sources,
        factors=_factors(study, case, roads),
        parts=tuple(range(a, b) for a, b in itertools.pairwise(edges)),
        n_waves=max(2, _WAVES // n_random) if modal and n_random else 0,
        points=study.points,
        duration=length,
        seed=study.seed,
        averaging=study.assessment.averaging if study.assessment else "max_1s",
        quantities=spectra_asked_for(study.assessment.criteria) if study.assessment else (),
        isolations=study.isolations,
        map=_map(study, case, method),
        speed=None,
        watched=_watched(study, method),
    )
    yield job
    for i, speed in enumerate(job.map.speeds if job.map is not None else ()):
        there = study.at_speed(speed).acting(case, roads[0], method)
        yield replace(
            job,
            name=f"{name}-speed{i}",
            sources=there,
            parts=(),
            n_waves=0,
            duration=study.long_enough(there),
            speed=speed,
        )


@dataclass(frozen=True, kw_only=True, eq=False)
class PreparedJob:
    """Hold what all parts of a job share: its layout, and the way to the places of its map.

    Attributes
    ----------
    layout : Layout
        Of all that acts at once; of a day, of its first route.
    places : PlaceResponses or None
        What leads to the places of a map.
    alone : mapping of str to Layout
        Of a day, one passage on each route.
    meeting : Layout or None
        Of a day, the two vehicles that meet closest, at once.
    """

    layout: Layout
    places: PlaceResponses | None
    alone: Mapping[str, Layout] = field(default_factory=dict[str, Layout])
    meeting: Layout | None = None


def _watched(study: Study, method: MethodPlan) -> tuple[Criterion, ...]:
    """Return the curves above which time is counted: of the assessed method, if a day asks."""
    assessment = study.assessment
    if assessment is None or assessment.method != method.name or not study.schedules:
        return ()
    return assessment.criteria


def _map(study: Study, case: Case, method: MethodPlan) -> MapPlan | None:
    """Return what is mapped of a case: by the assessed method, and of traffic if asked for."""
    plan, assessment = study.map, study.assessment
    if plan is None or assessment is None or assessment.method != method.name:
        return None
    return plan if plan.traffic or len(case.routes) == 1 else None


def prepare_job(job: Job, floor: PreparedFloor) -> PreparedJob:
    """Lay out what all parts of a job share."""
    if job.schedule is not None:
        alone = {
            source.name: lay_out(
                floor,
                source,
                method=job.method.interaction,
                points=job.points,
                duration=float(np.ceil(source.leaves + TAIL + 1.0)),
            )
            for source in job.sources
        }
        departures = departures_of(job.schedule, job.sources, job.seed)
        return PreparedJob(
            layout=next(iter(alone.values())),
            places=None,
            alone=alone,
            meeting=lay_out_meeting(floor, alone, departures, job.points),
        )
    layout = lay_out(
        floor,
        job.sources,
        method=job.method.interaction,
        points=job.points,
        duration=job.duration,
    )
    places = None if job.map is None else lay_out_places(floor, layout, job.map.places)
    return PreparedJob(layout=layout, places=places)

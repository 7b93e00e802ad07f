"""Cut a study into jobs: what shares a layout."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np

from trundle.criteria import spectra_asked_for
from trundle.response import (
    SpectrumQuantity,
)
from trundle.road import FeaturedRoad, Road
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
from trundle.structure import Spot
from trundle.study.map_plan import MapPlan
from trundle.study.model import Study
from trundle.study.plans import Case, MethodPlan

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
        for k, roads in enumerate(_groups(study))
        for job in _jobs(study, f"method{i}-case{j}-roads{k}", (case, method), roads)
    )


def _groups(study: Study) -> list[list[str]]:
    """Return roads together whose random parts differ by a factor, and by nothing else.

    Over vehicles that are not linear no response follows from that on another road.
    """
    groups: dict[object, list[str]] = {}
    if not all(drive.vehicle.is_linear for drive in study.drives.values()):
        return [[name] for name in study.roads]
    for name, road in study.roads.items():
        features = road.features if isinstance(road, FeaturedRoad) else ()
        base = road.base if isinstance(road, FeaturedRoad) else road
        alike = None if base.is_given or base.spectrum is None else base.spectrum.waviness
        groups.setdefault((name if alike is None else alike, features), []).append(name)
    return list(groups.values())


def _roughness(road: Road) -> float:
    """Return Gd(n0) of a road's random part [m3]; 1 of a road that has none."""
    return 1.0 if road.spectrum is None else road.spectrum.roughness


def _jobs(
    study: Study, name: str, what: tuple[Case, MethodPlan], roads: list[str]
) -> Iterator[Job]:
    """Give the job at the study's own speeds, and one for each further speed that is mapped."""
    case, method = what
    sources = study.acting(case, roads[0], method)
    first = _roughness(study.roads[roads[0]])
    length = study.record_length(sources)
    dt = method.interaction.integration.dt
    size = runs_at_once(sources, dt, length, len(study.points))
    n_parts = -(-study.runs // size)
    edges = np.linspace(0, study.runs, n_parts + 1).astype(int)
    modal = method.interaction.integration.f_max is not None
    n_random = sum(source.random for source in sources)
    job = Job(
        name=name,
        case=case,
        method=method,
        sources=sources,
        factors={name: float(np.sqrt(_roughness(study.roads[name]) / first)) for name in roads},
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
    """Hold what all parts of a job share: its layout, and the way to the places of its map."""

    layout: Layout
    places: PlaceResponses | None


def _map(study: Study, case: Case, method: MethodPlan) -> MapPlan | None:
    """Return what is mapped of a case: by the assessed method, and of traffic if asked for."""
    plan, assessment = study.map, study.assessment
    if plan is None or assessment is None or assessment.method != method.name:
        return None
    return plan if plan.traffic or len(case.routes) == 1 else None


def prepare_job(job: Job, floor: PreparedFloor) -> PreparedJob:
    """Lay out what all parts of a job share."""
    layout = lay_out(
        floor,
        job.sources,
        method=job.method.interaction,
        points=job.points,
        duration=job.duration,
    )
    places = None if job.map is None else lay_out_places(floor, layout, job.map.places)
    return PreparedJob(layout=layout, places=places)

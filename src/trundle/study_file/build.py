"""Turn checked sections into a study in SI, and check how they fit together."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import TypeVar

import numpy as np

from trundle._kinds import kinds_checked
from trundle.criteria import Criterion, find_criterion, shaped
from trundle.errors import InputError, Problem, StudyError
from trundle.road import RoughnessBand
from trundle.route import ConstantSpeed, Route
from trundle.signals import Isolation
from trundle.structure import (
    FloorPlan,
    build_floor,
    reference_plan,
)
from trundle.study.model import Assessment, Case, Drive, Note, Printed, PrintedBound, Study
from trundle.study_file import schema
from trundle.study_file._attempt import attempt
from trundle.study_file._relations import relation_problems
from trundle.study_file.build_map import MapInput, map_plan_of
from trundle.study_file.build_methods import methods_of
from trundle.study_file.convert import floor_plan_of, isolation_of, road_label, road_of, vehicle_of
from trundle.study_file.lines import line_of, lines_of
from trundle.study_file.read import StudyFile, read_study, read_text
from trundle.study_file.user_criteria import read_criteria
from trundle.vehicle import Vehicle

__all__ = ["load_study", "study_from_text"]

T = TypeVar("T")

_MAX_NODES = 100_000  # 600,000 dofs: beyond this a mesh size is more likely a slip


@kinds_checked
def load_study(
    path: Path | str, *, source: str | None = None, files: Mapping[str, Path] | None = None
) -> Study:
    """Read, check and build a study.

    Parameters
    ----------
    path : path-like
        A TOML study file.
    source : str, optional
        What the file is called in messages and reports; its path unless given.
    files : mapping of str to Path, optional
        Where files are that the study names, if not beside it.

    Returns
    -------
    Study
        Everything in SI, the floor meshed.

    Raises
    ------
    StudyError
        With every mistake found: of single values, and of how they fit together.
    """
    path = Path(path)
    file, problems = read_study(path)
    file = file if source is None else replace(file, source=source)
    return _built(file, problems, path.parent, files or {})


@kinds_checked
def study_from_text(text: str, *, source: str = "study", folder: Path | str = ".") -> Study:
    """Check and build a study from the text of a study file.

    Parameters
    ----------
    text : str
        TOML, as in a study file.
    source : str
        What it is called in messages and reports.
    folder : path-like
        Where files are that it names.

    Returns
    -------
    Study
        Everything in SI, the floor meshed.

    Raises
    ------
    StudyError
        With every mistake found.
    """
    if not text.isascii() and any("\ud800" <= c <= "\udfff" for c in text):
        raise InputError(f"{source}: holds half a character (a surrogate); write it as UTF-8")
    file, problems = read_text(text, source)
    return _built(file, problems, Path(folder), {})


def _built(
    file: StudyFile, problems: list[Problem], folder: Path, files: Mapping[str, Path]
) -> Study:
    study = _Builder(file, problems, folder, files).build()
    if problems or study is None:
        lines = lines_of(file.text)
        placed = [replace(p, line=line_of(p.place, lines)) for p in problems]
        placed.sort(key=lambda p: p.line or np.inf)
        raise StudyError(file.source, placed)
    return study


class _Builder:
    """Collect problems while building, so that one mistake does not hide the next."""

    def __init__(
        self, file: StudyFile, problems: list[Problem], folder: Path, files: Mapping[str, Path]
    ) -> None:
        self.file, self.problems = file, problems
        self.folder, self.files = folder, files
        self.read: dict[str, bytes] = {}

    def build(self) -> Study | None:
        file = self.file
        plan, mesh_size = self._plan()
        vehicles = self._vehicles()
        drives = self._drives(vehicles)
        band, follows = self._band()
        methods, mistakes = methods_of(file, mesh_size, band)
        self.problems += mistakes
        assessment = self._assessment()
        isolations = self._isolations()
        mapped, mistakes = map_plan_of(
            MapInput(
                file=file,
                plan=plan,
                mesh_size=mesh_size,
                assessment=assessment,
                drives=drives,
                methods=methods,
                band=band,
                band_follows_dt=follows,
            )
        )
        self.problems += mistakes
        self._unique_names()
        self.problems += relation_problems(
            file, plan, drives, methods, band=band, follows_dt=follows
        )
        if self.problems or plan is None or file.general is None or band is None:
            return None
        floor = self._try("floor", lambda: build_floor(plan, mesh_size=mesh_size))
        if floor is None:
            return None
        general = file.general
        publication = file.tables.get("publication") or schema.PublicationSection()
        singles = tuple(Case(name=name, routes=(name,)) for name in drives)
        traffic = tuple(Case(name=t.name, routes=t.routes) for t in file.items("traffic"))
        return Study(
            title=general.title,
            source=file.source,
            text=file.text,
            content_hash=file.content_hash,
            files=self.read,
            seed=general.seed,
            runs=general.runs,
            duration=general.duration,
            floor=floor,
            plan=plan,
            mesh_size=mesh_size,
            drives=drives,
            cases=singles + traffic,
            roads={road_label(r): road_of(r) for r in file.items("road")},
            band=band,
            band_follows_dt=follows,
            points={p.name: p.at for p in file.items("point")},
            isolations=isolations,
            methods=tuple(methods.values()),
            assessment=assessment,
            map=mapped,
            printed=tuple(Printed(**dict(p)) for p in file.items("printed")),
            printed_bounds=tuple(PrintedBound(**dict(p)) for p in file.items("printed_bound")),
            notes=tuple(Note(**dict(n)) for n in file.items("note")),
            numbering=publication.numbers,
            force_speeds=publication.force_speeds,
            sources=publication.sources,
        )

    def _try(self, place: str, make: Callable[[], T], remedy: str = "") -> T | None:
        made = attempt(place, make, remedy)
        if isinstance(made, Problem):
            self.problems.append(made)
            return None
        return made

    def _plan(self) -> tuple[FloorPlan | None, float]:
        section = self.file.tables.get("floor")
        if section is None:
            return None, 1.0
        plan = (
            reference_plan()
            if isinstance(section, schema.ReferenceFloorSection)
            else self._try("floor", lambda: floor_plan_of(section))
        )
        if plan is not None:
            self._mesh_problems(plan, section.mesh_size)
        return plan, float(section.mesh_size)

    def _mesh_problems(self, plan: FloorPlan, size: float) -> None:
        sides = [high - low for low, high in (plan.x_extent, plan.y_extent)]
        nodes = np.prod([side / size + 1 for side in sides])
        if nodes > _MAX_NODES:
            smallest = float(np.sqrt(np.prod(sides) / _MAX_NODES))
            self.problems.append(
                Problem(
                    place="floor.mesh_size",
                    value=f"{size:g} m",
                    rule=f"the mesh may have {_MAX_NODES} nodes; this one would have {nodes:.3g}",
                    remedy=f"use {np.ceil(100 * smallest) / 100:g} m or more",
                )
            )
        elif size > 0.25 * min(sides):
            self.problems.append(
                Problem(
                    place="floor.mesh_size",
                    value=f"{size:g} m",
                    rule="an element may be at most a quarter of the floor's shorter side",
                    remedy=f"use {0.25 * min(sides):g} m or less; 1 m suits most floors",
                )
            )

    def _vehicles(self) -> dict[str, Vehicle]:
        made = {
            name: self._try(f"vehicle.{name}", lambda n=name, s=section: vehicle_of(n, s))
            for name, section in self.file.vehicles.items()
        }
        return {name: vehicle for name, vehicle in made.items() if vehicle is not None}

    def _drives(self, vehicles: dict[str, Vehicle]) -> dict[str, Drive]:
        drives: dict[str, Drive] = {}
        for i, section in self.file.lists.get("route", []):
            place = f"route[{i + 1}]"
            if section.vehicle not in vehicles:
                known = self.file.declared["vehicle"]
                if section.vehicle not in known:
                    self._unknown(f"{place}.vehicle", section.vehicle, sorted(known), "vehicle")
                continue
            path = np.array(section.path)
            route = self._try(
                f"{place}.path",
                lambda s=section, p=path: Route(points=p, law=ConstantSpeed(s.speed), name=s.name),
            )
            if route is not None:
                drives[section.name] = Drive(
                    route=route, vehicle=vehicles[section.vehicle], run_in=section.run_in
                )
        return drives

    def _band(self) -> tuple[RoughnessBand | None, bool]:
        section = self.file.tables.get("roughness")
        if section is None:
            return RoughnessBand(), True
        band = self._try(
            "roughness.n_max",
            lambda: RoughnessBand(
                n_min=section.n_min,
                n_max=section.n_max,
                contact_patch=section.contact_patch,
                gaussian_amplitudes=section.gaussian_amplitudes,
            ),
        )
        return band, section.n_max_follows_dt

    def _assessment(self) -> Assessment | None:
        section = self.file.tables.get("criteria")
        if section is None:
            return None
        own: list[Criterion] = []
        for i, name in enumerate(section.files):
            path = self.files.get(name, self.folder / name)
            read = self._try(f"criteria.files[{i + 1}]", lambda p=path: read_criteria(p))
            own += read or ()
            if read:
                self.read[name] = path.read_bytes()
        if self.problems and len(own) < len(section.files):
            return None  # a curve of a file that cannot be read is not a second mistake
        curves = [
            self._try(
                f"criteria.curves[{i + 1}]",
                lambda n=name: find_criterion(n, own),
                "see 'trundle criteria'",
            )
            for i, name in enumerate(section.curves)
        ]
        found = shaped((c for c in curves if c is not None), section.shape)
        return Assessment(
            criteria=found,
            method=section.method,
            percentile=section.percentile,
            averaging=section.averaging,
            events=section.events,
        )

    def _isolations(self) -> dict[str, Isolation]:
        found: dict[str, Isolation] = {}
        for i, section in self.file.lists.get("point", []):
            if section.isolator is not None:
                made = self._try(
                    f"point[{i + 1}].isolator", lambda s=section.isolator: isolation_of(s)
                )
                if made is not None:
                    found[section.name] = made
        return found

    def _unique_names(self) -> None:
        for kind, names in {
            "route and traffic": [s.name for k in ("route", "traffic") for s in self.file.items(k)],
            "point": [s.name for s in self.file.items("point")],
            "method": [s.name for s in self.file.items("method")],
            "road": [road_label(s) for s in self.file.items("road")],
        }.items():
            for name, times in Counter(names).items():
                if times > 1:
                    self.problems.append(
                        Problem(
                            place=kind,
                            value=f"{name!r} {times} times",
                            rule="names must differ, for results are found by them",
                            remedy="rename or remove one",
                        )
                    )

    def _unknown(self, place: str, value: str, known: Iterable[str], what: str) -> None:
        self.problems.append(
            Problem(
                place=place,
                value=repr(value),
                rule=f"must be the name of a {what} in this study",
                remedy=f"there are: {', '.join(known) or 'none'}",
            )
        )

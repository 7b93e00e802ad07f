"""Hold a study while it is put together from the sections of its file."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from trundle.errors import FitnessWarning, Problem
from trundle.road import Road, RoughnessBand
from trundle.signals import Isolation
from trundle.simulate import Source
from trundle.structure import FloorPlan, Structure, Surface, can_move
from trundle.structure.building import Building, Meshing
from trundle.structure.superelements import Parting
from trundle.study.map_plan import MapPlan
from trundle.study.model import Extent, extent_of
from trundle.study.plans import Assessment, Drive, MethodPlan
from trundle.study_file.document import StudyFile
from trundle.traffic import Schedule
from trundle.vehicle import Vehicle

__all__ = [
    "Draft",
    "covered",
    "is_off",
    "no_sway",
    "refer",
    "still_axes",
    "surface_at",
    "undrawn",
    "unique",
    "unknown",
]

_EDGE = 1e-6  # m


@dataclass(frozen=True, kw_only=True, eq=False)
class Draft:
    """Hold what is built so far; what is None, or missing, was not sound.

    Attributes
    ----------
    file : StudyFile
        The sections that are sound by themselves.
    folder : Path
        Where files are that it names.
    files : mapping of str to Path
        Where they are, if not there.
    plan : FloorPlan or None
        Plan of the floor.
    model : Structure or None
        The floor itself, where it came from a file or was built of a building.
    building : Building or None
        What it was built of.
    meshing : Meshing or None
        How that was meshed.
    parting : Parting or None
        How it is cut into parts, if it is.
    mesh_size : float
        Largest edge of an element [m].
    vehicles : mapping of str to Vehicle
        By name.
    drives : mapping of str to Drive
        Routes by name.
    sources : mapping of str to Source
        Other sources of vibration by name; a section adds its own.
    schedules : mapping of str to Schedule
        By name.
    roads : mapping of str to Road
        By label.
    band : RoughnessBand or None
        Waves that roads contain.
    band_follows_dt : bool
        Whether the band ends where the time step can no longer follow.
    methods : mapping of str to MethodPlan
        By name.
    assessment : Assessment or None
        What the response is held against.
    told : tuple of FitnessWarning
        What was noticed on the way.
    read : mapping of str to bytes
        Content of the files that were read.
    isolations : mapping of str to Isolation
        By point.
    map : MapPlan or None
        What is mapped.
    """

    file: StudyFile
    folder: Path
    files: Mapping[str, Path]
    plan: FloorPlan | None = None
    model: Structure | None = None
    building: Building | None = None
    meshing: Meshing | None = None
    parting: Parting | None = None
    mesh_size: float = 1.0
    vehicles: Mapping[str, Vehicle] = field(default_factory=dict[str, Vehicle])
    drives: Mapping[str, Drive] = field(default_factory=dict[str, Drive])
    sources: Mapping[str, Source] = field(default_factory=dict[str, Source])
    schedules: Mapping[str, Schedule] = field(default_factory=dict[str, Schedule])
    roads: Mapping[str, Road] = field(default_factory=dict[str, Road])
    band: RoughnessBand | None = None
    band_follows_dt: bool = True
    methods: Mapping[str, MethodPlan] = field(default_factory=dict[str, MethodPlan])
    assessment: Assessment | None = None
    told: tuple[FitnessWarning, ...] = ()
    read: Mapping[str, bytes] = field(default_factory=dict[str, bytes])
    isolations: Mapping[str, Isolation] = field(default_factory=dict[str, Isolation])
    map: MapPlan | None = None

    @property
    def acting(self) -> set[str]:
        """All names of what can act on the floor, also of what has mistakes."""
        return self.file.acting | set(self.sources)

    @property
    def extent(self) -> Extent | None:
        """Range of the floor along x and y [m]; None where there is none."""
        if self.plan is not None:
            return self.plan.x_extent, self.plan.y_extent
        return None if self.model is None else extent_of(self.model)


def unknown(place: str, value: str, known: Iterable[str], what: str) -> Problem:
    """Return the problem of a name that nothing in the study has."""
    return Problem(
        place=place,
        value=repr(value),
        rule=f"must be the name of a {what} in this study",
        remedy=f"there are: {', '.join(known) or 'none'}",
    )


def refer(place: str, value: str, known: Collection[str], what: str) -> Iterator[Problem]:
    """Give the problem of a name that nothing in the study has, if so.

    Parameters
    ----------
    place : str
        Where the name stands.
    value : str
        The name.
    known : collection of str
        Names that there are.
    what : str
        What it should be the name of.

    Yields
    ------
    Problem
        One, or nothing.
    """
    if value not in known:
        yield unknown(place, value, sorted(known), what)


def unique(named: Iterable[tuple[str, str]]) -> Iterator[Problem]:
    """Give the names that are there more than once, where each stands for the second time.

    Parameters
    ----------
    named : iterable of (str, str)
        Where what is named stands, and its name.

    Yields
    ------
    Problem
        One for each name.
    """
    places: dict[str, list[str]] = {}
    for place, name in named:
        places.setdefault(name, []).append(place)
    for name, there in places.items():
        if len(there) > 1:
            yield Problem(
                place=there[1],
                value=f"{name!r} {len(there)} times",
                rule="names must differ, for results are found by them",
                remedy=f"rename or remove one; the first is {there[0]}",
            )


def behind_the_end(draft: Draft, place: str, begins: float) -> Iterator[Problem]:
    """Give what begins when the record has ended: it would be in no result.

    Parameters
    ----------
    draft : Draft
        Its file says how long records are, or leaves them to end when all has left.
    place : str
        Where it says when it begins.
    begins : float
        When that is [s].

    Yields
    ------
    Problem
        One, or nothing.
    """
    duration = None if draft.file.general is None else draft.file.general.duration
    if duration is not None and begins >= duration:
        yield Problem(
            place=place,
            value=f"a beginning at {begins:g} s",
            rule=f"the record ends at {duration:g} s, and nothing of it would be in there",
            remedy="let it begin earlier, or lengthen or remove duration",
        )


def surface_at(
    draft: Draft, place: str, on: str | None
) -> tuple[Surface | None, Iterator[Problem]]:
    """Return the surface of a name, and the problem of a name that there is not.

    Parameters
    ----------
    draft : Draft
        With a model.
    place : str
        Where the name stands, or should.
    on : str or None
        The name; None for the only one.
    """
    if draft.model is None:
        return None, iter(_no_storeys(place, on) if draft.plan is not None else ())
    surfaces = draft.model.surfaces
    if on is None and len(surfaces) == 1:
        return next(iter(surfaces.values())), iter(())
    if on is not None and on in surfaces:
        return surfaces[on], iter(())
    problem = Problem(
        place=place,
        value="nothing" if on is None else repr(on),
        rule="must name a storey with a floor, or a ramp",
        remedy=f"there are: {', '.join(surfaces)}",
    )
    return None, iter([problem])


def _no_storeys(place: str, on: str | None) -> list[Problem]:
    if on is None:
        return []
    rule, remedy = "a [floor] of one storey has no other surface", "remove it"
    return [Problem(place=place, value=repr(on), rule=rule, remedy=remedy)]


def undrawn(draft: Draft, kind: str) -> Iterator[Problem]:
    """Give routes or points that name a layer of a drawing where there is no building to draw."""
    for i, section in draft.file.lists.get(kind, []):
        if section.drawn is not None and draft.building is None and _has_no_drawing(draft):
            yield Problem(
                place=f"{kind}[{i + 1}].drawn",
                value=repr(section.drawn),
                rule="a layer is one of [[building.drawing]], and this study has no building",
                remedy="give path" if kind == "route" else "give at",
            )


def _has_no_drawing(draft: Draft) -> bool:
    """Return whether there is no building of storeys, sound or not."""
    table = draft.file.tables.get("building")
    return "building" not in draft.file.given or (table is not None and table.kind != "storeys")


def is_off(extent: Extent, place: tuple[float, float]) -> bool:
    """Return whether a place is off the floor [m]."""
    (x0, x1), (y0, y1) = extent
    x, y = place
    return not (x0 - _EDGE <= x <= x1 + _EDGE and y0 - _EDGE <= y <= y1 + _EDGE)


def covered(extent: Extent) -> str:
    """Say where the floor is."""
    (x0, x1), (y0, y1) = extent
    return f"the floor covers x {x0:g} to {x1:g} m and y {y0:g} to {y1:g} m"


def still_axes(draft: Draft, place: str, axes: Sequence[str]) -> Iterator[Problem]:
    """Give axes along which nothing of a model moves, or along which its motion is not known.

    Parameters
    ----------
    draft : Draft
        With a model.
    place : str
        Where the axes stand.
    axes : sequence of str
        Those that are read.
    """
    model = draft.model
    still = [] if model is None else [a for a in axes if not can_move(model, "xyz".index(a))]
    if still:
        yield Problem(
            place=place,
            value=", ".join(still),
            rule="nothing of the model moves along it, or nobody says how",
            remedy="give the motion of nodes along it, or leave the axis out",
        )


def no_sway(place: str, axes: Sequence[str]) -> Problem:
    """Return the mistake of asking for level motion of what does not sway."""
    return Problem(
        place=place,
        value=", ".join(axes),
        rule="a storey whose columns end fixed does not sway as its building does: a [floor] "
        "is vertical only",
        remedy='model the [building], or leave axes = ["z"]',
    )

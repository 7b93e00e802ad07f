"""Define the sections of a study file.

Every section is checked by itself, so that the mistakes of all of them come at once.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Literal, Self, TypeAlias

from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from trundle.study_file.fields import (
    Acceleration,
    AreaDensity,
    DampingCoefficient,
    Density,
    Factor,
    Flag,
    Frequency,
    GroupName,
    Length,
    Line,
    Mass,
    Name,
    NonNegativeLength,
    Number,
    Place,
    PositiveLength,
    Pressure,
    Rate,
    Ratio,
    RotaryInertia,
    Section,
    Speed,
    Stiffness,
    Time,
    Wavenumber,
    Whole,
)
from trundle.vehicle import VEHICLES, wheel_mistake

__all__ = [
    "CriteriaSection",
    "DampingSection",
    "FloorSection",
    "GeneralSection",
    "IsolatorSection",
    "MapSection",
    "MethodSection",
    "NoteSection",
    "PlanFloorSection",
    "PointSection",
    "PrintedBoundSection",
    "PrintedSection",
    "PublicationSection",
    "ReferenceFloorSection",
    "RoadSection",
    "RoughnessSection",
    "RouteSection",
    "TrafficSection",
    "VehicleSection",
]

EdgeKind: TypeAlias = Literal["free", "symmetry", "simple", "pinned", "clamped"]
_MANY = 1_000_000


class GeneralSection(Section):
    """Title, seed, number of runs and record length: the keys above the first table."""

    title: Annotated[Line, Field(max_length=200)]
    seed: Annotated[Whole, Field(ge=0, lt=2**63)]
    runs: Annotated[Whole, Field(ge=1, le=_MANY)]
    duration: Time | None = None


class ReferenceFloorSection(Section):
    """The reference unit at a mesh size."""

    kind: Literal["reference_unit"]
    mesh_size: PositiveLength = 1.0


class RectangleSection(Section):
    """Width and depth of a beam or column."""

    width: PositiveLength
    depth: PositiveLength


class MaterialSection(Section):
    """An isotropic material."""

    elastic_modulus: Pressure
    poisson_ratio: Annotated[Number, Field(ge=0.0, lt=0.5)] = 0.2
    density: Density


class EdgesSection(Section):
    """How each edge of the plan is held."""

    x_min: EdgeKind = "free"
    x_max: EdgeKind = "free"
    y_min: EdgeKind = "free"
    y_max: EdgeKind = "free"


class PlanFloorSection(Section):
    """A rectangular storey of bays."""

    kind: Literal["plan"]
    mesh_size: PositiveLength
    x_lines: Annotated[tuple[Length, ...], Field(min_length=2)]
    y_lines: Annotated[tuple[Length, ...], Field(min_length=2)]
    x_extent: tuple[Length, Length] | None = None
    y_extent: tuple[Length, Length] | None = None
    slab_thickness: PositiveLength
    superimposed_mass: AreaDensity = 0.0
    material: MaterialSection
    beams_x: RectangleSection | None = None
    beams_y: RectangleSection | None = None
    secondary_y: RectangleSection | None = None
    secondary_per_bay: Annotated[Whole, Field(ge=1, le=50)] = 1
    column: RectangleSection | None = None
    storey_below: NonNegativeLength = 0.0
    storey_above: NonNegativeLength = 0.0
    eccentric_beams: Flag = True
    edges: EdgesSection = EdgesSection()


FloorSection: TypeAlias = Annotated[
    ReferenceFloorSection | PlanFloorSection, Field(discriminator="kind")
]


class BodySection(Section):
    """A rigid body of a planar vehicle."""

    mass: Annotated[Mass, Field(gt=0.0)]
    pitch_inertia: RotaryInertia = 0.0
    centre: Length = 0.0


class AxleSection(Section):
    """An axle of a planar vehicle."""

    body: Annotated[Whole, Field(ge=0)] = 0
    setback: NonNegativeLength
    stiffness: Annotated[Stiffness, Field(gt=0.0)]
    damping: DampingCoefficient = 0.0
    axle_mass: Mass = 0.0
    tyre_stiffness: Stiffness = 0.0
    tyre_damping: DampingCoefficient = 0.0

    @model_validator(mode="after")
    def _check_wheel(self) -> Self:
        if mistake := wheel_mistake(self.axle_mass, self.tyre_stiffness, self.tyre_damping):
            raise PydanticCustomError("rule", "{rule}", {"rule": mistake})
        return self


class HingeSection(Section):
    """A hinge between two bodies of a planar vehicle."""

    bodies: tuple[Whole, Whole]
    setback: Length


class PlanarVehicleSection(Section):
    """A vehicle built from bodies, hinges and axles."""

    kind: Literal["planar"]
    bodies: Annotated[tuple[BodySection, ...], Field(min_length=1)]
    axles: Annotated[tuple[AxleSection, ...], Field(min_length=1)]
    hinges: tuple[HingeSection, ...] = ()


if TYPE_CHECKING:
    LibraryKind: TypeAlias = str
else:  # the names are known only when the folder of vehicles has been read
    LibraryKind = Literal[tuple(VEHICLES)]


class LibraryVehicleSection(Section):
    """A vehicle of the library."""

    kind: LibraryKind


VehicleSection: TypeAlias = Annotated[
    LibraryVehicleSection | PlanarVehicleSection, Field(discriminator="kind")
]


class RoadSection(Section):
    """A road class."""

    class_: Annotated[Literal["A", "B", "C", "D", "E", "F", "G", "H"], Field(alias="class")]
    level: Literal["lower", "geometric_mean", "upper"] = "geometric_mean"
    waviness: Annotated[Number, Field(ge=1.0, le=4.0)] = 2.0


class RoughnessSection(Section):
    """What waves a synthetic road contains."""

    n_min: Wavenumber = 0.011
    n_max: Wavenumber = 2.83
    n_max_follows_dt: Flag = True
    contact_patch: NonNegativeLength = 0.0
    gaussian_amplitudes: Flag = False


class RouteSection(Section):
    """Where a vehicle drives, and how fast."""

    name: GroupName
    vehicle: Name
    path: Annotated[tuple[Place, ...], Field(min_length=2)]
    speed: Speed
    run_in: NonNegativeLength | None = None


class TrafficSection(Section):
    """Several routes driven at once."""

    name: GroupName
    routes: Annotated[tuple[Name, ...], Field(min_length=2)]


class IsolatorSection(Section):
    """What stands between floor and tool: a mass on a spring and a damper, or a table."""

    frequency: Frequency | None = None
    damping: Ratio | None = None
    table: Annotated[tuple[tuple[Frequency, Factor], ...], Field(min_length=2)] | None = None


class PointSection(Section):
    """A place where the response is read, on the floor or behind an isolator there."""

    name: Name
    at: Place
    isolator: IsolatorSection | None = None


class DampingSection(Section):
    """Damping of the floor: a ratio in every mode, or Rayleigh's two coefficients."""

    ratio: Ratio | None = None
    rayleigh_alpha: Rate | None = None
    rayleigh_beta: Time | None = None


class MethodSection(Section):
    """How vehicle and floor are computed."""

    name: GroupName
    interaction: Literal["decoupled", "coupled"]
    integration: Literal["modal", "newmark"] = "modal"
    f_max: Frequency | None = None
    precision: Literal["double", "single"] = "double"
    dt: Time
    n_max: Wavenumber | None = None
    contact_patch: NonNegativeLength | None = None
    damping: DampingSection
    contact: Literal["smooth", "hat"] = "smooth"
    entry: Literal["drive_in", "ramp", "static", "abrupt"] = "drive_in"
    entry_length: PositiveLength | None = None


class CriteriaSection(Section):
    """What the response is held against, and by which method's result."""

    curves: Annotated[tuple[str, ...], Field(min_length=1)]
    method: Name
    percentile: Annotated[Number, Field(gt=0.0, le=100.0)] = 95.0
    averaging: Literal["max_1s", "slow", "fast", "event"] = "max_1s"
    events: Annotated[Number, Field(ge=1.0, le=1e6)] = 1.0
    files: tuple[Line, ...] = ()
    shape: Literal["rising", "flat"] = "rising"


class MapSection(Section):
    """What is mapped over the whole floor, by the method that carries the verdict."""

    places: Literal["grid", "nodes"] = "grid"
    spacing: PositiveLength | None = None
    runs: Annotated[Whole, Field(ge=1, le=_MANY)] | None = None
    criterion: str | None = None
    traffic: Flag = False
    speeds: Annotated[tuple[Speed, ...], Field(max_length=20)] = ()
    every_step: Flag = False
    peaks: Flag = False


class PrintedSection(Section):
    """A published pair of values to hold beside ours."""

    case: Name
    road: str
    method: Name
    peak_acceleration: Acceleration
    rms_velocity: Speed


class PrintedBoundSection(Section):
    """A published upper bound to hold beside ours."""

    bound: Literal["single", "absolute maximum", "multiple vehicles"]
    road: str
    method: Name
    peak_acceleration: Acceleration
    rms_velocity: Speed


class PublicationSection(Section):
    """What a publication says of this study: numbers of its figures and tables, its sources."""

    numbers: dict[Name, Line] = Field(default_factory=dict[Name, Line])
    force_speeds: Annotated[tuple[Speed, ...], Field(max_length=10)] = ()
    sources: tuple[Line, ...] = ()


class NoteSection(Section):
    """A note that the report prints."""

    title: Annotated[Line, Field(max_length=200)]
    text: Annotated[str, Field(min_length=1, max_length=5000)]

"""Vehicles: of the library by name, by a data sheet, or built from bodies, hinges and axles."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Annotated, Any, Literal, Self, TypeAlias

from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from trundle.errors import Problem
from trundle.study_file.attempt import attempted
from trundle.study_file.draft import Draft
from trundle.study_file.fields import (
    AxleLoad,
    DampingCoefficient,
    Flag,
    Frequency,
    Length,
    Mass,
    NonNegativeLength,
    PositiveLength,
    Ratio,
    RotaryInertia,
    RotationalStiffness,
    Section,
    Stiffness,
    Whole,
)
from trundle.study_file.kinds import SectionKind
from trundle.study_file.lines import shown_key
from trundle.study_file.vehicle_changes import ChangedSection
from trundle.vehicle import (
    VEHICLES,
    Axle,
    Body,
    Bogie,
    DataSheet,
    Description,
    Hinge,
    Vehicle,
    describe,
    wheel_mistake,
)

__all__ = ["VEHICLE", "build"]


class BodySection(Section):
    """A rigid body."""

    mass: Annotated[Mass, Field(gt=0.0)]
    """Mass of the body."""
    pitch_inertia: RotaryInertia = 0.0
    """About the transverse axis through its centre; with 0 it only bounces."""
    centre: Length = 0.0
    """Distance of its centre of mass behind the front axle."""
    roll_inertia: RotaryInertia = 0.0
    """About the axis along the vehicle; with 0 it does not roll."""
    aside: Length = 0.0
    """Distance of its centre of mass to the left of the centre line."""
    height: NonNegativeLength = 0.0
    """Of its centre of mass above the ground: by it braking makes it pitch."""


class AxleSection(Section):
    """An axle."""

    body: Annotated[Whole, Field(ge=0)] = 0
    """Number of the body that it carries, from 0."""
    setback: NonNegativeLength
    """Distance behind the front axle."""
    stiffness: Annotated[Stiffness, Field(gt=0.0)]
    """Of the suspension; of suspension and tyre in series where axle_mass is 0."""
    damping: DampingCoefficient = 0.0
    """Of the suspension, likewise."""
    axle_mass: Mass = 0.0
    """Unsprung mass between suspension and tyre."""
    tyre_stiffness: Stiffness = 0.0
    """Of the axle's tyres together; only with an axle_mass."""
    tyre_damping: DampingCoefficient = 0.0
    """Of the axle's tyres together; only with an axle_mass."""
    track_width: NonNegativeLength = 0.0
    """Between the wheels of both sides; 0 takes both as one."""
    spring_track: NonNegativeLength = 0.0
    """Between the springs of both sides; as between the wheels unless given."""
    roll_inertia: RotaryInertia = 0.0
    """Of the axle about its middle; that of two wheels at its ends unless given."""
    roll_stiffness: RotationalStiffness = 0.0
    """Of an anti-roll bar between body and axle."""
    independent: Flag = False
    """Whether each wheel moves by itself, and not on a rigid axle."""

    @model_validator(mode="after")
    def _check_wheel(self) -> Self:
        if mistake := wheel_mistake(self.axle_mass, self.tyre_stiffness, self.tyre_damping):
            raise PydanticCustomError("rule", "{rule}", {"rule": mistake})
        return self


class BogieSection(Section):
    """Axles on one beam that rocks."""

    body: Annotated[Whole, Field(ge=0)] = 0
    """Number of the body that it carries, from 0."""
    setback: Length
    """Of its suspension, behind the front axle."""
    stiffness: Annotated[Stiffness, Field(gt=0.0)]
    """Of the suspension between body and beam."""
    damping: DampingCoefficient = 0.0
    """Of the suspension between body and beam."""
    mass: Annotated[Mass, Field(gt=0.0)]
    """Of the beam with its axles."""
    pitch_inertia: RotaryInertia = 0.0
    """Of the beam with its axles; it rocks about the suspension."""
    wheels: Annotated[tuple[Length, ...], Field(min_length=1)]
    """Places of the axles behind the suspension."""
    tyre_stiffness: Annotated[Stiffness, Field(gt=0.0)]
    """Of each axle's tyres."""
    tyre_damping: DampingCoefficient = 0.0
    """Of each axle's tyres."""


class HingeSection(Section):
    """A hinge between two bodies."""

    bodies: tuple[Whole, Whole]
    """Numbers of the two bodies, from 0."""
    setback: Length
    """Distance behind the front axle."""
    rolls_together: Flag = True
    """Whether both roll as one, as over a fifth wheel."""


class PlanarVehicleSection(ChangedSection):
    """A vehicle built from bodies, hinges, axles and bogies."""

    kind: Literal["planar"]
    """A vehicle of bodies, hinges, axles and bogies."""
    bodies: Annotated[tuple[BodySection, ...], Field(min_length=1)]
    """Its rigid bodies."""
    axles: tuple[AxleSection, ...] = ()
    """Its axles."""
    bogies: tuple[BogieSection, ...] = ()
    """Axles on one beam that rocks."""
    hinges: tuple[HingeSection, ...] = ()
    """What joins its bodies."""

    @model_validator(mode="after")
    def _check_axles(self) -> Self:
        if not self.axles and not self.bogies:
            rule = "a vehicle needs axles, or bogies"
            raise PydanticCustomError("rule", "{rule}", {"rule": rule})
        return self


class DataSheetSection(ChangedSection):
    """A vehicle as its data sheet tells it."""

    kind: Literal["data_sheet"]
    """A vehicle as its data sheet tells it."""
    axle_loads: Annotated[tuple[AxleLoad, ...], Field(min_length=1)]
    """What each axle carries, axles and wheels included: "2.65 t" or "26 kN"."""
    laden_axle_loads: tuple[AxleLoad, ...] = ()
    """The same with the payload."""
    laden: Flag = False
    """Whether it drives with the payload."""
    wheelbase: PositiveLength | None = None
    """Between its two axles."""
    setbacks: tuple[NonNegativeLength, ...] = ()
    """Places of all axles behind the front one, in place of a wheelbase."""
    bounce: Frequency | None = None
    """Natural frequency of the mass over each axle."""
    hop: Frequency | None = None
    """Natural frequency of each axle between springs and tyres; with unsprung."""
    damping: Ratio = 0.05
    """Ratio of critical damping of its bounce."""
    unsprung: tuple[Annotated[Mass, Field(gt=0.0)], ...] = ()
    """Mass of each axle with its wheels."""
    stiffness: tuple[Annotated[Stiffness, Field(gt=0.0)], ...] = ()
    """Of each axle's suspension, in place of bounce."""
    tyre_stiffness: tuple[Annotated[Stiffness, Field(gt=0.0)], ...] = ()
    """Of each axle's tyres, in place of hop."""

    @model_validator(mode="after")
    def _check_places(self) -> Self:
        rule = ""
        n = len(self.axle_loads)
        if n > 1 and (self.wheelbase is None) == (not self.setbacks):
            rule = "say where axles are once: wheelbase of two, or setbacks of all"
        elif self.wheelbase is not None and n != 2:
            rule = f"a wheelbase is of two axles; with {n} give setbacks"
        if rule:
            raise PydanticCustomError("rule", "{rule}", {"rule": rule})
        return self

    def sheet(self, name: str) -> DataSheet:
        """Return what the section says."""
        setbacks = self.setbacks or ((0.0,) if self.wheelbase is None else (0.0, self.wheelbase))
        return DataSheet(
            name=name, setbacks=setbacks, loads=self.axle_loads, laden=self.laden_axle_loads,
            bounce=self.bounce or 0.0, hop=self.hop or 0.0, damping=self.damping,
            unsprung=self.unsprung, stiffness=self.stiffness, tyre_stiffness=self.tyre_stiffness,
            source="study file",
        )  # fmt: skip


if TYPE_CHECKING:
    LibraryKind: TypeAlias = str
else:  # the names are known only when the folder of vehicles has been read
    LibraryKind = Literal[tuple(VEHICLES)]


class LibraryVehicleSection(ChangedSection):
    """A vehicle of the library."""

    kind: LibraryKind
    """Its name in the library; 'trundle vehicles' lists them."""
    bounce: Frequency | None = None
    """In place of the library's; of one that is known by its data sheet."""
    damping: Ratio | None = None
    """In place of the library's, likewise."""
    tyre_stiffness: tuple[Annotated[Stiffness, Field(gt=0.0)], ...] = ()
    """In place of the library's, likewise, of each axle."""

    @property
    def changes(self) -> dict[str, Any]:
        """What it says in place of the library's data sheet."""
        said: dict[str, Any] = {"bounce": self.bounce, "damping": self.damping}
        said["tyre_stiffness"] = self.tyre_stiffness or None
        return {key: value for key, value in said.items() if value is not None}


VehicleSection: TypeAlias = Annotated[
    LibraryVehicleSection | PlanarVehicleSection | DataSheetSection, Field(discriminator="kind")
]


VEHICLE = SectionKind(name="vehicle", schema=VehicleSection, form="named", required=True)


def build(draft: Draft) -> tuple[Draft, list[Problem]]:
    """Return the draft with its vehicles."""
    vehicles: dict[str, Vehicle] = {}
    found: list[Problem] = []
    for name, section in draft.file.vehicles.items():
        vehicle, mistakes = attempted(
            f"vehicle.{shown_key(name)}", lambda n=name, s=section: vehicle_of(n, s)
        )
        found += mistakes
        if vehicle is not None:
            vehicles[name] = vehicle
    return replace(draft, vehicles=vehicles), found


def vehicle_of(name: str, section: Any) -> Vehicle:
    """Return a vehicle, built or from the library."""
    return section.changed(_described(name, section)).build()


def _described(name: str, section: Any) -> Description:
    if isinstance(section, PlanarVehicleSection):
        return Description(
            name=name,
            bodies=tuple(Body(**dict(b)) for b in section.bodies),
            axles=tuple(Axle(**dict(a)) for a in section.axles),
            bogies=tuple(Bogie(**dict(b)) for b in section.bogies),
            hinges=tuple(Hinge(**dict(h)) for h in section.hinges),
            source="study file",
        )
    if isinstance(section, DataSheetSection):
        return section.sheet(name).description(laden=section.laden)
    return describe(section.kind, section.changes)

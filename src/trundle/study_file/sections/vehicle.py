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
    pitch_inertia: RotaryInertia = 0.0
    centre: Length = 0.0
    roll_inertia: RotaryInertia = 0.0
    aside: Length = 0.0
    height: NonNegativeLength = 0.0


class AxleSection(Section):
    """An axle."""

    body: Annotated[Whole, Field(ge=0)] = 0
    setback: NonNegativeLength
    stiffness: Annotated[Stiffness, Field(gt=0.0)]
    damping: DampingCoefficient = 0.0
    axle_mass: Mass = 0.0
    tyre_stiffness: Stiffness = 0.0
    tyre_damping: DampingCoefficient = 0.0
    track_width: NonNegativeLength = 0.0
    spring_track: NonNegativeLength = 0.0
    roll_inertia: RotaryInertia = 0.0
    roll_stiffness: RotationalStiffness = 0.0
    independent: Flag = False

    @model_validator(mode="after")
    def _check_wheel(self) -> Self:
        if mistake := wheel_mistake(self.axle_mass, self.tyre_stiffness, self.tyre_damping):
            raise PydanticCustomError("rule", "{rule}", {"rule": mistake})
        return self


class BogieSection(Section):
    """Axles on one beam that rocks."""

    body: Annotated[Whole, Field(ge=0)] = 0
    setback: Length
    stiffness: Annotated[Stiffness, Field(gt=0.0)]
    damping: DampingCoefficient = 0.0
    mass: Annotated[Mass, Field(gt=0.0)]
    pitch_inertia: RotaryInertia = 0.0
    wheels: Annotated[tuple[Length, ...], Field(min_length=1)]
    tyre_stiffness: Annotated[Stiffness, Field(gt=0.0)]
    tyre_damping: DampingCoefficient = 0.0


class HingeSection(Section):
    """A hinge between two bodies."""

    bodies: tuple[Whole, Whole]
    setback: Length
    rolls_together: Flag = True


class PlanarVehicleSection(ChangedSection):
    """A vehicle built from bodies, hinges, axles and bogies."""

    kind: Literal["planar"]
    bodies: Annotated[tuple[BodySection, ...], Field(min_length=1)]
    axles: tuple[AxleSection, ...] = ()
    bogies: tuple[BogieSection, ...] = ()
    hinges: tuple[HingeSection, ...] = ()

    @model_validator(mode="after")
    def _check_axles(self) -> Self:
        if not self.axles and not self.bogies:
            rule = "a vehicle needs axles, or bogies"
            raise PydanticCustomError("rule", "{rule}", {"rule": rule})
        return self


class DataSheetSection(ChangedSection):
    """A vehicle as its data sheet tells it."""

    kind: Literal["data_sheet"]
    axle_loads: Annotated[tuple[AxleLoad, ...], Field(min_length=1)]
    laden_axle_loads: tuple[AxleLoad, ...] = ()
    laden: Flag = False
    wheelbase: PositiveLength | None = None
    setbacks: tuple[NonNegativeLength, ...] = ()
    bounce: Frequency | None = None
    hop: Frequency | None = None
    damping: Ratio = 0.05
    unsprung: tuple[Annotated[Mass, Field(gt=0.0)], ...] = ()
    stiffness: tuple[Annotated[Stiffness, Field(gt=0.0)], ...] = ()
    tyre_stiffness: tuple[Annotated[Stiffness, Field(gt=0.0)], ...] = ()

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
    bounce: Frequency | None = None
    damping: Ratio | None = None
    tyre_stiffness: tuple[Annotated[Stiffness, Field(gt=0.0)], ...] = ()

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

"""Vehicles: of the library by name, or built from bodies, hinges and axles."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Annotated, Any, Literal, Self, TypeAlias

from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from trundle.errors import Problem
from trundle.study_file.attempt import attempted
from trundle.study_file.draft import Draft
from trundle.study_file.fields import (
    DampingCoefficient,
    Length,
    Mass,
    NonNegativeLength,
    RotaryInertia,
    Section,
    Stiffness,
    Whole,
)
from trundle.study_file.kinds import SectionKind
from trundle.vehicle import (
    VEHICLES,
    Axle,
    Body,
    Hinge,
    Vehicle,
    build_vehicle,
    library_vehicle,
    wheel_mistake,
)

__all__ = ["VEHICLE", "build"]


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


VEHICLE = SectionKind(name="vehicle", schema=VehicleSection, form="named", required=True)


def build(draft: Draft) -> tuple[Draft, list[Problem]]:
    """Return the draft with its vehicles."""
    vehicles: dict[str, Vehicle] = {}
    found: list[Problem] = []
    for name, section in draft.file.vehicles.items():
        vehicle, mistakes = attempted(f"vehicle.{name}", lambda n=name, s=section: vehicle_of(n, s))
        found += mistakes
        if vehicle is not None:
            vehicles[name] = vehicle
    return replace(draft, vehicles=vehicles), found


def vehicle_of(name: str, section: Any) -> Vehicle:
    """Return a vehicle, built or from the library."""
    if isinstance(section, PlanarVehicleSection):
        return build_vehicle(
            name=name,
            bodies=tuple(Body(**dict(b)) for b in section.bodies),
            axles=tuple(Axle(**dict(a)) for a in section.axles),
            hinges=tuple(Hinge(**dict(h)) for h in section.hinges),
            source="study file",
        )
    return library_vehicle(section.kind)

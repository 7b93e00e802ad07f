"""What a study says of a vehicle besides what it is: payload, track, tyres, what shakes it."""

from __future__ import annotations

from dataclasses import replace
from typing import Annotated

import numpy as np
from pydantic import Field

from trundle.errors import InputError
from trundle.study_file.fields import (
    Angle,
    AnyTime,
    Flag,
    Force,
    Frequency,
    Length,
    Mass,
    Name,
    NonNegativeLength,
    Number,
    PositiveLength,
    RotaryInertia,
    Section,
    Stiffness,
    Whole,
)
from trundle.vehicle import BodyForce, Description, Friction, OutOfRound, Stop

__all__ = ["ChangedSection"]


class PayloadSection(Section):
    """What a vehicle carries, and where."""

    mass: Annotated[Mass, Field(gt=0.0)]
    """Of the payload."""
    setback: Length
    """Of its centre, behind the front axle."""
    aside: Length = 0.0
    """Of its centre, to the left of the centre line."""
    body: Annotated[Whole, Field(ge=0)] = 0
    """Number of the body that carries it, from 0."""


class OutOfRoundSection(Section):
    """A wave round the wheels."""

    amplitude: PositiveLength
    """Of the wave."""
    radius: PositiveLength
    """Of the wheel."""
    order: Annotated[Whole, Field(ge=1, le=200)] = 1
    """Waves round the wheel: 1 is runout, more the lugs of a tread."""
    axle: Annotated[Whole, Field(ge=1)] | None = None
    """Number of the axle, from 1; every one unless given."""
    phase: Angle = 0.0
    """Where the wave begins."""


class BodyForceSection(Section):
    """A force on a body: an engine, a driveline, lifting gear."""

    name: Name = "engine"
    """What it is called."""
    amplitude: Annotated[Force, Field(gt=0.0)]
    """Of the force."""
    body: Annotated[Whole, Field(ge=0)] = 0
    """Number of the body that it acts on, from 0."""
    setback: Length = 0.0
    """Where it acts, behind the front axle."""
    aside: Length = 0.0
    """Where it acts, to the left of the centre line."""
    frequency: Frequency | None = None
    """Of the force."""
    order: Annotated[Number, Field(gt=0.0)] | None = None
    """Waves a turn of a wheel of radius, in place of a frequency."""
    radius: PositiveLength | None = None
    """Of the wheel that it turns with."""
    phase: Angle = 0.0
    """Of the force at the start."""
    from_: Annotated[AnyTime | None, Field(alias="from")] = None
    """When it begins; it was there before unless given."""
    to: AnyTime | None = None
    """When it ends; it goes on unless given."""


class FrictionSection(Section):
    """Friction of a leaf spring."""

    axle: Annotated[Whole, Field(ge=1)]
    """Number of the axle, from 1."""
    force: Annotated[Force, Field(gt=0.0)]
    """At which the spring slips."""
    stiffness: Annotated[Stiffness, Field(gt=0.0)]
    """Of the spring until it slips."""


class StopSection(Section):
    """A stop behind a gap."""

    axle: Annotated[Whole, Field(ge=1)]
    """Number of the axle, from 1."""
    gap: NonNegativeLength
    """Until the stop is met."""
    stiffness: Annotated[Stiffness, Field(gt=0.0)]
    """Of the stop."""


class ChangedSection(Section):
    """What may be said of every vehicle besides what it is."""

    payload: PayloadSection | None = None
    """A load where it stands."""
    track_width: PositiveLength | None = None
    """Between left and right wheels, which then roll on tracks of their own."""
    roll_inertia: tuple[RotaryInertia, ...] = ()
    """Of each body; a radius of gyration of 0.42 track widths unless given."""
    contact_patch: NonNegativeLength | None = None
    """Length over which its tyres average the road; that of [roughness] wins."""
    wheel_radius: NonNegativeLength | None = None
    """Of a hard wheel, which rolls over gaps as a disc does."""
    heights: tuple[NonNegativeLength, ...] = ()
    """Of each body's centre of mass above the ground: braking makes it pitch."""
    out_of_round: tuple[OutOfRoundSection, ...] = ()
    """What is not round of its wheels."""
    force: tuple[BodyForceSection, ...] = ()
    """What shakes its bodies: an engine, a pump, a mast."""
    friction: tuple[FrictionSection, ...] = ()
    """Leaf springs that rub."""
    stop: tuple[StopSection, ...] = ()
    """Stops behind gaps."""
    lifts_off: Flag = False
    """Whether wheels leave the ground where they would pull on it."""

    def changed(self, one: Description) -> Description:
        """Return a vehicle as this section wants it."""
        if self.track_width is None and self.roll_inertia:
            raise InputError("roll_inertia is of a vehicle in space: give its track_width too")
        if self.track_width is not None:
            one = one.widened(self.track_width, roll_inertia=self.roll_inertia)
        if self.payload is not None:
            load = self.payload
            one = one.loaded(load.mass, body=load.body, setback=load.setback, aside=load.aside)
            if load.aside and not any(body.roll_inertia for body in one.bodies):
                raise InputError(
                    "a payload aside of the middle rolls its vehicle: give the vehicle's "
                    "track_width too"
                )
        keys = ("contact_patch", "wheel_radius")
        said = {key: getattr(self, key) for key in keys if getattr(self, key) is not None}
        rounds = tuple(_round_of(r) for r in self.out_of_round)
        forces = tuple(_force_of(f) for f in self.force)
        laws = (
            *(Friction(axle=f.axle - 1, force=f.force, stiffness=f.stiffness)
              for f in self.friction),
            *(Stop(axle=f.axle - 1, gap=f.gap, stiffness=f.stiffness) for f in self.stop),
        )  # fmt: skip
        return replace(
            self._raised(one), **said, rounds=rounds, forces=forces, laws=laws,
            lifts_off=self.lifts_off,
        )  # fmt: skip

    def _raised(self, one: Description) -> Description:
        """Return a vehicle whose bodies' centres are as high as this section says."""
        if not self.heights:
            return one
        if len(self.heights) != len(one.bodies):
            raise InputError(
                f"heights gives {len(self.heights)} numbers for {len(one.bodies)} bodies: one each"
            )
        bodies = zip(one.bodies, self.heights, strict=True)
        return replace(one, bodies=tuple(replace(body, height=h) for body, h in bodies))


def _round_of(section: OutOfRoundSection) -> OutOfRound:
    axle = None if section.axle is None else section.axle - 1
    return OutOfRound(
        amplitude=section.amplitude, radius=section.radius, order=section.order,
        phase=section.phase, axle=axle,
    )  # fmt: skip


def _force_of(section: BodyForceSection) -> BodyForce:
    low = -np.inf if section.from_ is None else section.from_
    high = np.inf if section.to is None else section.to
    return BodyForce(
        name=section.name, amplitude=section.amplitude, body=section.body,
        setback=section.setback, aside=section.aside, frequency=section.frequency or 0.0,
        order=section.order or 0.0, radius=section.radius or 0.0, phase=section.phase,
        during=(low, high),
    )  # fmt: skip

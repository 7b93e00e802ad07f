"""Machines: rotors out of balance, harmonics, run-ups, blows, on mounts or not."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Annotated, Self

import numpy as np
from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from trundle.errors import Problem
from trundle.machine import Harmonics, MachineForce, RunUp, Strokes, Unbalance
from trundle.signals import Isolator
from trundle.simulate.sources.machine import Machine
from trundle.study_file.attempt import attempted
from trundle.study_file.draft import Draft, behind_the_end, surface_at
from trundle.study_file.fields import (
    AnyTime,
    Flag,
    Force,
    Frequency,
    GroupName,
    Impulse,
    Mass,
    Name,
    Place,
    Ratio,
    Section,
    Speed,
    Time,
)
from trundle.study_file.fields import Unbalance as MassRadius
from trundle.study_file.kinds import SectionKind
from trundle.study_file.way_checks import standing_problems

__all__ = ["MACHINE", "build", "problems"]

_Amplitude = Annotated[Force, Field(gt=0.0)]
_WAYS = ("rotor", "harmonics", "run_up", "blows")


class RotorSection(Section):
    """A rotor out of balance: by its unbalance, or by a balance grade and its mass."""

    speed: Frequency
    """How fast it turns; rpm is understood."""
    unbalance: MassRadius | None = None
    """Mass times radius, such as "500 g mm"."""
    grade: Speed | None = None
    """Balance grade, e omega: "6.3 mm/s" is G 6.3."""
    mass: Annotated[Mass | None, Field(gt=0.0)] = None
    """Of the rotor, with its grade."""

    @model_validator(mode="after")
    def _check_kind(self) -> Self:
        by_grade = (self.grade is not None, self.mass is not None)
        if (self.unbalance is None) != all(by_grade) or any(by_grade) != all(by_grade):
            rule = "a rotor has an unbalance, or a grade (6.3 mm/s for G 6.3) and its mass"
            raise PydanticCustomError("rule", "{rule}", {"rule": rule})
        return self

    def force(self) -> MachineForce:
        """Return what it presses with."""
        if self.unbalance is not None:
            return Unbalance(mass_radius=self.unbalance, frequency=self.speed)
        return Unbalance.of_grade(
            grade=self.grade or 0.0, rotor_mass=self.mass or 0.0, frequency=self.speed
        )


class RunUpSection(Section):
    """A speed that goes evenly from one to another: of a rotor, or of a shaker."""

    from_: Annotated[Frequency, Field(alias="from")]
    """Frequency at the beginning."""
    to: Frequency
    """Frequency at the end."""
    takes: Time
    """How long it takes."""
    unbalance: MassRadius = 0.0
    """Mass times radius; the force grows with the speed squared."""
    amplitude: Force = 0.0
    """Of a force that does not grow with the speed."""

    def force(self) -> MachineForce:
        """Return what it presses with."""
        return RunUp(
            f_from=self.from_, f_to=self.to, takes=self.takes, mass_radius=self.unbalance,
            amplitude=self.amplitude,
        )  # fmt: skip


class BlowsSection(Section):
    """Blows of half a sine, one or one every so often."""

    impulse: Impulse
    """Of one blow."""
    contact_time: Time
    """How long a blow lasts."""
    every: Time | None = None
    """Time from blow to blow; there is one unless given."""
    first: AnyTime = 1.0
    """When the first blow begins."""

    def force(self) -> MachineForce:
        """Return what it presses with."""
        return Strokes(
            impulse=self.impulse, contact_time=self.contact_time, first=self.first,
            every=np.inf if self.every is None else self.every,
        )  # fmt: skip


class MountsSection(Section):
    """What stands between machine and floor."""

    frequency: Frequency
    """Natural frequency of the machine on its mounts."""
    damping: Ratio
    """Ratio of critical damping of the mounts."""


class MachineSection(Section):
    """A machine on the floor."""

    name: GroupName
    """How results and traffic call it."""
    at: Place | None = None
    """Where it stands."""
    feet: Annotated[tuple[Place, ...] | None, Field(min_length=1)] = None
    """Where its feet stand, which share the force; in place of at."""
    on: Name | None = None
    """Surface on which it stands, where there are several."""
    rotor: RotorSection | None = None
    """A rotor out of balance."""
    harmonics: Annotated[tuple[tuple[Frequency, _Amplitude], ...] | None, Field(min_length=1)] = (
        None
    )
    """Frequencies and amplitudes of its force."""
    run_up: RunUpSection | None = None
    """A speed that goes evenly from one to another."""
    blows: BlowsSection | None = None
    """Blows of half a sine."""
    mounts: MountsSection | None = None
    """What stands between it and the floor; nothing unless given."""
    starts: AnyTime = 0.0
    """When it starts."""
    lasts: Time | None = None
    """How long it runs; without it, it never stops."""
    random_phase: Flag = True
    """Whether its phase is drawn anew in every run."""

    @model_validator(mode="after")
    def _check_kind(self) -> Self:
        given = [key for key in _WAYS if getattr(self, key) is not None]
        rule = ""
        if len(given) != 1:
            rule = f"a machine has one of {', '.join(_WAYS)}; got {' and '.join(given) or 'none'}"
        elif (self.at is None) == (self.feet is None):
            rule = "a machine stands at one place, or on several feet: give at or feet"
        if rule:
            raise PydanticCustomError("rule", "{rule}", {"rule": rule})
        return self

    def force(self) -> MachineForce:
        """Return what it presses with."""
        if self.harmonics is not None:
            f, amplitude = np.array(self.harmonics).T
            return Harmonics(frequencies=f, amplitudes=amplitude, phases=np.zeros_like(f))
        made = self.rotor or self.run_up or self.blows
        assert made is not None  # checked above
        return made.force()

    @property
    def places(self) -> tuple[Place, ...]:
        """Where its feet stand."""
        return self.feet or (() if self.at is None else (self.at,))


MACHINE = SectionKind(name="machine", schema=MachineSection, form="list", shakes=True)


def build(draft: Draft) -> tuple[Draft, list[Problem]]:
    """Return the draft with its machines."""
    machines: dict[str, Machine] = {}
    found: list[Problem] = []
    for i, section in draft.file.lists.get("machine", []):
        machine, mistakes = attempted(
            f"machine[{i + 1}]", lambda s=section, i=i: _machine(draft, s, f"machine[{i + 1}].on")
        )
        found += mistakes
        if machine is not None:
            machines[section.name] = machine
    return replace(draft, sources={**draft.sources, **machines}), found


def _machine(draft: Draft, section: MachineSection, place: str) -> Machine:
    surface, _ = surface_at(draft, place, section.on)
    feet = np.array(section.places)
    mounts = section.mounts
    return Machine(
        name=section.name,
        feet=feet if surface is None else surface.frame.from_plan(feet),
        force=section.force(),
        on=section.on,
        mounts=mounts and Isolator(frequency=mounts.frequency, damping_ratio=mounts.damping),
        starts=section.starts,
        lasts=np.inf if section.lasts is None else section.lasts,
        random_phase=section.random_phase,
    )


def problems(draft: Draft) -> Iterator[Problem]:
    """Give machines off the floor, and steps that do not show how fast they shake."""
    for i, section in draft.file.lists.get("machine", []):
        place = f"machine[{i + 1}]"
        key = "at" if section.feet is None else "feet"
        yield from standing_problems(draft, place, key, section.places, section.on)
        first = 0.0 if section.blows is None else section.blows.first
        key = "blows.first" if first > 0.0 else "starts"
        yield from behind_the_end(draft, f"{place}.{key}", section.starts + first)
        machine = draft.sources.get(section.name)
        if machine is None:
            continue
        for method in draft.methods.values():
            dt = method.interaction.integration.dt
            _, mistakes = attempted(place, lambda m=machine, dt=dt: m.check(dt, None))
            yield from mistakes

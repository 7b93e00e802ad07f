"""Describe a vehicle by its parts, change the description, and build it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from trundle._checks import positive
from trundle._kinds import kinds_checked
from trundle._typing import Array
from trundle.dynamics import LinearSystem
from trundle.errors import InputError
from trundle.vehicle.assembly import Assembly, assembled
from trundle.vehicle.excitation import BodyForce, OutOfRound
from trundle.vehicle.model import GRAVITY, Vehicle
from trundle.vehicle.nonlinear import PartLaw
from trundle.vehicle.parts import Axle, Body, Bogie, Hinge, LumpedMass, Unit

__all__ = ["Description", "build_vehicle"]

ROLL_RADIUS = 0.42
"""Radius of gyration of a body that rolls, over its track width, where nobody says: 0.63 m of a car
with 1.5 m (0.40 to 0.45 in R. N. Jazar, Vehicle Dynamics, 2008, and CommonRoad's cars)."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Description:
    """Hold a vehicle as its parts.

    Attributes
    ----------
    name, source : str
        Name for tables, and where the numbers come from.
    bodies, axles, bogies, hinges, lumped : tuple
        The parts.
    units : tuple of Unit
        What turns as one in a curve, from the front; found from hinges unless given.
    contact_patch, wheel_radius : float
        How its tyres meet the road [m], see `Vehicle`.
    rounds : tuple of OutOfRound
        What is not round of its wheels; nothing unless given.
    forces : tuple of BodyForce
        What shakes its bodies; nothing unless given.
    laws : tuple of Friction or Stop
        What is not linear of its suspensions; nothing unless given.
    lifts_off : bool
        Whether wheels leave the ground where they would pull on it.
    assumption : str
        What of it is assumed, and not from a source.
    confidence : str
        How far its numbers can be trusted; empty where nobody says.
    """

    name: str
    bodies: tuple[Body, ...]
    axles: tuple[Axle, ...] = ()
    bogies: tuple[Bogie, ...] = ()
    hinges: tuple[Hinge, ...] = ()
    lumped: tuple[LumpedMass, ...] = ()
    units: tuple[Unit, ...] = ()
    contact_patch: float = 0.0
    wheel_radius: float = 0.0
    rounds: tuple[OutOfRound, ...] = ()
    forces: tuple[BodyForce, ...] = ()
    laws: tuple[PartLaw, ...] = ()
    lifts_off: bool = False
    source: str = ""
    assumption: str = ""
    confidence: str = ""

    def loaded(self, mass: float, *, body: int, setback: float, aside: float = 0.0) -> Description:
        """Return it with a payload.

        Parameters
        ----------
        mass : float
            Of the payload [kg].
        body : int
            Which body carries it, from 0.
        setback, aside : float
            Where its centre is: behind the front axle, and to the left of the centre line [m].
        """
        load = LumpedMass(mass=positive("payload", mass), body=body, setback=setback, aside=aside)
        return replace(self, lumped=(*self.lumped, load))

    def widened(self, track_width: float, *, roll_inertia: Sequence[float] = ()) -> Description:
        """Return it in space: with left and right wheels, and bodies that roll.

        Parameters
        ----------
        track_width : float
            Between the wheels of both sides [m], of all axles.
        roll_inertia : sequence of float
            Of every body [kg m2]; of a radius of gyration of 0.42 track widths unless given.

        Raises
        ------
        InputError
            Another number of inertias than bodies, or bogies, which are planar.
        """
        width = positive("track_width", track_width)
        if self.bogies:
            raise InputError(f"vehicle {self.name!r} has bogies, which are planar: leave it so")
        inertia = tuple(roll_inertia) or tuple(b.mass * (ROLL_RADIUS * width) ** 2
                                               for b in self.bodies)  # fmt: skip
        if len(inertia) != len(self.bodies):
            raise InputError(
                f"roll_inertia gives {len(inertia)} numbers for {len(self.bodies)} bodies of "
                f"{self.name!r}: give one each"
            )
        said = "" if roll_inertia else f"; radius of roll {ROLL_RADIUS} track widths"
        return replace(
            self,
            bodies=tuple(
                replace(body, roll_inertia=positive("roll_inertia", i))
                for body, i in zip(self.bodies, inertia, strict=True)
            ),
            axles=tuple(replace(axle, track_width=width) for axle in self.axles),
            units=_widened_units(self.units),
            assumption=(self.assumption + said).lstrip("; "),
        )

    def build(self) -> Vehicle:
        """Build the vehicle; static contact forces follow from equilibrium under gravity.

        Raises
        ------
        InputError
            A part that names a body which does not exist, or a vehicle that does not stand.
        """
        _check_parts(self)
        made = assembled(
            self.bodies, self.axles, bogies=self.bogies, hinges=self.hinges, lumped=self.lumped,
            forces=self.forces,
        )  # fmt: skip
        sag = _settle(self.name, made.stiffness, GRAVITY * made.weight)
        stiffness = np.array([c.stiffness for c in made.contacts])
        setback = np.array([c.setback for c in made.contacts])
        front = float(setback.min())
        made_of = Vehicle(
            name=self.name,
            system=LinearSystem(mass=made.mass, damping=made.damping, stiffness=made.stiffness),
            contact_map=made.contact_map,
            contact_stiffness=stiffness,
            contact_damping=np.array([c.damping for c in made.contacts]),
            static_forces=_pressing(self.name, made, stiffness * (made.contact_map @ sag)),
            setback=setback - front,
            lateral=np.array([c.lateral for c in made.contacts]),
            contact_names=tuple(c.name for c in made.contacts),
            source=self.source,
            contact_patch=self.contact_patch,
            wheel_radius=self.wheel_radius,
            units=self.units or _units(self, made, front),
            rounds=self.rounds,
            forces=self.forces,
            force_map=made.forces,
            pitching=made.pitching,
            laws=self.laws,
            law_map=made.stretches[[law.axle for law in self.laws]],
            lifts_off=self.lifts_off,
            assumption=self.assumption,
            confidence=self.confidence,
        )
        for one in self.rounds:
            if not made_of.contacts_of(one.axle):
                raise InputError(
                    f"vehicle {self.name!r} has no axle {(one.axle or 0) + 1} to be out of round; "
                    f"there are: {', '.join(made_of.contact_names)}"
                )
        return made_of


@kinds_checked
def build_vehicle(
    *,
    name: str,
    bodies: tuple[Body, ...],
    axles: tuple[Axle, ...],
    hinges: tuple[Hinge, ...] = (),
    lumped: tuple[LumpedMass, ...] = (),
    bogies: tuple[Bogie, ...] = (),
    source: str = "",
) -> Vehicle:
    """Assemble a vehicle: planar, or in space where axles have a track width.

    Static contact forces follow from equilibrium of the springs under gravity.

    Parameters
    ----------
    name : str
        Name for tables.
    bodies, axles, hinges, lumped, bogies : tuple
        The parts; axles give the contacts, in the order given, and bogies further ones.
    source : str
        Where the numbers come from.

    Returns
    -------
    Vehicle
        Its front axle is the contact with the smallest setback, moved to 0.

    Raises
    ------
    InputError
        A part that names a body which does not exist, or a vehicle that does not stand.
    """
    return Description(
        name=name, bodies=bodies, axles=axles, hinges=hinges, lumped=lumped, bogies=bogies,
        source=source,
    ).build()  # fmt: skip


def _check_laws(one: Description) -> None:
    """Refuse friction and stops of axles that have no suspension to work in."""
    for law in one.laws:
        if law.axle >= len(one.axles):
            raise InputError(f"axle numbers must be 1 to {len(one.axles)}; got {law.axle + 1}")
        axle = one.axles[law.axle]
        if axle.axle_mass == 0.0 or (axle.independent and axle.track_width > 0.0):
            raise InputError(
                f"{type(law).__name__.lower()} of axle {law.axle + 1} works between a body and a "
                "rigid axle with an axle_mass: give that too"
            )


def _check_parts(one: Description) -> None:
    _check_laws(one)
    if not one.bodies or not (one.axles or one.bogies):
        raise InputError("a vehicle needs at least one body and one axle")
    if any(hinge.bodies[0] == hinge.bodies[1] for hinge in one.hinges):
        raise InputError("a hinge must join two different bodies")
    named = [part.body for part in (*one.axles, *one.bogies, *one.lumped, *one.forces)]
    named += [b for h in one.hinges for b in h.bodies]
    last = len(one.bodies) - 1
    if any(not 0 <= number <= last for number in named):
        raise InputError(f"body numbers must be 0 to {last}; got {sorted(set(named))}")


def _pressing(name: str, made: Assembly, static_forces: Array) -> Array:
    if np.any(static_forces <= 0.0):
        who = made.contacts[int(static_forces.argmin())].name
        raise InputError(
            f"vehicle {name!r}: {who} would lift off at rest, its "
            f"static load is {static_forces.min():.3g} N; put the masses between the axles"
        )
    return static_forces


def _settle(name: str, stiffness: Array, weight: Array) -> Array:
    squares = np.linalg.eigvalsh(stiffness)
    if squares[0] <= 1e-12 * squares[-1]:
        raise InputError(
            f"vehicle {name!r} does not stand on its axles; give every body two supports "
            "(axles or hinges), or no pitch_inertia; one that rolls has a track_width somewhere"
        )
    return np.linalg.solve(stiffness, weight)


def _widened_units(units: tuple[Unit, ...]) -> tuple[Unit, ...]:
    """Return units whose contacts are left and right wheels."""
    return tuple(
        replace(unit, contacts=tuple(side for c in unit.contacts for side in (2 * c, 2 * c + 1)))
        for unit in units
    )


def _units(one: Description, made: Assembly, front: float) -> tuple[Unit, ...]:
    """Return what turns as one: what is hinged turns by itself, all else as one.

    A unit pivots in the middle of its axles behind where it is led; one without any, as a dolly
    whose axle is its lead, is led with what pulls it.
    """
    joints = sorted(one.hinges, key=lambda h: h.setback)
    groups = _hinged_groups(len(one.bodies), joints)
    carried = [axle.body for axle in one.axles for _ in range(1 + (axle.track_width > 0.0))]
    carried += [bogie.body for bogie in one.bogies for _ in bogie.wheels]
    setback = np.array([c.setback for c in made.contacts]) - front
    units: list[Unit] = []
    for group, lead in groups:
        contacts = tuple(i for i, body in enumerate(carried) if body in group)
        start = 0.0 if lead is None else lead - front
        behind = sorted({float(setback[i]) for i in contacts if setback[i] > start + 1e-9})
        if behind:
            units.append(Unit(lead=start, pivot=float(np.mean(behind)), contacts=contacts))
        elif units:
            last = units[-1]
            units[-1] = replace(last, contacts=(*last.contacts, *contacts))
    return tuple(units)


def _hinged_groups(n_bodies: int, joints: Sequence[Hinge]) -> list[tuple[set[int], float | None]]:
    """Return the bodies of each unit with where it is hinged on, from the front."""
    behind = {max(joint.bodies): joint.setback for joint in joints}
    first = {body for body in range(n_bodies) if body not in behind}
    later = sorted(((at, body) for body, at in behind.items()))
    return [(first, None), *(({body}, at) for at, body in later)]

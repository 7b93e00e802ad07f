"""Put parts together as coordinates, springs between them, and contacts.

Every part that moves has coordinates of its own: the height of its centre, and the angles by which
it pitches and rolls where it has inertia for them. A place on it is a row over all coordinates; a
spring between two places is the outer product of the difference of their rows, and a hinge is a
difference that is not allowed. Axles and bogies become such parts and springs here, so that planar
and spatial vehicles are one description and one algebra.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TypeAlias

import numpy as np
from jaxtyping import Float
from scipy import linalg

from trundle._typing import Array
from trundle.errors import InputError
from trundle.vehicle.excitation import BodyForce
from trundle.vehicle.parts import Axle, Body, Bogie, Hinge, LumpedMass

__all__ = ["Assembly", "Contact", "assembled"]


@dataclass(frozen=True, kw_only=True)
class Contact:
    """Hold where a vehicle touches the ground, and through what: see `trundle.vehicle.Vehicle`."""

    name: str
    part: int
    setback: float
    lateral: float
    stiffness: float
    damping: float


_Place: TypeAlias = tuple[int, float, float]
"""A place on a part: its number, setback and lateral."""


@dataclass(frozen=True, kw_only=True)
class _Spring:
    """A spring and damper between places on two parts."""

    ends: tuple[_Place, _Place]
    stiffness: float
    damping: float


@dataclass(kw_only=True, eq=False)
class _Parts:
    """What is collected while a vehicle is put together."""

    bodies: list[Body]
    springs: list[_Spring] = field(default_factory=list[_Spring])
    bars: list[tuple[int, int, float]] = field(default_factory=list[tuple[int, int, float]])
    contacts: list[Contact] = field(default_factory=list[Contact])
    suspended: list[tuple[_Place, _Place]] = field(default_factory=list[tuple[_Place, _Place]])


@dataclass(frozen=True, kw_only=True, eq=False)
class Assembly:
    """Hold the matrices of a vehicle on its contact springs.

    Attributes
    ----------
    mass, damping, stiffness : ndarray of float, shape (n_dofs, n_dofs)
        On rigid level ground, contact springs included.
    contact_map : ndarray of float, shape (n_contacts, n_dofs)
        Motion over each contact.
    weight : ndarray of float, shape (n_dofs,)
        Mass by coordinate: times gravity it is what pulls the vehicle down.
    pitching : ndarray of float, shape (n_dofs,)
        What an acceleration along the way does, by coordinate [kg m].
    forces : ndarray of float, shape (n_forces, n_dofs)
        Motion at each force on a body.
    stretches : ndarray of float, shape (n_axles, n_dofs)
        Stretch of the suspension of each axle, in its middle.
    contacts : tuple of Contact
        The contacts.
    """

    mass: Float[Array, "dofs dofs"]
    damping: Float[Array, "dofs dofs"]
    stiffness: Float[Array, "dofs dofs"]
    contact_map: Float[Array, "contacts dofs"]
    weight: Float[Array, " dofs"]
    pitching: Float[Array, " dofs"]
    forces: Float[Array, "forces dofs"]
    stretches: Float[Array, "axles dofs"]
    contacts: tuple[Contact, ...]


def assembled(
    bodies: Sequence[Body],
    axles: Sequence[Axle],
    *,
    bogies: Sequence[Bogie] = (),
    hinges: Sequence[Hinge] = (),
    lumped: Sequence[LumpedMass] = (),
    forces: Sequence[BodyForce] = (),
) -> Assembly:
    """Put parts together.

    Parameters
    ----------
    bodies, axles, bogies, hinges, lumped : sequence
        The parts; contacts come axle by axle and then bogie by bogie, left before right.
    forces : sequence of BodyForce
        What acts on bodies.
    """
    parts = _Parts(bodies=list(bodies))
    for number, axle in enumerate(axles, start=1):
        _put_axle(parts, axle, number)
        part = parts.contacts[-1].part
        place = axle.setback, axle.lateral
        # of independent wheels, the right one stands for both
        parts.suspended.append(((axle.body, *place), (part, *place)))
    number = len(axles) + 1
    for bogie in bogies:
        _put_bogie(parts, bogie, number)
        number += len(bogie.wheels)
    rows = _Rows(parts.bodies)
    mass, weight = _masses(parts.bodies, lumped, rows)
    stiffness, damping = _springs(parts, rows)
    contact_map = np.array([rows.at(c.part, c.setback, c.lateral) for c in parts.contacts])
    # as `Vehicle.free_system` takes them off again: what is left of springs alone is then 0
    contact_stiffness = np.array([contact.stiffness for contact in parts.contacts])
    contact_damping = np.array([contact.damping for contact in parts.contacts])
    stiffness += contact_map.T @ (contact_stiffness[:, None] * contact_map)
    damping += contact_map.T @ (contact_damping[:, None] * contact_map)
    keep = _allowed_motions(hinges, rows)
    mass, damping, stiffness = (keep.T @ m @ keep for m in (mass, damping, stiffness))
    return Assembly(
        mass=mass,
        damping=damping,
        stiffness=stiffness,
        contact_map=contact_map @ keep,
        weight=keep.T @ weight,
        pitching=keep.T @ _pitching(bodies, rows),
        forces=np.array([rows.at(f.body, f.setback, f.aside) for f in forces]).reshape(
            len(forces), rows.size
        )
        @ keep,
        stretches=np.array(
            [rows.at(*one) - rows.at(*other) for one, other in parts.suspended]
        ).reshape(len(parts.suspended), rows.size)
        @ keep,
        contacts=tuple(parts.contacts),
    )


def _put_axle(parts: _Parts, axle: Axle, number: int) -> None:
    """Put an axle in as what it is: springs alone, a mass, a rigid axle, or two wheels."""
    name = f"axle {number}"
    if axle.track_width == 0.0:
        if axle.axle_mass == 0.0:
            _touch(parts, axle, (name, axle.body, axle.lateral), axle.stiffness, axle.damping)
            return
        wheel = _new(parts, Body(mass=axle.axle_mass, centre=axle.setback, aside=axle.lateral))
        _hang(parts, axle, wheel, axle.lateral, 1.0)
        _touch(parts, axle, (name, wheel, axle.lateral), axle.tyre_stiffness, axle.tyre_damping)
        return
    half, middle = 0.5 * axle.track_width, axle.lateral
    sides = ((f"{name} left", middle + half), (f"{name} right", middle - half))
    if axle.axle_mass == 0.0:
        for side, at in sides:
            _touch(parts, axle, (side, axle.body, at), 0.5 * axle.stiffness, 0.5 * axle.damping)
        return
    wheels = [_side(parts, axle, at) for _, at in sides] if axle.independent else None
    beam = _beam(parts, axle) if wheels is None else -1
    reach = 0.5 * (axle.spring_track or axle.track_width)
    for i, (side, at) in enumerate(sides):
        part = beam if wheels is None else wheels[i]
        _hang(parts, axle, part, middle + (reach if i == 0 else -reach), 0.5)
        _touch(parts, axle, (side, part, at), 0.5 * axle.tyre_stiffness, 0.5 * axle.tyre_damping)
    if axle.roll_stiffness > 0.0:
        if wheels is not None:
            raise InputError(
                f"{name}: an anti-roll bar between independent wheels is not known; give a rigid "
                "axle, or springs that are so much stiffer"
            )
        parts.bars.append((axle.body, beam, axle.roll_stiffness))


def _beam(parts: _Parts, axle: Axle) -> int:
    """Add a rigid axle, which bounces and rolls."""
    inertia = axle.roll_inertia or 0.25 * axle.axle_mass * axle.track_width**2
    return _new(
        parts,
        Body(mass=axle.axle_mass, centre=axle.setback, aside=axle.lateral, roll_inertia=inertia),
    )


def _side(parts: _Parts, axle: Axle, at: float) -> int:
    """Add the wheel of one side, which bounces."""
    return _new(parts, Body(mass=0.5 * axle.axle_mass, centre=axle.setback, aside=at))


def _put_bogie(parts: _Parts, bogie: Bogie, first: int) -> None:
    """Put a bogie in, whose axles are numbered on from a number."""
    beam = _new(
        parts,
        Body(mass=bogie.mass, pitch_inertia=bogie.pitch_inertia, centre=bogie.setback),
    )
    place = bogie.setback, 0.0
    parts.springs.append(
        _Spring(
            ends=((bogie.body, *place), (beam, *place)),
            stiffness=bogie.stiffness,
            damping=bogie.damping,
        )
    )
    for number, wheel in enumerate(bogie.wheels, start=first):
        parts.contacts.append(
            Contact(
                name=f"axle {number}",
                part=beam,
                setback=bogie.setback + wheel,
                lateral=0.0,
                stiffness=bogie.tyre_stiffness,
                damping=bogie.tyre_damping,
            )
        )


def _new(parts: _Parts, body: Body) -> int:
    parts.bodies.append(body)
    return len(parts.bodies) - 1


def _hang(parts: _Parts, axle: Axle, part: int, lateral: float, share: float) -> None:
    """Put a share of an axle's suspension between its body and a part of the axle."""
    place = axle.setback, lateral
    spring = _Spring(
        ends=((axle.body, *place), (part, *place)),
        stiffness=share * axle.stiffness,
        damping=share * axle.damping,
    )
    parts.springs.append(spring)


def _touch(
    parts: _Parts,
    axle: Axle,
    what: tuple[str, int, float],
    stiffness: float,
    damping: float,
) -> None:
    name, part, lateral = what
    parts.contacts.append(
        Contact(
            name=name, part=part, setback=axle.setback, lateral=lateral,
            stiffness=stiffness, damping=damping,
        )
    )  # fmt: skip


class _Rows:
    """Give the height of a place on a part, or the angle that it rolls by, as a row."""

    def __init__(self, bodies: Sequence[Body]) -> None:
        self._bodies = bodies
        counts = [1 + (b.pitch_inertia > 0.0) + (b.roll_inertia > 0.0) for b in bodies]
        self.first = np.concatenate([[0], np.cumsum(counts)]).astype(int)
        self.size = int(self.first[-1])

    def at(self, part: int, setback: float, lateral: float) -> Array:
        """Return the height of a place on a part."""
        body, row, column = self._bodies[part], np.zeros(self.size), self.first[part]
        row[column] = 1.0
        if body.pitch_inertia > 0.0:
            row[column + 1] = setback - body.centre
        return row + (lateral - body.aside) * self.roll(part)

    def roll(self, part: int) -> Array:
        """Return the angle that a part rolls by, positive with its left side up."""
        row = np.zeros(self.size)
        if self._bodies[part].roll_inertia > 0.0:
            row[self.first[part + 1] - 1] = 1.0
        return row


def _masses(
    bodies: Sequence[Body], lumped: Sequence[LumpedMass], rows: _Rows
) -> tuple[Array, Array]:
    diagonal: list[float] = []
    for body in bodies:
        diagonal += [body.mass, *(i for i in (body.pitch_inertia, body.roll_inertia) if i > 0.0)]
    mass, weight = np.diag(diagonal), np.zeros(rows.size)
    for i, body in enumerate(bodies):
        weight += body.mass * rows.at(i, body.centre, body.aside)
    for part in lumped:
        row = rows.at(part.body, part.setback, part.aside)
        mass += part.mass * np.outer(row, row)
        weight += part.mass * row
    return mass, weight


def _pitching(bodies: Sequence[Body], rows: _Rows) -> Array:
    """Return the moments of bodies' inertia about the ground for an acceleration of 1 m/s2.

    Pitch is positive with the rear up; speeding up presses the rear down, by m h.
    """
    moments = np.zeros(rows.size)
    for i, body in enumerate(bodies):
        if body.pitch_inertia > 0.0:
            moments[rows.first[i] + 1] = -body.mass * body.height
    return moments


def _springs(parts: _Parts, rows: _Rows) -> tuple[Array, Array]:
    stiffness, damping = np.zeros((rows.size, rows.size)), np.zeros((rows.size, rows.size))
    for spring in parts.springs:
        stretch = rows.at(*spring.ends[0]) - rows.at(*spring.ends[1])
        stiffness += spring.stiffness * np.outer(stretch, stretch)
        damping += spring.damping * np.outer(stretch, stretch)
    for body, beam, bar in parts.bars:
        twist = rows.roll(body) - rows.roll(beam)
        stiffness += bar * np.outer(twist, twist)
    return stiffness, damping


def _allowed_motions(hinges: Sequence[Hinge], rows: _Rows) -> Array:
    """Return the motions in which what is hinged has one height, and rolls as one if it does."""
    gaps: list[Array] = []
    for hinge in hinges:
        one, other = hinge.bodies
        gaps.append(rows.at(one, hinge.setback, 0.0) - rows.at(other, hinge.setback, 0.0))
        twist = rows.roll(one) - rows.roll(other)
        if hinge.rolls_together and twist.any():
            gaps.append(twist)
    return linalg.null_space(np.array(gaps)) if gaps else np.eye(rows.size)

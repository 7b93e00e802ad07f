"""Build planar vehicles from rigid bodies, lumped masses, hinges and axles."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import linalg

from trundle._checks import finite, non_negative, positive, set_frozen
from trundle._kinds import kinds_checked
from trundle._typing import Array
from trundle.dynamics import LinearSystem
from trundle.errors import InputError
from trundle.vehicle.model import GRAVITY, Vehicle

__all__ = [
    "Axle",
    "Body",
    "Hinge",
    "LumpedMass",
    "build_vehicle",
    "damping_coefficient",
    "wheel_mistake",
]


def damping_coefficient(ratio: float, stiffness: float, mass: float) -> float:
    """Return ``c = 2 zeta sqrt(k m)`` [N s/m] for one mass on one spring."""
    ratio = non_negative("damping ratio", ratio)
    return 2.0 * ratio * float(np.sqrt(positive("stiffness", stiffness) * positive("mass", mass)))


@dataclass(frozen=True, kw_only=True)
class Body:
    """Hold a rigid body that bounces and pitches.

    Attributes
    ----------
    mass : float
        Mass [kg].
    pitch_inertia : float
        Moment of inertia about the transverse axis through its centre [kg m2]; 0 makes a
        body that only bounces.
    centre : float
        Distance of its centre of mass behind the front axle [m].
    """

    mass: float
    pitch_inertia: float = 0.0
    centre: float = 0.0

    def __post_init__(self) -> None:
        """Check mass and inertia."""
        set_frozen(
            self,
            mass=positive("body mass", self.mass),
            pitch_inertia=non_negative("pitch_inertia", self.pitch_inertia),
            centre=finite("centre", self.centre),
        )


@dataclass(frozen=True, kw_only=True)
class LumpedMass:
    """Hold a mass fixed to a body.

    Attributes
    ----------
    mass : float
        Mass [kg].
    body : int
        Number of the body, from 0.
    setback : float
        Distance behind the front axle [m].
    """

    mass: float
    body: int
    setback: float


@dataclass(frozen=True, kw_only=True)
class Hinge:
    """Join two bodies so that they share their height at one place (a fifth wheel).

    Attributes
    ----------
    bodies : tuple of int
        Numbers of the two bodies, from 0.
    setback : float
        Distance behind the front axle [m].
    """

    bodies: tuple[int, int]
    setback: float


@dataclass(frozen=True, kw_only=True)
class Axle:
    """Hold an axle: a spring and damper to its body, with or without a wheel mass of its own.

    Attributes
    ----------
    body : int
        Number of the body that it carries, from 0.
    setback : float
        Distance behind the front axle [m].
    stiffness, damping : float
        Suspension, or suspension and tyre in series where `axle_mass` is 0 [N/m], [N s/m].
    axle_mass : float
        Unsprung mass between suspension and tyre [kg].
    tyre_stiffness, tyre_damping : float
        Tyres of the axle together; used only with an `axle_mass` [N/m], [N s/m].
    lateral : float
        Distance of the contact to the left of the centre line [m].
    """

    body: int
    setback: float
    stiffness: float
    damping: float = 0.0
    axle_mass: float = 0.0
    tyre_stiffness: float = 0.0
    tyre_damping: float = 0.0
    lateral: float = 0.0

    def __post_init__(self) -> None:
        """Check every number, and that a wheel mass stands on a tyre."""
        set_frozen(
            self,
            setback=finite("setback", self.setback),
            stiffness=positive("stiffness", self.stiffness),
            damping=non_negative("damping", self.damping),
            axle_mass=non_negative("axle_mass", self.axle_mass),
            tyre_stiffness=non_negative("tyre_stiffness", self.tyre_stiffness),
            tyre_damping=non_negative("tyre_damping", self.tyre_damping),
        )
        if mistake := wheel_mistake(self.axle_mass, self.tyre_stiffness, self.tyre_damping):
            raise InputError(mistake)


def wheel_mistake(axle_mass: float, tyre_stiffness: float, tyre_damping: float) -> str:
    """Say what is missing between an axle's own mass and its tyre; nothing if all is there."""
    if axle_mass > 0.0 and tyre_stiffness == 0.0:
        return "an axle with an axle_mass stands on a tyre: give its tyre_stiffness too"
    if axle_mass == 0.0 and (tyre_stiffness > 0.0 or tyre_damping > 0.0):
        return (
            "a tyre carries an axle_mass: give that too, or leave tyre_stiffness and tyre_damping "
            "out and write the stiffness of suspension and tyre in series, k kt / (k + kt)"
        )
    return ""


@kinds_checked
def build_vehicle(
    *,
    name: str,
    bodies: tuple[Body, ...],
    axles: tuple[Axle, ...],
    hinges: tuple[Hinge, ...] = (),
    lumped: tuple[LumpedMass, ...] = (),
    source: str = "",
) -> Vehicle:
    """Assemble a planar vehicle.

    Static contact forces follow from equilibrium of the springs under gravity.

    Parameters
    ----------
    name : str
        Name for tables.
    bodies, axles, hinges, lumped : tuple
        The parts; axles give the contacts, in the order given.
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
    _check_parts(bodies, axles, hinges, lumped)
    coordinates = _body_coordinates(bodies)
    wheels = [i for i, axle in enumerate(axles) if axle.axle_mass > 0.0]
    size = sum(len(c) for c in coordinates) + len(wheels)
    rows = _Rows(bodies, coordinates, size)
    mass, damping, stiffness = (np.zeros((size, size)) for _ in range(3))
    for number, body in enumerate(bodies):
        for column, value in zip(
            coordinates[number], (body.mass, body.pitch_inertia), strict=False
        ):
            mass[column, column] += value
    for part in lumped:
        row = rows.at(part.body, part.setback)
        mass += part.mass * np.outer(row, row)
    contacts = _Contacts(len(axles), size)
    for i, axle in enumerate(axles):
        row = rows.at(axle.body, axle.setback)
        if axle.axle_mass > 0.0:
            wheel = np.eye(size)[size - len(wheels) + wheels.index(i)]
            stretch = np.outer(row - wheel, row - wheel)
            mass += axle.axle_mass * np.outer(wheel, wheel)
            stiffness += axle.stiffness * stretch
            damping += axle.damping * stretch
            contacts.put(i, wheel, axle.tyre_stiffness, axle.tyre_damping)
        else:
            contacts.put(i, row, axle.stiffness, axle.damping)
    stiffness += contacts.matrix(contacts.stiffness)
    damping += contacts.matrix(contacts.damping)
    weight = GRAVITY * _vertical_masses(bodies, lumped, axles, rows, wheels)
    keep = _allowed_motions(hinges, rows)
    mass, damping, stiffness = (keep.T @ m @ keep for m in (mass, damping, stiffness))
    contact_map = contacts.map @ keep
    sag = _settle(name, stiffness, keep.T @ weight)
    return Vehicle(
        name=name,
        system=LinearSystem(mass=mass, damping=damping, stiffness=stiffness),
        contact_map=contact_map,
        contact_stiffness=contacts.stiffness,
        contact_damping=contacts.damping,
        static_forces=_pressing(name, contacts.stiffness * (contact_map @ sag)),
        setback=np.array([axle.setback for axle in axles]) - min(a.setback for a in axles),
        lateral=np.array([axle.lateral for axle in axles]),
        contact_names=tuple(f"axle {i + 1}" for i in range(len(axles))),
        source=source,
    )


class _Contacts:
    """Collect where a vehicle touches the ground, and through what."""

    def __init__(self, n_contacts: int, n_dofs: int) -> None:
        self.map = np.zeros((n_contacts, n_dofs))
        self.stiffness, self.damping = np.zeros(n_contacts), np.zeros(n_contacts)

    def put(self, i: int, row: Array, stiffness: float, damping: float) -> None:
        self.map[i], self.stiffness[i], self.damping[i] = row, stiffness, damping

    def matrix(self, values: Array) -> Array:
        return self.map.T @ (values[:, None] * self.map)


def _pressing(name: str, static_forces: Array) -> Array:
    if np.any(static_forces <= 0.0):
        raise InputError(
            f"vehicle {name!r}: axle {int(static_forces.argmin()) + 1} would lift off at rest, its "
            f"static load is {static_forces.min():.3g} N; put the masses between the axles"
        )
    return static_forces


class _Rows:
    """Give the height of a place on a body as a row over the coordinates."""

    def __init__(self, bodies: tuple[Body, ...], coordinates: list[list[int]], size: int) -> None:
        self.bodies, self.coordinates, self.size = bodies, coordinates, size

    def at(self, body: int, setback: float) -> Array:
        row = np.zeros(self.size)
        columns = self.coordinates[body]
        row[columns[0]] = 1.0
        if len(columns) == 2:
            row[columns[1]] = setback - self.bodies[body].centre
        return row


def _check_parts(
    bodies: tuple[Body, ...],
    axles: tuple[Axle, ...],
    hinges: tuple[Hinge, ...],
    lumped: tuple[LumpedMass, ...],
) -> None:
    if not bodies or not axles:
        raise InputError("a vehicle needs at least one body and one axle")
    if any(hinge.bodies[0] == hinge.bodies[1] for hinge in hinges):
        raise InputError("a hinge must join two different bodies")
    named = [part.body for part in (*axles, *lumped)] + [b for h in hinges for b in h.bodies]
    if any(not 0 <= number < len(bodies) for number in named):
        raise InputError(f"body numbers must be 0 to {len(bodies) - 1}; got {sorted(set(named))}")


def _body_coordinates(bodies: tuple[Body, ...]) -> list[list[int]]:
    coordinates, at = [], 0
    for body in bodies:
        count = 2 if body.pitch_inertia > 0.0 else 1
        coordinates.append(list(range(at, at + count)))
        at += count
    return coordinates


def _vertical_masses(
    bodies: tuple[Body, ...],
    lumped: tuple[LumpedMass, ...],
    axles: tuple[Axle, ...],
    rows: _Rows,
    wheels: list[int],
) -> Array:
    masses = sum(body.mass * rows.at(i, body.centre) for i, body in enumerate(bodies))
    masses = masses + sum(part.mass * rows.at(part.body, part.setback) for part in lumped)
    masses = masses + np.zeros(rows.size)
    masses[rows.size - len(wheels) :] = [axles[i].axle_mass for i in wheels]
    return masses


def _allowed_motions(hinges: tuple[Hinge, ...], rows: _Rows) -> Array:
    if not hinges:
        return np.eye(rows.size)
    gaps = [
        rows.at(hinge.bodies[0], hinge.setback) - rows.at(hinge.bodies[1], hinge.setback)
        for hinge in hinges
    ]
    return linalg.null_space(np.array(gaps))


def _settle(name: str, stiffness: Array, weight: Array) -> Array:
    squares = np.linalg.eigvalsh(stiffness)
    if squares[0] <= 1e-12 * squares[-1]:
        raise InputError(
            f"vehicle {name!r} does not stand on its axles; give every body two supports "
            "(axles or hinges), or no pitch_inertia"
        )
    return np.linalg.solve(stiffness, weight)

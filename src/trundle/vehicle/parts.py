"""Parts that vehicles are built from: bodies, masses, hinges, axles, bogies."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from trundle._checks import finite, non_negative, positive, set_frozen
from trundle.errors import InputError

__all__ = [
    "Axle",
    "Body",
    "Bogie",
    "Hinge",
    "LumpedMass",
    "Unit",
    "damping_coefficient",
    "wheel_mistake",
]


def damping_coefficient(ratio: float, stiffness: float, mass: float) -> float:
    """Return ``c = 2 zeta sqrt(k m)`` [N s/m] for one mass on one spring."""
    ratio = non_negative("damping ratio", ratio)
    return 2.0 * ratio * float(np.sqrt(positive("stiffness", stiffness) * positive("mass", mass)))


@dataclass(frozen=True, kw_only=True)
class Body:
    """Hold a rigid body that bounces, pitches and rolls.

    Attributes
    ----------
    mass : float
        Mass [kg].
    pitch_inertia : float
        Moment of inertia about the transverse axis through its centre [kg m2]; 0 makes a
        body that only bounces.
    centre : float
        Distance of its centre of mass behind the front axle [m].
    roll_inertia : float
        Moment of inertia about the axis along the vehicle through its centre [kg m2]; 0 makes a
        body that does not roll.
    aside : float
        Distance of its centre of mass to the left of the centre line [m].
    height : float
        Of its centre of mass above the ground [m]: by it braking makes it pitch; 0 does not.
    """

    mass: float
    pitch_inertia: float = 0.0
    centre: float = 0.0
    roll_inertia: float = 0.0
    aside: float = 0.0
    height: float = 0.0

    def __post_init__(self) -> None:
        """Check mass and inertia."""
        set_frozen(
            self,
            mass=positive("body mass", self.mass),
            pitch_inertia=non_negative("pitch_inertia", self.pitch_inertia),
            centre=finite("centre", self.centre),
            roll_inertia=non_negative("roll_inertia", self.roll_inertia),
            aside=finite("aside", self.aside),
            height=non_negative("height", self.height),
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
    aside : float
        Distance to the left of the centre line [m].
    """

    mass: float
    body: int
    setback: float
    aside: float = 0.0

    def __post_init__(self) -> None:
        """Check that it weighs something, and its place."""
        set_frozen(
            self,
            mass=positive("lumped mass", self.mass),
            setback=finite("setback", self.setback),
            aside=finite("aside", self.aside),
        )


@dataclass(frozen=True, kw_only=True)
class Hinge:
    """Join two bodies so that they share their height at one place (a fifth wheel).

    Attributes
    ----------
    bodies : tuple of int
        Numbers of the two bodies, from 0.
    setback : float
        Distance behind the front axle [m].
    rolls_together : bool
        Whether they roll as one, as over a fifth wheel; not over a drawbar or a ball.
    """

    bodies: tuple[int, int]
    setback: float
    rolls_together: bool = True

    def __post_init__(self) -> None:
        """Check its place."""
        set_frozen(self, setback=finite("setback", self.setback))


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
        Distance of its middle to the left of the centre line [m].
    track_width : float
        Between the wheels of both sides [m], which are then contacts of their own; 0 takes both
        as one.
    spring_track : float
        Between the springs of both sides [m]; as between the wheels unless given.
    roll_inertia : float
        Of the axle itself about its middle [kg m2]; that of two wheels at its ends,
        ``axle_mass track_width^2 / 4``, unless given.
    roll_stiffness : float
        Of an anti-roll bar between body and axle [N m/rad].
    independent : bool
        Whether each wheel moves by itself, and not on the ends of a rigid axle.
    """

    body: int
    setback: float
    stiffness: float
    damping: float = 0.0
    axle_mass: float = 0.0
    tyre_stiffness: float = 0.0
    tyre_damping: float = 0.0
    lateral: float = 0.0
    track_width: float = 0.0
    spring_track: float = 0.0
    roll_inertia: float = 0.0
    roll_stiffness: float = 0.0
    independent: bool = False

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
            lateral=finite("lateral", self.lateral),
            track_width=non_negative("track_width", self.track_width),
            spring_track=non_negative("spring_track", self.spring_track),
            roll_inertia=non_negative("roll_inertia", self.roll_inertia),
            roll_stiffness=non_negative("roll_stiffness", self.roll_stiffness),
        )
        if self.track_width == 0.0 and (self.spring_track or self.roll_stiffness):
            raise InputError("an axle that rolls has a track_width: give it too")
        if self.axle_mass == 0.0 and self.roll_stiffness > 0.0:
            raise InputError(
                "an anti-roll bar works between a body and an axle with an axle_mass: give that too"
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


@dataclass(frozen=True, kw_only=True)
class Bogie:
    """Hold a group of axles on one beam that rocks: a bogie, a walking beam.

    Attributes
    ----------
    body : int
        Number of the body that it carries, from 0.
    setback : float
        Of its suspension, behind the front axle [m].
    stiffness, damping : float
        Suspension between body and beam [N/m], [N s/m].
    mass, pitch_inertia : float
        Of the beam with its axles [kg], [kg m2]; it rocks about the suspension.
    wheels : tuple of float
        Places of the axles behind the suspension [m].
    tyre_stiffness, tyre_damping : float
        Of each axle [N/m], [N s/m].
    """

    body: int
    setback: float
    stiffness: float
    mass: float
    wheels: tuple[float, ...]
    tyre_stiffness: float
    damping: float = 0.0
    pitch_inertia: float = 0.0
    tyre_damping: float = 0.0

    def __post_init__(self) -> None:
        """Check that the beam has what it needs to rock."""
        set_frozen(
            self,
            setback=finite("setback", self.setback),
            stiffness=positive("stiffness", self.stiffness),
            mass=positive("mass", self.mass),
            wheels=tuple(finite("wheels", w) for w in self.wheels),
            tyre_stiffness=positive("tyre_stiffness", self.tyre_stiffness),
            damping=non_negative("damping", self.damping),
            pitch_inertia=non_negative("pitch_inertia", self.pitch_inertia),
            tyre_damping=non_negative("tyre_damping", self.tyre_damping),
        )
        if not self.wheels:
            raise InputError("a bogie has axles: give their places behind its suspension, wheels")
        if len(self.wheels) > 1 and self.pitch_inertia == 0.0:
            raise InputError(
                f"a bogie of {len(self.wheels)} axles rocks: give the beam's pitch_inertia"
            )


@dataclass(frozen=True, kw_only=True)
class Unit:
    """Hold what turns as one in a curve: a tractor, a semitrailer, a trailer.

    Attributes
    ----------
    lead : float
        Where it is led, behind the front axle [m]: its steered axle, or its coupling.
    pivot : float
        Where it rolls without sliding aside, behind the front axle [m]: the middle of the axles
        that do not steer.
    contacts : tuple of int
        Numbers of its contacts.
    """

    lead: float
    pivot: float
    contacts: tuple[int, ...]

    def __post_init__(self) -> None:
        """Check that it has a length."""
        set_frozen(self, lead=finite("lead", self.lead), pivot=finite("pivot", self.pivot))
        if self.pivot - self.lead <= 0.0:
            raise InputError(
                f"a unit that is led at {self.lead:g} m pivots behind it; got {self.pivot:g} m"
            )

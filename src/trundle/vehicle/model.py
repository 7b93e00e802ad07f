"""Hold a linear vehicle that touches the ground at contact points."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal, TypeAlias

import numpy as np
from jaxtyping import Complex, Float
from scipy import linalg

from trundle._checks import frozen_array, set_frozen, within
from trundle._typing import Array
from trundle.dynamics import LinearSystem
from trundle.errors import InputError, UnrestrainedModeError
from trundle.vehicle.excitation import BodyForce, OutOfRound
from trundle.vehicle.nonlinear import PartLaw
from trundle.vehicle.parts import Unit

__all__ = ["GRAVITY", "Confidence", "Vehicle"]

Confidence: TypeAlias = Literal["high", "medium", "low"]
"""How far numbers can be trusted: read in their source; inferred in part; mostly assumed."""

_LARGEST_WHEEL = 3.0  # m, of a contact patch or a radius

GRAVITY = 9.81
"""Acceleration of gravity [m/s2]."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Vehicle:
    """Hold a linear multi-axle vehicle.

    Displacements are measured from static equilibrium on level ground, up positive. Contact
    j presses on the ground with ``f_j = static_j - k_j (e_j z - y_j) - c_j (e_j z' - y_j')``,
    where y is the height of the ground under it and e_j a row of `contact_map`.

    Attributes
    ----------
    name : str
        Name for tables.
    system : LinearSystem
        Mass, damping, stiffness on level rigid ground; contact springs and dampers included.
    contact_map : ndarray of float, shape (n_contacts, n_dofs)
        Rows e_j: vehicle motion over each contact.
    contact_stiffness : ndarray of float, shape (n_contacts,)
        Stiffness between that motion and the ground [N/m].
    contact_damping : ndarray of float, shape (n_contacts,)
        Damping coefficient there [N s/m].
    static_forces : ndarray of float, shape (n_contacts,)
        Static contact forces, positive when pressing on the ground [N].
    setback : ndarray of float, shape (n_contacts,)
        Distance of each contact behind the front axle [m].
    lateral : ndarray of float, shape (n_contacts,)
        Distance of each contact to the left of the centre line [m].
    contact_names : tuple of str
        Names for tables and plots.
    source : str
        Where the numbers come from.
    contact_patch : float
        Length of road that a tyre stands on and averages over [m]; 0 where nobody says.
    wheel_radius : float
        Radius of hard wheels, which roll over a gap as a disc does [m]; 0 of soft tyres.
    units : tuple of Unit
        What turns as one in a curve, from the front; empty of a vehicle of one axle.
    rounds : tuple of OutOfRound
        What is not round of its wheels.
    forces : tuple of BodyForce
        What shakes its bodies.
    force_map : ndarray of float, shape (n_forces, n_dofs)
        Motion where each of these acts.
    pitching : ndarray of float, shape (n_dofs,)
        What an acceleration along the way of 1 m/s2 presses on it [kg m]; nothing unless given.
    laws : tuple of Friction or Stop
        What is not linear of its suspensions.
    law_map : ndarray of float, shape (n_laws, n_dofs)
        Stretch of the suspension where each works.
    lifts_off : bool
        Whether wheels leave the ground where they would pull on it.
    inner : int
        How many of the last contacts touch nothing: what acts within a vehicle is put in there.
    assumption : str
        What of it is assumed, and not from a source.
    confidence : str
        How far its numbers can be trusted; empty where nobody says.
    """

    name: str
    system: LinearSystem
    contact_map: Float[Array, "contacts dofs"]
    contact_stiffness: Float[Array, " contacts"]
    contact_damping: Float[Array, " contacts"]
    static_forces: Float[Array, " contacts"]
    setback: Float[Array, " contacts"]
    lateral: Float[Array, " contacts"]
    contact_names: tuple[str, ...]
    source: str = ""
    contact_patch: float = 0.0
    wheel_radius: float = 0.0
    units: tuple[Unit, ...] = ()
    rounds: tuple[OutOfRound, ...] = ()
    forces: tuple[BodyForce, ...] = ()
    force_map: Float[Array, "forces dofs"] | None = None
    pitching: Float[Array, " dofs"] | None = None
    laws: tuple[PartLaw, ...] = ()
    law_map: Float[Array, "laws dofs"] | None = None
    lifts_off: bool = False
    inner: int = 0
    assumption: str = ""
    confidence: str = ""

    def __post_init__(self) -> None:
        """Freeze arrays and check shapes and signs."""
        if self.system.is_sparse:
            raise InputError("a vehicle's matrices must be dense arrays")
        n = len(self.contact_names)
        contact_map = frozen_array("contact_map", self.contact_map, shape=(n, self.system.n_dofs))
        vectors = {
            name: frozen_array(name, getattr(self, name), shape=(n,))
            for name in (
                "contact_stiffness",
                "contact_damping",
                "static_forces",
                "setback",
                "lateral",
            )
        }
        for name in ("contact_stiffness", "contact_damping"):
            if np.any(vectors[name] < 0.0):
                raise InputError(f"{name} must be 0 or more; got {vectors[name].tolist()}")
        if self.force_map is not None:
            shape = (len(self.forces), self.system.n_dofs)
            set_frozen(self, force_map=frozen_array("force_map", self.force_map, shape=shape))
        if self.pitching is not None:
            shape = (self.system.n_dofs,)
            set_frozen(self, pitching=frozen_array("pitching", self.pitching, shape=shape))
        for name in ("contact_patch", "wheel_radius"):
            set_frozen(self, **{name: within(name, getattr(self, name), 0.0, _LARGEST_WHEEL)})
        set_frozen(self, contact_map=contact_map, **vectors)

    def with_inner_contacts(self, *, braked: bool) -> Vehicle:
        """Return it with a contact of no stiffness for all that acts within it.

        What is put in there is a force on the vehicle, and none on the ground.

        Parameters
        ----------
        braked : bool
            Whether it speeds up or brakes on its way: its bodies then pitch.
        """
        rows = [] if self.law_map is None else list(self.law_map)
        rows += [] if self.force_map is None else list(self.force_map)
        names = [f"{type(law).__name__.lower()} axle {law.axle + 1}" for law in self.laws]
        names += [force.name for force in self.forces]
        if braked and self.pitching is not None and np.any(self.pitching != 0.0):
            rows, names = [*rows, self.pitching], [*names, "braking"]
        if not rows:
            return self
        none = np.zeros(len(rows))
        return replace(
            self,
            contact_map=np.vstack([self.contact_map, rows]),
            contact_stiffness=np.concatenate([self.contact_stiffness, none]),
            contact_damping=np.concatenate([self.contact_damping, none]),
            static_forces=np.concatenate([self.static_forces, none]),
            setback=np.concatenate([self.setback, none]),
            lateral=np.concatenate([self.lateral, none + self.lateral[0]]),
            contact_names=(*self.contact_names, *(f"{name}, inside" for name in names)),
            inner=len(rows),
        )

    def backwards(self) -> Vehicle:
        """Return it driving backwards, its last axle first; left is then on its other side."""
        return replace(
            self,
            setback=self.setback.max() - self.setback,
            lateral=-self.lateral,
            pitching=None if self.pitching is None else -self.pitching,
            units=(),
        )

    def contacts_of(self, axle: int | None) -> list[int]:
        """Return the contacts of an axle, from 0; all that touch the ground for None."""
        outer = range(self.n_contacts - self.inner)
        if axle is None:
            return list(outer)
        name = f"axle {axle + 1}"
        return [i for i in outer if self.contact_names[i].removesuffix(" left").removesuffix(
            " right") == name]  # fmt: skip

    @property
    def is_linear(self) -> bool:
        """Whether it grows with the road: without friction, stops, and lifting off."""
        return not self.laws and not self.lifts_off

    @property
    def n_contacts(self) -> int:
        """Number of contact points."""
        return len(self.contact_names)

    @property
    def length(self) -> float:
        """Distance from the first contact to the last [m]."""
        return float(self.setback.max() - self.setback.min())

    @property
    def total_mass(self) -> float:
        """Mass that the static contact forces carry [kg]."""
        return float(self.static_forces.sum() / GRAVITY)

    @property
    def free_system(self) -> LinearSystem:
        """The vehicle without its contact springs and dampers, as the contact solver sees it."""
        e = self.contact_map
        return LinearSystem(
            mass=self.system.mass,
            damping=self.system.damping - e.T @ (self.contact_damping[:, None] * e),
            stiffness=self.system.stiffness - e.T @ (self.contact_stiffness[:, None] * e),
        )

    @property
    def _stiffness_and_mass(self) -> tuple[Array, Array]:
        return np.asarray(self.system.stiffness), np.asarray(self.system.mass)

    def natural_frequencies(self) -> Float[Array, " dofs"]:
        """Return the undamped natural frequencies on rigid ground, rising [Hz].

        Raises
        ------
        UnrestrainedModeError
            The vehicle does not stand on its contacts.
        """
        squares = linalg.eigh(*self._stiffness_and_mass, eigvals_only=True)
        if squares[0] <= 1e-9 * squares[-1]:
            raise UnrestrainedModeError(
                f"vehicle {self.name!r} does not stand on its contacts: a motion has no stiffness"
            )
        return np.sqrt(squares) / (2.0 * np.pi)

    def mode_shapes(self) -> tuple[Float[Array, " dofs"], Float[Array, "contacts dofs"]]:
        """Return natural frequencies [Hz] and the motion over each contact, peak 1."""
        squares, shapes = linalg.eigh(*self._stiffness_and_mass)
        seen = self.contact_map @ shapes
        peak = seen[np.abs(seen).argmax(axis=0), np.arange(seen.shape[1])]
        return np.sqrt(squares) / (2.0 * np.pi), seen / peak

    def decay_rates(self) -> Float[Array, " modes"]:
        """Return the decay rates of the free motions on rigid ground [1/s], rising."""
        return np.sort(-np.real(self.poles()))

    def poles(self) -> Complex[Array, " modes"]:
        """Return the eigenvalues of the free motions on rigid ground [1/s], in any order."""
        s = self.system
        inverse = np.linalg.inv(np.asarray(s.mass))
        n = s.n_dofs
        state = np.block(
            [[np.zeros((n, n)), np.eye(n)], [-inverse @ s.stiffness, -inverse @ s.damping]]
        )
        return np.linalg.eigvals(state).astype(complex)

    def contact_force_transfer(
        self, f: Float[Array, " lines"], *, speed: float
    ) -> Complex[Array, "lines contacts"]:
        """Return the complex contact forces for a unit harmonic road on rigid ground [N/m].

        Parameters
        ----------
        f : ndarray of float, shape (n_lines,)
            Frequency felt by the wheel [Hz].
        speed : float
            Speed [m/s]; every axle meets the same road later by its setback.

        Returns
        -------
        ndarray of complex, shape (n_lines, n_contacts)
            Dynamic contact force per metre of road amplitude under the front axle.
        """
        w = 2.0 * np.pi * np.asarray(f)[:, None]
        ground = np.exp(-1j * w * self.setback / speed)
        link = self.contact_stiffness + 1j * w * self.contact_damping
        s, e = self.system, self.contact_map
        dynamic = (
            s.stiffness + 1j * w[:, :, None] * s.damping - w[:, :, None] ** 2 * np.asarray(s.mass)
        )
        motion = np.linalg.solve(dynamic, ((link * ground) @ e)[:, :, None])[:, :, 0]
        return -link * (motion @ e.T - ground)

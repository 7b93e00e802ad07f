"""Hold vehicles and the springs by which they touch the ground, whatever the ground is."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Float
from scipy import linalg, sparse

from trundle._typing import Array
from trundle.dynamics import LinearSystem, block_diagonal
from trundle.simulate.sources.source import Source
from trundle.simulate.wheels.timeline import Timeline
from trundle.vehicle import Vehicle

__all__ = ["Contacts", "Springs", "Wheels"]


@dataclass(frozen=True, kw_only=True, eq=False)
class Springs:
    """Hold springs and dampers between vehicle and ground.

    Attributes
    ----------
    contact_map : ndarray of float, shape (n_contacts, n_dofs)
        Vehicle motion over each contact.
    stiffness, damping, static : ndarray of float, shape (n_contacts, 1)
        Contact springs [N/m], dampers [N s/m] and static forces [N].
    standing_stiffness : ndarray of float, shape (n_dofs, n_dofs)
        Vehicle stiffness on rigid ground, contact springs included [N/m].
    """

    contact_map: Float[Array, "contacts dofs"]
    stiffness: Float[Array, "contacts 1"]
    damping: Float[Array, "contacts 1"]
    static: Float[Array, "contacts 1"]
    standing_stiffness: Float[Array, "dofs dofs"]

    def standing_on(self, road: Float[Array, "contacts runs"]) -> Float[Array, "dofs runs"]:
        """Return where vehicles stand at rest, in equilibrium on heights under their wheels [m]."""
        pushed = self.contact_map.T @ (self.stiffness * road)
        return linalg.solve(self.standing_stiffness, pushed)

    def settled(
        self, sinking: Float[Array, "contacts contacts"], rigid: Float[Array, "contacts runs"]
    ) -> tuple[
        Float[Array, "contacts runs"], Float[Array, "contacts runs"], Float[Array, "dofs runs"]
    ]:
        """Let vehicles and floor settle together.

        Parameters
        ----------
        sinking : ndarray of float, shape (n_contacts, n_contacts)
            The floor's static sinking S under wheel i for a unit force of wheel j [m/N].
        rigid : ndarray of float, shape (n_contacts, n_runs)
            Contact forces in equilibrium on rigid ground [N].

        Returns
        -------
        forces, push : ndarray of float, shape (n_contacts, n_runs)
            Contact forces, and what the sunken floor pushes at vehicles that are held [N].
        moved : ndarray of float, shape (n_dofs, n_runs)
            How the vehicles move by it [m].

        Notes
        -----
        With ``R = 1 - k E K_v^-1 E^T`` what a push at the held vehicle leaves of itself,
        ``f = f_rigid - R k S f``.
        """
        e, k = self.contact_map, self.stiffness
        sink = k * sinking
        lift = linalg.solve(self.standing_stiffness, e.T)
        left = np.eye(len(k)) - k * (e @ lift)
        forces = linalg.solve(np.eye(len(k)) + left @ sink, rigid)
        push = -sink @ forces
        return forces, push, lift @ push


@dataclass(frozen=True, kw_only=True, eq=False)
class Contacts:
    """Hold vehicles that drive at once, as one system.

    Attributes
    ----------
    vehicles : tuple of Vehicle
        The vehicles.
    """

    vehicles: tuple[Vehicle, ...]

    @classmethod
    def of(cls, sources: Sequence[Source]) -> Contacts:
        """Return what hangs on the contacts of some sources."""
        moving = (source.oscillator or _nothing(source.contact_names) for source in sources)
        return cls(vehicles=tuple(moving))

    @cached_property
    def each(self) -> tuple[Contacts, ...]:
        """Every vehicle by itself."""
        return tuple(Contacts(vehicles=(vehicle,)) for vehicle in self.vehicles)

    @cached_property
    def standing(self) -> LinearSystem:
        """The vehicles on their contact springs."""
        return block_diagonal(tuple(vehicle.system for vehicle in self.vehicles))

    @cached_property
    def free(self) -> LinearSystem:
        """The vehicles without their contact springs."""
        return block_diagonal(tuple(vehicle.free_system for vehicle in self.vehicles))

    @cached_property
    def springs(self) -> Springs:
        """All contacts."""
        many = self.vehicles
        return Springs(
            contact_map=np.asarray(sparse.block_diag([v.contact_map for v in many]).toarray()),
            stiffness=np.concatenate([v.contact_stiffness for v in many])[:, None],
            damping=np.concatenate([v.contact_damping for v in many])[:, None],
            static=np.concatenate([v.static_forces for v in many])[:, None],
            standing_stiffness=np.asarray(self.standing.stiffness),
        )


def _nothing(contact_names: tuple[str, ...]) -> Vehicle:
    """Return what stands for no vehicle: a mass on a spring that touches none of the contacts.

    Contact springs are 0, so that what is put in at a contact is its force, moving floor or not.
    """
    none = np.zeros(len(contact_names))
    one = np.ones((1, 1))
    return Vehicle(
        name="known forces",
        system=LinearSystem(mass=one, damping=0.0 * one, stiffness=one),
        contact_map=np.zeros((len(contact_names), 1)),
        contact_stiffness=none,
        contact_damping=none,
        static_forces=none,
        setback=none,
        lateral=none,
        contact_names=contact_names,
    )


@dataclass(frozen=True, kw_only=True, eq=False)
class Wheels:
    """Hold what a drive needs of vehicles and time.

    Attributes
    ----------
    contacts : Contacts
        The vehicles.
    timeline : Timeline
        Where their wheels are.
    static : bool
        Whether the record starts in static equilibrium, or after a run-in.
    """

    contacts: Contacts
    timeline: Timeline
    static: bool

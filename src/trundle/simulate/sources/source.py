"""Say what is asked of a source of vibration.

A source says where its contacts are (`Track`), what hangs on them (a vehicle, or nothing: then its
forces are known), and what is put in at every run (`Inputs`). Structures, integrations, statistics
and maps know no more of it.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Protocol, runtime_checkable

import numpy as np
from jaxtyping import Complex, Float

from trundle._typing import Array
from trundle.dynamics import Modes
from trundle.errors import FitnessWarning, InputError
from trundle.route import Along, Track
from trundle.structure import ContactShape, Structure
from trundle.vehicle import Vehicle

__all__ = ["Inputs", "KnownForces", "Source", "WaveSet"]


@runtime_checkable
class Inputs(Protocol):
    """What one source puts in, run by run: pushes at its contacts.

    A push is what would be added to a contact's force if source and structure stood still [N]; of a
    source without a vehicle it is its force, downwards.
    """

    def draw(self, run: int) -> tuple[Float[Array, "times contacts"], Float[Array, " contacts"]]:
        """Return the pushes of a run [N], and the height under each contact at first [m]."""
        ...

    def still(self) -> tuple[Float[Array, "times contacts"], Float[Array, " contacts"]]:
        """Return the same without anything random."""
        ...


@dataclass(frozen=True, kw_only=True, eq=False)
class WaveSet:
    """Hold waves of one random road, as one independent source sends them to a vehicle's wheels.

    Attributes
    ----------
    along : Along
        Where the wheels are, at all times.
    n : ndarray of float, shape (n_waves,)
        Spatial frequencies [cycle/m].
    power, coarse_power : ndarray of float, shape (n_waves,)
        Variance that each stands for, and what every other one would stand for [m2].
    share : ndarray of float, shape (n_waves, n_contacts)
        Part of the unit amplitude at each wheel's track.
    stiffness, damping : ndarray of float, shape (n_contacts,)
        Contact springs [N/m] and dampers [N s/m].
    level : bool
        Whether the vehicle starts level, as over a road of no height.
    """

    along: Along
    n: Float[Array, " waves"]
    power: Float[Array, " waves"]
    coarse_power: Float[Array, " waves"]
    share: Float[Array, "waves contacts"]
    stiffness: Float[Array, " contacts"]
    damping: Float[Array, " contacts"]
    level: bool

    def part(self, which: slice) -> WaveSet:
        """Return some of the waves."""
        return replace(
            self,
            n=self.n[which],
            power=self.power[which],
            coarse_power=self.coarse_power[which],
            share=self.share[which],
        )

    def phase(self) -> Float[Array, "waves times"]:
        """Return the phase of every wave under the front wheel [rad]."""
        return 2.0 * np.pi * self.n[:, None] * self.along.station[:, 0]

    def pushes(self) -> Iterator[tuple[Complex[Array, "times waves"], Complex[Array, " waves"]]]:
        """Give what waves of unit amplitude push at each contact [N/m], and their first height."""
        along, wavenumber = self.along, 2.0 * np.pi * self.n
        front = along.station[:, 0]
        rolling = np.exp(1j * front[:, None] * wavenumber)
        for i, (k, c) in enumerate(zip(self.stiffness, self.damping, strict=True)):
            # every wheel of a vehicle follows its first at a fixed distance
            behind = np.exp(1j * (along.station[0, i] - front[0]) * wavenumber)
            unit = rolling * (self.share[:, i] * behind)
            turning = along.speed[:, i, None] * wavenumber
            yield (k + 1j * c * turning) * unit, np.zeros_like(unit[0]) if self.level else unit[0]


@runtime_checkable
class Source(Protocol):
    """Something that makes a structure vibrate."""

    @property
    def name(self) -> str:
        """Name; what is random of it depends on the seed, this name and the run alone."""
        ...

    @property
    def contact_names(self) -> tuple[str, ...]:
        """Name of every contact."""
        ...

    @property
    def oscillator(self) -> Vehicle | None:
        """What moves over the contacts; None where the forces are known."""
        ...

    @property
    def standing(self) -> bool:
        """Whether it stands on the structure at time 0, in equilibrium with it."""
        ...

    @property
    def level(self) -> bool:
        """Whether its vehicle starts level, and not in equilibrium on the road."""
        ...

    @property
    def random(self) -> bool:
        """Whether its inputs differ from run to run, as waves of a spectrum."""
        ...

    @property
    def varies(self) -> bool:
        """Whether its inputs differ from run to run in any other way: no road scales them."""
        ...

    @property
    def complete(self) -> bool:
        """Whether what it puts in is all that there is of it, in every band."""
        ...

    @property
    def leaves(self) -> float:
        """Time at which its last contact leaves [s]; infinity if none ever does."""
        ...

    def begins(self, dt: float) -> float:
        """Return when it begins to move [s], whole steps before or after time 0."""
        ...

    def later(self, by: float) -> Source:
        """Return the same, put off by some time [s]."""
        ...

    def track(self, time: Float[Array, " times"], begins: float) -> Track:
        """Return where its contacts are at some times [s]; before it begins it stands still."""
        ...

    def way(self) -> Iterator[tuple[Float[Array, "places 2"], Float[Array, "places 2"]]]:
        """Give places all along its way, with directions, closer than elements are long."""
        ...

    @property
    def on(self) -> str | None:
        """Name of the surface that it acts on; None for the only one."""
        ...

    def inputs(self, time: Float[Array, " times"], begins: float, seed: int) -> Inputs:
        """Return what it puts in from its first time to the record's end."""
        ...

    def waves(
        self, time: Float[Array, " times"], begins: float, n_waves: int
    ) -> tuple[WaveSet, ...]:
        """Return the waves of what is random of it; none where nothing is."""
        ...

    def stands_at(self, time: float) -> tuple[tuple[float, float] | None, int]:
        """Return where its first contact stands at a time, None when off; and how many stand."""
        ...

    def excited_to(self, ends: float) -> float:
        """Return to which frequency it excites a structure in a record of a length [s]."""
        ...

    def partly_excited_to(self, ends: float) -> float:
        """Return to which it does so in part, so that levels are lower bounds; no less."""
        ...

    def check(self, dt: float, duration: float | None) -> tuple[FitnessWarning, ...]:
        """Refuse what a step [s] cannot show, before work starts; return doubts about it."""
        ...

    def doubts(
        self, structure: Structure, modes: Modes | None, contact: ContactShape
    ) -> tuple[FitnessWarning, ...]:
        """Return what a result must say of it on a structure."""
        ...


class KnownForces:
    """What holds for every source whose forces are known, for such a source to inherit.

    It gives its name, its contacts by name, when its last leaves, its surface, its track and way,
    its inputs, and to which frequency it excites; it has no vehicle, no run-in, no waves of a
    spectrum, and no doubts unless it says so.
    """

    oscillator: Vehicle | None = None
    standing = False
    level = False
    random = False
    varies = False
    complete = True

    def begins(self, dt: float) -> float:
        """Return 0: it acts from the record's start."""
        del dt
        return 0.0

    def later(self: Source, by: float) -> Source:
        """Refuse: it says nothing of when it begins."""
        if by == 0.0:
            return self
        raise InputError(f"{self.name!r} does not say when it begins, and cannot begin later")

    def waves(
        self, time: Float[Array, " times"], begins: float, n_waves: int
    ) -> tuple[WaveSet, ...]:
        """Return none."""
        del time, begins, n_waves
        return ()

    def partly_excited_to(self: Source, ends: float) -> float:
        """Return to which frequency it excites: its forces are all that there is of it."""
        return self.excited_to(ends)

    def stands_at(self: Source, time: float) -> tuple[tuple[float, float] | None, int]:
        """Return where its first contact stands at a time, None when off; and how many stand."""
        track = self.track(np.array([time]), -np.inf)
        on, first = track.share[0] > 0.0, track.place[0, 0]
        return (float(first[0]), float(first[1])) if on[0] else None, int(on.sum())

    def check(self, dt: float, duration: float | None) -> tuple[FitnessWarning, ...]:
        """Refuse nothing."""
        del dt, duration
        return ()

    def doubts(
        self, structure: Structure, modes: Modes | None, contact: ContactShape
    ) -> tuple[FitnessWarning, ...]:
        """Say nothing."""
        del structure, modes, contact
        return ()

"""Make machines sources of vibration: forces at their feet, through mounts if they have some."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from trundle._checks import frozen_array, non_negative, set_frozen
from trundle._typing import Array
from trundle.dynamics import Modes
from trundle.errors import FitnessWarning, InputError
from trundle.machine import MachineForce
from trundle.route import Track
from trundle.signals import Isolator, behind
from trundle.simulate.sources.random_road import run_generator
from trundle.simulate.sources.source import KnownForces
from trundle.structure import ContactShape, Structure

__all__ = ["Machine"]

_SHOWN = 0.4  # of the sampling frequency, up to which a step shows a wave
_COMES_ON = 1.0  # s, over which a steady force comes on
_SETTLES = 10.0  # s of record that a machine which never stops needs at least


@dataclass(frozen=True, kw_only=True, eq=False)
class Machine(KnownForces):
    """A machine on the floor, whose force its feet share equally.

    Its mass is not on the floor: put it there as a mass of the building where it counts. Level
    forces are not in it.

    Attributes
    ----------
    name : str
        Name; its phase depends on the seed, this name and the run alone.
    feet : ndarray of float, shape (n_feet, 2)
        Where they stand on their surface [m].
    force : MachineForce
        What the machine makes.
    on : str or None
        Name of the surface; None for the only one.
    mounts : Isolator or None
        What stands between machine and floor: the force is passed on as motion would be.
    starts : float
        When it starts [s].
    lasts : float
        How long it runs [s]; infinity for one that never stops.
    random_phase : bool
        Whether a rotor stands anywhere when the record begins, or at 0.
    """

    name: str
    feet: Float[Array, "feet 2"]
    force: MachineForce
    on: str | None = None
    mounts: Isolator | None = None
    starts: float = 0.0
    lasts: float = np.inf
    random_phase: bool = True

    def __post_init__(self) -> None:
        """Check places and times."""
        feet = frozen_array("feet", self.feet, shape=(None, 2))
        if not len(feet):
            raise InputError(f"machine {self.name!r} needs at least one foot")
        if not self.lasts > 0.0:
            raise InputError(f"machine {self.name!r} must run longer than 0 s; got {self.lasts:g}")
        set_frozen(self, feet=feet, starts=non_negative("starts", self.starts))

    @property
    def varies(self) -> bool:
        """Whether its phase is random."""
        return self.random_phase

    @property
    def contact_names(self) -> tuple[str, ...]:
        """Name of every foot."""
        if len(self.feet) == 1:
            return ("foot",)
        return tuple(f"foot {i + 1}" for i in range(len(self.feet)))

    @property
    def leaves(self) -> float:
        """When it has stopped [s]; of one that never does, when it has settled."""
        return self.starts + (self.lasts if np.isfinite(self.lasts) else _SETTLES)

    def later(self, by: float) -> Machine:
        """Return the same machine, started later [s]."""
        return replace(self, starts=self.starts + by)

    def track(self, time: Float[Array, " times"], begins: float) -> Track:
        """Return where its feet stand: always there."""
        del begins
        shape = (len(time), len(self.feet))
        place = np.broadcast_to(self.feet, (*shape, 2))
        return Track(
            on=self.on, place=place, direction=np.broadcast_to([1.0, 0.0], place.shape),
            speed=np.zeros(shape), share=np.ones(shape), share_slope=np.zeros(shape),
        )  # fmt: skip

    def way(self) -> Iterator[tuple[Float[Array, "places 2"], Float[Array, "places 2"]]]:
        """Give the places of its feet, with a direction.

        Yields
        ------
        tuple of ndarray, shape (n_feet, 2)
            Places [m], and unit directions.
        """
        yield np.asarray(self.feet), np.broadcast_to([1.0, 0.0], self.feet.shape)

    def inputs(self, time: Float[Array, " times"], begins: float, seed: int) -> MachineInputs:
        """Return what its feet press with."""
        del begins
        return MachineInputs(self, time, seed)

    def excited_to(self, ends: float) -> float:
        """Return where its force ends [Hz]."""
        del ends
        return self.force.reaches

    def check(self, dt: float, duration: float | None) -> tuple[FitnessWarning, ...]:
        """Refuse a force that is faster than a step shows: it would look slow."""
        del duration
        shows = self.force.shows
        if shows > _SHOWN / dt:
            raise InputError(
                f"machine {self.name!r} shakes at {shows:.4g} Hz, and steps of {1e3 * dt:g} ms "
                f"show {_SHOWN / dt:.4g} Hz at most: shorten dt to {1e3 * _SHOWN / shows:.2g} ms"
            )
        return ()

    def doubts(
        self, structure: Structure, modes: Modes | None, contact: ContactShape
    ) -> tuple[FitnessWarning, ...]:
        """Say what of a machine is not in it."""
        del structure, modes, contact
        message = "its vertical force alone: level forces, and its mass on the floor, are not in it"
        return (FitnessWarning(subject=f"machine, {self.name}", message=message),)


class MachineInputs:
    """What the feet of a machine press a floor with."""

    def __init__(self, machine: Machine, time: Float[Array, " times"], seed: int) -> None:
        self._machine, self._time, self._seed = machine, time, seed

    def draw(self, run: int) -> tuple[Float[Array, "times contacts"], Float[Array, " contacts"]]:
        """Return the forces of a run [N], and no heights."""
        machine = self._machine
        if not machine.random_phase:
            return self._pressed(0.0)
        return self._pressed(run_generator(self._seed, machine.name, run).random())

    def still(self) -> tuple[Float[Array, "times contacts"], Float[Array, " contacts"]]:
        """Return them without anything random: at phase 0, or none where the phase is random."""
        if self._machine.random_phase:
            shape = (len(self._time), len(self._machine.feet))
            return np.zeros(shape), np.zeros(shape[1])
        return self._pressed(0.0)

    def _pressed(self, phase: float) -> tuple[Array, Array]:
        machine, n_feet = self._machine, len(self._machine.feet)
        clock = self._time - machine.starts
        force = machine.force.at(clock, phase) * _running(clock, machine)
        if machine.mounts is not None:
            force = behind(machine.mounts, force, 1.0 / float(self._time[1] - self._time[0]))
        return np.repeat(force[:, None] / n_feet, n_feet, axis=1), np.zeros(n_feet)


def _running(clock: Array, machine: Machine) -> Float[Array, " times"]:
    """Return a factor that is 1 while a machine runs: a steady one comes on and goes smoothly."""
    if machine.force.sudden:
        return ((clock >= 0.0) & (clock <= machine.lasts)).astype(float)
    over = min(_COMES_ON, 0.5 * machine.lasts)
    nearest = np.clip(np.minimum(clock, machine.lasts - clock) / over, 0.0, 1.0)
    return 0.5 - 0.5 * np.cos(np.pi * nearest)

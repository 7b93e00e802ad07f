"""Say what is asked of a time integration, of a floor prepared for it, and of what is driven over.

A study chooses an `Integration`. It prepares a structure once, for all crossings: a
`PreparedFloor`. That lays itself under the wheels of some crossings: a `Ground`, which carries them
over their record on any roads. A new integration is a file that gives all three; nothing outside
asks which it is.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol, runtime_checkable

from jaxtyping import Float

from trundle._progress import Progress
from trundle._typing import Array, SparseMatrix
from trundle.dynamics import Damping, ModalRecursion, Modes
from trundle.errors import FitnessWarning
from trundle.simulate.modal.residual import StaticFlexibility
from trundle.simulate.wheels.contacts import Wheels
from trundle.simulate.wheels.driven import Driven
from trundle.simulate.wheels.roads import RoadUnderWheels
from trundle.simulate.wheels.standing import StandingWheels
from trundle.structure import Structure
from trundle.vehicle import Vehicle

__all__ = ["Ground", "Integration", "ModalReach", "PreparedFloor"]


@runtime_checkable
class Ground(Protocol):
    """What lies under the wheels of some crossings: rigid, in its modes, or in all its dofs."""

    @property
    def coupled(self) -> bool:
        """Whether it moves under the wheels."""
        ...

    @property
    def doubts(self) -> tuple[FitnessWarning, ...]:
        """What a result must say of how it lies under these wheels."""
        ...

    def check(self, wheels: Wheels) -> None:
        """Refuse contacts that the time step does not bear."""
        ...

    def drive(
        self,
        wheels: Wheels,
        road: RoadUnderWheels,
        *,
        weight: Float[Array, " runs"],
        progress: Progress | None = None,
    ) -> Driven:
        """Carry the wheels over the record, all runs together.

        `weight` is the share of its static wheel loads that each run feels: 1, or 0 for its
        dynamics alone.
        """
        ...

    def with_modes_below(self, f: float) -> Ground:
        """Return the same with fewer modes [Hz]; refused where it has none."""
        ...


@dataclass(frozen=True, kw_only=True, eq=False)
class ModalReach:
    """Hold how motion in modes leads from forces at some dofs to some readings.

    Attributes
    ----------
    propagator : ModalRecursion
        Steps of the modes.
    n_stepped : int
        How many of them are stepped; the others follow the forces (`following_filters`).
    dof_shapes : ndarray of float, shape (n_modes, n_dofs)
        Modes at the dofs.
    read_shapes : ndarray of float, shape (n_read, n_modes)
        Modes at what is read.
    residual : ndarray of float or None, shape (n_read, n_dofs)
        Static flexibility of the modes left out [m/N].
    """

    propagator: ModalRecursion
    n_stepped: int
    dof_shapes: Float[Array, "modes dofs"]
    read_shapes: Float[Array, "read modes"]
    residual: Float[Array, "read dofs"] | None


@runtime_checkable
class PreparedFloor(Protocol):
    """A structure with what its integration needs: modes, or a factorised matrix."""

    @property
    def floor(self) -> Structure:
        """The structure."""
        ...

    @property
    def integration(self) -> Integration:
        """Time integration it is prepared for."""
        ...

    @property
    def damping(self) -> Damping:
        """Damping it is prepared for."""
        ...

    @property
    def modes(self) -> Modes | None:
        """Natural modes below `f_max`; None where it is stepped without them."""
        ...

    @property
    def flexibility(self) -> StaticFlexibility:
        """Static deflections, for starts at rest and for the modes left out."""
        ...

    def doubts(self) -> tuple[FitnessWarning, ...]:
        """Return what a result must say of step and modes."""
        ...

    def under(self, standing: StandingWheels, reader: SparseMatrix, *, coupled: bool) -> Ground:
        """Lie under wheels; `reader` (n_points, n_dofs) is where the response is read."""
        ...

    def reach(self, dofs: Array, reader: SparseMatrix) -> ModalReach:
        """Return how forces at dofs reach readings; refused where there are no modes."""
        ...


@runtime_checkable
class Integration(Protocol):
    """How equations are integrated in time."""

    @property
    def dt(self) -> float:
        """Time step [s]."""
        ...

    @property
    def f_max(self) -> float | None:
        """Frequency below which all modes are kept [Hz]; None where no modes are used."""
        ...

    @property
    def f_resolved(self) -> float:
        """Highest frequency that modes and step show as it is [Hz]."""
        ...

    def doubts(self) -> tuple[FitnessWarning, ...]:
        """Return what a result must say of step and modes."""
        ...

    def check_damping(self, damping: Damping) -> None:
        """Refuse a damping that it cannot carry."""
        ...

    def check_vehicle(self, vehicle: Vehicle, *, level: bool) -> None:
        """Refuse a vehicle whose motion the step cannot show, or a start that it does not know.

        `level` says that it starts level, and not in equilibrium on the road.
        """
        ...

    def prepare(
        self,
        floor: Structure,
        damping: Damping,
        *,
        modes: Modes | None = None,
        flexibility: StaticFlexibility | None = None,
        progress: Progress | None = None,
    ) -> PreparedFloor:
        """Find modes, or factorise, once for all crossings of a structure."""
        ...

    def rigid(self) -> Ground:
        """Return ground that does not move."""
        ...

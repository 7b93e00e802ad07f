"""Step a floor in its modes, exactly: what is chosen, and how a floor is prepared for it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from jaxtyping import Int

from trundle._checks import positive, set_frozen, within
from trundle._progress import Progress
from trundle._typing import Array, SparseMatrix
from trundle.dynamics import TOP, ByMaterial, Damping, ModalRecursion, Modes, response_basis
from trundle.errors import FitnessWarning, InputError
from trundle.signals import TOP_FREQUENCY
from trundle.simulate.ground import ModalReach
from trundle.simulate.modal.floor import ModalFloor
from trundle.simulate.modal.followers import followers_of
from trundle.simulate.modal.ground import ModalGround, RigidForExactSteps
from trundle.simulate.modal.point_motion import point_filters
from trundle.simulate.modal.residual import StaticFlexibility, point_residual, unit_loads
from trundle.simulate.step_limits import step_problem
from trundle.simulate.wheels.standing import StandingWheels
from trundle.structure import Structure
from trundle.vehicle import Vehicle

__all__ = ["MODES_BEYOND", "FloorInModes", "Modal"]

MODES_BEYOND = 1.25  # times a band's upper edge must the modes reach, for 3 % in its level


@dataclass(frozen=True, kw_only=True)
class Modal:
    """Choose modal superposition with all modes below a frequency, stepped exactly.

    Attributes
    ----------
    f_max : float
        All modes below this frequency are kept [Hz].
    dt : float
        Time step [s].
    residual : bool
        Add the static flexibility of the modes left out (True), or leave them out altogether.
    single : bool
        Carry the floor's state over the steps in single precision: faster, to some 1e-4.
    response_tolerance : float
        Step as few combinations of modes as answer between route and points within this error
        (`dynamics.combined_modes`); 0 for all modes.
    """

    f_max: float
    dt: float
    residual: bool = True
    single: bool = False
    response_tolerance: float = 0.0

    def __post_init__(self) -> None:
        """Check all numbers."""
        set_frozen(self, f_max=positive("f_max", self.f_max), dt=positive("dt", self.dt))
        within("response_tolerance", self.response_tolerance, 0.0, 0.1)

    def __str__(self) -> str:
        """Describe the method for a report."""
        rest = "" if self.residual else "nothing for the modes above, "
        rest += "single precision, " if self.single else ""
        if self.response_tolerance:
            rest += f"combined within {100 * self.response_tolerance:g} %, "
        return (
            f"modal superposition, modes below {self.f_max:g} Hz, {rest}exact recursion, "
            f"dt = {1e3 * self.dt:g} ms"
        )

    @property
    def f_resolved(self) -> float:
        """Highest frequency that modes and step show as it is [Hz].

        Modes are right to 0.45 of the sampling frequency (`dynamics.sampling`) and
        ``f_max / 1.25``: those above answer statically, and the nearest of them do more. On the
        reference unit the 80 Hz band, which ends at 89 Hz, was up to 30 % off with modes to 90 Hz,
        7 % with modes to 100 Hz, 3 % to 112 Hz, 2 % to 125 Hz; the 63 Hz band with modes to 90 Hz
        1.5 %.
        """
        return min(self.f_max / MODES_BEYOND, TOP / self.dt)

    def doubts(self) -> tuple[FitnessWarning, ...]:
        """Return what a result must say of step and modes."""
        found, shown = [], TOP / self.dt
        if shown <= TOP_FREQUENCY:
            found.append(
                FitnessWarning(
                    subject="time step",
                    message=f"dt = {1e3 * self.dt:g} ms shows frequencies to {shown:.3g} Hz as "
                    "they are; bands that reach above are not assessed",
                )
            )
        found.append(
            FitnessWarning(
                subject="modal truncation",
                message=f"modes above {self.f_max:g} Hz are left out; they follow the wheels "
                "without delay (static residual flexibility), not with their own resonance: "
                f"levels to {self.f_max / MODES_BEYOND:.3g} Hz were within 3 % on the reference "
                "unit, and bands that reach above are not assessed",
            )
        )
        return tuple(found)

    def check_damping(self, damping: Damping) -> None:
        """Carry any damping."""

    def check_vehicle(self, vehicle: Vehicle, *, level: bool) -> None:
        """Refuse a vehicle that vibrates faster than the step shows, or is not linear."""
        del level
        if not vehicle.is_linear:
            raise InputError(
                f"vehicle {vehicle.name!r} is not linear (friction, stops, or lifting off): it is "
                'stepped run by run with Newmark\'s method alone, integration = "newmark"'
            )
        if problem := step_problem(vehicle, self.dt):
            raise InputError(problem)

    def prepare(
        self,
        floor: Structure,
        damping: Damping,
        *,
        modes: Modes | None = None,
        flexibility: StaticFlexibility | None = None,
        progress: Progress | None = None,
    ) -> FloorInModes:
        """Find the modes, unless some that reach as far are given."""
        if modes is None or modes.f_max < self.f_max:
            modes = floor.modes(self.f_max, progress=progress)
        modes = self._below(modes)
        ratios = damping.in_modes(modes, floor.damped_stiffness)
        return FloorInModes(
            floor=floor,
            integration=self,
            damping=damping,
            propagator=ModalRecursion(modes.omega, ratios, self.dt),
            modes=modes,
            flexibility=flexibility or StaticFlexibility(floor),
        )

    def _below(self, modes: Modes) -> Modes:
        """Return the modes asked for, of which at least one must be stepped."""
        nyquist = 0.5 / self.dt
        kept = modes.below(self.f_max)
        if kept.n_modes == 0:
            raise InputError(f"no mode lies below f_max = {self.f_max:g} Hz; raise f_max")
        if kept.frequencies[0] >= nyquist:
            raise InputError(
                f"no mode lies below {nyquist:g} Hz, half the sampling frequency; shorten dt"
            )
        return kept

    def rigid(self) -> RigidForExactSteps:
        """Return ground that does not move."""
        return RigidForExactSteps(dt=self.dt)


@dataclass(frozen=True, kw_only=True, eq=False)
class FloorInModes:
    """Hold a structure in its modes.

    Attributes
    ----------
    floor : Structure
        The structure.
    integration : Modal
        What it is prepared for.
    damping : Damping
        Its damping.
    propagator : ModalRecursion
        The steps of all modes.
    modes : Modes
        Natural modes below `f_max`.
    flexibility : StaticFlexibility
        Static deflections, for the modes left out.
    """

    floor: Structure
    integration: Modal
    damping: Damping
    propagator: ModalRecursion
    modes: Modes
    flexibility: StaticFlexibility

    @cached_property
    def residual(self) -> bool:
        """Whether the modes left out answer statically."""
        return self.integration.residual and self.flexibility.known

    def doubts(self) -> tuple[FitnessWarning, ...]:
        """Return what a result must say of step and modes."""
        found = self.integration.doubts()
        if self.integration.residual and not self.residual:
            found = tuple(one for one in found if one.subject != "modal truncation")
            found += (
                FitnessWarning(
                    subject="modal truncation",
                    message=f"{self.floor.name} is known by its {self.modes.n_modes} modes below "
                    f"{self.modes.f_max:g} Hz alone: what lies above does not answer, not even "
                    "statically (the floor sinks less under a wheel, and close to a route levels "
                    "may be too low), and that no mode below is missing is their giver's word; "
                    f"bands that reach above {self.integration.f_resolved:.3g} Hz are not assessed",
                ),
            )
        if self.modes.answering:
            found += (FitnessWarning(subject="answers", message=self.modes.answering),)
        if self.modes.basis is not None:
            found += (FitnessWarning(subject="parts", message=self.modes.basis.told),)
        if isinstance(self.damping, ByMaterial):
            found += (self._damping_found(),)
        return found

    def _damping_found(self) -> FitnessWarning:
        """Say what materials make of the damping of modes."""
        ratios = 100.0 * self.propagator.double / (2.0 * np.sqrt(self.propagator.square))
        low, high = ratios.min(), ratios.max()
        return FitnessWarning(
            subject="damping",
            message=f"by the energy that modes store in each material they have {low:.2g} to "
            f"{high:.2g} % of critical, the first {ratios[0]:.2g} %",
        )

    @cached_property
    def n_stepped(self) -> int:
        """How many of the modes are stepped; those after them follow the forces.

        Modes below half the sampling frequency must be, and those that creep below it: damped
        beyond critical they come back at ``omega (zeta - sqrt(zeta^2 - 1))``.
        """
        omega = np.sqrt(self.propagator.square)
        ratio = np.maximum(1.0, self.propagator.double / (2.0 * omega))
        slowest = omega * (ratio - np.sqrt(ratio**2 - 1.0))
        must = np.flatnonzero(slowest < np.pi / self.propagator.dt)
        return int(must[-1]) + 1 if len(must) else 0

    def under(
        self, standing: StandingWheels, reader: SparseMatrix, *, coupled: bool
    ) -> ModalGround:
        """Lie under wheels."""
        if self.integration.response_tolerance:
            fewer, doubts = self._combined(standing.used_dofs(), reader)
            return replace(fewer._lying(standing, reader, coupled=coupled), doubts=doubts)
        return self._lying(standing, reader, coupled=coupled)

    def _lying(
        self, standing: StandingWheels, reader: SparseMatrix, *, coupled: bool
    ) -> ModalGround:
        """Lie under wheels with all modes that are held."""
        residual, dofs = None, standing.used_dofs()
        if self.residual:
            residual = point_residual(self.flexibility, self.modes, reader, dofs)
        followers = followers_of(self.modes, self.propagator, self.n_stepped, reader, dofs)
        floor = ModalFloor(
            self.modes.first(self.n_stepped),
            self.propagator.part(slice(self.n_stepped)),
            standing,
            reader,
            flexibility=self.flexibility if coupled and self.residual else None,
            single=self.integration.single,
        )
        return ModalGround(
            floor=floor,
            residual=residual,
            followers=followers,
            filters=point_filters(floor, residual, followers),
            coupled=coupled,
        )

    def _combined(
        self, dofs: Int[Array, " dofs"], reader: SparseMatrix
    ) -> tuple[FloorInModes, tuple[FitnessWarning, ...]]:
        """Return the same in as few combinations of its modes as a route and points need."""
        tolerance, n_modes = self.integration.response_tolerance, self.modes.n_modes
        basis = response_basis(
            self.modes.omega,
            self.propagator.double / (2.0 * self.modes.omega),
            self.modes.at(dofs),
            self.modes.seen(reader),
            f_max=self.integration.f_resolved,
            tolerance=tolerance,
        )
        if basis is None:
            return self, ()
        fewer = replace(
            self,
            modes=self.modes.combined(basis.combined, basis.omega),
            propagator=ModalRecursion(basis.omega, basis.ratios, self.integration.dt),
        )
        told = FitnessWarning(
            subject="response basis",
            message=f"{n_modes} modes are stepped as {len(basis.omega)} combinations of them: "
            f"between route and points their response differs by {100 * basis.error:.2g} % in the "
            "worst band (RMS of the difference over that of the response), static parts left out",
        )
        return fewer, (told,)

    def reach(self, dofs: Int[Array, " dofs"], reader: SparseMatrix) -> ModalReach:
        """Return how forces at dofs reach readings, for all modes kept."""
        read = np.ascontiguousarray(self.modes.seen(reader))
        shapes, residual = self.modes.at(dofs), None
        if self.residual:
            residual = np.empty((reader.shape[0], len(dofs)))
            for part, unit in unit_loads(dofs, self.floor.n_dofs):
                residual[:, part] = reader @ self.flexibility.solve(unit)
            residual -= (read / self.modes.omega**2) @ shapes.T
        return ModalReach(
            propagator=self.propagator,
            n_stepped=self.n_stepped,
            dof_shapes=np.ascontiguousarray(shapes.T),
            read_shapes=read,
            residual=residual,
        )

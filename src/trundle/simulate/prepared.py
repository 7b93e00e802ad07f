"""Prepare a floor once for all crossings: find its modes, or factorise."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from trundle._kinds import kinds_checked
from trundle._progress import Progress
from trundle.dynamics import (
    Damping,
    LinearSystem,
    Modal,
    ModalRatio,
    ModalRecursion,
    Modes,
    NewmarkPropagator,
    Rayleigh,
    natural_modes,
)
from trundle.errors import InputError
from trundle.simulate.crossing import Integration
from trundle.simulate.modal.residual import StaticFlexibility
from trundle.structure import Floor

__all__ = ["PreparedFloor", "prepare"]


@dataclass(frozen=True, kw_only=True, eq=False)
class PreparedFloor:
    """Hold a floor with what its integration needs: modes, or a factorised matrix.

    Attributes
    ----------
    floor : Floor
        The floor.
    integration : Newmark or Modal
        Time integration it is prepared for.
    damping : Rayleigh or ModalRatio
        Damping it is prepared for.
    propagator : NewmarkPropagator or ModalRecursion
        The scheme with its coefficients, for all modes.
    modes : Modes or None
        Natural modes below `f_max`, for `Modal`; a full floor has none.
    flexibility : StaticFlexibility
        Static deflections, for starts at rest and for the modes left out.
    """

    floor: Floor
    integration: Integration
    damping: Damping
    propagator: NewmarkPropagator | ModalRecursion
    modes: Modes | None
    flexibility: StaticFlexibility

    @property
    def n_stepped(self) -> int:
        """How many of the modes are stepped; those after them follow the forces.

        Modes below half the sampling frequency must be, and those that creep below it: damped
        beyond critical they come back at ``omega (zeta - sqrt(zeta^2 - 1))``.
        """
        if not isinstance(self.propagator, ModalRecursion):
            return 0
        omega = np.sqrt(self.propagator.square)
        ratio = np.maximum(1.0, self.propagator.double / (2.0 * omega))
        slowest = omega * (ratio - np.sqrt(ratio**2 - 1.0))
        must = np.flatnonzero(slowest < np.pi / self.propagator.dt)
        return int(must[-1]) + 1 if len(must) else 0

    @property
    def residual(self) -> bool:
        """Whether the modes left out answer statically."""
        return isinstance(self.integration, Modal) and self.integration.residual

    @property
    def single(self) -> bool:
        """Whether steps are carried out in single precision."""
        return isinstance(self.integration, Modal) and self.integration.single


@kinds_checked
def prepare(
    floor: Floor,
    integration: Integration,
    damping: Damping,
    *,
    modes: Modes | None = None,
    flexibility: StaticFlexibility | None = None,
    progress: Progress | None = None,
) -> PreparedFloor:
    """Find modes, or factorise, once for all crossings of a floor.

    Parameters
    ----------
    floor : Floor
        The floor.
    integration : Newmark or Modal
        Time integration.
    damping : Rayleigh or ModalRatio
        Damping of the floor.
    modes : Modes, optional
        Modes found before; they must reach as far as `integration` asks.
    flexibility : StaticFlexibility, optional
        Static deflections of the same floor found before.
    progress : callable, optional
        Told the share of modes found.
    """
    flexibility = flexibility or StaticFlexibility(floor)
    if isinstance(integration, Modal):
        if modes is None or modes.f_max < integration.f_max:
            modes = natural_modes(
                floor.mass, floor.stiffness, f_max=integration.f_max, progress=progress
            )
        modes = _below(modes, integration)
        ratios = damping.ratios(modes.omega)
        propagator = ModalRecursion(modes.omega, ratios, integration.dt)
        return PreparedFloor(
            floor=floor,
            integration=integration,
            damping=damping,
            propagator=propagator,
            modes=modes,
            flexibility=flexibility,
        )
    matrix = (
        0.0 * floor.mass
        if isinstance(damping, ModalRatio)
        else damping.matrix(floor.mass, floor.stiffness)
    )
    system = LinearSystem(mass=floor.mass, damping=matrix, stiffness=floor.stiffness)
    return PreparedFloor(
        floor=floor,
        integration=integration,
        damping=damping,
        propagator=NewmarkPropagator(
            system, integration, rayleigh=damping if isinstance(damping, Rayleigh) else None
        ),
        modes=None,
        flexibility=flexibility,
    )


def _below(modes: Modes, integration: Modal) -> Modes:
    """Return the modes asked for, of which at least one must be stepped."""
    f_max, nyquist = integration.f_max, 0.5 / integration.dt
    kept = modes.below(f_max)
    if kept.n_modes == 0:
        raise InputError(f"no mode lies below f_max = {f_max:g} Hz; raise f_max")
    if kept.frequencies[0] >= nyquist:
        raise InputError(
            f"no mode lies below {nyquist:g} Hz, half the sampling frequency; shorten dt"
        )
    return kept

"""Prepare a floor once for all crossings: find its modes, or factorise."""

from __future__ import annotations

from trundle._kinds import kinds_checked
from trundle._progress import Progress
from trundle.dynamics import Damping, Modes
from trundle.simulate.ground import Integration, PreparedFloor
from trundle.simulate.modal.residual import StaticFlexibility
from trundle.structure import Structure

__all__ = ["prepare"]


@kinds_checked
def prepare(
    floor: Structure,
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
    floor : Structure
        The floor.
    integration : Modal, Newmark or another Integration
        Time integration.
    damping : ModalRatio, Rayleigh or another Damping
        Damping of the floor.
    modes : Modes, optional
        Modes found before; they must reach as far as `integration` asks.
    flexibility : StaticFlexibility, optional
        Static deflections of the same floor found before.
    progress : callable, optional
        Told the share of modes found.
    """
    return integration.prepare(
        floor, damping, modes=modes, flexibility=flexibility, progress=progress
    )

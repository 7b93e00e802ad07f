"""Say how vehicle and floor act on each other, and by what integration."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TypeAlias

from trundle._kinds import kinds_checked
from trundle.dynamics import Damping, ModalRatio
from trundle.simulate.ground import Integration
from trundle.simulate.modal.method import Modal
from trundle.structure import ContactShape, Hermite

__all__ = ["Coupled", "Decoupled", "Interaction"]


@kinds_checked
@dataclass(frozen=True, kw_only=True)
class Decoupled:
    """Load the floor with the contact forces of a vehicle on rigid ground.

    The paper's dynamic nodal loading (DNL), "non-interaction".

    Attributes
    ----------
    integration : Modal, Newmark or another Integration
        Time integration of vehicle and floor; modes to 90 Hz in steps of 5 ms, which shows
        bands up to 80 Hz, unless given.
    damping : ModalRatio, Rayleigh or another Damping
        Damping of the floor.
    contact : Hermite, Hat or another ContactShape
        Interpolation of the load between nodes.
    """

    integration: Integration = field(default_factory=lambda: Modal(f_max=112.0, dt=0.005))
    damping: Damping = field(default_factory=lambda: ModalRatio(ratio=0.03))
    contact: ContactShape = field(default_factory=Hermite)

    def __post_init__(self) -> None:
        """Refuse a damping that the integration cannot carry."""
        self.integration.check_damping(self.damping)

    @property
    def moves(self) -> bool:
        """Whether the floor moves under the wheels: no."""
        return False

    def __str__(self) -> str:
        """Describe the method for a report."""
        return f"decoupled; {self.integration}; {self.damping}; {self.contact}"


@kinds_checked
@dataclass(frozen=True, kw_only=True)
class Coupled:
    """Solve vehicle and floor together at every step, without factorising anything again.

    The paper's dynamic finite-element method (DFE), "interaction". Attributes as in
    `Decoupled`.
    """

    integration: Integration = field(default_factory=lambda: Modal(f_max=112.0, dt=0.005))
    damping: Damping = field(default_factory=lambda: ModalRatio(ratio=0.03))
    contact: ContactShape = field(default_factory=Hermite)

    def __post_init__(self) -> None:
        """Refuse a damping that the integration cannot carry."""
        self.integration.check_damping(self.damping)

    @property
    def moves(self) -> bool:
        """Whether the floor moves under the wheels: yes."""
        return True

    def __str__(self) -> str:
        """Describe the method for a report."""
        return f"coupled; {self.integration}; {self.damping}; {self.contact}"


Interaction: TypeAlias = Decoupled | Coupled
"""How vehicle and floor act on each other."""

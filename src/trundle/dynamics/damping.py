"""State damping once, for direct integration and modal superposition alike."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float

from trundle._checks import non_negative, positive, set_frozen, within
from trundle._typing import Array, Matrix, SparseMatrix
from trundle.dynamics.modes import Modes
from trundle.errors import FitnessWarning, InputError

__all__ = ["ByMaterial", "Damping", "ModalRatio", "Rayleigh"]

_HEAVY = 0.10  # damping ratio above which Rayleigh damping suppresses what it should show
_LOOKED_AT = (10.0, 20.0, 40.0, 80.0)  # Hz


@runtime_checkable
class Damping(Protocol):
    """How a structure is damped: a ratio for each mode, and matrices where it can be had so."""

    def ratios(self, omega: Float[Array, " modes"]) -> Float[Array, " modes"]:
        """Return the damping ratio of each mode at circular frequency omega [rad/s]."""
        ...

    def in_modes(
        self, modes: Modes, damped: Callable[[float], SparseMatrix]
    ) -> Float[Array, " modes"]:
        """Return the damping ratio of each mode.

        `damped` gives the stiffness, every part's times its damping ratio, that of parts without
        one times what it is called with.
        """
        ...

    @property
    def rayleigh(self) -> Rayleigh | None:
        """The same as ``alpha M + beta K``; None where it is no such sum."""
        ...

    def doubts(self) -> tuple[FitnessWarning, ...]:
        """Return what a result must say of it."""
        ...


@dataclass(frozen=True, kw_only=True)
class Rayleigh:
    """Damp in proportion to mass and stiffness, ``C = alpha M + beta K``.

    The ratio of a mode at omega is ``alpha / (2 omega) + beta omega / 2``.

    Attributes
    ----------
    alpha : float
        Mass coefficient [1/s].
    beta : float
        Stiffness coefficient [s].

    Examples
    --------
    The coefficients printed in Pan, Mita and Li (2001) are 3 % at 3.75 and 5.80 Hz:

    >>> paper = Rayleigh(alpha=0.8587, beta=0.001)
    >>> paper.ratios(2 * np.pi * np.array([3.75, 5.80])).round(4).tolist()
    [0.03, 0.03]
    """

    alpha: float
    beta: float

    def __post_init__(self) -> None:
        """Check both coefficients."""
        set_frozen(
            self,
            alpha=non_negative("rayleigh alpha", self.alpha),
            beta=non_negative("rayleigh beta", self.beta),
        )

    @classmethod
    def through(cls, ratio: float, f_low: float, f_high: float) -> Rayleigh:
        """Give one damping ratio at two frequencies [Hz]."""
        ratio = within("damping ratio", ratio, 0.0, 1.0)
        low = 2.0 * np.pi * positive("f_low", f_low)
        high = 2.0 * np.pi * positive("f_high", f_high)
        if high <= low:
            raise InputError(f"f_high must be above f_low = {f_low:g} Hz; got {f_high:g} Hz")
        return cls(alpha=2 * ratio * low * high / (low + high), beta=2 * ratio / (low + high))

    def ratios(self, omega: Float[Array, " modes"]) -> Float[Array, " modes"]:
        """Return the damping ratio of each mode at circular frequency omega [rad/s]."""
        return self.alpha / (2.0 * omega) + self.beta * omega / 2.0

    def in_modes(
        self, modes: Modes, damped: Callable[[float], SparseMatrix]
    ) -> Float[Array, " modes"]:
        """Return the damping ratio of each mode, whatever it is made of."""
        del damped
        return self.ratios(modes.omega)

    @property
    def rayleigh(self) -> Rayleigh:
        """Itself."""
        return self

    def doubts(self) -> tuple[FitnessWarning, ...]:
        """Say how it grows where it grows beyond a tenth of critical."""
        ratios = self.ratios(2.0 * np.pi * np.array(_LOOKED_AT))
        if ratios.max() < _HEAVY:
            return ()
        told = zip(_LOOKED_AT, ratios, strict=True)
        text = ", ".join(f"{100 * z:.2g} % at {x:g} Hz" for x, z in told)
        return (FitnessWarning(subject="damping", message=f"Rayleigh damping grows: {text}"),)

    def matrix(self, mass: Matrix, stiffness: Matrix) -> Matrix:
        """Return C [N s/m] for the given mass and stiffness matrices."""
        return self.alpha * mass + self.beta * stiffness

    def __str__(self) -> str:
        """Describe the model for a report."""
        return f"Rayleigh alpha = {self.alpha:g} 1/s, beta = {self.beta:g} s"


@dataclass(frozen=True, kw_only=True)
class ModalRatio:
    """Damp every mode with one ratio of critical damping.

    Attributes
    ----------
    ratio : float
        Ratio of critical damping, at least 0 and below 1.
    """

    ratio: float

    def __post_init__(self) -> None:
        """Check the ratio."""
        if self.ratio >= 1.0:
            raise InputError(
                f"damping ratio must be below 1; got {self.ratio:g} (write 3 % as 0.03)"
            )
        set_frozen(self, ratio=non_negative("damping ratio", self.ratio))

    def ratios(self, omega: Float[Array, " modes"]) -> Float[Array, " modes"]:
        """Return the damping ratio of each mode at circular frequency omega [rad/s]."""
        return np.full_like(omega, self.ratio)

    def in_modes(
        self, modes: Modes, damped: Callable[[float], SparseMatrix]
    ) -> Float[Array, " modes"]:
        """Return the damping ratio of each mode, whatever it is made of."""
        del damped
        return self.ratios(modes.omega)

    @property
    def rayleigh(self) -> Rayleigh | None:
        """None: it would fill the whole matrix; without damping both coefficients are 0."""
        return None if self.ratio else Rayleigh(alpha=0.0, beta=0.0)

    def doubts(self) -> tuple[FitnessWarning, ...]:
        """Say nothing: every mode has what was asked for."""
        return ()

    def __str__(self) -> str:
        """Describe the model for a report."""
        return f"{100 * self.ratio:g} % of critical in every mode"


@dataclass(frozen=True, kw_only=True)
class ByMaterial:
    """Damp every mode as the materials that it strains.

    The ratio of a mode is the mean of those of its parts, each weighted by the energy that it
    stores: ``sum(zeta_g phi.T K_g phi) / phi.T K phi`` (composite modal damping; Eurocode 8-2,
    annex D).

    Attributes
    ----------
    other : float
        Ratio of critical damping of parts whose material has none, such as springs.
    """

    other: float

    def __post_init__(self) -> None:
        """Check the ratio."""
        set_frozen(self, other=within("damping ratio", self.other, 0.0, 0.9999))

    def ratios(self, omega: Float[Array, " modes"]) -> Float[Array, " modes"]:
        """Return the ratio of parts whose material has none: of modes alone no more is known."""
        return np.full_like(omega, self.other)

    def in_modes(
        self, modes: Modes, damped: Callable[[float], SparseMatrix]
    ) -> Float[Array, " modes"]:
        """Return the damping ratio of each mode, by the energy in its parts."""
        return modes.energies(damped(self.other)) / modes.omega**2

    @property
    def rayleigh(self) -> Rayleigh | None:
        """None: modes differ as their parts do."""
        return None

    def doubts(self) -> tuple[FitnessWarning, ...]:
        """Say nothing: every part has what was asked for."""
        return ()

    def __str__(self) -> str:
        """Describe the model for a report."""
        return (
            "damping of modes by the energy in each material, "
            f"{100 * self.other:g} % of critical where none is given"
        )

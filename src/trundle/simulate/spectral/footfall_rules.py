"""Say how each guide weighs the response to footfall: build-up, weighting, what is added to what.

All of them put the harmonics of a walker on a floor in its modes; they differ in how far a mode
builds up before the walker has gone by, and in what the acceleration is held against. Where P354
adds the sizes of modes (with the signs of their shapes), modes are added with their phases here, as
CCIP-016 does: of one mode both are the same.

References
----------
A. L. Smith, S. J. Hicks, P. J. Devine, SCI P354, revised (2009): chapter 6. M. R. Willford, P.
Young, CCIP-016 (2006): 4.3 and 4.4. T. M. Murray, D. E. Allen, E. E. Ungar, D. B. Davis, AISC
Design Guide 11, 2nd ed. (2016): chapters 4 and 7. Their equations are from memory, confidence high.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Literal, Protocol, TypeAlias, runtime_checkable

import numpy as np
from jaxtyping import Float

from trundle._checks import one_of, positive, set_frozen
from trundle._typing import Array
from trundle.footfall import FootfallLoad
from trundle.signals import BASE_ACCELERATION, weighting_response

__all__ = [
    "AiscBayRule",
    "AiscRule",
    "CcipRule",
    "FootfallQuantity",
    "FootfallRule",
    "SciRule",
    "aisc_bay_acceleration",
    "footfall_rule",
]

FootfallQuantity: TypeAlias = Literal["response_factor", "peak_acceleration"]
"""A response factor, or a peak acceleration [m/s2]."""

_G = 9.80665  # m/s2
_STRIDE = 0.75  # m, CCIP-016
_AVERAGE = 0.55  # of a span in which a mode is driven as at its middle, CCIP-016
_P0 = 65.0 * 4.4482216152605  # N, offices: half of 157 lb times 0.83 (Design Guide 11, table 4-1)


@runtime_checkable
class FootfallRule(Protocol):
    """How a guide makes a level of the motion that a walker gives a floor."""

    @property
    def quantity(self) -> FootfallQuantity:
        """What the level is."""
        ...

    @property
    def together(self) -> bool:
        """Whether harmonics add up by their squares; the largest alone counts otherwise."""
        ...

    def amplitudes(self, load: FootfallLoad, pace: float) -> Float[Array, " harmonics"]:
        """Return the force of each harmonic [N]."""
        ...

    def build_up(
        self, load: FootfallLoad, pace: float, ratios: Float[Array, " modes"]
    ) -> Float[Array, "harmonics modes"]:
        """Return the share of its steady state that each mode reaches."""
        ...

    def steady_weight(self, f: Float[Array, " harmonics"]) -> Float[Array, " harmonics"]:
        """Return the level of each m/s2 of peak acceleration at frequencies [Hz]."""
        ...

    def transient_weight(self, omega: Float[Array, " modes"]) -> Float[Array, " modes"]:
        """Return the level of each m/s of RMS velocity of modes at circular frequencies [rad/s]."""
        ...


@dataclass(frozen=True, kw_only=True)
class SciRule:
    """Hold SCI P354: response factor by acceleration weighted with Wb.

    Attributes
    ----------
    path_length : float
        Length of the walking path L_p [m]; without end unless given.

    Notes
    -----
    ``R = a_w,rms / 0.005``, harmonics by the root of the sum of squares, each ``1/sqrt(2)`` of its
    peak; ``rho = 1 - exp(-2 pi zeta L_p f_p / v)``, the same for all harmonics.
    """

    path_length: float = np.inf
    quantity: FootfallQuantity = "response_factor"
    together: bool = True

    def __post_init__(self) -> None:
        """Check the length."""
        set_frozen(self, path_length=_length("path_length", self.path_length))

    def amplitudes(self, load: FootfallLoad, pace: float) -> Float[Array, " harmonics"]:
        """Return the force of each harmonic [N]."""
        return load.amplitudes(pace)

    def build_up(
        self, load: FootfallLoad, pace: float, ratios: Float[Array, " modes"]
    ) -> Float[Array, "harmonics modes"]:
        """Return the share of its steady state that each mode reaches."""
        cycles = self.path_length * pace / load.walking_speed(pace)
        return np.tile(_reached(ratios, cycles), (len(load.harmonics), 1))

    def steady_weight(self, f: Float[Array, " harmonics"]) -> Float[Array, " harmonics"]:
        """Return the response factor of each m/s2 of peak acceleration."""
        return np.abs(weighting_response("Wb", f)) / (np.sqrt(2.0) * BASE_ACCELERATION)

    def transient_weight(self, omega: Float[Array, " modes"]) -> Float[Array, " modes"]:
        """Return the response factor of each m/s of RMS velocity, each mode weighted by itself."""
        return omega * np.abs(weighting_response("Wb", omega / (2 * np.pi))) / BASE_ACCELERATION


@dataclass(frozen=True, kw_only=True)
class CcipRule:
    """Hold CCIP-016: response factor by the base curve at each frequency; of ISO 10137 as well.

    Attributes
    ----------
    span : float
        Length L that is walked across [m]; without end unless given.

    Notes
    -----
    Base line of peak acceleration ``0.0141 / sqrt(f)`` below 4 Hz, 0.0071 to 8 Hz, and
    ``2.82e-4 pi f`` above [m/s2], which is an RMS velocity of ``1e-4`` m/s above 8 Hz. Build-up
    ``rho_h = 1 - exp(-2 pi zeta N)`` with ``N = 0.55 h L / l``, l = 0.75 m a step. The guide holds
    the impulsive response against the base velocity at the first frequency; here each mode is held
    against that at its own, the same where all lie above 8 Hz.
    """

    span: float = np.inf
    quantity: FootfallQuantity = "response_factor"
    together: bool = True

    def __post_init__(self) -> None:
        """Check the span."""
        set_frozen(self, span=_length("span", self.span))

    def amplitudes(self, load: FootfallLoad, pace: float) -> Float[Array, " harmonics"]:
        """Return the force of each harmonic [N]."""
        return load.amplitudes(pace)

    def build_up(
        self, load: FootfallLoad, pace: float, ratios: Float[Array, " modes"]
    ) -> Float[Array, "harmonics modes"]:
        """Return the share of its steady state that each mode reaches."""
        del pace
        numbers = np.arange(1, len(load.harmonics) + 1)
        return _reached(ratios, _AVERAGE * numbers[:, None] * self.span / _STRIDE)

    def steady_weight(self, f: Float[Array, " harmonics"]) -> Float[Array, " harmonics"]:
        """Return the response factor of each m/s2 of peak acceleration."""
        flat = np.where(f < 4.0, 0.0141 / np.sqrt(f), 0.0071)
        return 1.0 / np.where(f > 8.0, 2.82e-4 * np.pi * f, flat)

    def transient_weight(self, omega: Float[Array, " modes"]) -> Float[Array, " modes"]:
        """Return the response factor of each m/s of RMS velocity."""
        return np.where(omega < 16.0 * np.pi, omega / BASE_ACCELERATION, 1e4)


@dataclass(frozen=True, kw_only=True)
class AiscRule:
    """Hold chapter 7 of AISC Design Guide 11: peak acceleration of the largest harmonic.

    Notes
    -----
    ``a_p = FRF_max alpha Q rho`` with ``alpha = 0.09 exp(-0.075 f)`` for the second to the fourth
    harmonic, and ``rho = 50 zeta + 0.25`` below 1 % of critical, ``12.5 zeta + 0.625`` to 3 %, 1
    above. Of impulses, the equivalent sinusoidal peak ``sqrt(2) a_rms`` over a step.
    """

    quantity: FootfallQuantity = "peak_acceleration"
    together: bool = False

    def amplitudes(self, load: FootfallLoad, pace: float) -> Float[Array, " harmonics"]:
        """Return the force of each harmonic [N]; the formula is for the second and later ones."""
        numbers = np.arange(1, len(load.harmonics) + 1)
        return np.where(numbers > 1, load.weight * 0.09 * np.exp(-0.075 * pace * numbers), 0.0)

    def build_up(
        self, load: FootfallLoad, pace: float, ratios: Float[Array, " modes"]
    ) -> Float[Array, "harmonics modes"]:
        """Return the share of its steady state that each mode reaches."""
        del pace
        low = np.where(ratios < 0.01, 50.0 * ratios + 0.25, 12.5 * ratios + 0.625)
        return np.tile(np.minimum(low, 1.0), (len(load.harmonics), 1))

    def steady_weight(self, f: Float[Array, " harmonics"]) -> Float[Array, " harmonics"]:
        """Return 1: accelerations stand as they are."""
        return np.ones_like(f)

    def transient_weight(self, omega: Float[Array, " modes"]) -> Float[Array, " modes"]:
        """Return the equivalent peak acceleration of each m/s of RMS velocity."""
        return np.sqrt(2.0) * omega


@dataclass(frozen=True, kw_only=True)
class AiscBayRule:
    """Hold chapter 4 of AISC Design Guide 11 on a floor in its modes: ``P0 exp(-0.35 f) FRF``.

    Attributes
    ----------
    force : float
        P0 [N]: 65 lb in offices. It holds the factor 1/2 for a walker who is not where it is felt,
        and for a steady state that is not reached.
    """

    force: float = _P0
    quantity: FootfallQuantity = "peak_acceleration"
    together: bool = False

    def __post_init__(self) -> None:
        """Check the force."""
        set_frozen(self, force=positive("force", self.force))

    def amplitudes(self, load: FootfallLoad, pace: float) -> Float[Array, " harmonics"]:
        """Return the force of each harmonic [N], whichever it is."""
        return self.force * np.exp(-0.35 * pace * np.arange(1, len(load.harmonics) + 1))

    def build_up(
        self, load: FootfallLoad, pace: float, ratios: Float[Array, " modes"]
    ) -> Float[Array, "harmonics modes"]:
        """Return 1: the force holds what is not reached."""
        del pace
        return np.ones((len(load.harmonics), len(ratios)))

    def steady_weight(self, f: Float[Array, " harmonics"]) -> Float[Array, " harmonics"]:
        """Return 1: accelerations stand as they are."""
        return np.ones_like(f)

    def transient_weight(self, omega: Float[Array, " modes"]) -> Float[Array, " modes"]:
        """Return 0: the chapter is for floors below 9 Hz, which impulses do not govern."""
        return np.zeros_like(omega)


def aisc_bay_acceleration(
    *, frequency: float, weight: float, damping_ratio: float, force: float = _P0
) -> float:
    """Return the peak acceleration of a bay by the formula of Design Guide 11, chapter 4 [m/s2].

    ``a_p / g = P0 exp(-0.35 f_n) / (beta W)``.

    Parameters
    ----------
    frequency : float
        Of the combined mode [Hz].
    weight : float
        Effective weight of the panel W [N], twice what moves with the middle.
    damping_ratio : float
        Ratio of critical damping.
    force : float
        P0 [N]: 65 lb in offices unless given.

    Examples
    --------
    >>> a = aisc_bay_acceleration(frequency=5.0, weight=400e3, damping_ratio=0.03)
    >>> round(a / 9.80665, 5)
    0.00419
    """
    pressed = force * np.exp(-0.35 * positive("frequency", frequency))
    return float(
        _G * pressed / (positive("damping_ratio", damping_ratio) * positive("weight", weight))
    )


_MADE: Mapping[str, type[SciRule | CcipRule | AiscRule]] = MappingProxyType(
    {"p354": SciRule, "ccip-016": CcipRule, "iso-10137": CcipRule, "dg11": AiscRule}
)


def footfall_rule(name: str, length: float = np.inf) -> FootfallRule:
    """Return the rule that goes with a load function of `trundle.footfall`.

    Parameters
    ----------
    name : str
        One of `trundle.footfall.FOOTFALLS`.
    length : float
        How far is walked [m]: the path of P354, the span of CCIP-016; the others ask for none.
    """
    made = _MADE[one_of("guide", name, _MADE)]
    if made is SciRule:
        return SciRule(path_length=length)
    return CcipRule(span=length) if made is CcipRule else AiscRule()


def _length(name: str, value: float) -> float:
    return np.inf if value == np.inf else positive(name, value)


def _reached(ratios: Array, cycles: Array | float) -> Array:
    """Return how far a mode builds up over some cycles."""
    return -np.expm1(-2.0 * np.pi * ratios * cycles)

"""Describe road roughness by the displacement spectra of ISO 8608."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from typing import Any, Literal, Protocol, TypeAlias, get_args, runtime_checkable

import numpy as np
from jaxtyping import Float

from trundle._checks import one_of, positive, set_frozen, within
from trundle._typing import Array, ArrayLike
from trundle.errors import InputError

__all__ = [
    "CLASS_NAMES",
    "FITTED_RANGE",
    "REFERENCE_ANGULAR_FREQUENCY",
    "REFERENCE_FREQUENCY",
    "RoadClass",
    "RoadSpectrum",
    "RoughnessLevel",
    "Spectrum",
    "class_limits",
]

REFERENCE_FREQUENCY = 0.1
"""Reference spatial frequency n0 [cycle/m] (ISO 8608)."""

REFERENCE_ANGULAR_FREQUENCY = 1.0
"""Reference angular spatial frequency Omega0 [rad/m] (ISO 8608)."""

FITTED_RANGE = (0.011, 2.83)
"""Spatial frequencies over which ISO 8608 fits its straight line [cycle/m]."""

CLASS_NAMES = "ABCDEFGH"
"""The eight road classes, smooth to rough."""

RoughnessLevel: TypeAlias = Literal["lower", "geometric_mean", "upper"]
"""Which line of a class: its lower limit, geometric mean or upper limit."""

_LEVEL_FACTOR = {"lower": 0.5, "geometric_mean": 1.0, "upper": 2.0}


def class_limits(name: str) -> tuple[float, float, float]:
    """Return lower limit, geometric mean and upper limit of Gd(n0) of a class [m3].

    ISO 8608 leaves the lower limit of A and the upper limit of H open; the values here
    continue its geometric series, as Pan, Mita and Li (2001, Table 1) do.

    Examples
    --------
    >>> [round(1e6 * limit) for limit in class_limits("B")]
    [32, 64, 128]
    """
    one_of("road class", name, CLASS_NAMES)
    mean = 16e-6 * 4.0 ** CLASS_NAMES.index(name)
    return 0.5 * mean, mean, 2.0 * mean


@runtime_checkable
class Spectrum(Protocol):
    """A straight line ``Gd(n) = Gd(n0) (n / n0)^-w``: what random roads are drawn from."""

    @property
    def roughness(self) -> float:
        """Displacement PSD at the reference frequency, Gd(n0) [m3]."""
        ...

    @property
    def waviness(self) -> float:
        """Exponent w."""
        ...

    def displacement_psd(self, n: ArrayLike) -> Float[Array, ...]:
        """Return the one-sided PSD Gd [m3] at spatial frequency n [cycle/m]."""
        ...


class _Random:
    """What every road has that is random alone."""

    @property
    def spectrum(self) -> Spectrum:
        """Itself."""
        assert isinstance(self, Spectrum)
        return self

    @property
    def is_given(self) -> bool:
        """Whether a part of it is the same in every run: none is."""
        return False

    @property
    def start(self) -> float:
        """Station that lies at a route's start: 0."""
        return 0.0

    def under(self, lateral: float, tread: Any) -> None:  # noqa: ANN401 - it has no given part
        """Return its given part: none."""
        del lateral, tread

    def of(self, route: str) -> Any:  # noqa: ANN401 - its own class
        """Return itself, the same on every route."""
        del route
        return self


@dataclass(frozen=True)
class RoadClass(_Random):
    """Hold a road class of ISO 8608 with the line of it that is meant.

    Attributes
    ----------
    name : str
        Class letter, ``A`` (smooth) to ``H``.
    level : {"lower", "geometric_mean", "upper"}
        Line of the class; the geometric mean unless said otherwise.
    waviness : float
        Exponent w of ``Gd(n) = Gd(n0) (n / n0)^-w``, 1 to 4.

    Examples
    --------
    >>> RoadClass("B").roughness
    6.4e-05
    """

    name: str
    _: KW_ONLY
    level: RoughnessLevel = "geometric_mean"
    waviness: float = 2.0

    def __post_init__(self) -> None:
        """Check class letter, level and exponent."""
        one_of("road class", self.name, CLASS_NAMES)
        one_of("road level", self.level, get_args(RoughnessLevel))
        set_frozen(self, waviness=within("waviness", self.waviness, 1.0, 4.0))

    @property
    def roughness(self) -> float:
        """Displacement PSD at the reference frequency, Gd(n0) [m3]."""
        return class_limits(self.name)[1] * _LEVEL_FACTOR[self.level]

    def displacement_psd(self, n: ArrayLike) -> Float[Array, ...]:
        """Return the one-sided PSD Gd [m3] at spatial frequency n [cycle/m]."""
        return _line(self, n)

    def displacement_psd_angular(self, angular: ArrayLike) -> Float[Array, ...]:
        """Return the one-sided PSD Gd [m3/rad] at angular spatial frequency Omega [rad/m].

        The same power in other words: ``Gd(Omega) dOmega = Gd(n) dn``, so
        ``Gd(Omega) = Gd(n) / (2 pi)`` at ``Omega = 2 pi n``.
        """
        wave = np.asarray(angular, float)
        return self.displacement_psd(wave / (2.0 * np.pi)) / (2.0 * np.pi)

    def variance(self, n_min: float, n_max: float) -> float:
        """Return the elevation's variance over a band of spatial frequencies [m2]."""
        low, high = positive("n_min", n_min), positive("n_max", n_max)
        if low > high:
            raise InputError(f"n_max must be n_min, {low:g} cycle/m, or more; got {high:g} cycle/m")
        return float(band_power(self, np.array([low]), np.array([high]))[0])

    def __str__(self) -> str:
        """Describe class and line for a report."""
        line = self.level.replace("_", " ")
        exponent = "" if self.waviness == 2.0 else f", w = {self.waviness:g}"
        return f"class {self.name} ({line}{exponent})"


@dataclass(frozen=True, kw_only=True)
class RoadSpectrum(_Random):
    """Hold a roughness that is no class: measured, or that of a floor of some flatness.

    Attributes
    ----------
    roughness : float
        Displacement PSD at the reference frequency, Gd(n0) [m3].
    waviness : float
        Exponent w of ``Gd(n) = Gd(n0) (n / n0)^-w``, 1 to 4.
    name : str
        What it is, for reports.
    """

    roughness: float
    waviness: float = 2.0
    name: str = "given spectrum"

    def __post_init__(self) -> None:
        """Check both numbers."""
        set_frozen(
            self,
            roughness=positive("roughness", self.roughness),
            waviness=within("waviness", self.waviness, 1.0, 4.0),
        )

    def displacement_psd(self, n: ArrayLike) -> Float[Array, ...]:
        """Return the one-sided PSD Gd [m3] at spatial frequency n [cycle/m]."""
        return _line(self, n)

    def __str__(self) -> str:
        """Describe the roughness for a report."""
        exponent = "" if self.waviness == 2.0 else f", w = {self.waviness:.3g}"
        return f"{self.name} (Gd(n0) = {1e6 * self.roughness:.3g}e-6 m3{exponent})"


def _line(road: Spectrum, n: ArrayLike) -> Float[Array, ...]:
    return road.roughness * (np.asarray(n, float) / REFERENCE_FREQUENCY) ** -road.waviness


def band_power(
    road: Spectrum, low: Float[Array, " bands"], high: Float[Array, " bands"]
) -> Float[Array, " bands"]:
    """Integrate Gd over bands [low, high] of spatial frequency in closed form [m2]."""
    w, n0 = road.waviness, REFERENCE_FREQUENCY
    if w == 1.0:
        return road.roughness * n0 * np.log(high / low)
    return road.roughness * n0**w / (w - 1.0) * (low ** (1.0 - w) - high ** (1.0 - w))

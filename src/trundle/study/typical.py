"""Hold what values of a study are usual, and guess at what was meant by one that is not."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TypeAlias

from trundle.errors import FitnessWarning

__all__ = ["TYPICAL", "Typical", "doubt_of"]

Units: TypeAlias = tuple[tuple[str, float], ...]

_SLIPS = (1e3, 1e-3, 10.0, 0.1, 100.0, 0.01, 1e6, 1e-6)
"""Factors of a prefix left out or of a decimal point moved, the likeliest first."""

_FEW = 3  # guesses that help; more are a list
_ROUND_OFF = 1e-9


@dataclass(frozen=True, kw_only=True)
class Typical:
    """Hold the usual range of a quantity.

    Attributes
    ----------
    what : str
        The quantity in words.
    low, high : float
        Range [SI], wide enough that what lies outside is more often a slip than a choice.
    units : tuple of (str, float)
        Units to write it in with their size [SI], rising.
    power : float
        Power of the typed value with which the quantity goes: 1/2 for a frequency that a stiffness
        decides.
    cause : str
        What was typed, where that is not the quantity itself.
    slips : tuple of float
        Other factors that are mistaken for each other.
    """

    what: str
    low: float
    high: float
    units: Units = (("", 1.0),)
    power: float = 1.0
    cause: str = ""
    slips: tuple[float, ...] = ()

    def holds(self, value: float) -> bool:
        """Return whether a value is usual."""
        return self.low * (1.0 - _ROUND_OFF) <= value <= self.high * (1.0 + _ROUND_OFF)

    def write(self, value: float) -> str:
        """Write a value in the largest unit of which it holds one, or else in the smallest."""
        fitting = [(n, s) for n, s in self.units if abs(value) >= s * (1.0 - _ROUND_OFF)]
        name, size = fitting[-1] if fitting else self.units[0]
        digits = float(f"{value / size:.4g}")
        return f"{digits:.10g} {name}".rstrip()

    def guesses(self, value: float) -> tuple[str, ...]:
        """Return what may have been meant."""
        factors = [f for f in (*self.slips, *_SLIPS) if self.holds(value * f**self.power)]
        if self.cause:
            return tuple(f"{self.cause} {_times(f)}" for f in factors[:_FEW])
        return tuple(dict.fromkeys(self.write(value * f) for f in factors[:_FEW]))


def _times(factor: float) -> str:
    return f"{factor:g} times as large" if factor > 1.0 else f"{1.0 / factor:g} times smaller"


def doubt_of(place: str, key: str, value: float) -> FitnessWarning | None:
    """Return the doubt about a value, or None where it is usual.

    Parameters
    ----------
    place : str
        Where it stands in the study.
    key : str
        Its quantity in `TYPICAL`.
    value : float
        The value [SI].
    """
    typical = TYPICAL[key]
    if typical.holds(value):
        return None
    guesses = typical.guesses(value)
    ask = f"did you mean {' or '.join(guesses)}?" if guesses else "is it meant?"
    return FitnessWarning(
        subject=place,
        message=f"{typical.write(value)} is unusual: {typical.what} is mostly "
        f"{typical.write(typical.low)} to {typical.write(typical.high)}; {ask}",
    )


_LENGTH: Units = (("mm", 1e-3), ("m", 1.0))
_METRES: Units = (("m", 1.0),)
_MASS: Units = (("kg", 1.0), ("t", 1e3))
_STRESS: Units = (("kPa", 1e3), ("MPa", 1e6), ("GPa", 1e9))
_PERCENT: Units = (("%", 0.01),)
_HERTZ: Units = (("Hz", 1.0),)
_KM_H = 1.0 / 3.6
_SPEED: Units = (("km/h", _KM_H),)

# The ranges are rules of thumb of design practice, opened by a good margin: materials from light
# concrete and timber to steel (EN 1992-1-1 table 3.1, EN 338, EN 1993-1-1); damping of floors from
# 0.7 % bare steel to 5-6 % with partitions (SCI P354 table 4.1; Willford and Young, CCIP-016);
# spans over depths from deep transfer girders to slender slabs (EN 1992-1-1 table 7.4N gives 14 to
# 30); axle loads to those of container handlers.
TYPICAL: Mapping[str, Typical] = {
    "modulus": Typical(
        what="the modulus of a floor's material", low=8e9, high=220e9, units=_STRESS
    ),
    "density": Typical(
        what="the density of a floor's material", low=350.0, high=8000.0, units=(("kg/m3", 1.0),)
    ),
    "modulus over density": Typical(
        what="modulus over density of timber, concrete or steel",
        low=5e6,
        high=32e6,
        units=(("MPa per kg/m3", 1e6),),
        cause="a modulus",
    ),
    "slab": Typical(what="the thickness of a slab", low=0.06, high=1.2, units=_LENGTH),
    "slab over span": Typical(
        what="thickness over span of a slab", low=1 / 70, high=1 / 3, cause="a thickness"
    ),
    "beam width": Typical(what="the width of a beam", low=0.03, high=3.0, units=_LENGTH),
    "beam depth": Typical(what="the depth of a beam", low=0.1, high=4.0, units=_LENGTH),
    "beam over span": Typical(
        what="depth over span of a beam", low=1 / 45, high=1 / 2.5, cause="a depth"
    ),
    "column": Typical(what="the side of a column", low=0.1, high=3.0, units=_LENGTH),
    "storey": Typical(what="the height of a storey", low=2.0, high=20.0, units=_METRES),
    "bay": Typical(what="the distance of column lines", low=1.0, high=40.0, units=_METRES),
    "superimposed mass": Typical(
        what="mass on a floor", low=10.0, high=3000.0, units=(("kg/m2", 1.0),), slips=(102.0,)
    ),
    "damping": Typical(what="the damping ratio of a floor", low=0.005, high=0.1, units=_PERCENT),
    "rayleigh": Typical(
        what="the damping ratio that Rayleigh's coefficients give",
        low=0.003,
        high=0.15,
        units=_PERCENT,
    ),
    "speed": Typical(
        what="the speed of a vehicle on a floor",
        low=1.5 * _KM_H,
        high=50.0 * _KM_H,
        units=_SPEED,
        slips=(_KM_H, 3.6),
    ),
    "vehicle mass": Typical(
        what="the mass of a vehicle", low=50.0, high=120e3, units=_MASS, cause="masses"
    ),
    "axle load": Typical(
        what="the load of an axle", low=10.0, high=30e3, units=_MASS, cause="masses"
    ),
    "wheelbase": Typical(
        what="the distance of a vehicle's first and last axle", low=0.3, high=25.0, units=_METRES
    ),
    "bounce of a truck": Typical(
        what="the lowest frequency of a vehicle above 3.5 t",
        low=0.6,
        high=6.0,
        units=_HERTZ,
        power=0.5,
        cause="a stiffness",
    ),
    "bounce": Typical(
        what="the lowest frequency of a light vehicle",
        low=0.6,
        high=30.0,
        units=_HERTZ,
        power=0.5,
        cause="a stiffness",
    ),
    "damping of a vehicle": Typical(
        what="the damping ratio of a vehicle's lowest motion",
        low=0.005,
        high=0.7,
        units=_PERCENT,
        cause="a damping",
    ),
    "waviness": Typical(what="the waviness of a road", low=1.5, high=3.0),
    "longest wave": Typical(
        what="the lowest wavenumber of a road", low=1e-3, high=0.1, units=(("1/m", 1.0),)
    ),
    "shortest wave": Typical(
        what="the highest wavenumber of a road", low=1.0, high=100.0, units=(("1/m", 1.0),)
    ),
    "contact patch": Typical(
        what="the length of a tyre's contact", low=0.01, high=0.5, units=_LENGTH
    ),
    "entry": Typical(
        what="the length over which a wheel comes on", low=0.1, high=30.0, units=_METRES
    ),
    "run-in": Typical(what="the road before the floor", low=1.0, high=2000.0, units=_METRES),
    "route": Typical(what="the length of a route", low=2.0, high=500.0, units=_METRES),
    "isolator": Typical(what="the frequency of an isolator", low=0.3, high=30.0, units=_HERTZ),
    "damping of an isolator": Typical(
        what="the damping ratio of an isolator", low=0.005, high=0.5, units=_PERCENT
    ),
    "modes": Typical(
        what="the frequency up to which modes are kept", low=15.0, high=500.0, units=_HERTZ
    ),
}

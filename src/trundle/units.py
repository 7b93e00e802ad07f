"""Read quantities as people write them, and print them as engineers read them.

This is the only module that knows a unit other than SI's. Only `study`, `report` and `cli`
use it.
"""

from __future__ import annotations

import math
import re
from functools import cache
from typing import Any, Literal

from trundle.errors import InputError

__all__ = [
    "DIMENSIONS",
    "GAL",
    "KMH",
    "MICROMETRE_PER_SECOND",
    "PRINTED",
    "motion_scale",
    "to_si",
]

GAL = 0.01
"""One gal [m/s2]."""

KMH = 1.0 / 3.6
"""One kilometre per hour [m/s]."""

MICROMETRE_PER_SECOND = 1e-6
"""One micrometre per second [m/s]."""

PRINTED: dict[str, float] = {
    "gal": GAL,
    "m/s2": 1.0,
    "mm/s2": 1e-3,
    "mg": 9.80665e-3,
    "in/s2": 0.0254,
    "um/s": MICROMETRE_PER_SECOND,
    "mm/s": 1e-3,
    "m/s": 1.0,
    "mil/s": 2.54e-5,
    "in/s": 0.0254,
    "um": 1e-6,
    "mm": 1e-3,
    "m": 1.0,
    "mil": 2.54e-5,
    "in": 0.0254,
}
"""Units of motion that reports are written in, in those of SI."""

DIMENSIONS: dict[str, tuple[str, str]] = {
    "length": ("m", "1 m"),
    "time": ("s", "25 ms"),
    "speed": ("m/s", "15 km/h"),
    "frequency": ("1/s", "20 Hz"),
    "rate": ("1/s", "0.8587 1/s"),
    "wavenumber": ("1/m", "0.011 1/m"),
    "mass": ("kg", "40.7 t"),
    "area density": ("kg/m**2", "500 kg/m2"),
    "line density": ("kg/m", "120 kg/m"),
    "density": ("kg/m**3", "2450 kg/m3"),
    "pressure": ("kg/m/s**2", "30 GPa"),
    "load": ("kg/m/s**2", "3 kN/m2"),
    "force": ("kg*m/s**2", "26 kN"),
    "impulse": ("kg*m/s", "30 N s"),
    "unbalance": ("kg*m", "500 g mm"),
    "stiffness": ("kg/s**2", "14700 N/cm"),
    "stiffness per metre": ("kg/m/s**2", "50 MN/m/m"),
    "rotational stiffness": ("kg*m**2/s**2", "20 MN m/rad"),
    "angle": ("rad", "30 deg"),
    "area": ("m**2", "84.5 cm2"),
    "second moment": ("m**4", "23130 cm4"),
    "damping coefficient": ("kg/s", "10 kN s/m"),
    "moment of inertia": ("kg*m**2", "4600 kg m2"),
    "acceleration": ("m/s**2", "0.3 gal"),
    "roughness": ("m**3", "16e-6 m3"),
    "ratio": ("", "3 %"),
}
"""Each kind of quantity: its SI unit and an example to copy."""

_QUANTITY = re.compile(
    r"^\s*(?P<number>[+-]?(\d+(\.\d*)?|\.\d+)([eE][+-]?\d{1,3})?)\s*(?P<unit>(1/)?[^\d\s.+-].{0,30})?$"
)
# Without dimension to pint, so it would let an angle or a decibel pass for a count.
_SECONDS = {"second", "millisecond", "microsecond", "minute", "hour"}
_COUNTED = {
    "frequency": {"hertz", "kilohertz", "megahertz", "cycle", *_SECONDS},
    "rate": {"hertz", "kilohertz", *_SECONDS},
    "ratio": {"percent", "permille", "ppm"},
    "angle": {"degree", "radian", "gradian"},
}
_CYCLIC = ("frequency", "wavenumber")
_UNIT_CHARACTERS = re.compile(r"^[A-Za-zµμ%/*^()·\s\d²³-]*$")
# in a unit of motion g is gravity, not a gram, and mg a thousandth of it
_GRAVITY = re.compile(r"\b(?P<prefix>[muµμ]?)gn?\b")
_TURNS = re.compile(r"^(rpm|r/min)$", re.IGNORECASE)
# a power of a power, or a large one: a parser would work on m**9**9**9 for ever
_TOWER = re.compile(
    r"(?:\*\*|\^)\s*[(+-]*\d{2,}|(?:\*\*|\^)[^A-Za-z/]*?\d\s*\)*\s*(?:\*\*|\^)|\d{6,}"
)
_POWER = re.compile(r"(?<=[A-Za-zµμ])([234])\b")


def to_si(text: object, dimension: str) -> float:
    """Turn a quantity with its unit into a number in SI.

    Parameters
    ----------
    text : str, or a plain number for a ratio
        Such as ``"15 km/h"``, ``"14700 N/cm"``, ``"500 kg/m2"`` or ``"3 %"``.
    dimension : str
        A key of `DIMENSIONS`.

    Returns
    -------
    float
        Value in SI.

    Raises
    ------
    InputError
        No number, no unit, a unit that is unknown or of another kind.

    Examples
    --------
    >>> to_si("14700 N/cm", "stiffness")
    1470000.0
    """
    unit_si, example = DIMENSIONS[dimension]
    if isinstance(text, int | float) and not isinstance(text, bool) and dimension == "ratio":
        return _finite(float(text), example)
    if not isinstance(text, str):
        raise InputError(f"a {dimension} is written as text with its unit, such as {example!r}")
    match = _QUANTITY.match(text)
    if match is None:
        raise InputError(f"a {dimension} is a number and a unit, such as {example!r}")
    number, unit = float(match["number"]), (match["unit"] or "").strip()
    if not unit:
        if dimension == "ratio":
            return _finite(number, example)
        raise InputError(f"the unit is missing; write it after the number, such as {example!r}")
    return _finite(number * _factor(unit, unit_si, dimension, example), example)


def _finite(number: float, example: str) -> float:
    if not math.isfinite(number):
        raise InputError(f"the number must be finite, such as {example!r}")
    return number


@cache
def _factor(unit: str, unit_si: str, dimension: str, example: str) -> float:
    if not _UNIT_CHARACTERS.match(unit) or _TOWER.search(unit):
        raise InputError(f"unit {unit!r} is not understood; write it such as in {example!r}")
    if dimension == "mass" and unit in {"ton", "tons"}:
        raise InputError(
            "a 'ton' is 1000 kg, 907 kg or 1016 kg by country; write 't' for 1000 kg, or kg"
        )
    registry, pint = _registry()
    if dimension in _CYCLIC and "rad" in unit:
        raise InputError(f"a {dimension} counts cycles, not radians; divide by 2 pi: {example!r}")
    spelled = unit.replace("·", "*").replace("²", "**2").replace("³", "**3").replace("^", "**")
    spelled = _POWER.sub(r"**\1", spelled)
    if dimension == "frequency":  # a parser makes radians of a turn
        spelled = _TURNS.sub("1/minute", spelled)
    if dimension == "acceleration":
        spelled = _GRAVITY.sub(r"\g<prefix>standard_gravity", spelled)
    try:
        units = registry.parse_units(spelled)
        allowed = _COUNTED.get(dimension)
        if allowed is not None and not {str(name) for name in units._units} <= allowed:
            raise InputError(f"unit {unit!r} is not one of {dimension}; write such as {example!r}")
        factor = registry.Quantity(1.0, units).to(unit_si).magnitude
    except InputError:
        raise
    except pint.DimensionalityError:
        raise InputError(
            f"unit {unit!r} is not one of {dimension}; write such as {example!r}"
        ) from None
    except Exception:  # pint raises half a dozen unrelated types on text it cannot parse
        raise InputError(f"unit {unit!r} is unknown; write it such as in {example!r}") from None
    return float(factor)


@cache
def _registry() -> tuple[Any, Any]:
    import pint  # a tenth of a second that commands without a study file need not spend

    registry = pint.UnitRegistry(on_redefinition="ignore")
    registry.define("gal = 0.01 * meter / second ** 2")
    registry.define("kNs = kilonewton * second")
    registry.define("cycle = 1")
    registry.define("Ns = newton * second")
    registry.define("Nm = newton * meter")  # or it would be a nautical mile's neighbour
    registry.define("kNm = kilonewton * meter")
    registry.define("MNm = meganewton * meter")
    return registry, pint


def motion_scale(
    unit: str, sensitivity: str = ""
) -> tuple[float, Literal["acceleration", "velocity"]]:
    """Return the factor that turns samples into SI, and what they are of.

    Parameters
    ----------
    unit : str
        Unit of the samples, with a number before it or not: ``mm/s``, ``20 m/s2``, ``mV``, ``1``.
    sensitivity : str
        Of the sensor, for samples that are volts (or counts): ``10 V/(m/s2)``, ``1000 mV/g``.

    Raises
    ------
    InputError
        A unit of neither acceleration nor velocity.

    Examples
    --------
    >>> motion_scale("mV", "100 mV/(m/s2)")
    (0.01, 'acceleration')
    """
    registry, _ = _registry()
    quantity = _parsed(unit, registry)
    kinds: tuple[tuple[str, Literal["acceleration", "velocity"]], ...] = (
        ("m/s**2", "acceleration"),
        ("m/s", "velocity"),
    )
    if sensitivity:
        if any(quantity.is_compatible_with(si) for si, _ in kinds):
            raise InputError(
                f"{unit!r} is motion already, and a sensitivity of {sensitivity!r} is for volts or "
                "counts; leave one out"
            )
        divisor = _parsed(sensitivity, registry)
        if not divisor.magnitude > 0.0:
            raise InputError(f"sensitivity {sensitivity!r} must be greater than 0")
        quantity = quantity / divisor
    if not quantity.magnitude > 0.0:
        raise InputError(f"{unit!r} must be greater than 0")
    for si, kind in kinds:
        if quantity.is_compatible_with(si):
            return float(f"{quantity.to(si).magnitude:.12g}"), kind
    told = f"{unit!r}" + (f" with sensitivity {sensitivity!r}" if sensitivity else "")
    raise InputError(
        f"unit {told} is neither acceleration nor velocity; write such as 'mm/s2', 'um/s', or 'V' "
        "with a sensitivity such as '10 V/(m/s2)'"
    )


def _parsed(text: str, registry: Any) -> Any:
    """Return a quantity; a bare unit counts once."""
    match = re.match(
        r"^\s*(?P<number>[+-]?[\d.]+(?:[eE][+-]?\d{1,3})?)?\s*(?P<unit>.{0,40})$", text
    )
    unit = (match["unit"] if match else "").strip()
    if match is None or not _UNIT_CHARACTERS.match(unit) or _TOWER.search(unit):
        raise InputError(f"{text!r} is not understood; write such as 'mm/s2' or '10 V/(m/s2)'")
    spelled = unit.replace("·", "*").replace("²", "**2").replace("³", "**3").replace("^", "**")
    spelled = _GRAVITY.sub(r"\g<prefix>standard_gravity", _POWER.sub(r"**\1", spelled))
    try:
        number = float(match["number"] or 1.0)
        return number * (registry.parse_units(spelled) if spelled else registry.dimensionless)
    except Exception:  # pint raises half a dozen unrelated types on text it cannot parse
        raise InputError(
            f"unit {unit!r} is unknown; write such as 'mm/s2', 'um/s' or 'V'"
        ) from None

"""Define the field types of a study file: quantities with units, places, names."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Annotated, Any, TypeAlias

from pydantic import AfterValidator, BaseModel, BeforeValidator, ConfigDict, Strict
from pydantic_core import PydanticCustomError

from trundle.errors import InputError
from trundle.response import QUANTITIES
from trundle.units import DIMENSIONS, to_si

__all__ = [
    "Acceleration",
    "Angle",
    "AnySpeed",
    "AnyTime",
    "AreaDensity",
    "AxleLoad",
    "CrossArea",
    "DampingCoefficient",
    "Density",
    "Factor",
    "Flag",
    "Force",
    "Frequency",
    "Grade",
    "GridPlace",
    "GroupName",
    "Impulse",
    "Length",
    "Line",
    "LineDensity",
    "Load",
    "Mass",
    "Name",
    "NonNegativeLength",
    "Number",
    "Place",
    "PositiveLength",
    "Pressure",
    "Quantity",
    "Rate",
    "Ratio",
    "RotaryInertia",
    "RotationalStiffness",
    "Roughness",
    "Rule",
    "SecondMoment",
    "Section",
    "Speed",
    "Stiffness",
    "StiffnessPerMetre",
    "Time",
    "Unbalance",
    "Wavenumber",
    "Whole",
]


class Section(BaseModel):
    """Base of every section: unknown keys are mistakes, values are frozen.

    What stands below a field says what it means; the reference of study files is made of it.
    """

    model_config = ConfigDict(
        extra="forbid", frozen=True, arbitrary_types_allowed=True, use_attribute_docstrings=True
    )


# What no vehicle, road or floor exceeds: a value beyond is a slip of the unit or the key.
_LARGEST = {
    "length": 1e4,
    "time": 1e6,
    "speed": 150.0,
    "frequency": 2e3,
    "rate": 1e4,
    "wavenumber": 100.0,
    "mass": 1e7,
    "area density": 1e5,
    "line density": 1e6,
    "density": 3e4,
    "load": 1e7,
    "stiffness per metre": 1e13,
    "rotational stiffness": 1e14,
    "angle": 10.0,
    "area": 1e3,
    "second moment": 1e4,
    "pressure": 1e13,
    "force": 1e9,
    "impulse": 1e6,
    "unbalance": 1e4,
    "stiffness": 1e13,
    "damping coefficient": 1e11,
    "moment of inertia": 1e10,
    "acceleration": 1e4,
    "roughness": 1.0,
    "ratio": 1e3,
}
_SMALLEST = {"speed": 1e-10, "pressure": 1e5, "wavenumber": 1e-4}


@dataclass(frozen=True)
class Quantity:
    """Read a number with its unit, and hold of what dimension it is.

    Attributes
    ----------
    dimension : str
        One of `trundle.units.DIMENSIONS`.
    """

    dimension: str

    def __call__(self, value: Any) -> float:
        """Return the number in SI units."""
        unit = DIMENSIONS[self.dimension][0].replace("**", "")
        largest, smallest = _LARGEST[self.dimension], _SMALLEST.get(self.dimension, 0.0)
        try:
            number = to_si(value, self.dimension)
        except InputError as error:
            raise PydanticCustomError("quantity", "{rule}", {"rule": str(error)}) from None
        if abs(number) > largest or 0.0 < abs(number) < smallest:
            low = f"{smallest:g} to " if smallest else "up to "
            rule = f"a {self.dimension} is {low}{largest:g} {unit}; this one is {number:g} {unit}"
            raise PydanticCustomError("quantity", "{rule}", {"rule": rule})
        return number


@dataclass(frozen=True)
class Rule:
    """Refuse numbers that break a rule, and hold how it reads.

    Attributes
    ----------
    accepts : callable
        Whether a number keeps it.
    text : str
        How messages and the reference of study files say it.
    """

    accepts: Callable[[float], bool]
    text: str

    def __call__(self, value: float) -> float:
        """Return the number as it is."""
        if not self.accepts(value):
            raise PydanticCustomError("rule", "{rule}", {"rule": self.text})
        return value


def _quantity(dimension: str) -> BeforeValidator:
    return BeforeValidator(Quantity(dimension))


def _rule(accepts: Callable[[float], bool], text: str) -> AfterValidator:
    return AfterValidator(Rule(accepts, text))


_POSITIVE = _rule(lambda value: value > 0.0, "must be greater than 0")
_NON_NEGATIVE = _rule(lambda value: value >= 0.0, "must be 0 or more")


def _check_line(value: str) -> str:
    if not value.strip() or value != value.strip():
        rule = "must not be blank, nor begin or end with a space"
        raise PydanticCustomError("rule", "{rule}", {"rule": rule})
    if not value.isprintable():
        rule = "must be plain text on one line, without control characters"
        raise PydanticCustomError("rule", "{rule}", {"rule": rule})
    return value


def _check_name(value: str) -> str:
    _check_line(value)
    if len(value) > 60:
        raise PydanticCustomError("rule", "{rule}", {"rule": "must be at most 60 characters"})
    if value.startswith(".") or "/" in value or "\\" in value:
        rule = "must be usable in a path: without '/' and '\\', and not beginning with '.'"
        raise PydanticCustomError("rule", "{rule}", {"rule": rule})
    return value


# Coordinates of the results: a group below them cannot have such a name.
_TAKEN = {"band", "case", "contact", "method_name", "point", "road", "run"} | {
    quantity.name for quantity in QUANTITIES if quantity.per == "contact"
}


def _check_group_name(value: str) -> str:
    if _check_name(value) in _TAKEN:
        rule = "must not be a name that the results have for themselves"
        raise PydanticCustomError("rule", "{rule}", {"rule": rule})
    return value


Flag: TypeAlias = Annotated[bool, Strict()]
Whole: TypeAlias = Annotated[int, Strict()]
Number: TypeAlias = Annotated[float, Strict()]
Line: TypeAlias = Annotated[str, Strict(), AfterValidator(_check_line)]
Name: TypeAlias = Annotated[str, AfterValidator(_check_name)]
GroupName: TypeAlias = Annotated[str, AfterValidator(_check_group_name)]
Length: TypeAlias = Annotated[float, _quantity("length")]
PositiveLength: TypeAlias = Annotated[float, _quantity("length"), _POSITIVE]
NonNegativeLength: TypeAlias = Annotated[float, _quantity("length"), _NON_NEGATIVE]
Time: TypeAlias = Annotated[float, _quantity("time"), _POSITIVE]
AnyTime: TypeAlias = Annotated[float, _quantity("time"), _NON_NEGATIVE]
AnySpeed: TypeAlias = Annotated[float, _quantity("speed"), _NON_NEGATIVE]
Speed: TypeAlias = Annotated[float, _quantity("speed"), _POSITIVE]
Frequency: TypeAlias = Annotated[float, _quantity("frequency"), _POSITIVE]
Wavenumber: TypeAlias = Annotated[float, _quantity("wavenumber"), _POSITIVE]
Rate: TypeAlias = Annotated[float, _quantity("rate"), _NON_NEGATIVE]
Mass: TypeAlias = Annotated[float, _quantity("mass"), _NON_NEGATIVE]
AreaDensity: TypeAlias = Annotated[float, _quantity("area density"), _NON_NEGATIVE]
Density: TypeAlias = Annotated[float, _quantity("density"), _POSITIVE]
Pressure: TypeAlias = Annotated[float, _quantity("pressure"), _POSITIVE]
Force: TypeAlias = Annotated[float, _quantity("force"), _NON_NEGATIVE]
Impulse: TypeAlias = Annotated[float, _quantity("impulse"), _POSITIVE]
Unbalance: TypeAlias = Annotated[float, _quantity("unbalance"), _POSITIVE]
Stiffness: TypeAlias = Annotated[float, _quantity("stiffness"), _NON_NEGATIVE]
DampingCoefficient: TypeAlias = Annotated[float, _quantity("damping coefficient"), _NON_NEGATIVE]
RotaryInertia: TypeAlias = Annotated[float, _quantity("moment of inertia"), _NON_NEGATIVE]
Acceleration: TypeAlias = Annotated[float, _quantity("acceleration"), _POSITIVE]
Roughness: TypeAlias = Annotated[float, _quantity("roughness"), _POSITIVE]
Ratio: TypeAlias = Annotated[
    float,
    _quantity("ratio"),
    _rule(lambda value: 0.0 <= value < 1.0, "must be at least 0 and below 1 (write 3 % or 0.03)"),
]
Grade: TypeAlias = Annotated[float, _quantity("ratio")]
Factor: TypeAlias = Annotated[float, _quantity("ratio"), _POSITIVE]
Angle: TypeAlias = Annotated[float, _quantity("angle")]
CrossArea: TypeAlias = Annotated[float, _quantity("area"), _POSITIVE]
SecondMoment: TypeAlias = Annotated[float, _quantity("second moment"), _POSITIVE]
LineDensity: TypeAlias = Annotated[float, _quantity("line density"), _POSITIVE]
Load: TypeAlias = Annotated[float, _quantity("load"), _NON_NEGATIVE]
StiffnessPerMetre: TypeAlias = Annotated[float, _quantity("stiffness per metre"), _NON_NEGATIVE]
RotationalStiffness: TypeAlias = Annotated[float, _quantity("rotational stiffness"), _NON_NEGATIVE]
Place: TypeAlias = tuple[Length, Length]


def _crossing(value: Any) -> Any:
    """Leave the name of a crossing of grid lines as it is; read a pair as lengths."""
    if isinstance(value, str):
        if value.count("/") != 1:
            rule = 'must be [x, y], or where two grid lines cross, such as "A/1"'
            raise PydanticCustomError("rule", "{rule}", {"rule": rule})
        return value
    if not isinstance(value, list | tuple) or len(value) != 2:
        rule = 'must be two lengths [x, y], or where two grid lines cross, such as "A/1"'
        raise PydanticCustomError("rule", "{rule}", {"rule": rule})
    try:
        return tuple(to_si(one, "length") for one in value)
    except InputError as error:
        raise PydanticCustomError("quantity", "{rule}", {"rule": str(error)}) from None


def _axle_load(value: Any) -> float:
    """Read an axle's load as a mass [kg], be it written as one or as a weight."""
    try:
        mass = to_si(value, "mass")
    except InputError as error:
        try:
            mass = to_si(value, "force") / 9.81
        except InputError:
            raise PydanticCustomError("quantity", "{rule}", {"rule": str(error)}) from None
    if not 1.0 <= mass <= _LARGEST["mass"]:
        rule = f"an axle carries 1 kg to {_LARGEST['mass']:g} kg; this one {mass:g} kg"
        raise PydanticCustomError("rule", "{rule}", {"rule": rule})
    return mass


AxleLoad: TypeAlias = Annotated[float, BeforeValidator(_axle_load), _POSITIVE]
"""What an axle carries: ``"2.65 t"``, or ``"26 kN"``."""

GridPlace: TypeAlias = Annotated[Any, BeforeValidator(_crossing)]
"""A place in plan: ``[x, y]``, or the name of two grid lines that cross, ``"A/1"``."""

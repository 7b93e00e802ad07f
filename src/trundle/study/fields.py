"""Define the field types of a study file: quantities with units, places, names."""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated, Any, TypeAlias

from pydantic import AfterValidator, BaseModel, BeforeValidator, ConfigDict
from pydantic_core import PydanticCustomError

from trundle.errors import InputError
from trundle.units import to_si

__all__ = [
    "Acceleration",
    "AreaDensity",
    "DampingCoefficient",
    "Density",
    "Frequency",
    "Length",
    "Mass",
    "Name",
    "NonNegativeLength",
    "Place",
    "PositiveLength",
    "Pressure",
    "Rate",
    "Ratio",
    "RotaryInertia",
    "Section",
    "Speed",
    "Stiffness",
    "Time",
    "Wavenumber",
]


class Section(BaseModel):
    """Base of every section: unknown keys are mistakes, values are frozen."""

    model_config = ConfigDict(extra="forbid", frozen=True, arbitrary_types_allowed=True)


def _quantity(dimension: str) -> BeforeValidator:
    def read(value: Any) -> float:
        try:
            return to_si(value, dimension)
        except InputError as error:
            raise PydanticCustomError("quantity", "{rule}", {"rule": str(error)}) from None

    return BeforeValidator(read)


def _rule(accepts: Callable[[float], bool], text: str) -> AfterValidator:
    def check(value: float) -> float:
        if not accepts(value):
            raise PydanticCustomError("rule", "{rule}", {"rule": text})
        return value

    return AfterValidator(check)


_POSITIVE = _rule(lambda value: value > 0.0, "must be greater than 0")
_NON_NEGATIVE = _rule(lambda value: value >= 0.0, "must be 0 or more")


def _check_name(value: str) -> str:
    if not value.strip() or len(value) > 60:
        raise PydanticCustomError("rule", "{rule}", {"rule": "must be 1 to 60 characters"})
    if any(ord(letter) < 32 for letter in value) or "/" in value:
        rule = "must be plain text on one line, without '/'"
        raise PydanticCustomError("rule", "{rule}", {"rule": rule})
    return value


Name: TypeAlias = Annotated[str, AfterValidator(_check_name)]
Length: TypeAlias = Annotated[float, _quantity("length")]
PositiveLength: TypeAlias = Annotated[float, _quantity("length"), _POSITIVE]
NonNegativeLength: TypeAlias = Annotated[float, _quantity("length"), _NON_NEGATIVE]
Time: TypeAlias = Annotated[float, _quantity("time"), _POSITIVE]
Speed: TypeAlias = Annotated[float, _quantity("speed"), _POSITIVE]
Frequency: TypeAlias = Annotated[float, _quantity("frequency"), _POSITIVE]
Wavenumber: TypeAlias = Annotated[float, _quantity("wavenumber"), _POSITIVE]
Rate: TypeAlias = Annotated[float, _quantity("rate"), _NON_NEGATIVE]
Mass: TypeAlias = Annotated[float, _quantity("mass"), _NON_NEGATIVE]
AreaDensity: TypeAlias = Annotated[float, _quantity("area density"), _NON_NEGATIVE]
Density: TypeAlias = Annotated[float, _quantity("density"), _POSITIVE]
Pressure: TypeAlias = Annotated[float, _quantity("pressure"), _POSITIVE]
Stiffness: TypeAlias = Annotated[float, _quantity("stiffness"), _NON_NEGATIVE]
DampingCoefficient: TypeAlias = Annotated[float, _quantity("damping coefficient"), _NON_NEGATIVE]
RotaryInertia: TypeAlias = Annotated[float, _quantity("moment of inertia"), _NON_NEGATIVE]
Acceleration: TypeAlias = Annotated[float, _quantity("acceleration"), _POSITIVE]
Ratio: TypeAlias = Annotated[
    float,
    _quantity("ratio"),
    _rule(lambda value: 0.0 <= value < 1.0, "must be at least 0 and below 1 (write 3 % or 0.03)"),
]
Place: TypeAlias = tuple[Length, Length]

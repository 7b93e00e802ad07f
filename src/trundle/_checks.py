"""Check and freeze values once, at the border of the package.

Every function returns the value it was given (converted), so a ``__post_init__`` can both
check and store it, and the code behind that point never checks again.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from difflib import get_close_matches
from typing import Any

import numpy as np

from trundle._typing import ArrayLike
from trundle.errors import InputError


def finite(name: str, value: float) -> float:
    """Return a finite float or say why it is not one."""
    try:
        number = float(value)
    except (TypeError, ValueError):
        raise InputError(f"{name} must be a number; got {value!r}") from None
    if not math.isfinite(number):
        raise InputError(f"{name} must be finite; got {number}")
    return number


def positive(name: str, value: float) -> float:
    """Return a float above zero or say why it is not one."""
    number = finite(name, value)
    if number <= 0.0:
        raise InputError(f"{name} must be greater than 0; got {number:g}")
    return number


def non_negative(name: str, value: float) -> float:
    """Return a float of zero or more or say why it is not one."""
    number = finite(name, value)
    if number < 0.0:
        raise InputError(f"{name} must be 0 or more; got {number:g}")
    return number


def within(name: str, value: float, low: float, high: float, *, remedy: str = "") -> float:
    """Return a float in the closed interval [low, high] or say why it is not one."""
    number = finite(name, value)
    if not low <= number <= high:
        hint = f" ({remedy})" if remedy else ""
        raise InputError(f"{name} must be in [{low:g}, {high:g}]; got {number:g}{hint}")
    return number


def count(name: str, value: int, *, at_least: int = 1) -> int:
    """Return an integer of at least a minimum or say why it is not one."""
    number = finite(name, value)
    if number != int(number) or number < at_least:
        raise InputError(f"{name} must be a whole number of at least {at_least}; got {value!r}")
    return int(number)


def one_of(name: str, value: str, choices: Iterable[str]) -> str:
    """Return a word of a closed list or name the nearest one."""
    options = sorted(choices)
    if value in options:
        return value
    near = get_close_matches(str(value), options, n=1)
    hint = f" (did you mean {near[0]!r}?)" if near else ""
    raise InputError(f"{name} must be one of {', '.join(options)}; got {value!r}{hint}")


def frozen_array(
    name: str, value: ArrayLike, *, shape: tuple[int | None, ...], dtype: Any = np.float64
) -> np.ndarray:
    """Return a read-only, finite, C-ordered copy with the asked shape (None: any length)."""
    array = np.array(value, dtype=dtype, order="C")
    matches = array.ndim == len(shape) and all(
        want is None or want == have for want, have in zip(shape, array.shape, strict=True)
    )
    if not matches:
        wanted = tuple("any" if want is None else want for want in shape)
        raise InputError(f"{name} must have shape {wanted}; got {array.shape}")
    if not np.all(np.isfinite(array)):
        place = tuple(int(i) for i in np.argwhere(~np.isfinite(array))[0])
        raise InputError(f"{name} must be finite; element {place} is {array[place]}")
    array.setflags(write=False)
    return array


def set_frozen(instance: object, **values: object) -> None:
    """Store converted values in a frozen dataclass from its own ``__post_init__``."""
    for name, value in values.items():
        object.__setattr__(instance, name, value)

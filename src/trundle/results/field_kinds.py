"""Check what a file says against what the fields of a value may hold."""

from __future__ import annotations

import functools
import types
import typing
from collections.abc import Mapping
from typing import Any

import numpy as np

__all__ = ["fields_hold", "holds"]


def fields_hold(kind: type, values: Mapping[str, Any]) -> bool:
    """Return whether values are what the fields of a dataclass may hold, all the way down.

    Parameters
    ----------
    kind : type
        The dataclass; its annotations say what its fields hold.
    values : mapping of str
        A value for each field.
    """
    hints = _hints(kind)
    return all(holds(value, hints[name]) for name, value in values.items())


@functools.cache
def _hints(kind: type) -> dict[str, Any]:
    return typing.get_type_hints(kind)


def holds(value: Any, hint: Any) -> bool:
    """Return whether a value is what a type hint allows, all the way down."""
    origin, arguments = typing.get_origin(hint), typing.get_args(hint)
    if origin in {typing.Union, types.UnionType}:
        return any(holds(value, option) for option in arguments)
    if origin is typing.Literal:
        return value in arguments
    if origin is tuple:
        return isinstance(value, tuple) and _each_holds(value, arguments)
    if isinstance(origin, type) and issubclass(origin, Mapping):
        return isinstance(value, Mapping) and all(
            holds(k, arguments[0]) and holds(v, arguments[1]) for k, v in value.items()
        )
    return _is(value, hint)


def _each_holds(value: tuple[Any, ...], arguments: tuple[Any, ...]) -> bool:
    if len(arguments) == 2 and arguments[1] is Ellipsis:
        return all(holds(one, arguments[0]) for one in value)
    return len(value) == len(arguments) and all(map(holds, value, arguments))


def _is(value: Any, hint: Any) -> bool:
    if hint is float:
        return isinstance(value, int | float) and not isinstance(value, bool)
    if hint is int:
        return isinstance(value, int) and not isinstance(value, bool)
    if hint is np.ndarray:
        return isinstance(value, np.ndarray)
    # arrays with named axes say by themselves whether a number of axes is theirs
    return isinstance(hint, type) and isinstance(value, hint)

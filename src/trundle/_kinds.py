"""Refuse arguments of a wrong kind with the name of the right one, instead of failing far inside.

What a signature's hints say is looked at when a public function or constructor is called: whether
a value is of one of the classes named, whether a mapping or sequence is one and holds what it
should. Arrays and numbers have checks of their own where their sizes are known.
"""

from __future__ import annotations

import functools
import inspect
import types
import typing
from collections.abc import Callable, Mapping, Sequence
from typing import Any, TypeVar

import numpy as np

from trundle.errors import InputError

__all__ = ["kinds_checked"]

T = TypeVar("T", bound=Callable[..., Any])

_MISSING = object()
_EXAMPLES = {
    "Road": 'RoadClass("B")',
    "RoadClass": 'RoadClass("B")',
    "Criterion": 'find_criterion("VC-A"), or VC for the generic curves',
    "Vehicle": 'library_vehicle("container_truck_40ft")',
    "Route": 'Route.straight((0, 15), (24, 15), speed=4, name="main")',
    "Integration": "Modal(f_max=112, dt=0.005)",
    "Damping": "ModalRatio(ratio=0.03)",
    "ContactShape": "Hermite()",
    "Entry": 'entry_named("abrupt")',
    "Runs": "what ensemble(...) returns",
    "Floor": "what build_floor(...) returns",
    "Structure": "what build_floor(...) returns",
    "Study": 'load_study("study.toml")',
    "Record": 'read_record("record.csv", RecordOptions())',
}


def kinds_checked(called: T) -> T:
    """Check the kinds of what a function, or a dataclass's constructor, is called with.

    Parameters
    ----------
    called : callable
        A function, or a class whose constructor is to check.

    Returns
    -------
    callable
        The same with the check in front; the class itself, its constructor replaced.
    """
    if isinstance(called, type):
        called.__init__ = _checked(called.__init__, skip=1)
        return typing.cast("T", called)
    return typing.cast("T", _checked(called, skip=0))


def _checked(function: Callable[..., Any], *, skip: int) -> Callable[..., Any]:
    signature = inspect.signature(function)

    @functools.wraps(function)
    def checking(*args: Any, **kwargs: Any) -> Any:
        try:
            bound = signature.bind(*args, **kwargs)
        except TypeError:
            return function(*args, **kwargs)  # Python's own words name the argument
        hints = _hints(function)
        for name, value in list(bound.arguments.items())[skip:]:
            if name in hints:
                _check(name, value, hints[name])
        return function(*args, **kwargs)

    return checking


@functools.cache
def _hints(function: Callable[..., Any]) -> dict[str, Any]:
    """Return the hints of a function; none if one can only be read by a type checker."""
    try:
        return typing.get_type_hints(function)
    except (NameError, TypeError):
        return {}


def _check(name: str, value: object, hint: Any) -> None:
    options = _options(hint)
    if value is None and type(None) in options:
        return
    wanted = [w for w in options if w is not type(None)]
    fits = [_fits(value, w) for w in wanted]
    if True in fits:
        _check_inside(name, value, wanted[fits.index(True)])
    elif None not in fits:
        raise InputError(f"{name} must be {_words(wanted)}; got {_shown(value)}")


def _check_inside(name: str, value: Any, wanted: Any) -> None:
    """Check what a sequence or mapping of our own values holds."""
    arguments = typing.get_args(wanted)
    if isinstance(value, Mapping) and len(arguments) == 2:
        for key, one in value.items():
            _check(f"{name}[{key!r}]", one, arguments[1])
    elif isinstance(value, list | tuple) and arguments:
        if typing.get_origin(wanted) is tuple and arguments[-1] is not Ellipsis:
            return
        for i, one in enumerate(value):
            _check(f"{name}[{i}]", one, arguments[0])


def _options(hint: Any) -> tuple[Any, ...]:
    """Return what a hint allows, unions taken apart."""
    if typing.get_origin(hint) in {typing.Union, types.UnionType}:
        return tuple(o for part in typing.get_args(hint) for o in _options(part))
    return (hint,)


def _fits(value: object, wanted: Any) -> bool | None:
    """Return whether a value is of a kind; None where that is not looked at."""
    origin = typing.get_origin(wanted) or wanted
    if origin is Any or not isinstance(origin, type):  # Any is a class that refuses to be asked
        return None
    numbers = origin in {int, float, complex, bool, object} or issubclass(origin, np.ndarray)
    if numbers or origin.__module__.startswith(("jaxtyping", "numpy", "scipy")):
        return None  # numbers are checked with their bounds, arrays with their shapes
    if getattr(origin, "_is_protocol", False):
        members = [name for name in dir(origin) if not name.startswith("_")]
        # what is there is looked at, not called: a property may be long to compute
        return all(
            inspect.getattr_static(value, name, _MISSING) is not _MISSING for name in members
        )
    if origin is tuple:
        return isinstance(value, list | tuple | np.ndarray) and _as_long(value, wanted)
    if origin in {Mapping, Sequence} and isinstance(value, str):
        return False
    return isinstance(value, origin)


def _as_long(value: Any, wanted: Any) -> bool:
    """Return whether a sequence is as long as a tuple of so many must be."""
    arguments = typing.get_args(wanted)
    return not arguments or arguments[-1] is Ellipsis or len(value) == len(arguments)


def _words(wanted: list[Any]) -> str:
    """Name kinds, with an example of how one is got."""
    names = [_name(w) for w in wanted]
    kinds = [getattr(w, "__name__", "") for w in wanted]
    example = next((_EXAMPLES[n] for n in kinds if n in _EXAMPLES), "")
    for w in wanted:
        if typing.get_origin(w) is not None and issubclass(typing.get_origin(w) or w, Mapping):
            example = '{"tool": (6.0, 5.0)}'
    return " or ".join(names) + (f", such as {example}" if example else "")


def _name(wanted: Any) -> str:
    origin = typing.get_origin(wanted) or wanted
    inside = [option for part in typing.get_args(wanted) for option in _options(part)]
    inner = [getattr(option, "__name__", "") for option in inside]
    if issubclass(origin, Mapping):
        return "a mapping of names to places" if "tuple" in inner else "a mapping"
    if issubclass(origin, str):
        return "text"
    if origin is tuple and inner and typing.get_args(wanted)[-1] is not Ellipsis:
        return f"{len(inner)} numbers"
    if issubclass(origin, Sequence) and inner and inner[0]:
        return f"several {inner[0]}"
    name = str(getattr(origin, "__name__", origin))
    return f"{'an' if name[0] in 'AEIOU' else 'a'} {name}"


def _shown(value: object) -> str:
    try:
        text = repr(value)
    except Exception:  # a stranger's own repr
        text = "something"
    text = text if len(text) <= 60 else text[:57] + "..."
    kind = type(value).__name__
    return text if text.startswith(f"{kind}(") else f"{text} ({kind})"

"""Say in words what a field of a study file takes: its kind, its unit, what is allowed."""

from __future__ import annotations

import types
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal, Union, get_args, get_origin

import annotated_types as limits
from pydantic import AfterValidator, BeforeValidator
from pydantic.fields import FieldInfo

from trundle.study_file.fields import Quantity, Rule, Section
from trundle.units import DIMENSIONS
from trundle.vehicle import VEHICLES

__all__ = ["Taken", "default_of", "taken_by"]

_PLAIN = {bool: "`true` or `false`", int: "whole number", float: "number", str: "text"}
# what validators of their own read, by their names
_READ = {
    "_check_line": "text",
    "_check_name": "name",
    "_check_group_name": "name",
    "_crossing": 'place `["1 m", "2 m"]` or `"A/1"`',
    "_axle_load": 'mass or force, such as `"2.65 t"` or `"26 kN"`',
    "_metres": "unit of length",
    "_as_text": "text, or a date",
    "_as_list": "",  # one value stands for a list of one
    "_field": 'time of the day, such as `"8:30"`',
    "_units": 'units, such as `"kN, m"`',
}
_SHORT = {"greater than 0": "> 0", "0 or more": ">= 0"}
# SI units as they are written, where DIMENSIONS has their parts
_SHOWN = {"Pa": ("pressure", "load"), "N": ("force",), "N/m": ("stiffness",)}
_BOUNDS = ((limits.Ge, "ge", ">="), (limits.Gt, "gt", ">"), (limits.Le, "le", "<="),
           (limits.Lt, "lt", "<"))  # fmt: skip


@dataclass(frozen=True, kw_only=True)
class Taken:
    """Hold what a field takes.

    Attributes
    ----------
    kind : str
        In words, with unit and example.
    rules : tuple of str
        What is allowed.
    inner : tuple of (str, type)
        Tables inside, and how each is written after its key.
    """

    kind: str
    rules: tuple[str, ...] = ()
    inner: tuple[tuple[str, type[Section]], ...] = field(default=())


def taken_by(info: FieldInfo) -> Taken:
    """Return what a field takes."""
    return _taken(info.annotation, tuple(info.metadata))


def _taken(annotation: Any, said: Sequence[Any] = ()) -> Taken:
    origin, inner = get_origin(annotation), get_args(annotation)
    said = tuple(part for one in said for part in getattr(one, "metadata", (one,)))
    if hasattr(annotation, "__metadata__"):
        return _taken(annotation.__origin__, (*annotation.__metadata__, *said))
    rules = tuple(_rules(said))
    if origin in {Union, types.UnionType}:
        return _either([one for one in inner if one is not type(None)], said)
    if origin is Literal:
        return Taken(kind="word", rules=(_words(inner),))
    if origin in {tuple, dict}:
        return _gathered(origin, inner, rules)
    if isinstance(annotation, type) and issubclass(annotation, Section):
        return Taken(kind="table", inner=(("", annotation),))
    return Taken(kind=_kind(annotation, said), rules=rules)


def _gathered(origin: type, inner: Sequence[Any], rules: tuple[str, ...]) -> Taken:
    """Return what holds several values: by name, of any number, or of a fixed one."""
    if origin is dict:
        one = _taken(inner[1])
        kind = "tables by name" if one.inner else f"{one.kind}, by name"
        return Taken(kind=kind, rules=rules, inner=tuple((".NAME", s) for _, s in one.inner))
    if inner[-1] is Ellipsis:
        return _list(_taken(inner[0]), rules)
    parts = [_taken(one) for one in inner]
    return Taken(kind=_several([one.kind for one in parts]), rules=(*parts[0].rules, *rules))


def _either(options: Sequence[Any], said: Sequence[Any]) -> Taken:
    found = [_taken(one, said) for one in options]
    inner = dict.fromkeys(pair for one in found for pair in one.inner)
    rules = dict.fromkeys(rule for one in found for rule in one.rules)
    kinds = dict.fromkeys(one.kind for one in found)
    return Taken(kind=", or ".join(kinds), rules=tuple(rules), inner=tuple(inner))


def _list(one: Taken, rules: tuple[str, ...]) -> Taken:
    if one.kind == "word":
        return Taken(kind=f"list of {one.rules[0]}", rules=(*one.rules[1:], *rules))
    kind = "list of tables" if one.inner else f"list: {one.kind}"
    return Taken(
        kind=kind, rules=(*one.rules, *rules), inner=tuple(("[]", s) for _, s in one.inner)
    )


def _several(kinds: Sequence[str]) -> str:
    """Return what stands side by side in a list: ``list of 2: frequency and force``."""
    words = [kind.partition(", such as")[0] for kind in kinds]
    named = f"list of {len(words)}: {' and '.join(dict.fromkeys(words))}"
    examples = [kind.partition("such as `")[2].strip("`") for kind in kinds]
    return f"{named}, such as `[{', '.join(examples)}]`" if all(examples) else named


def _kind(annotation: Any, said: Sequence[Any]) -> str:
    """Return what one value is, by what reads it."""
    for one in reversed(said):
        reader = getattr(one, "func", None) if isinstance(one, _VALIDATORS) else None
        if isinstance(reader, Quantity):
            return _quantity(reader.dimension)
        if reader is not None and not isinstance(reader, Rule) and _READ[reader.__name__]:
            return _READ[reader.__name__]
    return _PLAIN[annotation]


_VALIDATORS = (AfterValidator, BeforeValidator)


def _quantity(dimension: str) -> str:
    return f'{dimension}, such as `"{DIMENSIONS[dimension][1]}"`'


def _rules(said: Sequence[Any]) -> list[str]:
    found = list(dict.fromkeys(_each_rule(said)))
    return [rule for rule in found if rule != ">= 0" or "> 0" not in found]


def _each_rule(said: Sequence[Any]) -> Iterator[str]:
    for one in said:
        if isinstance(getattr(one, "func", None), Rule):
            text = one.func.text.removeprefix("must be ")
            yield _SHORT.get(text, text)
        for kind, name, sign in _BOUNDS:
            if isinstance(one, kind):
                yield f"{sign} {_number(getattr(one, name))}"
        if isinstance(one, limits.MinLen) and one.min_length:
            yield f"at least {one.min_length}"
        if isinstance(one, limits.MaxLen):
            yield f"at most {one.max_length}"


def _number(value: float) -> str:
    return "2^63" if value == 2**63 else f"{value:.12g}"


def _words(options: Sequence[Any]) -> str:
    if set(options) == set(VEHICLES):
        return "a name of [the library](../vehicles.md)"
    return ", ".join(f'`"{option}"`' for option in options)


def default_of(info: FieldInfo) -> str:
    """Return what a field is unless it is given, as the file would have it."""
    if info.is_required():
        return "needed"
    value = info.get_default(call_default_factory=True)
    if value is None or isinstance(value, Section) or value in ((), {}, ""):
        return ""
    if isinstance(value, bool):
        return f"`{str(value).lower()}`"
    return f"`{_one(value, info)}`"


def _one(value: Any, info: FieldInfo) -> str:
    if isinstance(value, tuple):
        return f"[{', '.join(_one(part, info) for part in value)}]"
    if isinstance(value, str):
        return f'"{value}"'
    unit = next((_unit(dimension) for dimension in _dimensions(info)), "")
    return f'"{value:g} {unit}"' if unit else f"{value:g}"


def _unit(dimension: str) -> str:
    """Return the SI unit of a dimension as it is written."""
    short = next((unit for unit, named in _SHOWN.items() if dimension in named), "")
    return short or DIMENSIONS[dimension][0].replace("**", "").replace("*", " ")


def _dimensions(info: FieldInfo) -> Iterator[str]:
    """Give the dimensions of the numbers in a field."""
    waiting: list[Any] = [info.annotation, *info.metadata]
    while waiting:
        one = waiting.pop()
        reader = getattr(one, "func", None)
        if isinstance(reader, Quantity):
            yield reader.dimension
        waiting += [*get_args(one), *getattr(one, "__metadata__", ())]

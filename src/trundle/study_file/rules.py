"""Say what a key must be, in this program's words instead of a validation library's."""

from __future__ import annotations

from typing import Any

__all__ = ["rule_of"]

_KINDS = {
    "int": "must be a whole number",
    "float": "must be a number",
    "bool": "must be true or false",
    "string": "must be text, in quotes",
    "list": "must be a list, in square brackets",
    "tuple": "must be a list, in square brackets",
    "dict": "must be a table of keys, as in { key = value }",
    "model": "must be a table of keys, as in { key = value }",
    "finite": "must be a finite number",
}
_BOUNDS = {
    "greater_than": ("gt", "must be greater than {:.12g}"),
    "greater_than_equal": ("ge", "must be {:.12g} or more"),
    "less_than": ("lt", "must be less than {:.12g}"),
    "less_than_equal": ("le", "must be {:.12g} or less"),
    "too_short": ("min_length", "must hold at least {:.12g}"),
    "too_long": ("max_length", "must hold at most {:.12g}"),
}
_OWN = {"rule", "quantity"}


def rule_of(error: dict[str, Any]) -> str:
    """Return the rule that an error of validation breaks.

    Parameters
    ----------
    error : dict
        One of pydantic's errors: its ``type``, ``ctx`` and ``msg``.
    """
    kind, context = str(error["type"]), error.get("ctx", {})
    if kind in _OWN:
        return str(error["msg"])
    if kind in {"value_error", "assertion_error"}:
        return str(context.get("error", "is not right"))
    if kind == "literal_error":
        return f"must be one of {context['expected']}"
    if kind in _BOUNDS:
        name, words = _BOUNDS[kind]
        return words.format(float(context[name]))
    return _KINDS.get(kind.partition("_")[0], "is not what belongs here")

"""Tell mistakes of keys that take values of several kinds by the kind that the value is like."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

__all__ = ["by_likeness"]

_BRANCHES = (
    "tuple[", "literal[", "list[", "dict[", "function-", "constrained-", "lax-or-strict[", "model[",
)  # fmt: skip
_WORDS = {"literal": "a word", "tuple": "a list", "Section": "a table"}


def by_likeness(errors: Sequence[Mapping[str, Any]], data: object) -> list[dict[str, Any]]:
    """Return errors whose locations name keys alone, those of one alternative of each key.

    The validating library gives the errors of every alternative, and names it in their locations.
    Kept are those of a list for a list, of a table for a table, of a word for a word; the words
    that a key takes are told with what else it does.

    Parameters
    ----------
    errors : sequence of mapping
        What the library found, with ``loc``.
    data : object
        What was validated.
    """
    kept: list[dict[str, Any]] = []
    groups: dict[tuple[Any, ...], dict[str, list[dict[str, Any]]]] = {}
    for error in errors:
        loc = tuple(part for part in error["loc"] if part != "[key]")
        at = next((i for i, part in enumerate(loc) if _is_branch(part)), None)
        if at is None:
            kept.append({**error, "loc": loc})
        else:
            one = {**error, "loc": loc[:at] + loc[at + 1 :]}
            groups.setdefault(loc[:at], {}).setdefault(str(loc[at]), []).append(one)
    for place, branches in groups.items():
        kept += by_likeness(_likest(branches, _value(data, place)), data)
    return kept


def _is_branch(part: object) -> bool:
    return isinstance(part, str) and (part.startswith(_BRANCHES) or part.endswith("Section"))


def _kind(branch: str) -> str:
    return next((kind for kind in _WORDS if branch.startswith(kind) or branch.endswith(kind)), "")


def _likest(branches: Mapping[str, list[dict[str, Any]]], value: object) -> list[dict[str, Any]]:
    wanted = "tuple" if isinstance(value, list) else "literal"
    wanted = "Section" if isinstance(value, Mapping) else wanted
    by_kind = {_kind(branch): found for branch, found in branches.items()}
    found = by_kind.get(wanted) or next(iter(branches.values()))
    others = [_WORDS[kind] for kind in by_kind if kind not in {wanted, ""}]
    return [{**error, "others": others} for error in found]


def _value(data: object, place: Sequence[Any]) -> object:
    """Return what stands at a place; None where nothing does."""
    for part in place:
        if isinstance(data, Mapping):
            data = data.get(part)
        elif isinstance(data, list) and isinstance(part, int) and part < len(data):
            data = data[part]
        else:
            return None
    return data

"""Make a value of a study, or say what is wrong with it and where."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

from trundle.errors import InputError, Problem

__all__ = ["attempt", "attempted"]

T = TypeVar("T")


def attempt(place: str, make: Callable[[], T], remedy: str = "") -> T | Problem:
    """Return what `make` gives, or the problem of that place that it ends in."""
    try:
        return make()
    except InputError as error:
        rule, _, value = str(error).partition("; got ")
        return Problem(
            place=place,
            value=value or "this section",
            rule=rule,
            remedy=remedy or "correct the value",
        )


def attempted(
    place: str, make: Callable[[], T], remedy: str = ""
) -> tuple[T | None, list[Problem]]:
    """Return what `make` gives, or nothing and the problem of that place."""
    made = attempt(place, make, remedy)
    return (None, [made]) if isinstance(made, Problem) else (made, [])

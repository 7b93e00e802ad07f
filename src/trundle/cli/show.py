"""Choose how a command says what it found: as tables, as JSON, or not at all."""

from __future__ import annotations

import json
from typing import Any, Literal, TypeAlias

from trundle._json import plain
from trundle.cli.saying import say
from trundle.errors import InputError, StudyError

__all__ = ["Show", "error_as_json", "say_json", "show_of", "warn"]

Show: TypeAlias = Literal["tables", "json", "nothing"]


def show_of(*, as_json: bool, quiet: bool) -> Show:
    """Return what --json and --quiet ask for."""
    if as_json and quiet:
        raise InputError("--json prints and --quiet does not: give one of them")
    return "json" if as_json else "nothing" if quiet else "tables"


def say_json(value: object) -> None:
    """Print a value as JSON, which has no not-a-number."""
    say(json.dumps(plain(value), indent=1, allow_nan=False))


def warn(message: object, show: Show) -> None:
    """Print a doubt: among the tables, or on the error stream beside JSON and silence."""
    say(f"warning: {message}", error=show != "tables")


def error_as_json(error: Exception) -> str:
    """Return an error as JSON, the mistakes of a study one by one."""
    said: dict[str, Any] = {"error": str(error)}
    if isinstance(error, StudyError):
        said = {
            "error": str(error).partition("\n")[0],
            "mistakes": [
                {
                    "place": p.place,
                    "line": p.line,
                    "value": p.value,
                    "rule": p.rule,
                    "remedy": p.remedy,
                }
                for p in error.problems
            ],
        }
    return json.dumps(said, indent=1)

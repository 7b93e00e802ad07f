"""Say what a format of road profiles offers, and find all that there are."""

from __future__ import annotations

import functools
import importlib
import pkgutil
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from trundle.profiles.survey import Survey

__all__ = ["ProfileFormat", "all_formats", "format_of"]


@dataclass(frozen=True, kw_only=True, eq=False)
class ProfileFormat:
    """Hold how a format is told, and how it is read.

    Attributes
    ----------
    name : str
        What it is called.
    claims : callable
        Takes the first bytes of a file; returns whether it is of this format.
    read : callable
        Takes all bytes, and the path for messages; returns the survey, or raises `InputError`.
    """

    name: str
    claims: Callable[[bytes], bool]
    read: Callable[[bytes, Path], Survey]


@functools.cache
def all_formats() -> tuple[ProfileFormat, ...]:
    """Return the formats that have a file in ``profiles/formats``."""
    from trundle.profiles import formats  # noqa: PLC0415 - its files import this module

    modules = (m.name for m in pkgutil.iter_modules(formats.__path__, f"{formats.__name__}."))
    return tuple(importlib.import_module(name).FORMAT for name in sorted(modules))


def format_of(data: bytes) -> ProfileFormat | None:
    """Return the format of a file by its first bytes, whatever its name says; None for a table."""
    return next((one for one in all_formats() if one.claims(data)), None)

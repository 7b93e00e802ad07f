"""Say what a format of records offers, and find all that there are."""

from __future__ import annotations

import functools
import importlib
import pkgutil
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from trundle.records.raw import RawRecord

__all__ = ["RecordFormat", "all_formats", "format_of"]


@dataclass(frozen=True, kw_only=True, eq=False)
class RecordFormat:
    """Hold how a format is told, and how it is read.

    Attributes
    ----------
    name : str
        What it is called.
    suffixes : tuple of str
        Endings of file names that belong to it alone, as ``.wav``.
    claims : callable
        Takes the first bytes of a file; returns whether it is of this format.
    read : callable
        Takes all bytes, the path for messages, and the channels that are wanted, as the user names
        them; returns the record in units of the file, or raises `InputError`.
    full_scale : bool
        Whether its samples may be shares of a full scale, which the user must then say.
    """

    name: str
    suffixes: tuple[str, ...]
    claims: Callable[[bytes], bool]
    read: Callable[[bytes, Path, str], RawRecord]
    full_scale: bool = False


@functools.cache
def all_formats() -> tuple[RecordFormat, ...]:
    """Return the formats that have a file in ``records/formats``."""
    from trundle.records import formats  # noqa: PLC0415 - its files import this module

    modules = (m.name for m in pkgutil.iter_modules(formats.__path__, f"{formats.__name__}."))
    return tuple(importlib.import_module(name).FORMAT for name in sorted(modules))


def format_of(data: bytes) -> RecordFormat | None:
    """Return the format of a file by its first bytes, whatever its name says; None for text."""
    return next((one for one in all_formats() if one.claims(data)), None)

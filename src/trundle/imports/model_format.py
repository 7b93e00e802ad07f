"""Say what a format of structural models offers, and find all that there are."""

from __future__ import annotations

import functools
import importlib
import pkgutil
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from trundle.errors import Problem
from trundle.structure import Structure

__all__ = ["ModelFormat", "ReadModel", "all_formats"]


@dataclass(frozen=True, kw_only=True, eq=False)
class ReadModel:
    """Hold what was read.

    Attributes
    ----------
    structure : Structure or None
        The model; None where problems leave none.
    problems : tuple of Problem
        What was not understood, with its place: nothing is left out in silence.
    """

    structure: Structure | None
    problems: tuple[Problem, ...] = ()


@dataclass(frozen=True, kw_only=True, eq=False)
class ModelFormat:
    """Hold how a format is told, and how it is read.

    Attributes
    ----------
    name : str
        What it is called.
    suffixes : tuple of str
        Endings of file names that it usually has.
    claims : callable
        Takes the first bytes of a file; returns whether it is of this format.
    read : callable
        Takes the path; returns what was read.
    """

    name: str
    suffixes: tuple[str, ...]
    claims: Callable[[bytes], bool]
    read: Callable[[Path], ReadModel]


@functools.cache
def all_formats() -> tuple[ModelFormat, ...]:
    """Return the formats that have a file in ``imports/formats``."""
    from trundle.imports import formats  # noqa: PLC0415 - its files import this module

    modules = (m.name for m in pkgutil.iter_modules(formats.__path__, f"{formats.__name__}."))
    return tuple(importlib.import_module(name).FORMAT for name in sorted(modules))

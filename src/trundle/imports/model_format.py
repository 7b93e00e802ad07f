"""Say what a format of structural models offers, and find all that there are."""

from __future__ import annotations

import functools
import importlib
import pkgutil
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from trundle.errors import Problem
from trundle.imports.mesh_groups import GroupMake
from trundle.imports.stand_on import SurfaceChoice
from trundle.imports.unit_system import Units
from trundle.structure import Structure

__all__ = ["Asked", "ModelFormat", "ReadModel", "all_formats"]


@dataclass(frozen=True, kw_only=True, eq=False)
class Asked:
    """Hold what its reader says of a model beside its file.

    Attributes
    ----------
    kind : str or None
        Format, by its `ModelFormat.kind`; None: the file's content tells.
    units : Units or None
        Units of its numbers; None: those that the file states, or else SI.
    surfaces : tuple of SurfaceChoice
        What is stood on; none for all of its levels.
    ignore : frozenset of str
        Names of cards or tables that are nothing of the model: they are told, and passed over.
    groups : mapping of str to GroupMake
        What groups of a mesh are, where the format knows of geometry alone.
    """

    kind: str | None = None
    units: Units | None = None
    surfaces: tuple[SurfaceChoice, ...] = ()
    ignore: frozenset[str] = frozenset()
    groups: Mapping[str, GroupMake] = field(default_factory=dict[str, GroupMake])


@dataclass(frozen=True, kw_only=True, eq=False)
class ReadModel:
    """Hold what was read.

    Attributes
    ----------
    structure : Structure or None
        The model in SI; None where problems leave none.
    problems : tuple of Problem
        What was not understood, with its place: nothing is left out in silence.
    units : Units or None
        Units that its numbers were taken to be in.
    told : tuple of str
        What was passed over, and what was assumed.
    files : tuple of Path
        All files that were read, the model's own first.
    """

    structure: Structure | None
    problems: tuple[Problem, ...] = ()
    units: Units | None = None
    told: tuple[str, ...] = ()
    files: tuple[Path, ...] = ()


@dataclass(frozen=True, kw_only=True, eq=False)
class ModelFormat:
    """Hold how a format is told, and how it is read.

    Attributes
    ----------
    kind : str
        What study files call it: ``kind = "nastran"``.
    name : str
        What it is called.
    suffixes : tuple of str
        Endings of file names that it usually has.
    claims : callable
        Takes the first bytes of a file; returns whether it is of this format.
    read : callable
        Takes the path, and what is asked; returns what was read.
    """

    kind: str
    name: str
    suffixes: tuple[str, ...]
    claims: Callable[[bytes], bool]
    read: Callable[[Path, Asked], ReadModel]


@functools.cache
def all_formats() -> tuple[ModelFormat, ...]:
    """Return the formats that have a file in ``imports/formats``."""
    from trundle.imports import formats  # noqa: PLC0415 - its files import this module

    modules = (m.name for m in pkgutil.iter_modules(formats.__path__, f"{formats.__name__}."))
    return tuple(importlib.import_module(name).FORMAT for name in sorted(modules))

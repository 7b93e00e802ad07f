"""Say what a format of exports offers, and find all that there are."""

from __future__ import annotations

import functools
import importlib
import os
import pkgutil
import shutil
import tempfile
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

from trundle.dynamics import Modes
from trundle.errors import InputError
from trundle.results.study_result import StudyResult
from trundle.run.playback import Playback
from trundle.structure import Structure

__all__ = ["ExportFormat", "Subject", "all_exports", "export", "format_of"]


@dataclass(frozen=True, kw_only=True, eq=False)
class Subject:
    """Hold what may be written; what is None is not there.

    Attributes
    ----------
    structure : Structure
        The model.
    modes : Modes or None
        Its natural modes.
    playback : Playback or None
        A crossing, frame by frame.
    result : StudyResult or None
        A study's results.
    origin : tuple of float or None
        Longitude and latitude of x = y = 0 [degrees].
    north : float
        Direction of north in plan, counterclockwise from y [rad].
    """

    structure: Structure
    modes: Modes | None = None
    playback: Playback | None = None
    result: StudyResult | None = None
    origin: tuple[float, float] | None = None
    north: float = 0.0


@dataclass(frozen=True, kw_only=True, eq=False)
class ExportFormat:
    """Hold how a format is written.

    Attributes
    ----------
    kind : str
        What the command calls it.
    name : str
        What it is called.
    suffix : str
        Ending of its files.
    needs : tuple of str
        Fields of `Subject` without which nothing can be written.
    uses : tuple of str
        Fields that are written too where they are there.
    write : callable
        Takes the subject; returns the content of each file by its suffix, the main one first:
        what stands behind the stem that the user has chosen.
    """

    kind: str
    name: str
    suffix: str
    needs: tuple[str, ...] = ()
    uses: tuple[str, ...] = ()
    write: Callable[[Subject, str], Mapping[str, bytes]]


@functools.cache
def all_exports() -> tuple[ExportFormat, ...]:
    """Return the formats that have a file in ``exports/formats``."""
    from trundle.exports import formats  # noqa: PLC0415 - its files import this module

    modules = (m.name for m in pkgutil.iter_modules(formats.__path__, f"{formats.__name__}."))
    return tuple(importlib.import_module(name).EXPORT for name in sorted(modules))


def format_of(path: Path, kind: str | None = None) -> ExportFormat:
    """Return the format of a kind, or by the path's ending.

    Raises
    ------
    InputError
        There is none.
    """
    for one in all_exports():
        if one.kind == kind or (kind is None and path.name.lower().endswith(one.suffix)):
            return one
    names = ", ".join(f"{one.kind} ({one.suffix})" for one in all_exports())
    raise InputError(f"{kind or path.name}: of no format that is written; there are: {names}")


def export(subject: Subject, path: Path, kind: str | None = None) -> tuple[Path, ...]:
    """Write a subject; return the files, the main one first.

    Files appear when all of them are whole; those of the same names are replaced.

    Parameters
    ----------
    subject : Subject
        What is written.
    path : Path
        The main file; others stand beside it, with names that begin as its does.
    kind : str, optional
        The format; told by the path's ending unless given.

    Raises
    ------
    InputError
        No such format, a subject that lacks what it needs, a place that cannot be written to.
    """
    chosen = format_of(path, kind)
    for name in chosen.needs:
        if getattr(subject, name) is None:
            raise InputError(f"{chosen.name} needs {_WORDS[name]}, and there is none")
    content = chosen.write(subject, path.stem)
    files = [path, *(path.with_name(path.stem + end) for end in list(content)[1:])]
    try:
        folder = Path(tempfile.mkdtemp(prefix=".trundle-", dir=path.absolute().parent))
        try:
            for file, data in zip(files, content.values(), strict=True):
                (folder / file.name).write_bytes(data)
            for file in reversed(files):  # the main one last: it names the others
                os.replace(folder / file.name, file)
        finally:
            shutil.rmtree(folder, ignore_errors=True)
    except OSError as error:
        raise InputError(f"{path}: cannot be written ({error.strerror})") from None
    return tuple(files)


_WORDS = {
    "modes": "modes (--f-max)",
    "playback": "a crossing",
    "result": "results of a study",
}

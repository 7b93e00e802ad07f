"""Read a structural model, whatever format its file is in."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from trundle.errors import InputError, Problem
from trundle.imports.guard import check_sound, guarded
from trundle.imports.model_format import Asked, ModelFormat, ReadModel, all_formats
from trundle.imports.stand_on import surfaces_of
from trundle.structure import Floor

__all__ = ["read_model"]

_FIRST = 65536  # bytes by which formats are told
_LARGEST = 500_000_000  # bytes: what is held in memory at once is a few times that


class _NoSuchFileError(InputError):
    """A path that leads to no model at all: there is nothing to have problems with."""


def read_model(path: Path, asked: Asked | None = None) -> ReadModel:
    """Read a structural model into SI.

    Parameters
    ----------
    path : Path
        A file of one of the formats that are known.
    asked : Asked, optional
        Its units, what is stood on, and what else its file does not say.

    Raises
    ------
    InputError
        A file that cannot be read, that is of no format that is known, or whose units are not
        those that are asked for.
    """
    asked = asked or Asked()
    read = ReadModel(structure=None)
    try:
        with guarded(path.name):
            read = _format_of(path, asked.kind).read(path, asked)
            if read.structure is None or not isinstance(read.structure, Floor):
                return read
            if not read.structure.n_dofs:
                raise InputError("nothing of it can move: no node is free")
            floor = read.structure
            check_sound(floor)  # elements without area or warped are told here too
            floor = replace(floor, decks=surfaces_of(floor.nodes, floor.elements, asked.surfaces))
    except _NoSuchFileError:
        raise
    except InputError as error:
        return replace(read, structure=None, problems=(_refused(path, error),))
    return replace(read, structure=floor)


def _refused(path: Path, error: InputError) -> Problem:
    return Problem(place=path.name, value="the model", rule=str(error), remedy="correct the model")


def _format_of(path: Path, kind: str | None) -> ModelFormat:
    try:
        if not path.is_file():
            raise _NoSuchFileError(f"{path}: no such file; name the file of a structural model")
        if path.stat().st_size > _LARGEST:
            raise _NoSuchFileError(f"{path}: a model may have {_LARGEST / 1e9:g} GB")
        with path.open("rb") as opened:
            first = opened.read(_FIRST)
    except OSError as error:
        raise _NoSuchFileError(f"{path}: cannot be read ({error.strerror})") from None
    if b"\0" in first:
        raise _NoSuchFileError(f"{path}: is binary; models are read as text: export it as text")
    if kind is not None:
        return next(one for one in all_formats() if one.kind == kind)
    found = next((one for one in all_formats() if one.claims(first)), None)
    if found is None:
        names = ", ".join(f"{one.name} ({', '.join(one.suffixes)})" for one in all_formats())
        raise _NoSuchFileError(f"{path}: of no format that is known: {names}")
    return found

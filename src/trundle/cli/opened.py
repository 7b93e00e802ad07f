"""Open what a command is pointed at: results, a study, or a model of another program."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from trundle._face import read_results
from trundle.errors import InputError, StudyError
from trundle.imports import Asked, all_formats, read_model, units_of
from trundle.imports.model_format import ReadModel
from trundle.results.study_result import StudyResult
from trundle.structure import Structure
from trundle.study.model import Study
from trundle.study_file.build import load_study

__all__ = ["Opened", "open_path"]


@dataclass(frozen=True, kw_only=True, eq=False)
class Opened:
    """Hold what stands at a path.

    Attributes
    ----------
    structure : Structure
        Its model.
    study : Study or None
        The study, of study files and of results.
    result : StudyResult or None
        The results.
    read : ReadModel or None
        What the file of a model gave.
    """

    structure: Structure
    study: Study | None = None
    result: StudyResult | None = None
    read: ReadModel | None = None


def open_path(path: Path, *, kind: str = "", units: str = "", ignore: str = "") -> Opened:
    """Open a folder of results, a study file, or the file of a model.

    Parameters
    ----------
    path : Path
        What is opened.
    kind, units, ignore : str
        Format of a model, its units, and what of it to pass over, between commas, as they are
        given to the command; empty for nothing.

    Raises
    ------
    InputError
        Nothing that can be read, or options of models for what is none.
    StudyError
        A study or a model with problems, all of which it lists.
    """
    if path.is_dir() or path.suffix.lower() == ".toml":
        if kind or units or ignore:
            raise InputError("--kind, --units and --ignore are of models; a study says them itself")
        if not path.is_dir():
            study = load_study(path)
            return Opened(structure=study.floor, study=study)
        result = read_results(path)
        return Opened(structure=result.study.floor, study=result.study, result=result)
    read = read_model(path, _asked(kind, units, ignore))
    if read.structure is None:
        raise StudyError(str(path), list(read.problems))
    return Opened(structure=read.structure, read=read)


def _asked(kind: str, units: str, ignore: str) -> Asked:
    kinds = [one.kind for one in all_formats()]
    if kind and kind not in kinds:
        raise InputError(f"--kind {kind!r}: must be one of {', '.join(kinds)}")
    try:
        taken = units_of(units) if units else None
    except InputError as error:
        raise InputError(f"--units: {error}") from None
    names = frozenset(one.strip() for one in ignore.split(",") if one.strip())
    return Asked(kind=kind or None, units=taken, ignore=names)

"""Turn checked sections into a study in SI, and check how they fit together."""

from __future__ import annotations

from collections import ChainMap
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from trundle._kinds import kinds_checked
from trundle.errors import InputError, Problem, StudyError
from trundle.study.model import Study
from trundle.study_file.document import StudyFile
from trundle.study_file.draft import Draft
from trundle.study_file.lines import line_of, lines_of
from trundle.study_file.read import read_study, read_text
from trundle.study_file.sections import FILES

__all__ = ["load_study", "study_from_text"]


@kinds_checked
def load_study(
    path: Path | str, *, source: str | None = None, files: Mapping[str, Path] | None = None
) -> Study:
    """Read, check and build a study.

    Parameters
    ----------
    path : path-like
        A TOML study file.
    source : str, optional
        What the file is called in messages and reports; its path unless given.
    files : mapping of str to Path, optional
        Where files are that the study names, if not beside it.

    Returns
    -------
    Study
        Everything in SI, the floor meshed.

    Raises
    ------
    StudyError
        With every mistake found: of single values, and of how they fit together.
    """
    path = Path(path)
    file, problems = read_study(path)
    file = file if source is None else replace(file, source=source)
    return _built(file, problems, path.parent, files or {})


@kinds_checked
def study_from_text(text: str, *, source: str = "study", folder: Path | str = ".") -> Study:
    """Check and build a study from the text of a study file.

    Parameters
    ----------
    text : str
        TOML, as in a study file.
    source : str
        What it is called in messages and reports.
    folder : path-like
        Where files are that it names.

    Returns
    -------
    Study
        Everything in SI, the floor meshed.

    Raises
    ------
    StudyError
        With every mistake found.
    """
    if not text.isascii() and any("\ud800" <= c <= "\udfff" for c in text):
        raise InputError(f"{source}: holds half a character (a surrogate); write it as UTF-8")
    file, problems = read_text(text, source)
    return _built(file, problems, Path(folder), {})


def _built(
    file: StudyFile, problems: list[Problem], folder: Path, files: Mapping[str, Path]
) -> Study:
    draft = Draft(file=file, folder=folder, files=files)
    for section in FILES:
        draft, mistakes = getattr(section, "build", _nothing)(draft)
        problems += mistakes
    for section in FILES:
        problems += getattr(section, "problems", _none)(draft)
    if problems:
        raise StudyError(file.source, _in_order(problems, file.text))
    try:
        values = [section.fields(draft) for section in FILES if hasattr(section, "fields")]
    except InputError as error:  # a floor whose parts do not fit shows when it is meshed
        place, text = "floor", str(error)
        problem = Problem(place=place, value="this section", rule=text, remedy="correct the value")
        raise StudyError(file.source, _in_order([problem], file.text)) from None
    return Study(
        source=file.source,
        text=file.text,
        content_hash=file.content_hash,
        **dict(ChainMap(*values)),
    )


def _nothing(draft: Draft) -> tuple[Draft, list[Problem]]:
    return draft, []


def _none(draft: Draft) -> Sequence[Problem]:
    del draft
    return ()


def _in_order(problems: Iterable[Problem], text: str) -> list[Problem]:
    """Return problems with their lines, in the order of the file."""
    lines = lines_of(text)
    placed = [replace(p, line=line_of(p.place, lines)) for p in problems]
    return sorted(placed, key=lambda p: p.line or np.inf)

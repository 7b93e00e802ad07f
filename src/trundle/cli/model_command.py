"""Sum up a model of another program, or the building of a study."""

from __future__ import annotations

from pathlib import Path

from trundle.cli.screen import print_table
from trundle.cli.show import say_json
from trundle.errors import InputError, StudyError
from trundle.imports import Asked, all_formats, read_model, units_of
from trundle.imports.model_format import ReadModel
from trundle.imports.summary import summary_of
from trundle.structure import Structure
from trundle.study_file.build import load_study
from trundle.views.model import summary_data, summary_tables

__all__ = ["model", "model_at"]


def model(path: Path, *, kind: str, units: str, ignore: str, as_json: bool) -> None:
    """Print what a model comes to."""
    structure, read = model_at(path, kind=kind, units=units, ignore=ignore)
    found = summary_of(structure, read)
    if as_json:
        say_json(summary_data(found))
        return
    for table in summary_tables(found):
        print_table(table.title, table.headings, table.rows, text_columns=table.text_columns)


def model_at(
    path: Path, *, kind: str = "", units: str = "", ignore: str = ""
) -> tuple[Structure, ReadModel | None]:
    """Return the structure of a study, or of a model's own file, and what that gave."""
    if path.suffix.lower() == ".toml":
        if kind or units or ignore:
            raise InputError("--kind, --units and --ignore are of models; a study says them itself")
        return load_study(path).floor, None
    kinds = [one.kind for one in all_formats()]
    if kind and kind not in kinds:
        raise InputError(f"--kind {kind!r}: must be one of {', '.join(kinds)}")
    try:
        taken = units_of(units) if units else None
    except InputError as error:
        raise InputError(f"--units: {error}") from None
    asked = Asked(
        kind=kind or None,
        units=taken,
        ignore=frozenset(one.strip() for one in ignore.split(",") if one.strip()),
    )
    read = read_model(path, asked)
    if read.structure is None:
        raise StudyError(str(path), list(read.problems))
    return read.structure, read

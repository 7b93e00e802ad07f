"""ETABS text files (.e2k): frames, floors and walls by storeys, as far as the syntax is public."""

from __future__ import annotations

import re
from pathlib import Path

from trundle.errors import InputError, Problem
from trundle.imports.etabs_statements import statements_of
from trundle.imports.etabs_tables import tables_of
from trundle.imports.formats.sap2000 import floor_of_tables, where_apart
from trundle.imports.model_format import Asked, ModelFormat, ReadModel
from trundle.imports.unit_system import agreed_units, in_si, units_of

__all__ = ["FORMAT"]


def read(path: Path, asked: Asked) -> ReadModel:
    """Read statements.

    Parameters
    ----------
    path : Path
        A file that ETABS has exported as text.
    asked : Asked
        Statements to be passed over.
    """
    ignored = {name.upper() for name in asked.ignore}
    try:
        statements = [s for s in statements_of(path) if s.words[0].upper() not in ignored]
        tables, stated, told = tables_of(statements, lambda text: units_of(text).length)
        units, said = agreed_units(units_of(stated), asked.units)
        floor, apart = floor_of_tables(tables, units, path.stem)
        if len(apart):
            raise InputError(f"{where_apart(apart)}: divide them so that they do")
        floor = in_si(floor, units)
    except InputError as error:
        problem = Problem(
            place=path.name, value="the model", rule=str(error), remedy="docs/models.md"
        )
        return ReadModel(structure=None, problems=(problem,), files=(path,))
    mesh = "floors and walls are meshed to 1 m or less"
    return ReadModel(structure=floor, units=units, told=(*said, mesh, *told), files=(path,))


FORMAT = ModelFormat(
    kind="etabs",
    name="ETABS text file",
    suffixes=(".e2k", ".$et"),
    claims=lambda data: (
        re.search(rb"^\$ (STORIES|CONTROLS|PROGRAM INFORMATION)", data, re.M) is not None
    ),
    read=read,
)

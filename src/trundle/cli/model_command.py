"""Sum up a model of another program, or the building of a study."""

from __future__ import annotations

from pathlib import Path

from trundle.cli.opened import open_path
from trundle.cli.screen import print_table
from trundle.cli.show import say_json
from trundle.imports.summary import summary_of
from trundle.views.model import summary_data, summary_tables

__all__ = ["model"]


def model(path: Path, *, kind: str, units: str, ignore: str, as_json: bool) -> None:
    """Print what a model comes to."""
    opened = open_path(path, kind=kind, units=units, ignore=ignore)
    found = summary_of(opened.structure, opened.read)
    if as_json:
        say_json(summary_data(found))
        return
    for table in summary_tables(found):
        print_table(table.title, table.headings, table.rows, text_columns=table.text_columns)

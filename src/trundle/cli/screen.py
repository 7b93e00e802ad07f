"""Print tables and progress on the screen."""

from __future__ import annotations

import sys
from collections.abc import Callable, Generator, Iterable
from contextlib import contextmanager
from typing import TypeAlias

from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn
from rich.table import Table
from rich.text import Text

__all__ = ["Tell", "print_table", "progress_bar"]

Tell: TypeAlias = Callable[[str, float], None]
"""Told what is being done, and the share done."""

_PIPE_WIDTH = 150  # tables are cut to pieces on a narrow pipe


def print_table(
    title: str, headings: Iterable[str], rows: Iterable[Iterable[str]], *, text_columns: int = 1
) -> None:
    """Print a table; the first columns hold text, the others numbers.

    Nothing is read as markup, so a unit or a name in brackets is shown as it is.
    """
    table = Table(title=Text(title))
    for i, heading in enumerate(headings):
        justify = "left" if i < text_columns else "right"
        table.add_column(Text(heading), justify=justify, overflow="fold")
    for row in rows:
        table.add_row(*(Text(cell) for cell in row))
    width = None if sys.stdout.isatty() else _PIPE_WIDTH
    Console(highlight=False, width=width).print(table)


@contextmanager
def progress_bar() -> Generator[Tell]:
    """Show a bar on a terminal, and one line a stage elsewhere."""
    if not sys.stderr.isatty():
        yield _line_teller()
        return
    with Progress(
        TextColumn("{task.description}", markup=False),
        BarColumn(),
        TextColumn("{task.percentage:3.0f} %"),
        TimeElapsedColumn(),
        console=Console(stderr=True),
        transient=True,
    ) as progress:
        task = progress.add_task("", total=1.0)
        yield lambda what, share: progress.update(task, description=what, completed=share)


def _line_teller() -> Tell:
    seen: set[str] = set()

    def tell(what: str, share: float) -> None:
        if what not in seen:
            seen.add(what)
            print(f"[{100 * share:3.0f} %] {what}", file=sys.stderr, flush=True)

    return tell

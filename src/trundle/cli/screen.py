"""Print tables and progress on the screen."""

from __future__ import annotations

import sys
import time
from collections.abc import Generator, Iterable
from contextlib import contextmanager

from rich.console import Console
from rich.progress import (
    BarColumn,
    Progress,
    TextColumn,
    TimeElapsedColumn,
    TimeRemainingColumn,
)
from rich.table import Table
from rich.text import Text

from trundle._progress import Tell, silent
from trundle.cli.interrupts import interruptible
from trundle.cli.saying import printable, say

__all__ = ["print_table", "progress_bar"]


_PIPE_WIDTH = 150  # tables are cut to pieces on a narrow pipe


def print_table(
    title: str, headings: Iterable[str], rows: Iterable[Iterable[str]], *, text_columns: int = 1
) -> None:
    """Print a table; the first columns hold text, the others numbers.

    Nothing is read as markup, so a unit or a name in brackets is shown as it is.
    """
    table = Table(title=Text(printable(title)))
    for i, heading in enumerate(headings):
        justify = "left" if i < text_columns else "right"
        table.add_column(Text(printable(heading)), justify=justify, overflow="fold")
    for row in rows:
        table.add_row(*(Text(printable(cell)) for cell in row))
    width = None if sys.stdout.isatty() else _PIPE_WIDTH
    Console(highlight=False, width=width).print(table)


@contextmanager
def progress_bar(*, quiet: bool = False) -> Generator[Tell]:
    """Show a bar on a terminal, and one line a stage elsewhere; nothing if quiet."""
    if quiet:
        yield interruptible(silent)
        return
    if not sys.stderr.isatty():
        yield interruptible(_line_teller())
        return
    with Progress(
        TextColumn("{task.description}", markup=False),
        BarColumn(),
        TextColumn("{task.percentage:3.0f} %"),
        TimeElapsedColumn(),
        TextColumn("left"),
        TimeRemainingColumn(elapsed_when_finished=False),
        console=Console(stderr=True),
        transient=True,
    ) as progress:
        task = progress.add_task("", total=1.0)
        yield interruptible(
            lambda what, share: progress.update(task, description=printable(what), completed=share)
        )


def _time_left(elapsed: float, done: float, left: float) -> str:
    """Return about how long the rest takes, once enough is done to say so."""
    if elapsed < 2.0 or done < 0.02:
        return ""
    seconds = elapsed * left / done
    return f", {seconds:.0f} s left" if seconds < 90 else f", {seconds / 60:.0f} min left"


def _line_teller() -> Tell:
    seen: set[str] = set()
    begun: list[tuple[float, float]] = []  # when the first share was told, and which

    def tell(what: str, share: float) -> None:
        now = time.monotonic()
        if not begun:
            begun.append((now, share))
        if what not in seen:
            seen.add(what)
            left = _time_left(now - begun[0][0], share - begun[0][1], 1.0 - share)
            say(f"[{100 * share:3.0f} %{left}] {what}", error=True)

    return tell

"""Write the pages that a build makes, in Markdown, only where they change."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path

__all__ = ["DOCS", "GENERATED", "ROOT", "code", "table", "write_page"]

DOCS = Path(__file__).resolve().parent.parent
ROOT = DOCS.parent
GENERATED = DOCS / "generated"


def write_page(path: Path, text: str) -> None:
    """Write a page; one that has not changed keeps its time, and is not read again."""
    path.parent.mkdir(parents=True, exist_ok=True)
    if not path.exists() or path.read_text("utf-8") != text:
        path.write_text(text, encoding="utf-8")


def code(text: str) -> str:
    """Return text as code, whatever bars it holds."""
    return f"`{text}`".replace("|", "\\|")


def table(head: Sequence[str], rows: Iterable[Sequence[str]], *, kind: str = "") -> str:
    """Return a table in Markdown.

    Parameters
    ----------
    head, rows : sequence of str
        Headings, and cells in Markdown.
    kind : str
        A class for the look of its columns.
    """
    lines = [f"| {' | '.join(head)} |", f"|{'---|' * len(head)}"]
    lines += [f"| {' | '.join(_cell(cell) for cell in row)} |" for row in rows]
    mark = f"{{.{kind}}}\n" if kind else ""
    body = "\n".join(lines)
    return f"\n\n{mark}{body}\n"


def _cell(text: str) -> str:
    return " ".join(text.split()) or " "

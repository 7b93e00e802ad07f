"""Print lines that cannot steer a terminal, whatever the names in them hold."""

from __future__ import annotations

import sys
import unicodedata

__all__ = ["printable", "say"]


def printable(text: str) -> str:
    """Return a text with a question mark for all that is neither shown nor a blank."""
    return "".join(c if c.isprintable() or _is_blank(c) else "?" for c in text)


def _is_blank(character: str) -> bool:
    return character == "\n" or unicodedata.category(character) == "Zs"


def say(text: object, *, error: bool = False) -> None:
    """Print a line, or several: titles and names of files may hold anything."""
    print(printable(str(text)), file=sys.stderr if error else sys.stdout)

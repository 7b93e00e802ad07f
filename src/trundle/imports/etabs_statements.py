"""Read the statements of ETABS text files (.e2k): words, some in quotes, under titles."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from pathlib import Path

from trundle.errors import InputError

__all__ = ["HOLDS_NOTHING", "Statement", "number_of", "statements_of"]

_WORD = re.compile(r'"((?:[^"]|"")*)"|(\S+)')


HOLDS_NOTHING = re.compile(
    "^("
    + "|".join(
        (
            "PROGRAM", "TITLE", "PREFERENCE", "RLLF", "GRID", "GENGRID", "COORDSYSTEM", "GROUP",
            "REFERENCEPOINT", "LOAD", "COMBO", "FUNCTION", "FUNC", "POINTLOAD", "LINELOAD",
            "AREALOAD", "SEISMIC", "WIND", "SPEC", "HIST", "STATIC", "MODALCASE", "PIERNAME",
            "SPANDRELNAME", "CONCRETE", "STEEL", "COMPOSITE", "WALL.*DESIGN", "SLAB.*DESIGN",
            "DESIGN", "DIMENSIONLINE", "DEVELOPEDELEV", "TABLESET", "LOGCOMMENT", "REBAR",
            "ENDOFFILE", "END", "LINKPROP", "TENDONPROP", "HINGE", "TOWER", "PROJECT", "COMPANY",
            "DEFAULT", "OUTPUT", "REPORT", "SECTIONCUT", "MERGETOL", "GLOBALX", "UNIFORMLOADSET",
            "AUTO",
        )
    )
    + ")"
)  # fmt: skip
"""Statements that hold nothing of the structure: drawing, loads, cases, design, output."""


@dataclass(frozen=True, kw_only=True)
class Statement:
    """Hold a line of the file: its words, and where it stands.

    Attributes
    ----------
    section : str
        Title of its part, behind the ``$``.
    words : tuple of str
        Without quotes; the first says what it is.
    place : str
        File and line.
    """

    section: str
    words: tuple[str, ...]
    place: str

    def keys(self, first: int, known: str | None = None) -> dict[str, str]:
        """Return the pairs of key and value from a word on.

        Parameters
        ----------
        first : int
            Number of the first key among the words.
        known : str, optional
            Pattern of the keys that are read or of no matter; all, unless given.

        Raises
        ------
        InputError
            A key that is not known or stands twice, or a key without a value.
        """
        rest = self.words[first:]
        found = {k.upper(): v for k, v in zip(rest[::2], rest[1::2], strict=False)}
        if len(rest) % 2 or 2 * len(found) < len(rest):
            raise InputError(f"{self.place}: must be keys with values, each once")
        odd = [k for k in found if known is not None and not re.fullmatch(known, k)]
        if odd:
            raise InputError(f"{self.place}: {odd[0]} of a {self.words[0]} is not read")
        return found

    def word(self, number: int) -> str:
        """Return a word that must be there."""
        if number >= len(self.words):
            raise InputError(f"{self.place}: {self.words[0]} ends too early")
        return self.words[number]


def statements_of(path: Path) -> list[Statement]:
    """Return the statements of a file.

    Raises
    ------
    InputError
        A file that cannot be read, or a line that begins no part.
    """
    try:
        text = path.read_text(encoding="utf-8-sig", errors="replace")
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror})") from None
    found, section = list[Statement](), ""
    for number, line in enumerate(text.splitlines(), start=1):
        if line.startswith("$"):
            section = line[1:].strip().upper()
        elif line.strip():
            words = tuple(m[1] if m[1] is not None else m[2] for m in _WORD.finditer(line))
            found.append(
                Statement(section=section, words=words, place=f"{path.name}, line {number}")
            )
    return found


def number_of(one: Statement, text: str) -> float:
    """Return a number of a statement.

    Parameters
    ----------
    one : Statement
        For messages.
    text : str
        What should be one.

    Raises
    ------
    InputError
        No number, or none that is finite.
    """
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise InputError(f"{one.place}: must be a number; got {text[:40]!r}")
    return value

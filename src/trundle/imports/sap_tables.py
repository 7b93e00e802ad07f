"""Read the tables of SAP2000's text files (.s2k): a row a line, ``Key=Value`` between blanks.

Reference: Computers and Structures, Inc., SAP2000 text file format (database tables exported as
text); values with blanks stand in quotes, and a line that ends in ``_`` goes on below.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from trundle.errors import InputError

__all__ = ["Row", "Table", "read_tables"]

_TABLE = re.compile(r'^\s*TABLE:\s*"?([^"]*?)"?\s*$', re.IGNORECASE)
_PAIR = re.compile(
    r'\s*([^\s="]+)\s*='
    r'(\s*"(?:[^"]|"")*"|[^\s"]+|\s+[^\s="]+(?![^\s"]*\s*=)|)'  # behind a blank no other key
)
_YES = {"yes": True, "no": False, "true": True, "false": False}


@dataclass(frozen=True, kw_only=True)
class Row:
    """Hold a row of a table.

    Attributes
    ----------
    place : str
        File and line.
    cells : mapping of str to str
        Values by key, in small letters.
    used : set of str
        Keys that were asked for.
    """

    place: str
    cells: Mapping[str, str]
    used: set[str]

    def text(self, key: str, default: str | None = None) -> str:
        """Return a value as it stands.

        Raises
        ------
        InputError
            No such key, and no default.
        """
        self.used.add(key.lower())
        found = self.cells.get(key.lower(), "")
        if found:
            return found
        if default is None:
            raise InputError(f"{self.place}: {key} is missing")
        return default

    def number(self, key: str, default: float | None = None) -> float:
        """Return a value as a number that is finite."""
        text = self.text(key, None if default is None else repr(default))
        try:
            value = float(text)
        except ValueError:
            value = math.nan
        if not math.isfinite(value):
            raise InputError(f"{self.place}: {key} must be a number; got {text[:40]!r}")
        return value

    def whole(self, key: str, default: int | None = None) -> int:
        """Return a value as a whole number."""
        value = self.number(key, default)
        if value != int(value):
            raise InputError(f"{self.place}: {key} must be a whole number; got {value:g}")
        return int(value)

    def yes(self, key: str, default: bool = False) -> bool:
        """Return whether a value says yes."""
        text = self.text(key, "Yes" if default else "No")
        if text.lower() not in _YES:
            raise InputError(f"{self.place}: {key} must be Yes or No; got {text[:40]!r}")
        return _YES[text.lower()]


@dataclass(frozen=True, kw_only=True)
class Table:
    """Hold a table.

    Attributes
    ----------
    name : str
        In capitals.
    place : str
        File and line of its title.
    rows : list of Row
        Its rows.
    """

    name: str
    place: str
    rows: list[Row] = field(default_factory=list[Row])

    @property
    def unused(self) -> tuple[str, ...]:
        """Which keys nobody asked for."""
        there = dict.fromkeys(key for row in self.rows for key in row.cells)
        used = {key for row in self.rows for key in row.used}
        return tuple(key for key in there if key not in used)


def read_tables(path: Path) -> dict[str, Table]:
    """Read all tables of a file; one that stands in it twice goes on.

    Raises
    ------
    InputError
        A file that cannot be read, a line of no table, or one that is no row.
    """
    tables: dict[str, Table] = {}
    current: Table | None = None
    for place, line in _joined(path):
        if found := _TABLE.match(line):
            name = found[1].strip().upper()
            current = tables.setdefault(name, Table(name=name, place=place))
            continue
        if line.strip().upper().startswith("END TABLE DATA"):
            return tables
        if current is None:
            if line.strip().lower().startswith("file "):
                continue
            raise InputError(f"{place}: must begin a table; got {line.strip()[:40]!r}")
        current.rows.append(_row(place, line))
    if not tables:
        raise InputError(f"{path.name}: holds no table")
    raise InputError(f"{path.name}: does not end with END TABLE DATA: it is cut short")


def _joined(path: Path) -> Iterator[tuple[str, str]]:
    """Give lines with their place, those joined that go on."""
    try:
        text = path.read_text(encoding="utf-8-sig", errors="replace")
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror})") from None
    begun, place = "", ""
    for number, line in enumerate(text.splitlines(), start=1):
        plain = line.rstrip()
        if not plain or (not begun and plain.startswith("$")):
            continue
        place = place if begun else f"{path.name}, line {number}"
        if plain.endswith(" _"):
            begun += plain[:-1]
            continue
        yield place, begun + plain
        begun = ""
    if begun:
        raise InputError(f"{place}: goes on, and the file ends")


def _row(place: str, line: str) -> Row:
    cells: dict[str, str] = {}
    at = 0
    for found in _PAIR.finditer(line):
        if line[at : found.start()].strip():
            break
        if found[1].lower() in cells:
            raise InputError(f"{place}: {found[1]} is there twice")
        cells[found[1].lower()] = found[2].strip().strip('"').replace('""', '"').strip()
        at = found.end()
    if line[at:].strip() or not cells:
        raise InputError(f"{place}: must be Key=Value pairs; got {line[at:].strip()[:40]!r}")
    return Row(place=place, cells=cells, used=set())

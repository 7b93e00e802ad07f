"""Read the cards of Nastran bulk data: fields of 8, of 16, or between commas, over many lines."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

from trundle.errors import InputError

__all__ = ["Card", "cards_of", "case_control", "real", "whole"]

_REAL = re.compile(r"^([+-]?(?:\d+\.?\d*|\.\d+))(?:[ED]?([+-]?\d+))?$", re.IGNORECASE)
_DEEPEST = 8  # files that include each other
_FILES = 1000  # that are included, however often


@dataclass(frozen=True, kw_only=True)
class Card:
    """Hold a card: its name, its fields behind the name, and where it stands.

    Attributes
    ----------
    name : str
        In capitals, without the star of large fields.
    fields : tuple of str
        Field 2 of the card is the first; blank ones are empty.
    place : str
        File and line.
    looked_at : set of int
        Numbers of the fields that were asked for.
    """

    name: str
    fields: tuple[str, ...]
    place: str
    looked_at: set[int] = field(default_factory=set[int])

    @property
    def unread(self) -> tuple[int, ...]:
        """Which fields hold something that nobody asked for, by their numbers."""
        there = (i for i, value in enumerate(self.fields, start=2) if value)
        return tuple(i for i in there if i not in self.looked_at)

    def get(self, number: int) -> str:
        """Return a field by its number in manuals, 2 for the first; empty if it is not there."""
        self.looked_at.add(number)
        return self.fields[number - 2] if 0 <= number - 2 < len(self.fields) else ""


def real(text: str, default: float | None = None) -> float:
    """Return a real number as Nastran writes it: 2.9+7 is 2.9e7, 1.D-3 is 1e-3.

    Raises
    ------
    InputError
        No such number, or none where there is no default.
    """
    if not text and default is not None:
        return default
    found = _REAL.match(text)
    if not found or (found[2] is None and text[-1:].upper() in {"E", "D"}):
        raise InputError(f"must be a number; got {text!r}")
    value = float(f"{found[1]}e{found[2] or 0}")
    if not math.isfinite(value):
        raise InputError(f"is too large a number; got {text!r}")
    return value


def whole(text: str, default: int | None = None) -> int:
    """Return a whole number.

    Raises
    ------
    InputError
        No such number, or none where there is no default.
    """
    if not text and default is not None:
        return default
    if not re.fullmatch(r"[+-]?\d{1,9}", text):
        raise InputError(f"must be a whole number; got {text!r}")
    return int(text)


def case_control(path: Path) -> dict[str, int]:
    """Return the numbers of sets that case control asks for, such as ``SPC = 3``."""
    found: dict[str, int] = {}
    for line in _opened(path):
        if re.match(r"\s*BEGIN\s+BULK", line, re.IGNORECASE):
            return found
        plain = line.partition("$")[0]
        if asked := re.match(r"\s*(SPC|MPC)\s*=\s*(\S*)", plain, re.IGNORECASE):
            name, number = asked[1].upper(), asked[2]
            if not number.isdigit():
                raise InputError(f"{path.name}: case control asks for {name} = {number!r}")
            if found.get(name, int(number)) != int(number):
                raise InputError(
                    f"{path.name}: subcases ask for {name} {found[name]} and {number}: leave one"
                )
            found[name] = int(number)
    return found


def cards_of(path: Path, files: dict[Path, None] | None = None) -> Iterator[Card]:
    """Give the cards of bulk data, those of included files where they are included.

    Parameters
    ----------
    path : Path
        The file that includes the others.
    files : dict, optional
        Takes every file that is read.

    Yields
    ------
    Card
        One after the other, continuation lines joined.

    Raises
    ------
    InputError
        A file that cannot be read, or files that include each other.
    """
    open_card: list[tuple[list[str], str]] = []
    for place, line in _lines(path, path.parent.resolve(), {} if files is None else files, []):
        try:
            fields, continues = _fields(line)
        except InputError as error:
            raise InputError(f"{place}: {error}") from None
        if continues:
            if not open_card:
                raise InputError(f"{place}: a line that continues no card: {line.strip()[:40]!r}")
            open_card[-1][0].extend(fields)
            continue
        if open_card:
            yield _card(*open_card.pop())
        open_card.append((fields, place))
    if open_card:
        yield _card(*open_card.pop())


def _card(fields: list[str], place: str) -> Card:
    name = fields[0].upper().rstrip("*")
    return Card(name=name, fields=tuple(fields[1:]), place=place)


def _opened(path: Path) -> Iterator[str]:
    """Give the lines of a file, one after the other: a model may be larger than memory."""
    try:
        with path.open(encoding="utf-8", errors="replace") as opened:
            yield from opened
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror})") from None


def _lines(
    path: Path, folder: Path, files: dict[Path, None], begun: list[Path], depth: int = 0
) -> Iterator[tuple[str, str]]:
    """Give lines of bulk data with their place, without comments."""
    if depth > _DEEPEST:
        raise InputError(f"{path}: files include each other, or {_DEEPEST} deep")
    files[path] = None
    begun.append(path)
    if len(begun) > _FILES:
        raise InputError(f"{path}: more than {_FILES} files are included")
    begins = re.compile(r"\s*BEGIN\s+BULK", re.IGNORECASE)
    start = next((i for i, line in enumerate(_opened(path), 1) if begins.match(line)), 0)
    for number, line in enumerate(_opened(path), 1):
        plain = line.partition("$")[0].rstrip()
        if number <= start or not plain.strip():
            continue
        if re.match(r"\s*ENDDATA", plain, re.IGNORECASE):
            return
        if named := re.match(r"\s*INCLUDE\s+['\"]?([^'\"]+)['\"]?\s*$", plain, re.IGNORECASE):
            inner = (path.parent / named[1].strip()).resolve()
            if not inner.is_relative_to(folder):
                raise InputError(
                    f"{path.name}, line {number}: {named[1]!r} is not beside the model"
                )
            if not inner.is_file():  # a card like any other, so that the rest is told too
                yield f"{path.name}, line {number}", f"INCLUDE,{named[1].strip()}"
                continue
            yield from _lines(inner, folder, files, begun, depth + 1)
            continue
        yield f"{path.name}, line {number}", plain


def _fields(line: str) -> tuple[list[str], bool]:
    """Return the fields of a line, and whether it continues the card before it.

    A line of the first form has 10 fields, of which the last only names the next line; a line that
    continues another gives none for its first.
    """
    text = line.expandtabs(8)
    between_commas = "," in text
    first = (text.partition(",")[0] if between_commas else text[:8]).strip()
    large = first.endswith("*") or first.startswith("*")
    n, size = (4, 16) if large else (8, 8)
    if between_commas:
        values = _between_commas(text, n)
    else:
        values = [text[8 + i * size : 8 + (i + 1) * size].strip() for i in range(n)]
    continues = not first or first[0] in "+*"
    return (values if continues else [first, *values]), continues


def _between_commas(text: str, n: int) -> list[str]:
    """Return the n values of a line of commas; behind them only the next line may be named.

    Raises
    ------
    InputError
        More values: they would stand in no field, and be lost.
    """
    cells = [cell.strip() for cell in text.split(",")][1:]
    beyond = [cell for cell in cells[n:] if cell]
    if len(beyond) > 1 or any(cell[0] not in "+*" for cell in beyond):
        raise InputError(
            f"a line holds {n} fields behind the first, and then a mark of the next line such as +;"
            f" got {beyond[0][:40]!r} behind them: put it into a line of its own"
        )
    return (cells + [""] * n)[:n]

"""Read tables with a heading, as spreadsheets and other programs write them.

pandas parses them; this is the only module that knows it.
"""

# pyright: reportUnknownMemberType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false
from __future__ import annotations

import re
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from itertools import zip_longest
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float, Int

from trundle._typing import Array
from trundle.errors import InputError
from trundle.imports.unit_system import says_no_unit, says_unit

__all__ = ["NumberTable", "read_table"]

_LARGEST = 1_000_000_000  # bytes
_UNIT = re.compile(r"\s*[\[(][^\[\]()]*[\])]\s*$")  # of a heading: "f [Hz]"
_RAGGED = re.compile(r"Expected (\d+) fields in line (\d+), saw (\d+)")


@dataclass(frozen=True, kw_only=True, eq=False)
class NumberTable:
    """Hold a table.

    Attributes
    ----------
    name : str
        Of its file, for messages.
    frame : pandas.DataFrame
        All cells as text, columns by heading: small letters, without units.
    lines : ndarray of int, shape (n_rows,)
        Line of each row in the file.
    units : mapping of str to str
        Units by heading, small letters, where the heading or a line below it says them.
    asked : set of str
        Columns that were asked for.
    """

    name: str
    frame: Any
    lines: Int[Array, " rows"]
    units: Mapping[str, str] = field(default_factory=dict[str, str])
    asked: set[str] = field(default_factory=set[str])

    def __len__(self) -> int:
        """Return how many rows there are."""
        return len(self.lines)

    @property
    def headings(self) -> tuple[str, ...]:
        """What its columns are called."""
        return tuple(map(str, self.frame.columns))

    @property
    def unused(self) -> tuple[str, ...]:
        """What nobody asked for, in words; nothing, if all columns were."""
        odd = [one for one in self.headings if one not in self.asked]
        return (f"not used of {self.name}: {', '.join(odd)}",) if odd else ()

    def unit_of(self, words: Sequence[str]) -> str:
        """Return the unit of a column, empty where nothing says it."""
        return next((self.units[one] for one in words if one in self.units), "")

    def find(self, words: Sequence[str]) -> Float[Array, " rows"] | None:
        """Return the column that is called by one of some words; None if none is.

        Empty cells are NaN.

        Raises
        ------
        InputError
            A cell that is no number, or none that is finite.
        """
        word = next((one for one in words if one in self.headings), None)
        if word is None:
            return None
        import pandas as pd  # noqa: PLC0415 - a quarter of a second, for tables alone

        self.asked.add(word)
        cells = self.frame[word]
        numbers = np.asarray(pd.to_numeric(cells, errors="coerce"), dtype=float)
        wrong = np.flatnonzero(~np.isfinite(numbers) & cells.notna().to_numpy())
        if wrong.size:
            shown = str(cells.iloc[wrong[0]])[:40]
            raise InputError(
                f"{self.name}, line {self.lines[wrong[0]]}: {word} must be a number; got {shown!r}"
            )
        return numbers

    def need(self, words: Sequence[str]) -> Float[Array, " rows"]:
        """Return a column that must be there, and whole.

        Raises
        ------
        InputError
            It is missing, or a cell of it is empty.
        """
        found = self.find(words)
        if found is None:
            raise InputError(
                f"{self.name}: no column {words[0]!r}; there are: {', '.join(self.headings)}"
            )
        empty = np.flatnonzero(np.isnan(found))
        if empty.size:
            raise InputError(f"{self.name}, line {self.lines[empty[0]]}: {words[0]} is empty")
        return found

    def labels(self, words: Sequence[str]) -> Array:
        """Return a column of names or numbers as text, that must be there and whole."""
        word = next((one for one in words if one in self.headings), None)
        if word is None:
            raise InputError(
                f"{self.name}: no column {words[0]!r}; there are: {', '.join(self.headings)}"
            )
        self.asked.add(word)
        cells = self.frame[word]
        empty = np.flatnonzero(cells.isna().to_numpy())
        if empty.size:
            raise InputError(f"{self.name}, line {self.lines[empty[0]]}: {words[0]} is empty")
        return np.array(cells.tolist(), dtype=str)

    def texts(self, words: Sequence[str]) -> Array | None:
        """Return a column as text, empty cells empty; None if there is none."""
        word = next((one for one in words if one in self.headings), None)
        self.asked.add(word or "")
        return None if word is None else np.array(self.frame[word].fillna("").tolist(), dtype=str)

    def whole(self, words: Sequence[str]) -> Int[Array, " rows"]:
        """Return a column of whole numbers that must be there."""
        found = self.need(words)
        wrong = np.flatnonzero(found != np.round(found))
        if wrong.size:
            raise InputError(
                f"{self.name}, line {self.lines[wrong[0]]}: {words[0]} must be a whole number; got "
                f"{found[wrong[0]]:g}"
            )
        return found.astype(np.int64)


def read_table(path: Path) -> NumberTable:
    """Read a table: commas, semicolons, tabs or blanks between columns, a heading above them.

    Parameters
    ----------
    path : Path
        A text file; lines before the heading that are a title, and lines that begin with # are
        passed over. A line below the heading is one of units where all its words are units, or
        say that there is none.

    Raises
    ------
    InputError
        No such file, no heading, rows of another length.
    """
    text = _text(path)
    lines = text.splitlines()
    at = _heading_in(lines)
    if at is None:
        raise InputError(f"{path.name}: holds no table: a heading, and numbers below it")
    heading = lines[at]
    mark = _mark_of(heading)
    below = [(i, line) for i, line in enumerate(lines[at + 1 :], at + 2) if _counts(line)]
    comma = mark == ";" and "." not in "".join(line for _, line in below[:50])
    frame = _frame(path.name, heading, below, mark, comma=comma)
    names = [_plain(str(one)) for one in frame.columns]
    if len({_plain(one) for one in re.split(mark, heading.replace('"', ""))}) < len(names):
        raise InputError(f"{path.name}, line {at + 1}: two columns have one heading")
    frame.columns = names
    numbers = np.array([i for i, _ in below], dtype=np.int64)[: len(frame)]
    given = re.split(mark, heading.replace('"', ""))
    units = {_plain(one): m[0].strip(" []()").lower() for one in given if (m := _UNIT.search(one))}
    if len(frame) and _says_units(frame):
        said = zip(names, frame.iloc[0].tolist(), strict=True)
        units |= {k: v.strip("[]()").lower() for k, v in said if isinstance(v, str) and v}
        frame, numbers = frame.iloc[1:], numbers[1:]
    if not len(frame):
        raise InputError(f"{path.name}: has a heading, and no rows")
    return NumberTable(name=path.name, frame=frame, lines=numbers, units=units)


def _frame(
    name: str, heading: str, below: Sequence[tuple[int, str]], mark: str, *, comma: bool
) -> Any:  # noqa: ANN401 - pandas's
    """Return the cells of rows, which come with their numbers in the file."""
    import io  # noqa: PLC0415 - with pandas

    import pandas as pd  # noqa: PLC0415 - a quarter of a second, for tables alone

    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            frame = pd.read_csv(
                io.StringIO("\n".join([heading, *(row for _, row in below)])), sep=mark, dtype=str,
                skipinitialspace=True, index_col=False, keep_default_na=False, na_values=[""],
                quotechar='"',
            )  # fmt: skip
    except pd.errors.ParserWarning:
        raise InputError(f"{name}: a row has more columns than the heading") from None
    except pd.errors.ParserError as error:
        found = _RAGGED.search(str(error))
        # the heading is the first line that pandas sees
        where = f", line {below[int(found[2]) - 2][0]}" if found else ""
        what = f"has {found[3]} columns, and the heading {found[1]}" if found else "is no table"
        raise InputError(f"{name}{where}: {what}") from None
    except (pd.errors.EmptyDataError, ValueError):
        raise InputError(f"{name}: is no table") from None
    for column in frame.columns:
        cells = frame[column].str.strip()
        frame[column] = cells.str.replace(",", ".", regex=False) if comma else cells
    return frame


def _counts(line: str) -> bool:
    return bool(line.strip(" ,;\t")) and not line.lstrip().startswith(("#", "!", "$"))


def _mark_of(line: str) -> str:
    """Return what stands between the columns of a line."""
    return next((one for one in ("\t", ";", ",") if one in line), r"\s+")


def _heading_in(lines: Sequence[str]) -> int | None:
    """Return where the heading stands; None if there is none."""
    counted = [i for i, line in enumerate(lines) if _counts(line)]
    for i, after in zip_longest(counted, counted[1:]):
        if _may_head(lines[i]) and (after is None or not _is_title(lines[i], lines[after])):
            return i
    return None


def _is_title(line: str, below: str) -> bool:
    """Return whether a line is of other columns than the one below it, which names some.

    A row may be shorter than its heading, as that of a triangle among quadrilaterals is.
    """
    mark = _mark_of(below)
    if not _may_head(below) or mark != _mark_of(line):
        return _may_head(below)
    columns, cells = (re.split(mark, one.strip()) for one in (line, below))
    return len(columns) < len(cells) and not any(map(_is_number, cells))


def _may_head(line: str) -> bool:
    """Return whether a line may name two columns or more."""
    words = [one for one in re.split(r"[\t;,]|\s+", line.strip()) if one]
    named = len(words) > 1 and not line.upper().startswith("TABLE:") and _counts(line)
    return named and not any(_is_number(one) for one in words[:1])


def _says_units(frame: Any) -> bool:  # noqa: ANN401 - pandas's
    """Return whether the first row is of units: all its words are, and numbers stand below.

    Nodes may be called m and N: what stands below a unit is a number, or the row is one of names.
    """
    first = ["" if isinstance(cell, float) else str(cell) for cell in frame.iloc[0]]
    if not all(says_unit(cell) or says_no_unit(cell) for cell in first):
        return False
    measured = [i for i, cell in enumerate(first) if not says_no_unit(cell)]
    below = frame.iloc[1:2, measured].to_numpy().ravel().tolist()
    return all(isinstance(cell, float) or _is_number(cell) for cell in below)


def _text(path: Path) -> str:
    try:
        if not path.is_file():
            raise InputError(f"{path}: no such file")
        if path.stat().st_size > _LARGEST:
            raise InputError(f"{path}: a table may have {_LARGEST / 1e9:g} GB")
        text = path.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError as error:
        raise InputError(f"{path.name}: byte {error.start} is not UTF-8 text") from None
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror})") from None
    if "\0" in text:
        raise InputError(f"{path.name}: is binary; give a table as text")
    return text


def _plain(cell: str) -> str:
    return _UNIT.sub("", cell).strip().lower().replace(" ", "_")


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True

"""Read measured samples from text: any delimiter, decimal mark, encoding and order of headings."""

from __future__ import annotations

import csv
import re
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Float

from trundle._typing import Array
from trundle.errors import InputError
from trundle.units import to_si

__all__ = ["RawRecord", "even_rate", "read_csv"]

_HEADING = re.compile(r"^\s*(?P<name>.*?)\s*(\[(?P<square>[^\[\]]+)\]|\((?P<round>[^()]+)\))\s*$")
_WORDS = re.compile(r"[^\s\[\(]+\s*[\[\(][^\]\)]*[\]\)]|\S+")  # name [unit], or a word
_TIME = re.compile(r"^\s*(t|t_\w+|time\w*|elapsed\w*|zeit|temps)\b", re.IGNORECASE)
_TIME_UNIT = re.compile(r"[\s_](?P<unit>s|sec|ms|us|µs|min|h)$", re.IGNORECASE)


@dataclass(frozen=True, kw_only=True, eq=False)
class RawRecord:
    """Hold samples as a file has them.

    Attributes
    ----------
    samples : ndarray of float, shape (n_channels, n_steps)
        In the units of the channels.
    rate : float or None
        Samples per second, where the file says it [Hz].
    names, units : tuple of str
        Of the channels; a unit that the file does not say is empty.
    whole : bool
        Whether they are shares of a full scale, as the whole numbers of a WAV file are.
    """

    samples: Float[Array, "channels steps"]
    rate: float | None
    names: tuple[str, ...]
    units: tuple[str, ...]
    whole: bool = False


@dataclass(frozen=True, kw_only=True, eq=False)
class _Table:
    """Lines of a table with their numbers in the file."""

    path: Path
    lines: list[str]
    numbers: list[int]
    delimiter: str
    width: int

    @property
    def comma(self) -> bool:
        """Whether commas stand for decimal points."""
        quoted = self.delimiter != "," or '"' in self.lines[0]
        return quoted and any("," in line for line in self.lines)


def read_csv(path: Path) -> RawRecord:
    """Read columns of samples under headings such as ``time [s], z [mm/s2]``.

    Columns stand between commas, semicolons, tabs or spaces; lines that begin with # are passed
    over; numbers may have decimal commas.

    Parameters
    ----------
    path : Path
        A text file in UTF-8, UTF-16 or Windows-1252.

    Raises
    ------
    InputError
        No text, no table, uneven time.
    """
    numbered = [
        (number, line)
        for number, line in enumerate(_text(path).splitlines(), start=1)
        if line.strip() and not line.startswith("#")
    ]
    if len(numbered) < 2:
        raise InputError(f"{path}: holds no samples")
    delimiter = next((mark for mark in (";", "\t", ",") if mark in numbered[0][1]), " ")
    if delimiter != " ":
        numbered = _without_last_marks(numbered, delimiter)
    first = _cells(numbered[0][1], delimiter, path)
    heading = not all(map(_is_number, first))
    body = numbered[1:] if heading else numbered
    table = _numbers(
        _Table(
            path=path,
            lines=[line for _, line in body],
            numbers=[number for number, _ in body],
            delimiter=delimiter,
            width=len(first),
        )
    )
    names, units = zip(*(_heading(h, i, heading=heading) for i, h in enumerate(first)), strict=True)
    if len(table) < 2:
        raise InputError(f"{path}: holds one sample")
    if heading and _TIME.match(first[0]) and len(first) > 1:
        unit = units[0] or _time_unit(names[0])
        scale = to_si(f"1 {unit}", "time") if unit else 1.0
        rate = even_rate(scale * table[:, 0], path)
        return RawRecord(samples=table[:, 1:].T.copy(), rate=rate, names=names[1:], units=units[1:])
    rising = np.diff(table[:, 0])
    if len(first) > 1 and np.all(rising > 0.0) and np.ptp(rising) < 0.1 * rising.mean():
        raise InputError(
            f"{path}: its first column, {names[0]!r}, rises evenly as time does; give it the "
            "heading 'time [s]', or leave it out"
        )
    return RawRecord(samples=table.T.copy(), rate=None, names=names, units=units)


def even_rate(time: Float[Array, " steps"], path: Path) -> float:
    """Return the sampling rate of time stamps, which must be even [Hz].

    Parameters
    ----------
    time : ndarray of float, shape (n_steps,)
        Time stamps [s].
    path : Path
        The file, for messages.
    """
    if not np.isfinite(time).all():
        at = int(np.argmin(np.isfinite(time)))
        raise InputError(f"{path}: time stamp {at + 1} is not a number")
    steps = np.diff(time)
    if np.any(steps < 0.0) or time[-1] <= time[0]:
        raise InputError(f"{path}: time does not rise; sort the record")
    step = float((time[-1] - time[0]) / (len(time) - 1))
    # Stamps are written with so many decimals: they stray by half of the last, and no more.
    exact = 4.0 * np.finfo(float).eps * max(1.0, float(np.abs(time).max()))
    decimals = next((k for k in range(10) if np.abs(time - np.round(time, k)).max() <= exact), 10)
    if np.abs(time - (time[0] + step * np.arange(len(time)))).max() > 10.0**-decimals + 0.01 * step:
        usual = float(np.median(steps))
        at = int(np.argmax(steps))
        if steps[at] > 1.5 * usual + 2.0 * 10.0**-decimals:
            raise InputError(
                f"{path}: gaps in time; the widest after {time[at]:.6g} s ({steps[at]:.4g} s "
                f"instead of {usual:.4g} s); cut the record there"
            )
        raise InputError(f"{path}: time steps vary from {steps.min():.4g} to {steps.max():.4g} s")
    return 1.0 / step


def _text(path: Path) -> str:
    """Return a file's text; spreadsheets and loggers write one of three encodings."""
    data = path.read_bytes()
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        encodings = ("utf-16",)
    elif b"\0" in data:
        encodings = ()
    else:
        encodings = ("utf-8-sig", "cp1252")
    for encoding in encodings:
        with suppress(UnicodeDecodeError):
            return data.decode(encoding)
    raise InputError(f"{path}: is not text; records are CSV, WAV, UFF 58 or miniSEED files")


def _without_last_marks(numbered: list[tuple[int, str]], delimiter: str) -> list[tuple[int, str]]:
    """Take off the delimiter that some loggers put behind the last column of every line."""
    mark = numbered[0][1].rstrip(" ").endswith(delimiter)
    if not all(line.rstrip(" ").endswith(delimiter) for _, line in numbered[1 - mark :]):
        return numbered
    return [(number, line.rstrip(" ").removesuffix(delimiter)) for number, line in numbered]


def _cells(line: str, delimiter: str, path: Path) -> list[str]:
    if delimiter == " ":
        return _WORDS.findall(line)
    try:
        return next(csv.reader([line], delimiter=delimiter, skipinitialspace=True))
    except csv.Error as error:
        raise InputError(f"{path}: cannot be read as a table ({error})") from None


def _numbers(table: _Table) -> Float[Array, "rows columns"]:
    """Return the numbers, quickly if all cells are; else find which are not."""
    lines, delimiter = table.lines, table.delimiter
    if table.comma and delimiter != ",":
        lines = [line.replace(",", ".") for line in lines]
    with suppress(ValueError):
        quick = np.loadtxt(
            lines, delimiter=None if delimiter == " " else delimiter, ndmin=2, comments=None
        )
        if quick.shape[1] == table.width:
            return quick
    return _cell_by_cell(table)


def _cell_by_cell(table: _Table) -> Float[Array, "rows columns"]:
    """Return the table; empty cells and words become not-a-number, which a record refuses."""
    out = np.full((len(table.lines), table.width), np.nan)
    try:
        rows = list(csv.reader(table.lines, delimiter=table.delimiter, skipinitialspace=True))
    except csv.Error as error:
        raise InputError(f"{table.path}: cannot be read as a table ({error})") from None
    if len(rows) != len(table.lines):
        raise InputError(f"{table.path}: a quoted cell holds a line break; export it without")
    for i, row in enumerate(rows):
        cells = [cell for cell in row if cell or table.delimiter != " "]
        if len(cells) != table.width:
            raise InputError(
                f"{table.path}: line {table.numbers[i]} has {len(cells)} columns, the first has "
                f"{table.width}"
            )
        for j, cell in enumerate(cells):
            with suppress(ValueError):
                out[i, j] = float(cell.replace(",", ".") if table.comma else cell)
    return out


def _is_number(text: str) -> bool:
    try:
        float(text.replace(",", "."))
    except ValueError:
        return False
    return True


def _time_unit(name: str) -> str:
    """Return the unit behind a heading such as ``time_ms`` or ``Time ms``, or nothing."""
    match = _TIME_UNIT.search(name)
    return match["unit"].replace("sec", "s") if match else ""


def _heading(text: str, column: int, *, heading: bool) -> tuple[str, str]:
    if not heading:
        return f"channel {column + 1}", ""
    match = _HEADING.match(text)
    if match is None:
        return text.strip() or f"channel {column + 1}", ""
    unit = match["square"] or match["round"]
    return match["name"].strip() or f"channel {column + 1}", unit.strip()

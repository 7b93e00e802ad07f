"""Read measured samples from text: any delimiter, decimal mark, encoding and order of headings."""

from __future__ import annotations

import csv
import re
from contextlib import suppress
from pathlib import Path

import numpy as np
from jaxtyping import Float

from trundle._typing import Array
from trundle.errors import InputError
from trundle.records.cells import as_array, cells_of, is_number
from trundle.records.headings import Heading, facts_of, read_heading, tells_unit
from trundle.records.lines import Layout, find_table, text_of
from trundle.records.names_above import DECIMAL, TWO_OR_ONE
from trundle.records.raw import Facts, RawRecord
from trundle.records.stamps import clock_begin, clock_seconds, even_rate, is_stamp, on_even_time
from trundle.units import to_si

__all__ = ["read_table"]

_TIME = re.compile(
    r"^\s*(t|t_\w+|[a-z]*time\w*|x[_ ]?value|elapsed\w*|zeit\w*|uhrzeit|temps)\b", re.IGNORECASE
)
_CLOCK = re.compile(r"^\s*(date|datum|day|timestamp|time stamp|clock|utc)\b", re.IGNORECASE)
_COUNTER = re.compile(
    r"^\s*(count\w*|index|idx|n|no\.?|nr\.?|#|sample\w*|row|point|packet\w*)\s*$", re.IGNORECASE
)
_TIME_UNIT = re.compile(r"[\s_](?P<unit>s|sec|ms|us|µs|ns|min|h)$", re.IGNORECASE)
_SLOWEST = 2.5  # Hz: stamps without a unit that say less are not seconds
_SCALES = (("s", 1.0), ("ms", 1e-3), ("us", 1e-6), ("ns", 1e-9))
_CONTRADICTS = 0.05  # relative: a stated rate may be nominal, and no more than so far off
_SAME = 0.005  # relative, between a stated rate and that of stamps
_TWICE = "may have a decimal mark, or one between thousands"


def read_table(data: bytes, path: Path, *, rate: float | None = None) -> RawRecord:
    """Read columns of samples under headings such as ``time [s], z [mm/s2]``.

    Columns stand between commas, semicolons, tabs or blanks; numbers may have decimal commas. The
    table is found by itself: lines above it are read for a rate and units, words behind it are
    passed over.

    Parameters
    ----------
    data : bytes
        A text in UTF-8, UTF-16 or Windows-1252.
    path : Path
        The file, for messages.
    rate : float, optional
        Samples per second, where the user says so [Hz].

    Raises
    ------
    InputError
        No text, no table, uneven time.
    """
    layout = find_table(text_of(data, path), path)
    _refuse_two_or_one(layout, path)
    facts = facts_of(list(layout.above))
    cells, table = _numbers(layout, path)
    if len(table) < 2:
        raise InputError(f"{path}: holds one sample")
    if facts.n_samples is not None and facts.n_samples > len(table):
        raise InputError(
            f"{path}: says {facts.n_samples} samples above its table and holds {len(table)}: it is "
            "cut short; copy it again"
        )
    headings = _headings(layout, facts)
    notes = [
        f"line {number} behind the table is passed over: {line.strip()[:40]!r}"
        for number, line in layout.left_out[:1]
    ]
    stamps, time = _time(layout, headings, cells, table, (rate or facts.rate, path))
    counter = [] if stamps else _counter(headings, table, bool(layout.heading), rate or facts.rate)
    if counter:
        notes.append(f"column {headings[0].name!r} counts the samples, and is passed over")
    others = [i for i in range(table.shape[1]) if i not in {*stamps, *counter}]
    if not others:
        raise InputError(f"{path}: holds time and no channel")
    if not stamps and not counter:
        _refuse_unnamed_time(table, headings, path)
        _refuse_empty(layout, path)
    if not stamps and rate is None and facts.rate is None and facts.unclear:
        raise InputError(f"{path}: {facts.unclear!r} above its table {_TWICE}; say it by --rate")
    samples, found = table[:, others].T.copy(), facts.rate
    if time is not None:
        found = even_rate(time, path, stated=rate or facts.rate)
        if found is None:
            found, samples, note = on_even_time(time, samples)
            notes.append(note)
        if facts.rate and abs(facts.rate / found - 1.0) > _CONTRADICTS:
            raise InputError(
                f"{path}: says {facts.rate:.5g} Hz above its table, and its time {found:.5g} Hz; "
                "one is wrong"
            )
    clock = [i for i in stamps if cells is not None and is_stamp(cells[0][i])]
    return RawRecord(
        begin=clock_begin([[r[i] for r in cells] for i in clock[:2]]) if cells and clock else None,
        samples=samples,
        rate=found,
        names=tuple(headings[i].name for i in others),
        units=tuple(headings[i].unit for i in others),
        ranges=tuple(headings[i].range for i in others),
        notes=tuple(notes),
    )


def _refuse_two_or_one(layout: Layout, path: Path) -> None:
    """Refuse rows such as 4,507 where nothing says whether that is one number or two."""
    if layout.width > 2 or (layout.width == 2 and (layout.heading or layout.mark != ",")):
        return
    if layout.width == 1 and any(map(tells_unit, layout.heading)):
        return
    commas = [line for line in layout.lines if "," in line]
    if not commas or not all(map(TWO_OR_ONE.fullmatch, commas)):
        return
    if layout.width == 1 and any(map(DECIMAL.fullmatch, commas)):
        return
    raise InputError(
        f"{path}: {commas[0].strip()!r} may be one number with a decimal comma, or two; write a "
        "heading with units, such as 'z [mm/s2]' or 'time [s],z [mm/s2]'"
    )


def _refuse_empty(layout: Layout, path: Path) -> None:
    """Refuse empty lines where no time shows whether samples are missing there."""
    if layout.empty:
        raise InputError(
            f"{path}: line {layout.empty[0]} is empty, among samples without a time; write nan "
            "there for each sample that is missing, or take it off"
        )


def _headings(layout: Layout, facts: Facts) -> list[Heading]:
    """Return names and units of all columns, from headings, a line of units, or above them."""
    found = []
    for i in range(layout.width):
        if layout.heading:
            one = read_heading(layout.heading[i], i)
        else:
            one = Heading(name=f"channel {i + 1}")
        unit = one.unit
        if layout.units and layout.units[i].strip():
            unit = unit or layout.units[i].strip().strip("()[]").strip()
        found.append(Heading(name=one.name, unit=unit, range=one.range))
    return _with_stated_units(found, facts)


def _with_stated_units(headings: list[Heading], facts: Facts) -> list[Heading]:
    """Give columns without a unit that which stands above the table."""
    bare = [i for i, h in enumerate(headings) if not h.unit and not _is_time(h.name)]
    if len(facts.units) == 1:
        units = dict.fromkeys(bare, facts.units[0])
    elif len(facts.units) == len(bare):
        units = dict(zip(bare, facts.units, strict=True))
    elif len(facts.units) == len(headings):
        units = {i: facts.units[i] for i in bare}
    else:
        return headings
    return [
        Heading(name=h.name, unit=units.get(i, h.unit), range=h.range)
        for i, h in enumerate(headings)
    ]


def _is_time(name: str) -> bool:
    return bool(_TIME.match(name) or _CLOCK.match(name) or _COUNTER.match(name))


def _time(
    layout: Layout,
    headings: list[Heading],
    cells: list[list[str]] | None,
    table: Array,
    known: tuple[float | None, Path],
) -> tuple[list[int], Float[Array, " steps"] | None]:
    """Return the columns of time, and time in seconds; none where there is none."""
    rate, path = known
    if cells is not None:
        stamped = [i for i in range(table.shape[1]) if is_stamp(cells[0][i])]
        if stamped:
            return stamped, clock_seconds([[r[i] for r in cells] for i in stamped[:2]], path)
    if table.shape[1] < 2:
        return [], None
    named = [i for i, h in enumerate(headings) if layout.heading and _tells_time(h)]
    if named:
        at = named[0]
        return named, _scale(headings[at], table[:, at], rate, path) * table[:, at]
    steps = np.diff(table[:, 0])
    step = float(np.median(steps))
    if rate and step > 0.0 and np.ptp(steps) < 0.1 * step and not _is_whole(table[:, 0]):
        for _, scale in _SCALES:
            if abs(step * scale * rate - 1.0) < _SAME:
                return [0], scale * table[:, 0]
    return [], None


def _tells_time(heading: Heading) -> bool:
    """Return whether a heading is of time: its name, and its unit if it says one."""
    if not _TIME.match(heading.name):
        return False
    try:
        return not heading.unit or to_si(f"1 {heading.unit}", "time") > 0.0
    except InputError:
        return False


def _is_whole(column: Array) -> bool:
    """Return whether a column counts 0, 1, 2."""
    return bool(np.all(np.diff(column) == 1.0))


def _scale(heading: Heading, column: Array, rate: float | None, path: Path) -> float:
    """Return a time column's unit in seconds; what is neither said nor plausible is asked for."""
    tail = _TIME_UNIT.search(heading.name)
    unit = heading.unit or (tail["unit"].lower() if tail else "")
    if unit:
        return to_si(f"1 {unit}", "time")
    step = float(np.median(np.diff(column)))
    if step <= 0.0 or not np.isfinite(step):
        return 1.0
    if rate:
        fits = [scale for _, scale in _SCALES if abs(step * scale * rate - 1.0) < _SAME]
        return fits[0] if fits else 1.0
    if step * _SLOWEST > 1.0:
        likely = next((u for u, s in _SCALES[1:] if 1.0 < 1.0 / (step * s) < 1e5), "ms")
        raise InputError(
            f"{path}: {heading.name!r} rises by {step:g} from sample to sample and says no unit; "
            f"in seconds that would be {1.0 / step:.3g} samples a second: write the unit in the "
            f"heading, as in 'time [{likely}]', or say --rate"
        )
    return 1.0


def _counter(headings: list[Heading], table: Array, named: bool, rate: float | None) -> list[int]:
    """Return the first column if it counts samples."""
    if table.shape[1] < 2 or not _is_whole(table[:, 0]):
        return []
    called = named and _COUNTER.match(headings[0].name) is not None
    return [0] if called or (rate is not None and abs(rate - 1.0) > _SAME) else []


def _refuse_unnamed_time(table: Array, headings: list[Heading], path: Path) -> None:
    rising = np.diff(table[:, 0])
    if table.shape[1] > 1 and np.all(rising > 0.0) and np.ptp(rising) < 0.1 * rising.mean():
        counts = ", or 'count'" if _is_whole(table[:, 0]) else ""
        raise InputError(
            f"{path}: its first column, {headings[0].name!r}, rises evenly as time does; give it "
            f"the heading 'time [s]'{counts}, or leave it out"
        )


def _numbers(
    layout: Layout, path: Path
) -> tuple[list[list[str]] | None, Float[Array, "rows columns"]]:
    """Return the numbers, quickly if all cells are; else cells too, to find what they are."""
    lines = layout.lines
    comma = _decimal_comma(lines, layout.mark)
    if layout.mark not in {" ", ","} or not comma:
        if layout.mark != " ":
            lines = _without_last_marks(lines, layout.mark)
        quick = (line.replace(",", ".") for line in lines) if comma else lines
        with suppress(ValueError):
            mark = None if layout.mark == " " else layout.mark
            table = np.loadtxt(quick, delimiter=mark, ndmin=2, comments=None)
            if table.shape[1] == layout.width:
                return None, table
    cells = _cells(layout, path)
    return cells, as_array(cells, comma)


def _decimal_comma(lines: list[str], mark: str) -> bool:
    quoted = mark != "," or '"' in lines[0]
    return quoted and any("," in line for line in lines)


def _without_last_marks(lines: list[str], mark: str) -> list[str]:
    """Take off the delimiter that some loggers put behind the last column of every line."""
    if not all(line.rstrip(" ").endswith(mark) for line in lines):
        return lines
    return [line.rstrip(" ").removesuffix(mark) for line in lines]


def _cells(layout: Layout, path: Path) -> list[list[str]]:
    """Return all cells; a line of another width is named."""
    mark, width = layout.mark, layout.width
    lines = layout.lines
    if mark == " ":
        rows = [cells_of(line, mark) for line in lines]
    else:
        try:
            rows = list(csv.reader(lines, delimiter=mark, skipinitialspace=True))
        except csv.Error as error:
            raise InputError(f"{path}: cannot be read as a table ({error})") from None
        if len(rows) != len(lines):
            raise InputError(f"{path}: a quoted cell holds a line break; export it without")
    for i, row in enumerate(rows):
        if len(row) == width + 1 and not row[-1].strip():
            row.pop()
        if len(row) != width:
            _refuse_line(layout, i, len(row), path)
    return rows


def _refuse_line(layout: Layout, row: int, width: int, path: Path) -> None:
    number, line = layout.numbers[row], layout.lines[row]
    last = row == len(layout.lines) - 1
    if last and width < layout.width:
        raise InputError(
            f"{path}: line {number}, its last, has {width} of {layout.width} columns: the file is "
            "cut short; copy it again, or take that line off"
        )
    words = "" if any(map(is_number, cells_of(line, layout.mark))) else f" ({line.strip()[:40]!r})"
    raise InputError(
        f"{path}: line {number} has {width} columns{words}, the table has {layout.width}; take it "
        "off, or put # before it"
    )

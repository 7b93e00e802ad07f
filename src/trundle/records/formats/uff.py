"""Read universal files: time records of dataset 58, units of dataset 164."""

from __future__ import annotations

import re
import tempfile
import warnings
from pathlib import Path
from typing import Any

import numpy as np

from trundle.errors import InputError
from trundle.records.raw import RawRecord
from trundle.records.record_format import RecordFormat
from trundle.records.stamps import even_rate, on_even_time
from trundle.units import to_si

__all__ = ["FORMAT", "read_uff"]

_ORDINATE = {11: "m/s", 12: "m/s2"}  # codes of what the samples are, of dataset 58
_DIRECTIONS = {1: "x", 2: "y", 3: "z"}
_AXES = {1: "horizontal", 2: "horizontal", 3: "vertical"}


def read_uff(data: bytes, path: Path) -> RawRecord:
    """Read the time records of a universal file.

    Parameters
    ----------
    data : bytes
        The file.
    path : Path
        Its name, for messages.

    Raises
    ------
    InputError
        A damaged or cut file, no time record, channels of several rates or lengths.
    """
    data = _tidy(data)
    fences = sum(line.strip() == b"-1" for line in data.splitlines())
    if fences % 2:
        raise InputError(f"{path}: is cut short: its last dataset does not end; copy it again")
    sets = _sets(data, path)
    length = next((_length_factor(one, path) for one in sets if one.get("type") == 164), 1.0)
    found = [one for one in sets if one.get("type") == 58]
    found = [one for one in found if one.get("func_type") == 1 and not np.iscomplexobj(one["data"])]
    if not found:
        raise InputError(f"{path}: holds no time record (dataset 58, function type 1)")
    for i, one in enumerate(found):
        if int(one.get("num_pts") or 0) != len(one["data"]):
            raise InputError(
                f"{path}: {_name(one, i)!r} says {one.get('num_pts')} samples and holds "
                f"{len(one['data'])}; export it again"
            )
    return _joined(found, length, path)


def _joined(found: list[dict[str, Any]], length: float, path: Path) -> RawRecord:
    if len({len(one["data"]) for one in found}) > 1:
        raise InputError(f"{path}: its channels differ in length; assess them apart")
    samples = np.array([one["data"] for one in found], dtype=float)
    times = [_time_scale(one, path) * np.asarray(one["x"], float) for one in found]
    rates = [even_rate(time, path) for time in times]
    notes: tuple[str, ...] = ()
    if all(rate is None for rate in rates) and all(np.allclose(t, times[0]) for t in times):
        rate, samples, note = on_even_time(times[0], samples)
        rates, notes = [rate], (note,)
    if None in rates or len({round(float(rate or 0.0), 6) for rate in rates}) > 1:
        raise InputError(f"{path}: its channels differ in rate; assess them apart")
    return RawRecord(
        samples=samples,
        rate=rates[0],
        names=tuple(_name(one, i) for i, one in enumerate(found)),
        units=tuple(_unit(one, length) for one in found),
        axes=tuple(_AXES.get(abs(_whole(one, "rsp_dir")), "") for one in found),
        notes=notes,
    )


def _tidy(data: bytes) -> bytes:
    """Take the blanks off the ends of lines that some programs pad to 80 columns; only of text."""
    if b"58b" in data[:2_000_000]:
        return data
    return b"\n".join(line.rstrip() for line in data.splitlines()) + b"\n"


def _sets(data: bytes, path: Path) -> list[dict[str, Any]]:
    try:
        import pyuff  # noqa: PLC0415 - an extra
    except ImportError:
        raise InputError(f"{path}: UFF files need pyuff: pip install 'trundle[records]'") from None
    with tempfile.TemporaryDirectory(prefix="trundle-") as folder:
        copy = Path(folder) / "record.uff"
        copy.write_bytes(data)
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                file = pyuff.UFF(str(copy))
                kinds = [int(kind) for kind in file.get_set_types()]
                wanted = [i for i, kind in enumerate(kinds) if kind in {58, 164}]
                sets = [file.read_sets(i) for i in wanted]
        except Exception as error:  # its reader raises whatever its parsing meets
            told = str(error).replace(str(copy), path.name) or type(error).__name__
            raise InputError(f"{path}: is a damaged UFF file ({told[:120]})") from None
    return [one for one in sets if isinstance(one, dict)]


def _length_factor(one: dict[str, Any], path: Path) -> float:
    """Return how many of the file's lengths are a metre (dataset 164 divides by it)."""
    factor = float(one.get("length") or 0.0)
    if not (np.isfinite(factor) and factor > 0.0):
        raise InputError(f"{path}: its units (dataset 164) have a length factor of {factor:g}")
    return factor


def _time_scale(one: dict[str, Any], path: Path) -> float:
    label = str(one.get("abscissa_axis_units_lab") or "").strip()
    if not label or label.upper() == "NONE":
        return 1.0
    try:
        return to_si(f"1 {label}", "time")
    except InputError as error:
        raise InputError(f"{path}: its abscissa is no time: {error}") from None


def _whole(one: dict[str, Any], key: str) -> int:
    try:
        return int(one.get(key) or 0)
    except (TypeError, ValueError):
        return 0


def _name(one: dict[str, Any], number: int) -> str:
    """Return a channel's title, or the response's name, node and direction."""
    title = str(one.get("id1") or "").strip()
    if title and title.upper() != "NONE":
        return title
    entity = str(one.get("rsp_ent_name") or "").strip()
    node, way = _whole(one, "rsp_node"), _whole(one, "rsp_dir")
    parts = [
        entity if entity.upper() != "NONE" else "",
        str(node) if node else "",
        _DIRECTIONS.get(abs(way), ""),
    ]
    return " ".join(part for part in parts if part) or f"channel {number + 1}"


def _unit(one: dict[str, Any], length: float) -> str:
    label = str(one.get("ordinate_axis_units_lab") or "").strip()
    if label and label.upper() != "NONE":
        return label
    unit = _ORDINATE.get(_whole(one, "ordinate_spec_data_type"), "")
    return f"{1.0 / length:.12g} {unit}" if unit and length != 1.0 else unit


_BEGINS = re.compile(rb"^\s*-1[ \t]*\r?\n\s*\d{2,4}b?[ \t\r\n]")

FORMAT = RecordFormat(
    name="UFF",
    suffixes=(".uff", ".unv"),
    claims=lambda data: _BEGINS.match(data[:400]) is not None,
    read=lambda data, path, _wanted: read_uff(data, path),
)

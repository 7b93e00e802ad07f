"""Read miniSEED files."""

from __future__ import annotations

import io
import re
import warnings
from pathlib import Path
from typing import Any

import numpy as np

from trundle.errors import InputError
from trundle.records.raw import RawRecord
from trundle.records.record_format import RecordFormat

__all__ = ["FORMAT", "read_miniseed"]


def read_miniseed(data: bytes, path: Path, *, wanted: str = "") -> RawRecord:
    """Read a miniSEED file; channels of text are passed over by name.

    Parameters
    ----------
    data : bytes
        The file: read from memory and as miniSEED alone, so that no name is taken for a pattern,
        no archive is unpacked and no other reader is asked.
    path : Path
        Its name, for messages.
    wanted : str
        Names of channels, or ends of names, between commas; all if none is such a name.

    Raises
    ------
    InputError
        A damaged or cut file, gaps, channels of several rates or lengths.
    """
    traces = _traces(data, path)
    text = sorted({trace.id for trace in traces if trace.data.dtype.kind not in "iuf"})
    stream = [trace for trace in traces if trace.data.dtype.kind in "iuf"]
    asked = tuple(part.strip().casefold() for part in wanted.split(",") if part.strip())
    stream = [t for t in stream if t.id.casefold().endswith(asked)] or stream if asked else stream
    if not stream:
        raise InputError(f"{path}: {', '.join(text)} holds text, no samples")
    gaps = [trace.id for trace in stream if np.ma.isMaskedArray(trace.data)]
    if gaps:
        raise InputError(f"{path}: gaps in {', '.join(gaps)}; cut the record there")
    if len({(trace.stats.sampling_rate, len(trace.data)) for trace in stream}) > 1:
        raise InputError(
            f"{path}: its channels differ in rate or length ("
            + ", ".join(f"{t.id} {len(t.data)} at {t.stats.sampling_rate:g} Hz" for t in stream)
            + "); choose some of one length by --channel"
        )
    starts = [float(trace.stats.starttime) for trace in stream]
    rate = float(stream[0].stats.sampling_rate)
    if not rate > 0.0:
        raise InputError(f"{path}: says no sampling rate")
    if max(starts) - min(starts) > 0.5 / rate:
        raise InputError(f"{path}: its channels do not start together; assess them apart")
    return RawRecord(
        samples=np.array([trace.data for trace in stream], dtype=float),
        rate=rate,
        names=tuple(trace.id for trace in stream),
        units=("",) * len(stream),
        notes=tuple(f"{name} holds text, and is passed over" for name in text),
    )


def _traces(data: bytes, path: Path) -> list[Any]:
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # its imports use what Python is about to drop
            import obspy  # noqa: PLC0415 - an extra
    except ImportError:
        raise InputError(f"{path}: miniSEED needs obspy: pip install 'trundle[seismic]'") from None
    try:
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            stream = obspy.read(io.BytesIO(data), format="MSEED")
            known = {(t.stats.mseed.record_length, t.stats.mseed.number_of_records) for t in stream}
            numbers = [trace for trace in stream if trace.data.dtype.kind in "iuf"]
            joined = obspy.Stream(numbers).merge() if numbers else obspy.Stream()
    except Exception as error:  # its readers raise whatever their parsing meets
        raise InputError(f"{path}: is a damaged miniSEED file ({_first_line(error)})") from None
    faults = [str(one.message) for one in told if "InternalMSEED" in one.category.__name__]
    length = next(iter(known))[0] if len({size for size, _ in known}) == 1 else 0
    if length and len(data) % length:
        raise InputError(
            f"{path}: is cut short: {len(data) % length} bytes stand behind its last whole record "
            f"of {length}; copy it again"
        )
    if faults:
        raise InputError(f"{path}: is a damaged miniSEED file ({_first_line(faults[0])})")
    return [*joined, *(trace for trace in stream if trace.data.dtype.kind not in "iuf")]


def _first_line(error: object) -> str:
    lines = str(error).strip().splitlines()
    return lines[0][:120] if lines else type(error).__name__


_VERSION_2 = re.compile(rb"^[0-9 \x00]{6}[DRQM][ \x00]")

FORMAT = RecordFormat(
    name="miniSEED",
    suffixes=(".mseed", ".msd"),
    claims=lambda data: (
        (data[:2] == b"MS" and data[2:3] == b"\x03") or _VERSION_2.match(data[:8]) is not None
    ),
    read=lambda data, path, wanted: read_miniseed(data, path, wanted=wanted),
)

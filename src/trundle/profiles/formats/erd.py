"""Read ERD files, as road profilers write them and ProVAL and RoadRuf read them.

Format: M. W. Sayers, S. M. Karamihas, ERD file format for storage and analysis of road profiles,
University of Michigan Transportation Research Institute (1997), appendix to the RoadRuf manual. The
header is text; the second line tells how numbers are stored. Binary numbers stand in a file of
their own beside it, and are refused: their byte order is that of the machine that wrote them, and
nothing in the header tells it.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from trundle._typing import Array
from trundle.errors import InputError
from trundle.profiles.profile_format import ProfileFormat
from trundle.profiles.survey import Survey

__all__ = ["FORMAT", "read_erd"]

_WORD = 8  # columns of a keyword, and of each short name and unit
_LONG = 32  # columns of a long name
_TEXT = 5  # KEYNUM of numbers as text
_MOST_CHANNELS = 200
_MOST_POINTS = 20_000_000


def read_erd(data: bytes, path: Path) -> Survey:
    """Read an ERD file whose numbers are text.

    Parameters
    ----------
    data : bytes
        The file.
    path : Path
        Its name, for messages.

    Raises
    ------
    InputError
        A header that is not whole, binary numbers, fewer samples than it says, words among them.
    """
    lines = data.removeprefix(b"\xef\xbb\xbf").decode("latin-1").splitlines()
    n_channels, n_samples, step = _stored(lines, path)
    end = next((i for i, line in enumerate(lines) if line.strip().upper() == "END"), None)
    if end is None:
        raise InputError(f"{path}: has no line END behind its header: it is cut short")
    said = _keywords(lines[2:end])
    table, at = _numbers(lines, end + 1, n_channels, path)
    if n_samples > 0 and len(table) != n_samples:
        raise InputError(
            f"{path}: says {n_samples} samples of {n_channels} channels on line 2 and holds "
            f"{len(table)}: it is cut short, or not of this header; copy it again"
        )
    start = _number(said.get("XSTART", "0"), "XSTART", path)
    return Survey(
        station=start + step * np.arange(len(table)),
        elevation=table.T.copy(),
        names=_names(said, n_channels),
        station_unit=said.get("XUNITS", "").strip().lower(),
        units=tuple(word.lower() for word in _cut(said.get("UNITSNAM", ""), _WORD, n_channels)),
        lines=at,
    )


def _stored(lines: list[str], path: Path) -> tuple[int, int, float]:
    """Return the numbers of channels and of samples (0 or less where not said), and the step."""
    cells = [cell.strip() for cell in (lines[1] if len(lines) > 1 else "").split(",")]
    try:
        n_channels, n_samples = int(cells[0]), int(cells[1])
        kind, step = int(cells[4]), float(cells[5])
    except (ValueError, IndexError):
        raise InputError(
            f"{path}: line 2 must hold the numbers of channels, samples, records and bytes, the "
            f"kind of numbers and the step; got {', '.join(cells)[:60]!r}"
        ) from None
    if kind != _TEXT:
        raise InputError(
            f"{path}: its numbers are binary (kind {kind} on line 2), in a file of their own: "
            "export it as text (kind 5)"
        )
    if not 0 < n_channels <= _MOST_CHANNELS or n_samples > _MOST_POINTS:
        raise InputError(f"{path}: says {n_channels} channels of {n_samples} samples on line 2")
    if not 1e-9 < step < 1e6:
        raise InputError(
            f"{path}: its step on line 2 must be above 0, and no more than 1e6; got {step:g}"
        )
    return n_channels, n_samples, step


def _keywords(lines: list[str]) -> dict[str, str]:
    """Return what stands behind each keyword; ``&1000`` goes on with the line before it."""
    said: dict[str, str] = {}
    last = ""
    for line in lines:
        word, rest = line[:_WORD].strip().upper(), line[_WORD:]
        if word.startswith("&") and last:
            said[last] += rest
        elif word:
            last = word
            said[word] = rest
    return said


def _names(said: dict[str, str], count: int) -> tuple[str, ...]:
    for key, width in (("LONGNAME", _LONG), ("SHORTNAM", _WORD)):
        if said.get(key, "").strip():
            found = _cut(said[key], width, count)
            return tuple(name or f"channel {i + 1}" for i, name in enumerate(found))
    return tuple(f"channel {i + 1}" for i in range(count))


def _cut(text: str, width: int, count: int) -> list[str]:
    return [text[i * width : (i + 1) * width].strip() for i in range(count)]


def _numbers(lines: list[str], first: int, n_channels: int, path: Path) -> tuple[Array, Array]:
    """Return all rows behind the header, and on which line each stands."""
    rows: list[list[float]] = []
    at: list[int] = []
    for i, line in enumerate(lines[first:], first + 1):
        words = [word for word in re.split(r"[\s,]+", line) if word]
        if not words:
            continue
        if len(words) != n_channels:
            raise InputError(
                f"{path}: line {i} holds {len(words)} numbers, and line 2 says {n_channels} "
                "channels: it is damaged, or has decimal commas"
            )
        rows.append([_number(word, f"line {i}", path) for word in words])
        at.append(i)
    return np.array(rows).reshape(len(rows), n_channels), np.array(at, dtype=np.int64)


def _number(word: str, where: str, path: Path) -> float:
    try:
        value = float(word)
    except ValueError:
        value = np.nan
    if not np.isfinite(value):
        raise InputError(f"{path}: {where} must be a number; got {word.strip()[:40]!r}")
    return value


FORMAT = ProfileFormat(
    name="ERD",
    claims=lambda head: head.removeprefix(b"\xef\xbb\xbf").lstrip()[:8].upper() == b"ERDFILEV",
    read=read_erd,
)

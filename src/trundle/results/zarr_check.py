"""Look at a zarr store's metadata before a byte of it is decoded.

A store says by itself which codecs are to decode it, and some codecs run what they find: numcodecs'
pickle codec, for one. What this program writes needs few codecs and plain numbers and texts; what
names anything else is refused. A chunk that is missing is no error to readers of zarr, but numbers
that nobody computed: it is looked for too.
"""

from __future__ import annotations

import itertools
import json
import math
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from trundle.errors import InputError

__all__ = ["check_whole", "check_zarr"]

_CODECS = {"blosc"}  # the only one written, and what it unpacks to has a bound
_DTYPE = re.compile(r"^(?:[<>|][bifu](?:1|2|4|8)|[<>]U\d{1,4}|\|S\d{1,4})\Z")
_LARGEST = 2**33  # bytes of an array
_LARGEST_CHUNK = 2**31  # bytes, as blosc has it
_MOST = 50_000_000  # bytes of metadata in one file
_METADATA = {".zarray", ".zgroup", ".zattrs", ".zmetadata"}


def check_zarr(store: Path) -> None:
    """Refuse a store of another zarr format, with codecs or types that this program never writes.

    Parameters
    ----------
    store : Path
        A folder in zarr format 2.

    Raises
    ------
    InputError
        What is wrong, and in which file.
    """
    if store.is_symlink() or not store.is_dir():
        raise InputError(f"{store}: is no folder of results")
    for path in sorted(store.rglob("*")):
        if path.is_symlink() or not (path.is_file() or path.is_dir()):
            raise InputError(f"{path}: is a link, a device or a pipe, and results hold none")
        if path.name == "zarr.json":
            raise InputError(f"{path}: is of a zarr format that trundle does not write")
        if path.name in _METADATA:
            for where, array in _arrays(path):
                _check_array(where, array)


def check_whole(store: Path, name: str) -> None:
    """Refuse an array of a store that was looked at, if one of its chunks is missing.

    Parameters
    ----------
    store : Path
        A folder in zarr format 2 that `check_zarr` has passed.
    name : str
        The array's name.

    Raises
    ------
    InputError
        The array or a chunk of it is not there.
    """
    file = store / name / ".zarray"
    if not file.is_file():
        raise InputError(f"{store}: holds no {name.replace('_', ' ')}")
    said = next(array for _, array in _arrays(file))
    many = [math.ceil(n / max(1, c)) for n, c in zip(said["shape"], said["chunks"], strict=False)]
    if math.prod(many) > _MOST:
        raise InputError(f"{file}: says {math.prod(many)} chunks, which no results have")
    for place in itertools.product(*map(range, many)):
        chunk = file.with_name(".".join(map(str, place)) or "0")
        if not chunk.is_file():
            raise InputError(f"{chunk}: is missing, and its numbers with it; run the study again")


def _arrays(path: Path) -> Iterator[tuple[str, dict[str, Any]]]:
    """Give the description of each array that a file of metadata holds."""
    if not path.is_file() or path.stat().st_size > _MOST:
        raise InputError(f"{path}: is no metadata of results")
    try:
        said = json.loads(path.read_text("utf-8"))
    except (ValueError, RecursionError):
        raise InputError(f"{path}: is damaged") from None
    if path.name == ".zarray":
        yield str(path), said
    elif path.name == ".zmetadata":
        inside = said.get("metadata") if isinstance(said, dict) else None
        for name, array in (inside if isinstance(inside, dict) else {}).items():
            if str(name).rpartition("/")[2] == ".zarray":
                yield f"{path}, {name}", array


def _check_array(where: str, array: object) -> None:
    if not isinstance(array, dict):
        raise InputError(f"{where}: is damaged")
    dtype, shape, chunks = (array.get(key) for key in ("dtype", "shape", "chunks"))
    if not isinstance(dtype, str) or not _DTYPE.match(dtype):
        raise InputError(f"{where}: holds {str(dtype)[:40]!r}, which is neither numbers nor text")
    filters = array.get("filters") or []
    codecs = [array.get("compressor"), *(filters if isinstance(filters, list) else [filters])]
    for codec in filter(None, codecs):
        name = str(codec.get("id") if isinstance(codec, dict) else codec)
        if name not in _CODECS:
            raise InputError(
                f"{where}: names the codec {name[:40]!r}, which trundle never writes and does "
                "not open: it could run what is in the file"
            )
    size = int(re.sub(r"\D", "", dtype) or 1) * (4 if "U" in dtype else 1)
    for counts, largest in ((shape, _LARGEST), (chunks, _LARGEST_CHUNK)):
        if not isinstance(counts, list) or size * _product(counts) > largest:
            raise InputError(f"{where}: says a size of {str(counts)[:60]}, which no results have")
    if array.get("dimension_separator", ".") != ".":
        raise InputError(f"{where}: names its chunks as trundle never does")


def _product(counts: list[Any]) -> float:
    """Return how many numbers an array of some size has; infinite if that is no size."""
    whole = all(isinstance(n, int) and 0 <= n < _LARGEST for n in counts)
    return float(math.prod(counts)) if whole else math.inf

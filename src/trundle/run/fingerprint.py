"""Name a value by its content: two values with one digest compute the same."""

from __future__ import annotations

import dataclasses
import hashlib
from collections.abc import Iterator, Mapping, Set
from pathlib import Path

import numpy as np

__all__ = ["digest_of"]


def digest_of(value: object) -> str:
    """Return a digest of all that a value of dataclasses, arrays and plain values holds.

    Parameters
    ----------
    value : object
        Dataclasses, mappings, sequences, arrays, texts, numbers, in one another; what stands
        inside and has a ``content_hash`` is named by that. Paths are left out: where a file stood
        changes nothing.
    """
    found = hashlib.sha256()
    for part in _parts(value, whole=True):
        found.update(part)
        found.update(b"\0")
    return found.hexdigest()


def _parts(value: object, *, whole: bool = False) -> Iterator[bytes]:
    own = getattr(value, "content_hash", None)
    yield type(value).__name__.encode()
    if isinstance(value, np.ndarray):
        yield f"{value.dtype.str} {value.shape}".encode()
        yield np.ascontiguousarray(value).tobytes()
    elif isinstance(own, str) and not whole:
        yield own.encode()
    elif dataclasses.is_dataclass(value) and not isinstance(value, type):
        for field in dataclasses.fields(value):
            yield field.name.encode()
            yield from _parts(getattr(value, field.name))
    elif isinstance(value, Mapping):
        for key in sorted(value, key=repr):
            yield repr(key).encode()
            yield from _parts(value[key])
    elif isinstance(value, Set):
        for item in sorted(value, key=repr):
            yield from _parts(item)
    elif isinstance(value, list | tuple):
        for item in value:
            yield from _parts(item)
    elif not isinstance(value, Path):
        yield repr(value).encode()

"""Keep arrays in a file whose content is held against a checksum before it is believed."""

from __future__ import annotations

import hashlib
import io
import json
import os
import tempfile
import zipfile
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np

from trundle._typing import Array
from trundle.errors import InputError

__all__ = ["read_kept", "refuse_links", "stored_as_they_are", "write_kept"]

_SAID = "said as JSON"
_DIGEST = 32  # bytes of SHA-256 before the arrays


def write_kept(file: Path, arrays: Mapping[str, Array], label: str, said: Any = None) -> None:
    """Write arrays aside, have the disk hold them, and rename: whole or not at all.

    Parameters
    ----------
    file : Path
        Where they go; an earlier file of that name is replaced.
    arrays : mapping of str to ndarray
        Numbers; their names may hold anything but a slash.
    label : str
        What they are; only who asks for the same is given them.
    said : object
        What goes with them, as JSON takes it.
    """
    packed = io.BytesIO()
    named = {name: np.asarray(v, order="C") for name, v in arrays.items()}
    named[_SAID] = np.frombuffer(json.dumps(said).encode(), dtype=np.uint8)
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_STORED) as members:
        for name, array in named.items():  # as np.savez does, to which some names are arguments
            with members.open(f"{name}.npy", "w", force_zip64=True) as member:
                np.lib.format.write_array(member, array, allow_pickle=False)
    data = packed.getvalue()
    number, aside = tempfile.mkstemp(dir=file.parent, prefix=".writing-")
    try:
        with os.fdopen(number, "wb") as opened:
            opened.write(_digest(label, data))
            opened.write(data)
            opened.flush()
            os.fsync(number)
        os.replace(aside, file)
    except BaseException:
        with suppress(OSError):
            os.unlink(aside)
        raise


def read_kept(file: Path, label: str) -> tuple[dict[str, Array], Any] | None:
    """Return the arrays of a file and what goes with them; None if they are not what was written.

    Nothing in it is unpickled.

    Parameters
    ----------
    file : Path
        The file.
    label : str
        What its arrays must be.
    """
    try:
        with file.open("rb") as opened:
            digest, data = opened.read(_DIGEST), opened.read()
        if _digest(label, data) != digest:
            return None
        if not stored_as_they_are(io.BytesIO(data)):
            return None
        with np.load(io.BytesIO(data), allow_pickle=False) as arrays:
            found = {name: arrays[name] for name in arrays.files}
        return found, json.loads(found.pop(_SAID).tobytes())
    except Exception:  # readers raise whatever a stranger's archive leads them to
        return None


def stored_as_they_are(archive: BinaryIO) -> bool:
    """Return whether an archive's arrays are not compressed: none unpacks to more than its file."""
    with zipfile.ZipFile(archive) as members:
        plain = all(m.compress_type == zipfile.ZIP_STORED for m in members.infolist())
    archive.seek(0)
    return plain


def _digest(label: str, data: bytes) -> bytes:
    found = hashlib.sha256(label.encode() + b"\0")
    found.update(data)
    return found.digest()


def refuse_links(folder: Path) -> None:
    """Refuse a folder that is a link or holds one: writing would reach what it points to.

    Devices and pipes are refused as well, for reading one may never end.

    Raises
    ------
    InputError
        What is no file and no folder, by its name.
    """
    inside = sorted(folder.rglob("*")) if folder.is_dir() and not folder.is_symlink() else []
    for path in (folder, *inside):
        if path.is_symlink() or (path.exists() and not path.is_file() and not path.is_dir()):
            raise InputError(
                f"{path} is a link, a device or a pipe, and trundle writes none: whatever stands "
                "behind it would be written over; remove it, or choose another results folder "
                "with --out"
            )

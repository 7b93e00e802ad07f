"""Keep a floor's modes on disk, so that the next study of the same floor starts at once."""

from __future__ import annotations

import os
import tempfile
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np

from trundle._progress import Progress
from trundle.dynamics import (
    Modes,
    SparsePencil,
    are_modes_of,
    available_backends,
    modes_as_arrays,
    modes_from_arrays,
)
from trundle.results.kept import stored_as_they_are
from trundle.run.cache import cache_folder, make_room
from trundle.run.executor import Executor
from trundle.run.parts import modes_by_parts
from trundle.structure import Structure
from trundle.structure.superelements import PartedStructure

__all__ = ["has_modes", "modes_of"]


_KEPT = 8  # sets of modes; the one unused for longest goes first
_ROOM = 6e9  # bytes of them


def modes_of(
    floor: Structure,
    *,
    f_max: float,
    progress: Progress | None = None,
    executor: Executor | None = None,
) -> Modes:
    """Return the modes of a floor below a frequency, from the cache if it has them.

    Parameters
    ----------
    floor : Structure
        The floor.
    f_max : float
        Upper frequency [Hz].
    progress : callable, optional
        Told the share of modes found, where they must be found.
    executor : Executor, optional
        Who finds those of a structure that is cut into parts; threads of this process unless
        given.
    """
    parted = isinstance(floor, PartedStructure)
    if parted:
        floor.check_reach(f_max)
    file = _file(floor, f_max) if floor.has_matrices else None
    kept = None if file is None else _read(file, floor)
    if kept is not None and kept.f_max == f_max:
        return kept
    if parted:
        modes = modes_by_parts(floor, f_max, executor=executor, progress=progress)
    else:
        modes = floor.modes(f_max, progress=progress)
    if file is not None:
        _write(file, modes)
    return modes


def has_modes(floor: Structure, f_max: float) -> bool:
    """Return whether modes are kept; whether they can be believed is seen when they are read."""
    if not floor.has_matrices:
        return True  # given, not computed
    file = _file(floor, f_max)
    return file is not None and file.is_file()


def _file(floor: Structure, f_max: float) -> Path | None:
    """Return where modes are kept, None where keeping is switched off.

    Modes found up to another frequency, or by another solver, differ in their last digits: what
    other studies left must not change this one's.
    """
    folder = cache_folder()
    name = f"{floor.content_hash}-{f_max:.9g}-{available_backends()[0]}.npz"
    return None if folder is None else folder / name


def _read(file: Path, floor: Structure) -> Modes | None:
    """Return what a file holds; None if there is none, or it cannot be what it should."""
    try:
        with file.open("rb") as opened, _arrays_of(opened) as data:
            modes = modes_from_arrays(data)
        os.utime(file)
    except Exception:  # readers raise whatever damage leads them to
        return None
    if not isinstance(floor, PartedStructure):
        mass, stiffness = floor.matrices()
        pencil = SparsePencil(mass=mass, stiffness=stiffness)
        return modes if are_modes_of(modes, pencil) else None
    joined = floor.joined
    return replace(modes, basis=joined) if are_modes_of(modes, joined.pencil) else None


def _arrays_of(opened: BinaryIO) -> Any:  # noqa: ANN401 - numpy has no name for it
    """Return the arrays of a file, to be closed; nothing is unpickled or unpacked."""
    if not stored_as_they_are(opened):
        raise ValueError("compressed")
    return np.load(opened, allow_pickle=False)


def _write(file: Path, modes: Modes) -> None:
    """Write aside, then rename; a cache that cannot be written is no reason to stop."""
    aside: str | None = None
    arrays: dict[str, Any] = dict(modes_as_arrays(modes))
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        number, aside = tempfile.mkstemp(dir=file.parent, suffix=".part")
        with os.fdopen(number, "wb") as opened:
            np.savez(opened, **arrays)
            opened.flush()
            os.fsync(number)
        os.replace(aside, file)
        make_room(file, _KEPT, _ROOM)
    except OSError:
        if aside is not None:  # half of it on a full disk
            with suppress(OSError):
                os.unlink(aside)

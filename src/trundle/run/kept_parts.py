"""Keep reduced parts on disk: the next study that has an equal part need not reduce it."""

from __future__ import annotations

import os
from contextlib import suppress
from pathlib import Path

from trundle.dynamics import (
    Superelement,
    available_backends,
    is_reduction_of,
    part_as_arrays,
    part_from_arrays,
)
from trundle.results.kept import read_kept, write_kept
from trundle.run.cache import cache_folder, make_room
from trundle.structure.superelements import Part

__all__ = ["keep_part", "kept_part"]

_KEPT = 200  # parts; those unused for longest go first
_ROOM = 4e9  # bytes of them


def kept_part(part: Part, f_max: float) -> Superelement | None:
    """Return a part's reduction if it is kept and can be believed."""
    file = _file(part, f_max)
    found = None if file is None or not file.is_file() else read_kept(file, file.stem)
    if file is None or found is None:
        return None
    try:
        reduced = part_from_arrays(found[0])
        sound = is_reduction_of(reduced, part.mass, part.stiffness, part.boundary)
    except Exception:  # a stranger's arrays may be anything
        return None
    if not sound or reduced.f_max != f_max:
        return None
    with suppress(OSError):
        os.utime(file)
    return reduced


def keep_part(part: Part, reduced: Superelement) -> None:
    """Keep a part's reduction; a cache that cannot be written is no reason to stop."""
    file = _file(part, reduced.f_max)
    if file is None:
        return
    with suppress(OSError):
        file.parent.mkdir(parents=True, exist_ok=True)
        write_kept(file, part_as_arrays(reduced), file.stem)
        make_room(file, _KEPT, _ROOM)


def _file(part: Part, f_max: float) -> Path | None:
    """Return where a part is kept, None where keeping is switched off."""
    folder = cache_folder()
    name = f"part-{part.content_hash}-{f_max:.9g}-{available_backends()[0]}.npz"
    return None if folder is None else folder / "parts" / name

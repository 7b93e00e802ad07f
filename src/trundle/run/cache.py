"""Say where modes and reduced parts are kept from one study to the next."""

from __future__ import annotations

import os
from pathlib import Path

__all__ = ["cache_folder", "make_room"]


def cache_folder() -> Path | None:
    """Return where modes are kept, or None where keeping is switched off.

    ``TRUNDLE_CACHE`` names the folder; set to nothing it switches keeping off. Without it modes
    stand in the user's cache.
    """
    named = os.environ.get("TRUNDLE_CACHE")
    if named is not None:
        return Path(named) if named else None
    base = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    return base / "trundle" / "modes"


def make_room(newest: Path, count: int, size: float) -> None:
    """Leave so many files, of so many bytes together; those unused for longest go first.

    Parameters
    ----------
    newest : Path
        The file that was just written, which stays in any case.
    count : int
        How many files.
    size : float
        Bytes of all.
    """
    kept = sorted(newest.parent.glob("*.npz"), key=lambda f: f.stat().st_mtime, reverse=True)
    for number, one in enumerate(kept):
        size -= one.stat().st_size
        if one != newest and (number >= count or size < 0.0):
            one.unlink()

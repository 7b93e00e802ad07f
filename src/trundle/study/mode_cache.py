"""Keep a floor's modes on disk, so that the next study of the same floor starts at once."""

from __future__ import annotations

import os
import tempfile
import zipfile
from collections.abc import Callable
from pathlib import Path

import numpy as np

from trundle.dynamics import Modes, available_backends, natural_modes
from trundle.structure import Floor

__all__ = ["cache_folder", "modes_of"]

Progress = Callable[[float], None]

_KEPT = 8  # sets of modes; the one unused for longest goes first


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


def modes_of(floor: Floor, *, f_max: float, progress: Progress | None = None) -> Modes:
    """Return the modes of a floor below a frequency, from the cache if it has them.

    Parameters
    ----------
    floor : Floor
        The floor.
    f_max : float
        Upper frequency [Hz].
    progress : callable, optional
        Told the share of modes found, where they must be found.
    """
    folder = cache_folder()
    # Modes found up to another frequency, or by another solver, differ in their last digits: what
    # other studies left must not change this one's.
    name = f"{floor.content_hash}-{f_max:.9g}-{available_backends()[0]}.npz"
    file = None if folder is None else folder / name
    kept = None if file is None else _read(file, floor.n_dofs)
    if kept is not None and kept.f_max == f_max:
        return kept
    modes = natural_modes(floor.mass, floor.stiffness, f_max=f_max, progress=progress)
    if file is not None:
        _write(file, modes)
    return modes


def _read(file: Path, n_dofs: int) -> Modes | None:
    """Return what a file holds; None if there is none, or it cannot be what it should."""
    try:
        with file.open("rb") as opened, np.load(opened, allow_pickle=False) as data:
            modes = Modes(
                omega=data["omega"],
                shapes=data["shapes"],
                residuals=data["residuals"],
                f_max=float(data["f_max"]),
            )
        os.utime(file)
    except (OSError, EOFError, KeyError, ValueError, zipfile.BadZipFile):
        return None
    right = modes.shapes.shape == (n_dofs, len(modes.omega)) and np.isfinite(modes.shapes).all()
    return modes if right else None


def _write(file: Path, modes: Modes) -> None:
    """Write aside, then rename; a cache that cannot be written is no reason to stop."""
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.NamedTemporaryFile(dir=file.parent, suffix=".part", delete=False) as aside:
            np.savez(
                aside,
                omega=modes.omega,
                shapes=modes.shapes,
                residuals=modes.residuals,
                f_max=modes.f_max,
            )
        os.replace(aside.name, file)
        for old in sorted(file.parent.glob("*.npz"), key=lambda f: f.stat().st_mtime)[:-_KEPT]:
            old.unlink()
    except OSError:
        return

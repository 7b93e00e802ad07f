"""Keep a floor's modes on disk, so that the next study of the same floor starts at once."""

from __future__ import annotations

import hashlib
import os
import tempfile
from contextlib import suppress
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np

from trundle._progress import Progress
from trundle.dynamics import Modes, available_backends, count_modes_below, natural_modes
from trundle.results.kept import stored_as_they_are
from trundle.structure import Floor

__all__ = ["cache_folder", "has_modes", "modes_of"]


_SUMS = 3  # sums of all modes by which kept ones are tried
_OFF = 1e-6  # relative, that such a sum may be off
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
    file = _file(floor, f_max)
    kept = None if file is None else _read(file, floor)
    if kept is not None and kept.f_max == f_max:
        return kept
    modes = natural_modes(floor.mass, floor.stiffness, f_max=f_max, progress=progress)
    if file is not None:
        _write(file, modes)
    return modes


def has_modes(floor: Floor, f_max: float) -> bool:
    """Return whether modes are kept; whether they can be believed is seen when they are read."""
    file = _file(floor, f_max)
    return file is not None and file.is_file()


def _file(floor: Floor, f_max: float) -> Path | None:
    """Return where modes are kept, None where keeping is switched off.

    Modes found up to another frequency, or by another solver, differ in their last digits: what
    other studies left must not change this one's.
    """
    folder = cache_folder()
    name = f"{floor.content_hash}-{f_max:.9g}-{available_backends()[0]}.npz"
    return None if folder is None else folder / name


def _read(file: Path, floor: Floor) -> Modes | None:
    """Return what a file holds; None if there is none, or it cannot be what it should."""
    try:
        with file.open("rb") as opened, _arrays_of(opened) as data:
            modes = Modes(
                omega=data["omega"],
                shapes=data["shapes"],
                residuals=data["residuals"],
                f_max=float(data["f_max"]),
            )
            whole = data["digest"].tobytes() == _digest(modes)
        os.utime(file)
    except Exception:  # readers raise whatever damage leads them to
        return None
    return modes if whole and _are_of(floor, modes) else None


def _arrays_of(opened: BinaryIO) -> Any:  # noqa: ANN401 - numpy has no name for it
    """Return the arrays of a file, to be closed; nothing is unpickled or unpacked."""
    if not stored_as_they_are(opened):
        raise ValueError("compressed")
    return np.load(opened, allow_pickle=False)


def _digest(modes: Modes) -> bytes:
    """Return a sum of all that is kept of modes."""
    found = hashlib.sha256(f"{modes.f_max!r} {modes.shapes.shape}".encode())
    for values in (modes.omega, modes.residuals, modes.shapes):
        found.update(np.ascontiguousarray(values).tobytes())
    return found.digest()


def _are_of(floor: Floor, modes: Modes) -> bool:
    """Return whether modes are those of a floor, by sums with random signs.

    With signs s, ``K Phi s / lambda = M Phi s``, and ``|Phi s|^2`` by the mass is the number of
    modes; one spoiled number anywhere breaks either, and each costs a product with the shapes.
    """
    n = len(modes.omega)
    if modes.shapes.shape != (floor.n_dofs, n) or modes.residuals.shape != (n,) or n == 0:
        return False
    numbers = (modes.shapes, modes.omega, modes.residuals)
    sound = all(np.isfinite(values).all() for values in numbers)
    rising = modes.omega[0] > 0.0 and bool(np.all(np.diff(modes.omega) >= 0.0))
    if not sound or not rising or modes.frequencies[-1] >= modes.f_max:
        return False
    signs = np.random.default_rng(n).choice([-1.0, 1.0], size=(n, _SUMS))
    held = floor.stiffness @ (modes.shapes @ (signs / modes.omega[:, None] ** 2))
    both = modes.shapes @ signs
    moved = floor.mass @ both
    off = np.linalg.norm(held - moved, axis=0) / np.linalg.norm(moved, axis=0)
    unlike = np.abs(np.sum(both * moved, axis=0) / n - 1.0)
    if not (np.all(off < _OFF) and np.all(unlike < _OFF)):
        return False
    # Modes may be right, and one of them missing.
    return count_modes_below(floor.mass, floor.stiffness, modes.f_max) == n


def _write(file: Path, modes: Modes) -> None:
    """Write aside, then rename; a cache that cannot be written is no reason to stop."""
    aside: str | None = None
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        number, aside = tempfile.mkstemp(dir=file.parent, suffix=".part")
        with os.fdopen(number, "wb") as opened:
            np.savez(
                opened,
                omega=modes.omega,
                shapes=modes.shapes,
                residuals=modes.residuals,
                f_max=modes.f_max,
                digest=np.frombuffer(_digest(modes), dtype=np.uint8),
            )
            opened.flush()
            os.fsync(number)
        os.replace(aside, file)
        for old in sorted(file.parent.glob("*.npz"), key=lambda f: f.stat().st_mtime)[:-_KEPT]:
            old.unlink()
    except OSError:
        if aside is not None:  # half of it on a full disk
            with suppress(OSError):
                os.unlink(aside)

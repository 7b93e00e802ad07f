"""Fill a results folder aside and put it in place in one step, losing nothing that was there."""

from __future__ import annotations

import os
import shutil
import signal
import tempfile
import threading
from collections.abc import Generator
from contextlib import contextmanager, suppress
from pathlib import Path

from trundle.errors import InputError
from trundle.results.disk import named_disk_errors, true_path
from trundle.results.owned import check_owned, record_owned

__all__ = ["check_target", "new_results_folder", "uninterrupted"]


def check_target(folder: Path, kind: str = "study") -> None:
    """Refuse a results folder that cannot be written, before any work starts.

    Parameters
    ----------
    folder : Path
        The folder.
    kind : str
        What will be written there: results of a study, of a record, or of changes.

    Raises
    ------
    InputError
        A file in its place, a folder that holds something else, or no permission.
    """
    folder = true_path(folder)
    try:
        if _stands(folder):
            check_owned(folder, kind)
    except OSError as error:
        raise InputError(
            f"results folder {folder}: {error.strerror or error}; choose another with --out"
        ) from None
    parent = _nearest_folder(folder)
    if not parent.is_dir():
        raise InputError(f"results folder {folder}: {parent} is not a folder; choose another")
    try:
        with tempfile.TemporaryDirectory(dir=parent, prefix=".trundle-"):
            pass
    except OSError as error:
        raise InputError(
            f"results folder {folder} cannot be written ({error.strerror}); "
            "choose another with --out"
        ) from None


def _stands(folder: Path) -> bool:
    """Return whether a folder is there; refuse what is no folder, and the current one."""
    if folder.is_symlink():
        raise InputError(f"results folder {folder} is a link; name the folder itself with --out")
    if not folder.exists():
        return False
    if not folder.is_dir():
        raise InputError(
            f"results folder {folder}: a file has this name; choose another with --out"
        )
    if folder.resolve() == Path.cwd():
        raise InputError("the results folder must not be the current folder; name one with --out")
    return True


def _nearest_folder(folder: Path) -> Path:
    parent = folder.absolute().parent
    while not parent.exists() and parent != parent.parent:
        parent = parent.parent
    return parent


@contextmanager
def new_results_folder(
    folder: Path, *, within: Path | None = None, kind: str = "study"
) -> Generator[Path]:
    """Give a folder to fill; it takes its place only when all went well.

    It is filled beside its place, or `within` a folder of the same file system. What is written is
    recorded; of an earlier result nothing goes that is not on its own list, and of the same kind.

    An earlier result of that name is replaced at the end; after an error or an interrupt it
    still stands, and the half-filled folder is gone.
    """
    folder = true_path(folder)
    made = [parent for parent in folder.parents if not parent.exists()]
    aside: Path | None = None
    try:
        with named_disk_errors(folder, "nothing half-written is left, and earlier results stand"):
            folder.parent.mkdir(parents=True, exist_ok=True)
            aside = Path(tempfile.mkdtemp(dir=within or folder.parent, prefix=".trundle-"))
            aside.chmod(0o755)
            yield aside
            with uninterrupted():
                record_owned(aside, kind)
                _swap(aside, folder, kind)
    finally:
        with uninterrupted():
            if aside is not None:
                shutil.rmtree(aside, ignore_errors=True)
            if not folder.exists():
                for parent in made:
                    with suppress(OSError):
                        parent.rmdir()


@contextmanager
def uninterrupted() -> Generator[None]:
    """Hold back Ctrl-C and termination until the block is done.

    Writers with threads of their own would go on writing behind an interrupted main thread.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    held: list[int] = []
    numbers = (signal.SIGINT, signal.SIGTERM)
    old = [signal.signal(number, lambda n, _frame: held.append(n)) for number in numbers]
    try:
        yield
    finally:
        for number, handler in zip(numbers, old, strict=True):
            signal.signal(number, handler)
    if held:
        raise KeyboardInterrupt


def _swap(new: Path, place: Path, kind: str) -> None:
    """Put new results in the place of earlier ones; if something else is there, beside it."""
    if not os.path.lexists(place):
        os.rename(new, place)
        return
    old = Path(tempfile.mkdtemp(dir=place.parent, prefix=".trundle-old-"))
    try:
        with named_disk_errors(place, "it is left as it is"):
            _stands(place)
            seen = _times(place)
            # Hashing takes a while, in which a file may come or change.
            check_owned(place, kind)
            os.rename(place, old / "old")
        if _times(old / "old") != seen:
            os.rename(old / "old", place)
            raise InputError(f"results folder {place} was changed by somebody else a moment ago")
    except InputError as error:
        old.rmdir()
        beside = Path(tempfile.mkdtemp(dir=place.parent, prefix=f"{place.name}-"))
        os.rename(new, beside)
        raise InputError(f"{error}; the new results are in {beside}") from None
    os.rename(new, place)
    shutil.rmtree(old, ignore_errors=True)


def _times(folder: Path) -> dict[str, tuple[int, int]]:
    """Return when each file below a folder was changed last, and its size."""
    found = {str(path.relative_to(folder)): path.lstat() for path in folder.rglob("*")}
    return {name: (seen.st_mtime_ns, seen.st_size) for name, seen in found.items()}

"""Name a folder as the system does, and say in an engineer's words why a disk takes no more."""

from __future__ import annotations

import errno
import os
from collections.abc import Generator
from contextlib import contextmanager
from pathlib import Path

from trundle.errors import InputError

__all__ = ["named_disk_errors", "true_path"]

_OF_DISKS = {
    errno.EACCES, errno.EBUSY, errno.EDQUOT, errno.EFBIG, errno.EIO, errno.EMFILE,
    errno.ENAMETOOLONG, errno.ENFILE, errno.ENOENT, errno.ENOSPC, errno.ENOTDIR, errno.ENOTEMPTY,
    errno.EPERM, errno.EROFS, errno.ESTALE, errno.EXDEV,
}  # fmt: skip
_FULL = {errno.ENOSPC, errno.EDQUOT, errno.EFBIG}


@contextmanager
def named_disk_errors(folder: Path, kept: str) -> Generator[None]:
    """Turn what a disk refuses while a folder is written into a message.

    Parameters
    ----------
    folder : Path
        What is written.
    kept : str
        What of it all still stands.

    Raises
    ------
    InputError
        The folder, the reason, what stands, and what to do.
    """
    try:
        yield
    except OSError as error:
        if error.errno not in _OF_DISKS:
            raise
        full = error.errno in _FULL
        remedy = "free some space" if full else "see whether disk and folder can be written"
        place = folder if error.filename is None else os.fsdecode(error.filename)
        raise InputError(
            f"{place} cannot be written ({error.strerror}); {kept}; {remedy} and run it again, or "
            "choose another folder with --out"
        ) from None


def true_path(folder: Path) -> Path:
    """Return a folder's absolute path, steps back and links above it followed.

    ``o/../o`` is ``o``. Whether the folder is a link itself is still to be seen.
    """
    if folder.name in {"", ".."}:
        return Path(os.path.realpath(folder))
    return Path(os.path.realpath(folder.parent)) / folder.name

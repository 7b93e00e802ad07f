"""Write files that a command is asked for: whole, or not at all."""

from __future__ import annotations

from collections.abc import Generator, Iterable
from contextlib import contextmanager, suppress
from pathlib import Path

from trundle.errors import InputError

__all__ = ["check_file", "written_aside"]


def check_file(option: str, file: Path, suffixes: Iterable[str]) -> None:
    """Refuse a file of another ending, or where none can stand, before any work.

    Raises
    ------
    InputError
        With the option, the file and what it should be.
    """
    endings = sorted(suffixes)
    if file.suffix.lower() not in endings:
        raise InputError(f"{option} {str(file)!r}: must end with {' or '.join(endings)}")
    try:
        is_folder, has_place = file.is_dir(), file.absolute().parent.is_dir()
    except OSError as error:
        raise InputError(f"{option} {str(file)!r}: cannot be written ({error.strerror})") from None
    if is_folder:
        raise InputError(f"{option} {str(file)!r}: is a folder; name a file in it")
    if not has_place:
        raise InputError(
            f"{option} {str(file)!r}: there is no folder {file.absolute().parent}; make it first"
        )


@contextmanager
def written_aside(option: str, file: Path) -> Generator[Path]:
    """Give a file beside one, which takes its place when it is whole.

    Raises
    ------
    InputError
        The disk does not take it.
    """
    aside = file.with_name(f".{file.stem}.part{file.suffix}")
    try:
        yield aside
        aside.replace(file)
    except OSError as error:
        raise InputError(f"{option} {str(file)!r}: cannot be written ({error.strerror})") from None
    finally:
        with suppress(OSError):  # a name that none can bear
            aside.unlink(missing_ok=True)

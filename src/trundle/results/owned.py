"""Record what was written into a results folder, so that nothing else is ever replaced."""

from __future__ import annotations

import hashlib
import json
import os
from pathlib import Path

from trundle.errors import InputError

__all__ = ["MARK", "check_owned", "check_unchanged", "record_owned"]

MARK = ".trundle-results"
_UNREADABLE = (OSError, ValueError, KeyError, TypeError, AttributeError, RecursionError)


def record_owned(folder: Path, kind: str) -> None:
    """Write down every file of a folder with its hash, and what kind of results they are.

    Parameters
    ----------
    folder : Path
        Results that are complete.
    kind : str
        Of a study, a record or changes; one kind never replaces another.
    """
    found = _files(folder)
    for path in found.values():
        _have_on_disk(path)  # pieces of a run are removed next: a power cut must not take both
    files = {name: _hash(path) for name, path in found.items()}
    text = json.dumps({"kind": kind, "files": files}, indent=1)
    (folder / MARK).write_text(text + "\n", encoding="utf-8")
    _have_on_disk(folder / MARK)


def check_owned(folder: Path, kind: str) -> None:
    """Refuse to replace a folder that holds anything that this program did not write.

    Parameters
    ----------
    folder : Path
        A folder that is there.
    kind : str
        What would replace it.

    Raises
    ------
    InputError
        Files added or changed since, links, results of another kind.
    """
    if not any(folder.iterdir()):
        return
    remedy = "; choose another with --out, or move them away"
    try:
        known, own_kind = _recorded(folder)
    except _UNREADABLE:
        raise InputError(
            f"results folder {folder} holds files that trundle did not write, or no list of those "
            f"that it wrote{remedy}"
        ) from None
    if own_kind != kind:
        raise InputError(f"results folder {folder} holds results of a {own_kind}{remedy}")
    there = _files(folder)
    odd = sorted(name for name in there if name not in known or known[name] != _hash(there[name]))
    if odd:
        named = ", ".join(odd[:3]) + (" ..." if len(odd) > 3 else "")
        raise InputError(
            f"results folder {folder} holds files that trundle did not write, or that were changed "
            f"since ({named}){remedy}"
        )


def check_unchanged(folder: Path, below: str) -> None:
    """Refuse results of which a file is missing, or is not what was written.

    Results without a list pass, as some archives leave them: nothing tells what they were.

    Parameters
    ----------
    folder : Path
        A results folder.
    below : str
        Of its files, those in this folder inside it.

    Raises
    ------
    InputError
        A file that is gone, was added or changed, by its name; a list that cannot be read.
    """
    if not (folder / MARK).exists():
        return
    try:
        known, _ = _recorded(folder)
    except _UNREADABLE:
        raise InputError(f"{folder / MARK}: is damaged; run the study again") from None
    there = _files(folder / below)
    wanted = {n.removeprefix(f"{below}/"): h for n, h in known.items() if n.startswith(f"{below}/")}
    for name in sorted(wanted.keys() | there.keys()):
        if name not in there:
            raise InputError(f"{folder / below / name}: is missing; run the study again")
        if wanted.get(name) != _hash(there[name]):
            raise InputError(
                f"{folder / below / name}: is not as trundle wrote it; run the study again"
            )


def _recorded(folder: Path) -> tuple[dict[str, str], str]:
    """Return the files that a folder's list names, with their hashes, and their kind."""
    mark = folder / MARK
    if mark.is_symlink() or not mark.is_file():
        raise ValueError("no file")
    said = json.loads(mark.read_text("utf-8"))
    return {str(name): str(known) for name, known in said["files"].items()}, str(said["kind"])


def _files(folder: Path) -> dict[str, Path]:
    """Return all files below a folder but the list itself, links and empty folders too."""
    found = {
        str(path.relative_to(folder)): path
        for path in folder.rglob("*")
        if path.is_symlink() or not path.is_dir() or not any(path.iterdir())
    }
    found.pop(MARK, None)
    return found


def _have_on_disk(path: Path) -> None:
    if path.is_file() and not path.is_symlink():
        with path.open("rb") as opened:
            os.fsync(opened.fileno())


def _hash(path: Path) -> str:
    if path.is_symlink() or not path.is_file():
        return "link" if path.is_symlink() else "folder" if path.is_dir() else "other"
    with path.open("rb") as opened:
        return hashlib.file_digest(opened, "sha256").hexdigest()

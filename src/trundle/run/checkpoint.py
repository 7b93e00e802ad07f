"""Keep the pieces of a study as they are finished, so that a run that is stopped can go on.

Each piece is a file with a checksum, written aside and renamed into place: after a kill at any
moment a piece is there whole or not at all, and one that was altered is computed again.
"""

from __future__ import annotations

import hashlib
import json
import os
import shutil
from collections.abc import Generator
from contextlib import contextmanager, suppress
from dataclasses import replace
from pathlib import Path
from typing import Protocol, runtime_checkable

import numpy as np
import scipy

from trundle import __version__
from trundle.dynamics import available_backends
from trundle.errors import ComputationError, InputError
from trundle.results.codec import keep_value, kept_value
from trundle.results.disk import named_disk_errors, true_path
from trundle.results.kept import refuse_links
from trundle.results.parts import Part
from trundle.run.fingerprint import digest_of
from trundle.study.model import Study

__all__ = ["InMemory", "OnDisk", "PieceStore", "unfinished_folder", "unfinished_of"]

_MARK = "trundle-unfinished.json"
_FORMAT = 7  # of the pieces; another one starts anew


@runtime_checkable
class PieceStore(Protocol):
    """Where finished pieces are kept."""

    def has(self, name: str) -> bool:
        """Return whether a piece is there."""
        ...

    def save(self, name: str, piece: Part) -> None:
        """Keep a piece."""
        ...

    def load(self, name: str) -> Part:
        """Return a piece that is there."""
        ...


class InMemory:
    """Keep pieces for as long as this process lives."""

    def __init__(self) -> None:
        self._pieces: dict[str, Part] = {}

    def has(self, name: str) -> bool:
        """Return whether a piece is there."""
        return name in self._pieces

    def save(self, name: str, piece: Part) -> None:
        """Keep a piece."""
        self._pieces[name] = piece

    def load(self, name: str) -> Part:
        """Return a piece that is there."""
        return self._pieces[name]


class OnDisk:
    """Keep the pieces of a study in a folder, each in a file that is whole or not at all."""

    def __init__(self, folder: Path, fingerprint: str) -> None:
        self.folder = folder
        self._fingerprint = fingerprint
        self._store = folder / "pieces"
        if self._store.exists() and not self._store.is_dir():
            raise InputError(f"{self._store} is no folder; remove {folder}, and run it again")
        self._store.mkdir(exist_ok=True)
        for aside in self._store.glob(".writing-*"):  # what a killed process was writing
            aside.unlink(missing_ok=True)
        for aside in folder.glob(".trundle-*"):
            shutil.rmtree(aside, ignore_errors=True)
        # What does not hold against its checksum is computed again.
        self._sound = {file.stem for file in self._files() if self._read(file) is not None}

    @property
    def n_found(self) -> int:
        """How many sound pieces are there."""
        return len(self._sound)

    def has(self, name: str) -> bool:
        """Return whether a piece is there."""
        return name in self._sound

    def save(self, name: str, piece: Part) -> None:
        """Write a piece aside, then rename it into place."""
        with named_disk_errors(self._file(name), "pieces finished before are kept"):
            keep_value(self._file(name), piece, self._label(name))
        self._sound.add(name)

    def load(self, name: str) -> Part:
        """Return a piece that is there."""
        piece = self._read(self._file(name))
        if piece is None:
            raise ComputationError(
                f"{self._file(name)}: was altered while the run went on; run it again"
            )
        return piece

    def clear(self) -> None:
        """Forget all pieces; what somebody else put beside them stays."""
        for file in self._files():
            file.unlink(missing_ok=True)
        self._sound.clear()

    def _label(self, name: str) -> str:
        """Return what a piece is: neither another study's nor another piece of this one."""
        return f"{name} {self._fingerprint}"

    def _read(self, file: Path) -> Part | None:
        """Return the piece in a file; None if it is not what was written."""
        return kept_value(file, self._label(file.stem))

    def _files(self) -> list[Path]:
        return sorted(self._store.glob("*.piece"))

    def _file(self, name: str) -> Path:
        return self._store / f"{name}.piece"


def unfinished_folder(out: Path) -> Path:
    """Return where the pieces of a run into a results folder are kept until it is done."""
    out = true_path(out)
    return out.with_name(f"{out.name}.unfinished")


@contextmanager
def unfinished_of(
    study: Study, out: Path, *, fresh: bool = False, also: object = None
) -> Generator[OnDisk]:
    """Open the pieces of a run, those of an earlier one of the same study if it was stopped.

    When all goes well the folder is removed at the end; after an interrupt it stays.

    Parameters
    ----------
    study : Study
        What is run.
    out : Path
        Its results folder; the pieces stand beside it.
    fresh : bool
        Begin anew even if pieces are there.
    also : object
        What decides the bits of a piece beside the study, see `digest_of`.

    Raises
    ------
    InputError
        Another process works on the same results, or the folder is somebody else's.
    """
    folder = unfinished_folder(out)
    refuse_links(folder)
    mark = folder / _MARK
    if folder.exists() and not mark.is_file() and (not folder.is_dir() or any(folder.iterdir())):
        raise InputError(
            f"{folder} is where unfinished results would stand, but trundle did not write it; "
            "move it away, or choose another results folder with --out"
        )
    made = [parent for parent in folder.parents if not parent.exists()]
    with named_disk_errors(folder, "nothing was written"):
        folder.mkdir(parents=True, exist_ok=True)
    with _locked(folder / "lock"):
        store = _opened(folder, _fingerprint(study, also), fresh=fresh)
        try:
            yield store
        except BaseException:
            if not store.n_found:
                _remove(store, made)
            raise
        _remove(store, [])


def _opened(folder: Path, fingerprint: str, *, fresh: bool) -> OnDisk:
    """Return the pieces of a folder, those of another study thrown away."""
    mark = folder / _MARK
    with named_disk_errors(folder, "nothing was written"):
        store = OnDisk(folder, fingerprint)
        if fresh or not mark.is_file() or mark.read_bytes() != fingerprint.encode():
            store.clear()
            aside = mark.with_suffix(".aside")
            aside.unlink(missing_ok=True)
            aside.write_text(fingerprint, "utf-8")
            os.replace(aside, mark)  # never into what another name may share
    return store


def _remove(store: OnDisk, made: list[Path]) -> None:
    """Remove what was written; a folder that holds anything else stays with that."""
    store.clear()
    for name in (_MARK, "lock"):
        (store.folder / name).unlink(missing_ok=True)
    for folder in (store.folder / "pieces", store.folder, *made):
        with suppress(OSError):
            folder.rmdir()


def _fingerprint(study: Study, also: object) -> str:
    """Return all that decides the bits of a piece."""
    values = {
        "format": _FORMAT,
        "version": __version__,
        "numpy": np.__version__,
        "scipy": scipy.__version__,
        "solver": available_backends()[0],
        "study": hashlib.sha256(study.text.encode()).hexdigest(),
        "floor": study.floor.content_hash,
        # also of what the study's file only names: criteria, profiles, tables
        "content": digest_of(replace(study, source="")),
        "also": digest_of(also),
    }
    return json.dumps(values, indent=1) + "\n"


@contextmanager
def _locked(file: Path) -> Generator[None]:
    """Hold a lock that ends with this process, however that ends."""
    try:
        import fcntl  # noqa: PLC0415 - only where the system has it
    except ImportError:
        yield
        return
    with named_disk_errors(file, "nothing was written"):
        opened = file.open("a")  # nothing that is there is cut
    with opened:
        try:
            fcntl.flock(opened, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            raise InputError(
                f"another trundle is working on the same results ({file.parent}); "
                "wait for it, or choose another folder with --out"
            ) from None
        yield

"""Keep a result in a folder, bit by bit, and read it back.

``kept`` holds a file for each cell and each map, with checksums, beside the labelled arrays that
are meant for others; the study file and the criteria files that it names go with them. Nothing in
them is ever executed: see `codec`.
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from trundle.errors import InputError
from trundle.results.codec import keep_value, kept_value
from trundle.results.owned import check_unchanged
from trundle.results.study_result import StudyResult
from trundle.study.model import Study

__all__ = ["Kept", "keep_result", "kept_of", "read_result"]

_FOLDER = "kept"
_LABEL = "trundle result 1"


@dataclass(frozen=True, kw_only=True, eq=False)
class Kept:
    """Hold what a results folder says of itself.

    Attributes
    ----------
    folder : Path
        The results folder.
    source : str
        Where the study file stood.
    files : mapping of str to Path
        Where the files are now that the study names, by the names that it gives them.
    n_cells, n_maps : int
        How many cells and maps are kept.
    provenance : mapping of str
        Where the results come from.
    """

    folder: Path
    source: str
    files: Mapping[str, Path]
    n_cells: int
    n_maps: int
    provenance: Mapping[str, Any]


def keep_result(result: StudyResult, folder: Path) -> None:
    """Write the study file, and ``kept``: all that the report of a result is drawn from.

    Parameters
    ----------
    result : StudyResult
        A finished study.
    folder : Path
        Results folder, which must exist.
    """
    study, kept = result.study, folder / _FOLDER
    kept.mkdir()
    (folder / "study.toml").write_bytes(study.text.encode())
    names: dict[str, str] = {}
    for i, (name, content) in enumerate(study.files.items()):
        names[name] = f"file{i:02d}{Path(name).suffix}"
        (kept / names[name]).write_bytes(content)
    for i, (key, cell) in enumerate(result.cells.items()):
        keep_value(kept / f"cell{i:04d}", (cell, result.verdicts.get(key)), _LABEL)
    for i, pair in enumerate(result.maps.items()):
        keep_value(kept / f"map{i:04d}", pair, _LABEL)
    index = {
        "source": study.source,
        "study": hashlib.sha256(study.text.encode()).hexdigest(),
        "files": names,
        "cells": len(result.cells),
        "maps": len(result.maps),
        "provenance": result.provenance,
        "modes": result.modes,
    }
    keep_value(kept / "index", index, _LABEL)


def kept_of(folder: Path) -> Kept:
    """Return what a results folder says of itself, after a look at its files.

    Parameters
    ----------
    folder : Path
        A results folder.

    Raises
    ------
    InputError
        No results, those of an earlier version, files that were changed since.
    """
    if not (folder / _FOLDER / "index").is_file():
        raise InputError(
            f"{folder}: holds no results that can be read back; run the study again into a new "
            "folder"
        )
    check_unchanged(folder, _FOLDER)
    said = _read(folder, "index")
    text = (folder / "study.toml").read_bytes()
    if hashlib.sha256(text).hexdigest() != said["study"]:
        raise InputError(f"{folder / 'study.toml'}: is not the study that was run there")
    return Kept(
        folder=folder,
        source=said["source"],
        files={name: folder / _FOLDER / file for name, file in said["files"].items()},
        n_cells=said["cells"],
        n_maps=said["maps"],
        provenance=said["provenance"],
    )


def read_result(kept: Kept, study: Study) -> StudyResult:
    """Return the result that `keep_result` has written, bit by bit.

    Parameters
    ----------
    kept : Kept
        What the folder says of itself.
    study : Study
        The study in the folder, read again.
    """
    cells = [_read(kept.folder, f"cell{i:04d}") for i in range(kept.n_cells)]
    return StudyResult(
        study=study,
        cells={cell.key: cell for cell, _ in cells},
        verdicts={cell.key: verdicts for cell, verdicts in cells if verdicts is not None},
        maps=dict(_read(kept.folder, f"map{i:04d}") for i in range(kept.n_maps)),
        modes=_read(kept.folder, "index")["modes"],
        provenance=kept.provenance,
    )


def _read(folder: Path, name: str) -> Any:  # noqa: ANN401 - whatever was kept
    file = folder / _FOLDER / name
    value = kept_value(file, _LABEL)
    if value is None:
        raise InputError(f"{file}: is not as trundle wrote it; run the study again")
    return value

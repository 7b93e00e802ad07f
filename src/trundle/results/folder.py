"""Keep a result in a folder, bit by bit, and read it back.

``kept`` holds a file for each cell and each map, with checksums, beside the labelled arrays that
are meant for others; the study file and the criteria files that it names go with them. Nothing in
them is ever executed: see `codec`.
"""

from __future__ import annotations

import hashlib
from collections.abc import Sequence, Set
from dataclasses import astuple
from itertools import product
from pathlib import Path
from typing import Any, TypeVar

from trundle.criteria import Verdict
from trundle.errors import InputError
from trundle.results.cells import Cell, CellKey, DayKey
from trundle.results.codec import keep_value, kept_value
from trundle.results.field_kinds import holds
from trundle.results.kept_index import KeptIndex
from trundle.results.maps import MapKey, StudyMap
from trundle.results.owned import check_unchanged
from trundle.results.study_result import StudyResult
from trundle.study.model import Study
from trundle.traffic import Day

__all__ = ["files_of", "index_of", "keep_result", "read_result"]

_FOLDER = "kept"
_LABEL = "trundle result 2"
_CELL = tuple[Cell, tuple[Verdict, ...] | None]
_MAP = tuple[MapKey, StudyMap]
_DAY = tuple[DayKey, Day]
_Key = TypeVar("_Key", CellKey, MapKey, DayKey)


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
    for i, pair in enumerate(result.days.items()):
        keep_value(kept / f"day{i:04d}", pair, _LABEL)
    index = KeptIndex(
        source=study.source,
        study=hashlib.sha256(study.text.encode()).hexdigest(),
        files=names,
        cells=len(result.cells),
        maps=len(result.maps),
        days=len(result.days),
        modes=result.modes,
        mesh=result.mesh,
        parts=result.parts,
        provenance=result.provenance,
    )
    keep_value(kept / "index", index, _LABEL)
    mode = (folder / "study.toml").stat().st_mode
    for file in kept.iterdir():  # written aside for the writer alone; results are for whom they say
        file.chmod(mode)


def index_of(folder: Path) -> KeptIndex:
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
    index = _read(folder, "index", KeptIndex)
    try:
        text = (folder / "study.toml").read_bytes()
    except OSError:
        raise InputError(
            f"{folder / 'study.toml'}: cannot be read, and results say nothing without their "
            "study; put it back, or run the study again"
        ) from None
    if hashlib.sha256(text).hexdigest() != index.study:
        raise InputError(f"{folder / 'study.toml'}: is not the study that was run there")
    return index


def files_of(folder: Path, index: KeptIndex) -> dict[str, Path]:
    """Return where the files are that the study names, by the names that it gives them."""
    return {name: folder / _FOLDER / Path(file).name for name, file in index.files.items()}


def read_result(folder: Path, index: KeptIndex, study: Study) -> StudyResult:
    """Return the result that `keep_result` has written, bit by bit.

    Parameters
    ----------
    folder : Path
        The results folder.
    index : KeptIndex
        What it says of itself.
    study : Study
        The study in the folder, read again.
    """
    cells = [_read(folder, f"cell{i:04d}", _CELL) for i in range(index.cells)]
    maps = [_read(folder, f"map{i:04d}", _MAP) for i in range(index.maps)]
    days = [_read(folder, f"day{i:04d}", _DAY) for i in range(index.days)]
    of_study = _keys_of(study)
    _check_keys(folder, "cell", [cell.key for cell, _ in cells], of_study[0], every=True)
    _check_keys(folder, "map", [key for key, _ in maps], of_study[1])
    _check_keys(folder, "day", [key for key, _ in days], of_study[2])
    return StudyResult(
        study=study,
        cells={cell.key: cell for cell, _ in cells},
        verdicts={cell.key: verdicts for cell, verdicts in cells if verdicts is not None},
        maps=dict(maps),
        days=dict(days),
        modes=index.modes,
        mesh=index.mesh,
        parts=index.parts,
        provenance=index.provenance,
    )


def _keys_of(study: Study) -> tuple[set[CellKey], set[MapKey], set[DayKey]]:
    """Return what a study has cells of, and may have maps and days of."""
    cases, speeds = [case.name for case in study.cases], (study.map.speeds if study.map else ())
    return (
        {CellKey(*one) for one in product(cases, study.roads, (m.name for m in study.methods))},
        {MapKey(*one) for one in product(cases, study.roads, (None, *speeds))},
        {DayKey(*one) for one in product(study.schedules, study.roads)},
    )


def _check_keys(
    folder: Path, what: str, found: Sequence[_Key], known: Set[_Key], *, every: bool = False
) -> None:
    """Refuse a file that is sound and stands in another's place: a result would lack that one."""
    for i, key in enumerate(found):
        if key not in known or key in found[:i]:
            why = "is held by another file too" if key in known else "is none of the study"
            words = ", ".join(str(part) for part in astuple(key) if part is not None)
            raise InputError(
                f"{folder / _FOLDER / f'{what}{i:04d}'}: is of {words!r}, which {why}; run the "
                "study again"
            )
    if every and len(found) < len(known):
        raise InputError(
            f"{folder / _FOLDER}: holds {len(found)} of {len(known)} {what}s of the study; run it "
            "again"
        )


def _read(folder: Path, name: str, hint: Any) -> Any:  # noqa: ANN401 - whatever was kept
    """Return a value that was kept, if it is of the kind that it should be."""
    file = folder / _FOLDER / name
    value = kept_value(file, _LABEL)
    if value is None or not holds(value, hint):
        raise InputError(f"{file}: is not as trundle wrote it; run the study again")
    return value

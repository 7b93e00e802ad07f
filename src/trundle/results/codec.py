"""Turn values of results into arrays and JSON, and back, without anything that could be executed.

A value is a tree of dataclasses, tuples, mappings, texts, numbers and arrays. Its arrays are named
by their place in the tree, so that they can be kept as arrays; the rest is JSON, in which a
dataclass stands by its name. Only classes on the list here are ever made again, from exactly the
fields that they have: what else a file may name is refused.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from trundle._typing import Array
from trundle.criteria import BandOutcomes, ClassMap, Criterion, Verdict
from trundle.errors import FitnessWarning
from trundle.response import BandSpectra, ExactStatistics, LargestValues, RunLevels
from trundle.results.cells import Cell, CellKey, DayKey, History
from trundle.results.field_kinds import fields_hold
from trundle.results.kept import read_kept, write_kept
from trundle.results.kept_index import KeptIndex
from trundle.results.level_change import LevelChange
from trundle.results.maps import MapKey, StudyMap
from trundle.results.mesh_change import MeshChange
from trundle.results.modes import FirstModes
from trundle.results.parts import ChangesPart, DayPart, ExactPart, MapPart, RunsPart
from trundle.results.parts_change import PartsChange
from trundle.simulate import Coverage, TruncationChange
from trundle.traffic import Day, Loudest, Meeting

__all__ = ["keep_value", "kept_value", "pack", "unpack"]

_CLASSES: Mapping[str, Callable[..., Any]] = {
    kind.__name__: kind
    for kind in (
        BandOutcomes, BandSpectra, Cell, CellKey, ChangesPart, ClassMap, Coverage, Criterion, Day,
        DayKey, DayPart, ExactPart, ExactStatistics, FirstModes, FitnessWarning, History, KeptIndex,
        LargestValues, LevelChange, Loudest, MapKey, MapPart, Meeting, MeshChange, PartsChange,
        RunLevels, RunsPart, StudyMap, TruncationChange, Verdict,
    )
}  # fmt: skip
_PLAIN = (str, bool, int, float, type(None))


def pack(value: object) -> tuple[dict[str, Array], Any]:
    """Return the arrays of a value by name, and the rest as JSON takes it.

    Parameters
    ----------
    value : object
        Dataclasses of results, tuples, mappings, texts, numbers, arrays, in one another.

    Raises
    ------
    TypeError
        A class that is not on the list, which `unpack` could not make again.
    """
    arrays: dict[str, Array] = {}
    return arrays, _packed(value, "value", arrays)


def keep_value(file: Path, value: object, label: str) -> None:
    """Write a value: whole or not at all, see `write_kept`."""
    arrays, said = pack(value)
    write_kept(file, arrays, label, said)


def kept_value(file: Path, label: str) -> Any:
    """Return the value in a file; None if it is not there, or not what was written."""
    kept = read_kept(file, label)
    if kept is None:
        return None
    try:
        return unpack(*kept)
    except Exception:  # classes check what they are given, and raise whatever they find
        return None


def _packed(value: object, place: str, arrays: dict[str, Array]) -> Any:
    """Return a value as JSON, its arrays put aside."""
    if isinstance(value, np.ndarray):
        arrays[place] = value
        return {"array": place}
    if isinstance(value, np.generic):
        return value.item()
    if isinstance(value, _PLAIN):
        return value
    if isinstance(value, tuple | list):
        return [_packed(item, f"{place}.{i}", arrays) for i, item in enumerate(value)]
    if isinstance(value, Mapping):
        pairs = enumerate(value.items())
        return {
            "map": [
                [_packed(k, f"{place}.{i}k", arrays), _packed(v, f"{place}.{i}", arrays)]
                for i, (k, v) in pairs
            ]
        }
    name = type(value).__name__
    if _CLASSES.get(name) is not type(value) or not dataclasses.is_dataclass(value):
        raise TypeError(f"a {name} is not on the list of what results hold")
    return {
        "class": name,
        "fields": {
            field.name: _packed(getattr(value, field.name), f"{place}.{field.name}", arrays)
            for field in dataclasses.fields(value)
        },
    }


def unpack(arrays: Mapping[str, Array], said: Any) -> Any:
    """Return the value that `pack` took apart; sequences are tuples.

    Raises
    ------
    ValueError
        What `pack` does not write: another class, other fields, an array that is not there.
    """
    if isinstance(said, _PLAIN):
        return said
    if isinstance(said, list):
        return tuple(unpack(arrays, item) for item in said)
    if not isinstance(said, dict):
        raise ValueError(f"no value of results: {type(said).__name__}")
    if said.keys() == {"array"} and said["array"] in arrays:
        return arrays[said["array"]]
    if said.keys() == {"map"}:
        return {unpack(arrays, key): unpack(arrays, value) for key, value in said["map"]}
    if said.keys() == {"class", "fields"} and said["class"] in _CLASSES:
        kind: Any = _CLASSES[said["class"]]
        if said["fields"].keys() == {field.name for field in dataclasses.fields(kind)}:
            values = {n: unpack(arrays, value) for n, value in said["fields"].items()}
            if fields_hold(kind, values):
                return kind(**values)
    raise ValueError("no value of results")

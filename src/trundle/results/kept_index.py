"""Hold what a results folder says of what is kept in it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from trundle.results.mesh_change import MeshChange
from trundle.results.modes import FirstModes
from trundle.results.parts_change import PartsChange

__all__ = ["KeptIndex"]


@dataclass(frozen=True, kw_only=True, eq=False)
class KeptIndex:
    """Hold what stands in the first of the files that are kept.

    Attributes
    ----------
    source : str
        Where the study file stood.
    study : str
        SHA-256 of its text.
    files : mapping of str to str
        Names of the files that it names, here, by the names that it gives them.
    cells, maps, days : int
        How many are kept.
    modes : FirstModes or None
        Natural modes of the floor, where a method used them.
    mesh : MeshChange or None
        What a coarser mesh changes, where that was looked at.
    provenance : mapping of str
        Where the results come from.
    parts : PartsChange or None
        What less of each part changes, where that was looked at.
    """

    source: str
    study: str
    files: Mapping[str, str]
    cells: int
    maps: int
    days: int
    modes: FirstModes | None
    mesh: MeshChange | None
    provenance: Mapping[str, str | int | Mapping[str, str]]
    parts: PartsChange | None = None

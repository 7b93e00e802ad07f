"""Hold the sections of a study file that passed their own checks."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

__all__ = ["StudyFile"]


@dataclass(frozen=True, kw_only=True, eq=False)
class StudyFile:
    """Hold the sections of a study file that passed their own checks, still unrelated.

    Attributes
    ----------
    source : str
        Path of the file.
    text : str
        Its text, kept for provenance.
    general : GeneralSection or None
        The keys above the first table.
    tables : dict of str to Section
        ``floor``, ``roughness``, ``criteria``, ``map``, ``publication``.
    vehicles : dict of str to Section
        Vehicle sections by name.
    lists : dict of str to list of (int, Section)
        Sections of each list, with their place in it.
    declared : dict of str to set of str
        Names that the file gives, also those of sections with mistakes: a reference to one
        of them is not a second mistake.
    counts : dict of str to int
        Number of sections in each list, sound or not.
    given : frozenset of str
        Names of all that stands in the file, sound or not.
    shaking : tuple of str
        The lists whose sections shake a floor by themselves: walkers, machines.
    """

    source: str
    text: str
    general: Any
    tables: dict[str, Any] = field(default_factory=dict[str, Any])
    vehicles: dict[str, Any] = field(default_factory=dict[str, Any])
    lists: dict[str, list[tuple[int, Any]]] = field(
        default_factory=dict[str, list[tuple[int, Any]]]
    )
    declared: dict[str, set[str]] = field(default_factory=dict[str, set[str]])
    counts: dict[str, int] = field(default_factory=dict[str, int])
    given: frozenset[str] = frozenset()
    shaking: tuple[str, ...] = ()

    def items(self, name: str) -> list[Any]:
        """Return the sections of a list."""
        return [section for _, section in self.lists.get(name, [])]

    def has_bad(self, name: str) -> bool:
        """Return True when a list holds a section with mistakes."""
        return len(self.lists.get(name, [])) < self.counts.get(name, 0)

    @property
    def acting(self) -> set[str]:
        """All names of what can act on the floor, also of those with mistakes."""
        return {name for kind in ("route", *self.shaking) for name in self.declared.get(kind, ())}

    def place_of(self, name: str, *kinds: str) -> str:
        """Return where a section of a name stands, as messages write it: ``method[2]``."""
        places = (place for place, known in self.names(*kinds) if known == name)
        return next(places, "file")

    def names(self, *kinds: str) -> Iterator[tuple[str, str]]:
        """Give where each section of some lists stands, and its name."""
        for kind in kinds:
            for i, section in self.lists.get(kind, []):
                yield f"{kind}[{i + 1}]", section.name

    @property
    def content_hash(self) -> str:
        """Hash of the text."""
        return hashlib.sha256(self.text.encode()).hexdigest()[:16]

"""Read the sections of gmsh's mesh files, formats 2.2 and 4.1, as text.

Reference: Gmsh reference manual, chapter 10.1 (MSH file format).
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from trundle._typing import Array
from trundle.errors import InputError
from trundle.imports.mesh_groups import GroupedMesh

__all__ = ["grouped_mesh"]

_CORNERS = {15: 1, 1: 2, 2: 3, 3: 4}
_REFUSED = {
    4: (3, "tetrahedra"), 5: (3, "hexahedra"), 6: (3, "prisms"), 7: (3, "pyramids"),
    8: (1, "lines of second order"), 9: (2, "triangles of second order"),
    10: (2, "quadrilaterals of second order"), 16: (2, "quadrilaterals of second order"),
}  # fmt: skip
_DIMENSION = {1: 0, 2: 1, 3: 2, 4: 2}  # by the number of corners
_MOST = 2**53  # of a node's number
_PASSED = {"Comments", "Periodic", "Parametrizations", "InterpolationScheme"}


@dataclass(kw_only=True)
class _Mesh:
    """What the sections of a file say."""

    names: dict[tuple[int, int], str] = field(default_factory=dict)
    physical: dict[tuple[int, int], tuple[int, ...]] = field(default_factory=dict)
    tags: Array = field(default_factory=lambda: np.zeros(0, dtype=np.int64))
    places: Array = field(default_factory=lambda: np.zeros((0, 3)))
    blocks: list[tuple[int, tuple[int, ...], Array]] = field(default_factory=list)
    unread: list[tuple[int, tuple[int, ...], str]] = field(default_factory=list)

    def name_of(self, dimension: int, group: int) -> str:
        """Return what a group is called; 0 for elements of none."""
        things = ("points", "lines", "surfaces", "volumes")[dimension]
        if group == 0:
            return f"{things} of no physical group"
        return self.names.get((dimension, group), f"{things} {group}")


class _Lines:
    """The lines of a section, and the numbers in them."""

    def __init__(self, name: str, lines: Sequence[str], first: int) -> None:
        self._name, self._lines, self._first, self._at = name, lines, first, 0

    @property
    def place(self) -> str:
        """File and line of what is read next."""
        return f"{self._name}, line {self._first + self._at}"

    def text(self) -> str:
        """Return the next line."""
        if self._at >= len(self._lines):
            raise InputError(f"{self.place}: the section ends too early")
        self._at += 1
        return self._lines[self._at - 1]

    def numbers(self, least: int = 1) -> list[float]:
        """Return the numbers of the next line."""
        text = self.text()
        try:
            found = [float(word) for word in text.split()]
        except ValueError:
            found = []
        if len(found) < least:
            self._at -= 1
            raise InputError(f"{self.place}: must be {least} numbers or more; got {text[:40]!r}")
        return found

    def table(self, n: int, width: int) -> Array:
        """Return a table of numbers, a row a line."""
        rows = self._lines[self._at : self._at + n]
        try:
            found = np.array(" ".join(rows).split(), dtype=float)
        except ValueError:
            found = np.zeros(0)
        if len(rows) < n or found.size != n * width:
            self._complain(rows, width)
        self._at += n
        if not np.isfinite(found).all():
            raise InputError(f"{self.place}: a number before here is not finite")
        return found.reshape(n, width)

    def ended(self) -> None:
        """Refuse lines that are left over."""
        left = next((i for i in range(self._at, len(self._lines)) if self._lines[i].strip()), None)
        if left is not None:
            self._at = left
            raise InputError(f"{self.place}: is left over: more lines than the section says")

    def wholes(self, n: int, width: int) -> Array:
        """Return a table of whole numbers above 0, a row a line."""
        found = self.table(n, width)
        if found.size and (
            np.any(found != np.round(found)) or found.min() < 1 or found.max() > _MOST
        ):
            raise InputError(f"{self.place}: numbers before here must be whole, 1 to {_MOST:g}")
        return found.astype(np.int64)

    def skip(self, n: int) -> None:
        """Pass over some lines."""
        self._at = min(self._at + n, len(self._lines))

    def rest(self) -> tuple[list[str], int]:
        """Return all lines that are left, and the number of the first."""
        return list(self._lines[self._at :]), self._first + self._at

    def _complain(self, rows: Sequence[str], width: int) -> None:
        for i, row in enumerate(rows):
            words = row.split()
            if len(words) != width or not all(_is_number(word) for word in words):
                self._at += i
                raise InputError(f"{self.place}: must be {width} numbers; got {row[:40]!r}")
        self._at += len(rows)
        raise InputError(f"{self.place}: the section ends too early")


def _is_number(word: str) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True


def grouped_mesh(path: Path, nothing: Collection[str] = ()) -> tuple[GroupedMesh, tuple[str, ...]]:
    """Read a mesh; return it, and what was passed over.

    Parameters
    ----------
    path : Path
        The file.
    nothing : collection of str
        Groups that may hold elements that are not read.

    Raises
    ------
    InputError
        Of what is damaged, or is not read, with its line.
    """
    sections, told = dict(_sections(path)), list[str]()
    if "MeshFormat" not in sections:
        raise InputError(f"{path.name}: no $MeshFormat: no mesh of gmsh")
    version = _version(sections["MeshFormat"])
    mesh = _Mesh()
    for name in sections:
        if name not in {"MeshFormat", "PhysicalNames", "Entities", "Nodes", "Elements"}:
            if name not in _PASSED and not name.endswith("Data"):
                raise InputError(f"{path.name}: section ${name} is not read")
            told.append(f"passed over: ${name}")
    for name in ("Nodes", "Elements"):
        if name not in sections:
            raise InputError(f"{path.name}: no ${name}; it may be cut short")
    if "PhysicalNames" in sections:
        _names(mesh, sections["PhysicalNames"])
    if version == 2:
        _nodes_2(mesh, sections["Nodes"])
        _elements_2(mesh, sections["Elements"])
    else:
        if "Entities" in sections:
            _entities(mesh, sections["Entities"])
        _nodes_4(mesh, sections["Nodes"])
        _elements_4(mesh, sections["Elements"])
    for dimension, groups, why in mesh.unread:
        if not {mesh.name_of(dimension, group) for group in groups or (0,)} <= set(nothing):
            raise InputError(why)
    return _grouped(mesh, path.name), tuple(told)


def _sections(path: Path) -> Iterator[tuple[str, _Lines]]:
    try:
        lines = path.read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror})") from None
    starts = [i for i, line in enumerate(lines) if line.startswith("$")]
    opened: tuple[str, int] | None = None
    for i in starts:
        name = lines[i][1:].strip()
        if opened is None and not name.startswith("End"):
            opened = name, i
        elif opened is not None and name == f"End{opened[0]}":
            yield opened[0], _Lines(path.name, lines[opened[1] + 1 : i], opened[1] + 2)
            opened = None
        else:
            raise InputError(
                f"{path.name}, line {i + 1}: ${name} ends or begins in another section"
            )
    if opened is not None:
        raise InputError(
            f"{path.name}, line {opened[1] + 1}: ${opened[0]} does not end: the file is cut short"
        )


def _version(lines: _Lines) -> int:
    place = lines.place
    version, binary, _ = lines.numbers(3)[:3]
    if binary:
        raise InputError(f"{place}: a binary mesh is not read; save it as ASCII (Mesh.Binary = 0)")
    if version not in (2.0, 2.1, 2.2, 4.1):
        raise InputError(
            f"{place}: format {version:g} is not read; 2.2 and 4.1 are (Mesh.MshFileVersion)"
        )
    return int(version)


def _names(mesh: _Mesh, lines: _Lines) -> None:
    for _ in range(int(lines.numbers()[0])):
        place, text = lines.place, lines.text()
        words = text.split(None, 2)
        if len(words) < 3 or not (words[0].isdigit() and words[1].isdigit()):
            raise InputError(f"{place}: must be dimension, number and name; got {text[:40]!r}")
        mesh.names[int(words[0]), int(words[1])] = words[2].strip().strip('"')


def _entities(mesh: _Mesh, lines: _Lines) -> None:
    counts = [int(n) for n in lines.numbers(4)]
    for dimension, n in enumerate(counts):
        at = 4 if dimension == 0 else 7  # behind a point's place, or a box
        for _ in range(n):
            place, row = lines.place, lines.numbers(at + 1)
            many = int(row[at])
            if many < 0 or len(row) < at + 1 + many:
                raise InputError(f"{place}: says {many} physical groups, and does not name them")
            groups = tuple(abs(int(one)) for one in row[at + 1 : at + 1 + many])
            mesh.physical[dimension, int(row[0])] = groups


def _nodes_2(mesh: _Mesh, lines: _Lines) -> None:
    table = lines.table(_count(lines), 4)
    lines.ended()
    if len(table) and (np.any(table[:, 0] != np.round(table[:, 0])) or table[:, 0].min() < 1):
        raise InputError(f"{lines.place}: a node's number must be whole, and above 0")
    mesh.tags, mesh.places = table[:, 0].astype(np.int64), table[:, 1:]


def _nodes_4(mesh: _Mesh, lines: _Lines) -> None:
    blocks, tags, places = int(lines.numbers(4)[0]), [], []
    for _ in range(blocks):
        place, (_, _, parametric, n) = lines.place, lines.numbers(4)[:4]
        if parametric:
            raise InputError(f"{place}: parametric nodes are not read (Mesh.SaveParametric = 0)")
        tags.append(lines.wholes(int(n), 1)[:, 0])
        places.append(lines.table(int(n), 3))
    lines.ended()
    if tags:
        mesh.tags, mesh.places = np.concatenate(tags), np.concatenate(places)


def _count(lines: _Lines) -> int:
    place, n = lines.place, lines.numbers()[0]
    if n < 0 or n != int(n):
        raise InputError(f"{place}: must be a number of lines; got {n:g}")
    return int(n)


def _why_unread(kind: int, place: str) -> str:
    what = _REFUSED[kind][1] if kind in _REFUSED else f"elements of type {kind}"
    remedy = " (Mesh.ElementOrder = 1)" if "second order" in what else ""
    return (
        f"{place}: {what} are not read; points, lines, triangles and quadrilaterals of first order "
        f"are{remedy}"
    )


def _elements_4(mesh: _Mesh, lines: _Lines) -> None:
    blocks = int(lines.numbers(4)[0])
    for _ in range(blocks):
        place, (dimension, entity, kind, n) = lines.place, lines.numbers(4)[:4]
        groups = mesh.physical.get((int(dimension), int(entity)), ())
        if kind not in _CORNERS:
            mesh.unread.append((int(dimension), groups, _why_unread(int(kind), place)))
            lines.skip(int(n))
            continue
        corners = _CORNERS[int(kind)]
        table = lines.wholes(int(n), 1 + corners)
        mesh.blocks.append((corners, groups, table[:, 1:]))
    lines.ended()


def _elements_2(mesh: _Mesh, lines: _Lines) -> None:
    """Take elements: number, type, number of tags, tags (the first its group), nodes."""
    n = _count(lines)
    rows, first = lines.rest()
    if len([row for row in rows if row.strip()]) != n:
        raise InputError(f"{lines.place}: says {n} elements, and has {len(rows)}")
    found: dict[tuple[int, tuple[int, ...]], list[list[int]]] = defaultdict(list)
    for i, row in enumerate(rows[:n]):
        place = f"{lines.place.rpartition(' ')[0]} {first + i}"
        try:
            words = [int(word) for word in row.split()]
            kind, tags = words[1], words[3 : 3 + words[2]]
        except (ValueError, IndexError):
            raise InputError(f"{place}: must be an element; got {row[:40]!r}") from None
        group = tuple(tags[:1]) if tags and tags[0] else ()
        if kind not in _CORNERS:
            dimension = _REFUSED[kind][0] if kind in _REFUSED else 3
            mesh.unread.append((dimension, group, _why_unread(kind, place)))
            continue
        corners, nodes = _CORNERS[kind], words[3 + len(tags) :]
        if len(nodes) != corners:
            raise InputError(f"{place}: has {len(nodes)} nodes, and its type {corners}")
        found[corners, group].append(nodes)
    mesh.blocks = [(corners, group, np.array(one)) for (corners, group), one in found.items()]


def _grouped(mesh: _Mesh, name: str) -> GroupedMesh:
    order = np.argsort(mesh.tags, kind="stable")
    tags = mesh.tags[order]
    if len(tags) == 0:
        raise InputError(f"{name}: has no nodes")
    if np.any(np.diff(tags) == 0):
        raise InputError(
            f"{name}: node {tags[np.flatnonzero(np.diff(tags) == 0)[0]]} is there twice"
        )
    found: dict[tuple[str, int], list[Array]] = defaultdict(list)
    for corners, groups, nodes in mesh.blocks:
        at = np.minimum(np.searchsorted(tags, nodes), len(tags) - 1)
        if not np.array_equal(tags[at], nodes):
            raise InputError(
                f"{name}: an element names node {nodes[tags[at] != nodes][0]}, which is not there"
            )
        dimension = _DIMENSION[corners]
        for group in groups or (0,):
            word = mesh.name_of(dimension, group)
            found[word, corners].append(order[at])
    grouped: dict[str, tuple[Array, ...]] = {}
    for (word, _), blocks in found.items():
        grouped[word] = (*grouped.get(word, ()), np.concatenate(blocks))
    return GroupedMesh(nodes=mesh.places, groups=grouped)

"""Universal files of modes: units (164), nodes (2411), elements (2412), shapes (55).

Reference: Structural Dynamics Research Corporation, Universal file datasets 55, 164, 2411, 2412.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from trundle._typing import Array
from trundle.exports.cells import cells_of, shapes_at_nodes
from trundle.exports.export_format import ExportFormat, Subject

__all__ = ["EXPORT"]

_KINDS = {3: 91, 4: 94}  # thin triangles and quadrilaterals


def write(subject: Subject, stem: str) -> Mapping[str, bytes]:
    """Return the modes; shapes are scaled to unit modal mass, which each of them states.

    Parameters
    ----------
    subject : Subject
        With modes.
    stem : str
        Title of every mode.
    """
    assert subject.modes is not None  # the format needs them
    nodes = subject.structure.nodes
    sets = [
        _dataset(164, [f"{1:10d}{'SI: Meter (newton)':20s}{2:10d}",
                       f"{1.0:25.17e}{1.0:25.17e}{1.0:25.17e}", f"{-273.15:25.17e}"]),
        _dataset(2411, _places(nodes)),
        _dataset(2412, _faces(subject)),
    ]  # fmt: skip
    shapes = shapes_at_nodes(subject.structure, subject.modes)
    for i, (shape, f) in enumerate(zip(shapes, subject.modes.frequencies.tolist(), strict=True), 1):
        sets.append(_dataset(55, _mode(stem, i, f, shape)))
    return {".uff": "".join(sets).encode()}


def _dataset(number: int, lines: Iterator[str] | list[str]) -> str:
    return "\n".join(["    -1", f"{number:6d}", *lines, "    -1"]) + "\n"


def _places(nodes: Array) -> Iterator[str]:
    for i, (x, y, z) in enumerate(nodes.tolist(), start=1):
        yield f"{i:10d}{0:10d}{0:10d}{8:10d}"
        yield f"{x:25.16e}{y:25.16e}{z:25.16e}"


def _faces(subject: Subject) -> Iterator[str]:
    number = 0
    for block in cells_of(subject.structure).blocks:
        kind = _KINDS.get(block.shape[1])
        for corners in block.tolist() if kind else ():
            number += 1
            yield f"{number:10d}{kind:10d}{1:10d}{1:10d}{7:10d}{len(corners):10d}"
            yield "".join(f"{corner + 1:10d}" for corner in corners)


def _mode(title: str, number: int, frequency: float, shape: Array) -> Iterator[str]:
    yield from [f"{title[:70]}, mode {number}", *["NONE"] * 4]
    yield f"{1:10d}{2:10d}{3:10d}{8:10d}{2:10d}{6:10d}"  # normal mode, displacement, six a node
    yield f"{2:10d}{4:10d}{1:10d}{number:10d}"
    yield f"{frequency:13.5e}{1.0:13.5e}{0.0:13.5e}{0.0:13.5e}"
    for i, motion in enumerate(np.where(np.abs(shape) < 1e-99, 0.0, shape).tolist(), start=1):
        yield f"{i:10d}"
        yield "".join(f"{value:13.5e}" for value in motion)


EXPORT = ExportFormat(
    kind="uff",
    name="universal file of modes (dataset 55)",
    suffix=".uff",
    needs=("modes",),
    write=write,
)

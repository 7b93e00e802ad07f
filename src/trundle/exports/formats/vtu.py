"""ParaView's unstructured grids: mesh and modes in one file.

Reference: Kitware, VTK file formats (XML UnstructuredGrid, inline binary).
"""

from __future__ import annotations

import base64
from collections.abc import Iterator, Mapping
from html import escape

import numpy as np

from trundle._typing import Array
from trundle.exports.cells import Cells, cells_of, shapes_at_nodes
from trundle.exports.export_format import ExportFormat, Subject

__all__ = ["EXPORT", "grid_of"]

_KINDS = {1: 1, 2: 3, 3: 5, 4: 9}  # vertex, line, triangle, quad
_TYPES = {"f4": "Float32", "f8": "Float64", "i4": "Int32", "i8": "Int64", "u1": "UInt8"}


def write(subject: Subject, stem: str) -> Mapping[str, bytes]:
    """Return a grid, with motion and rotations of its modes.

    Parameters
    ----------
    subject : Subject
        With modes or without.
    stem : str
        Not used.
    """
    del stem
    mesh = cells_of(subject.structure)
    nodes = subject.structure.nodes
    data: dict[str, Array] = {}
    if subject.modes is not None:
        shapes = shapes_at_nodes(subject.structure, subject.modes)
        for i, (shape, f) in enumerate(zip(shapes, subject.modes.frequencies, strict=True), 1):
            data[f"mode {i}, {f:.4f} Hz"] = shape[:, :3].astype("f4")
            data[f"mode {i}, rotations"] = shape[:, 3:].astype("f4")
    return {".vtu": grid_of(nodes, mesh, data)}


def grid_of(nodes: Array, mesh: Cells, data: Mapping[str, Array]) -> bytes:
    """Return a grid with data at its nodes, by name.

    Parameters
    ----------
    nodes : ndarray of float, shape (n_nodes, 3)
        Places [m].
    mesh : Cells
        Elements between them.
    data : mapping of str to ndarray, shape (n_nodes, n)
        What is at them.
    """
    corners = [block.shape[1] for block in mesh.blocks]
    counts = [len(block) for block in mesh.blocks]
    flat = [block.ravel() for block in mesh.blocks]
    connectivity = np.concatenate(flat) if flat else np.zeros(0)
    offsets = np.cumsum(np.repeat(corners, counts)) if flat else np.zeros(0)
    types = np.repeat([_KINDS[n] for n in corners], counts)
    which = np.repeat(np.arange(len(counts)), counts)
    names = "\n".join(f"{i}: {name}" for i, name in enumerate(mesh.groups))
    parts = [
        '<?xml version="1.0"?>\n',
        '<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" '
        'header_type="UInt64">\n',
        f"<!-- groups:\n{escape(names).replace('--', '- -')}\n-->\n",
        "<UnstructuredGrid>\n",
        f'<Piece NumberOfPoints="{len(nodes)}" NumberOfCells="{sum(counts)}">\n<Points>\n',
        _array("points", nodes.astype("f8")),
        "</Points>\n<Cells>\n",
        _array("connectivity", connectivity.astype("i8")),
        _array("offsets", offsets.astype("i8")),
        _array("types", types.astype("u1")),
        "</Cells>\n<CellData>\n",
        _array("group", which.astype("i4")),
        "</CellData>\n<PointData>\n",
        *_arrays(data),
        "</PointData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n",
    ]
    return "".join(parts).encode()


def _arrays(data: Mapping[str, Array]) -> Iterator[str]:
    for name, values in data.items():
        yield _array(name, values)


def _array(name: str, values: Array) -> str:
    """Return an array as inline binary: its length in bytes, and it, in base 64."""
    little = np.ascontiguousarray(values).astype(values.dtype.newbyteorder("<"))
    raw = little.tobytes()
    coded = base64.b64encode(len(raw).to_bytes(8, "little") + raw).decode()
    kind = _TYPES[f"{values.dtype.kind}{values.dtype.itemsize}"]
    columns = f' NumberOfComponents="{values.shape[1]}"' if values.ndim > 1 else ""
    label = escape(name, quote=True)
    return f'<DataArray type="{kind}" Name="{label}"{columns} format="binary">{coded}</DataArray>\n'


EXPORT = ExportFormat(kind="vtu", name="ParaView grid", suffix=".vtu", uses=("modes",), write=write)

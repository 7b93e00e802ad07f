"""Read a structure's matrices as Matrix Market files, and the table of its nodes.

Reference: R. F. Boisvert, R. Pozo, K. A. Remington, The Matrix Market exchange formats, NISTIR
5935 (1996).
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import TextIO

import numpy as np
from scipy import sparse

from trundle._typing import Array, SparseMatrix
from trundle.errors import InputError, Problem
from trundle.imports.guard import guarded
from trundle.imports.known_nodes import DOFS, faces_of, read_nodes
from trundle.imports.model_format import ReadModel
from trundle.imports.number_tables import NumberTable, read_table
from trundle.imports.stand_on import SurfaceChoice, surfaces_of
from trundle.imports.unit_system import Units
from trundle.structure import MatrixModel

__all__ = ["read_matrices"]

_LARGEST = 2_000_000_000  # bytes
_MOST = 10_000_000  # rows
_UNEVEN = 1e-6  # of the largest entry, by which a matrix may differ from its transpose


def read_matrices(
    *,
    stiffness: Path,
    mass: Path,
    nodes: Path,
    units: Units,
    elements: Path | None = None,
    surfaces: Sequence[SurfaceChoice] = (),
) -> ReadModel:
    """Read both matrices and the nodes into SI.

    Parameters
    ----------
    stiffness, mass : Path
        Matrix Market files, in coordinates, real, symmetric or general.
    nodes : Path
        Table with columns node, x, y, z, and the row of each dof in the matrices, from 1 on, in
        columns ux, uy, uz, rx, ry, rz; an empty cell or 0 for a dof that has none. Without any
        of them, rows are those of the nodes in their order, six each or three.
    units : Units
        Of places and matrices.
    elements : Path, optional
        Table of faces between nodes, see `faces_of`.
    surfaces : sequence of SurfaceChoice
        What is stood on; none for all levels.
    """
    files = tuple(path for path in (nodes, stiffness, mass, elements) if path is not None)
    try:
        with guarded(stiffness.name):
            k, m = _matrix(stiffness), _matrix(mass)
        if k.shape != m.shape:
            raise InputError(
                f"{stiffness.name} has {k.shape[0]} rows, and {mass.name} {m.shape[0]}"
            )
        table = read_table(nodes)
        known = read_nodes(table, units.length)
        if len(known.labels) != len(table):
            raise InputError(f"{table.name}: a node stands in it twice")
        rows = _rows(table, k.shape[0])
        scale = _scale(rows, k.shape[0], units)
        smooth = bool((rows[:, 3:5] >= 0).any())
        faces, told = faces_of(
            known, elements, smooth=smooth, known=np.flatnonzero(rows[:, 2] >= 0)
        )
        model = MatrixModel(
            nodes=known.places,
            dof_index=rows,
            mass=_positive(_scaled(m, scale, units.mass), mass.name),
            stiffness=_positive(_scaled(k, scale, units.of(1, -1)), stiffness.name),
            faces=faces,
            decks=surfaces_of(known.places, faces, surfaces),
            name=stiffness.stem,
        )
    except InputError as error:
        problem = Problem(
            place=nodes.name, value="the model", rule=str(error), remedy="docs/models.md"
        )
        return ReadModel(structure=None, problems=(problem,), files=files)
    return ReadModel(structure=model, units=units, told=told, files=files)


def _matrix(path: Path) -> SparseMatrix:
    """Read a real symmetric matrix.

    Raises
    ------
    InputError
        No such file, none of Matrix Market, or one that is not symmetric or not finite.
    """
    try:
        if not path.is_file():
            raise InputError(f"{path}: no such file")
        if path.stat().st_size > _LARGEST:
            raise InputError(f"{path}: a matrix may have {_LARGEST / 1e9:g} GB")
        found = _entries(path)
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror})") from None
    if not np.isfinite(found.data).all():
        raise InputError(f"{path.name}: holds a number that is not finite")
    uneven = float(abs(found - found.T).max())
    if uneven > _UNEVEN * float(abs(found).max()):
        raise InputError(
            f"{path.name}: must be symmetric, and differs from its transpose by {uneven:.3g}; if "
            "one half was written, say 'symmetric' in its first line"
        )
    return sparse.csc_array(0.5 * (found + found.T))


def _size(opened: TextIO, name: str) -> tuple[int, int, str]:
    """Read the header of a matrix; return its rows, its entries, and its symmetry."""
    words = opened.readline().split()
    if not words or words[0] != "%%MatrixMarket":
        raise InputError(f"{name}, line 1: must begin with %%MatrixMarket")
    if [w.lower() for w in words[1:3]] != ["matrix", "coordinate"] or len(words) != 5:
        raise InputError(f"{name}, line 1: a matrix in coordinates is read")
    kind, symmetry = (word.lower() for word in words[3:])
    if kind not in {"real", "integer"}:
        raise InputError(f"{name}, line 1: must be a real matrix; it is {kind}")
    if symmetry not in {"symmetric", "general"}:
        raise InputError(f"{name}, line 1: must be symmetric or general; it is {symmetry}")
    number, line = 1, "%"
    while line.startswith("%") or not line.strip():
        number, line = number + 1, opened.readline()
        if not line:
            raise InputError(f"{name}: ends before its size")
    size = line.split()
    if len(size) != 3 or not all(word.isdigit() for word in size):
        raise InputError(f"{name}, line {number}: must be rows, columns and entries")
    n_rows, n_columns, n = map(int, size)
    if n_rows != n_columns:
        raise InputError(f"{name}: must be square; it is {n_rows} by {n_columns}")
    if not 0 < n_rows <= _MOST or n > 20 * _MOST:
        raise InputError(f"{name}: must have 1 to {_MOST:g} rows; it has {n_rows}")
    return n_rows, n, symmetry


def _entries(path: Path) -> SparseMatrix:
    """Read the entries of a matrix: a row, a column and a number a line, and nothing else."""
    import pandas as pd  # noqa: PLC0415 - a quarter of a second, for tables alone

    with path.open(encoding="utf-8", errors="replace") as opened:
        n_rows, n, symmetry = _size(opened, path.name)
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                table = pd.read_csv(
                    opened, sep=r"\s+", header=None, index_col=False, names=["i", "j", "value"],
                    dtype={"i": "int64", "j": "int64", "value": "float64"}, na_filter=False,
                    comment="%",
                )  # fmt: skip
        except (ValueError, Warning) as error:
            raise InputError(
                f"{path.name}: is no matrix that can be read ({str(error)[:120]})"
            ) from None
    if len(table) != n:
        raise InputError(f"{path.name}: is no matrix that can be read: {len(table)} of {n} entries")
    i, j = table["i"].to_numpy() - 1, table["j"].to_numpy() - 1
    if n and (min(i.min(), j.min()) < 0 or max(i.max(), j.max()) >= n_rows):
        raise InputError(f"{path.name}: an entry lies outside its {n_rows} rows")
    found = sparse.csc_array((table["value"].to_numpy(), (i, j)), shape=(n_rows, n_rows))
    if symmetry == "symmetric":
        found = found + sparse.tril(found, -1).T + sparse.triu(found, 1).T
    return sparse.csc_array(found)


def _rows(table: NumberTable, n_rows: int) -> Array:
    """Return the row of each dof of each row of the table, -1 for those that have none."""
    columns = [table.find(words) for words in DOFS]
    if all(column is None for column in columns):
        each = n_rows / len(table)
        if each not in (3.0, 6.0):
            raise InputError(
                f"{table.name}: has no columns ux .. rz, and {n_rows} rows of the matrices are "
                f"neither six nor three for each of {len(table)} nodes"
            )
        rows = np.full((len(table), 6), -1)
        rows[:, : int(each)] = np.arange(n_rows).reshape(len(table), -1)
        return rows
    empty = np.full(len(table), np.nan)
    given = np.column_stack([empty if one is None else one for one in columns])
    numbers = np.where(np.isnan(given), 0.0, given)
    wrong = (numbers != np.round(numbers)) | (numbers < 0) | (numbers > n_rows)
    if wrong.any():
        row, dof = np.argwhere(wrong)[0]
        raise InputError(
            f"{table.name}, line {table.lines[row]}: row {numbers[row, dof]:g} of "
            f"{DOFS[dof][0]} is none of the {n_rows} of the matrices"
        )
    rows = numbers.astype(int) - 1
    used, times = np.unique(rows[rows >= 0], return_counts=True)
    if np.any(times > 1):
        raise InputError(f"{table.name}: row {used[times > 1][0] + 1} belongs to two dofs")
    if len(used) < n_rows:
        free = np.setdiff1d(np.arange(n_rows), used)[0] + 1
        raise InputError(f"{table.name}: row {free} of the matrices belongs to no node")
    return rows


def _scale(rows: Array, n_rows: int, units: Units) -> Array:
    """Return one unit of each dof in SI: a length, or a radian, against a unit of length."""
    scale = np.ones(n_rows)
    turning = rows[:, 3:]
    scale[turning[turning >= 0]] = units.length
    return scale


def _scaled(matrix: SparseMatrix, scale: Array, unit: float) -> SparseMatrix:
    """Return a matrix in SI: entries of rotations carry a length each."""
    diagonal = sparse.diags_array(scale)
    return sparse.csc_array(unit * (diagonal @ matrix @ diagonal))


def _positive(matrix: SparseMatrix, name: str) -> SparseMatrix:
    diagonal = matrix.diagonal()
    if diagonal.min() < 0.0:
        row = int(diagonal.argmin()) + 1
        raise InputError(f"{name}: row {row} has a diagonal below 0")
    if not diagonal.max() > 0.0:
        raise InputError(f"{name}: has no entry on its diagonal")
    root = np.sqrt(diagonal)
    entries = matrix.tocoo()
    over = (
        np.abs(entries.data) > (1.0 + _UNEVEN) * root[entries.coords[0]] * root[entries.coords[1]]
    )
    if over.any():  # no such matrix is positive semidefinite
        row, column = (int(one[over][0]) + 1 for one in entries.coords)
        raise InputError(f"{name}: entry ({row}, {column}) is larger than its diagonals allow")
    return matrix

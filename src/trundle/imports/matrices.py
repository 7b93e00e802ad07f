"""Read a structure's matrices as Matrix Market files, and the table of its nodes.

Reference: R. F. Boisvert, R. Pozo, K. A. Remington, The Matrix Market exchange formats, NISTIR
5935 (1996).
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from scipy import sparse
from scipy.io import mmread

from trundle._typing import Array, SparseMatrix
from trundle.errors import InputError, Problem
from trundle.imports.known_nodes import DOFS, faces_of, read_nodes
from trundle.imports.model_format import ReadModel
from trundle.imports.number_tables import NumberTable, read_table
from trundle.imports.stand_on import SurfaceChoice, surfaces_of
from trundle.imports.unit_system import Units
from trundle.structure import MatrixModel

__all__ = ["read_matrices"]

_LARGEST = 8_000_000_000  # bytes
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
        with path.open("rb") as opened:
            if not opened.read(14).startswith(b"%%MatrixMarket"):
                raise InputError(f"{path.name}, line 1: must begin with %%MatrixMarket")
        found = sparse.csc_array(mmread(path, spmatrix=False))
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror})") from None
    except (ValueError, OverflowError, TypeError) as error:
        raise InputError(f"{path.name}: is no matrix that can be read ({error})") from None
    if found.dtype.kind not in "fi":
        raise InputError(f"{path.name}: must be a real matrix")
    found = found.astype(float)
    if found.shape[0] != found.shape[1]:
        raise InputError(f"{path.name}: must be square; it is {found.shape}")
    if not np.isfinite(found.data).all():
        raise InputError(f"{path.name}: holds a number that is not finite")
    uneven = float(abs(found - found.T).max())
    if uneven > _UNEVEN * float(abs(found).max()):
        raise InputError(
            f"{path.name}: must be symmetric, and differs from its transpose by {uneven:.3g}; if "
            "one half was written, say 'symmetric' in its first line"
        )
    return sparse.csc_array(0.5 * (found + found.T))


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
    if matrix.diagonal().min() < 0.0:
        row = int(matrix.diagonal().argmin()) + 1
        raise InputError(f"{name}: row {row} has a diagonal below 0")
    return matrix

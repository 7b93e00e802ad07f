"""Read modes of universal files: shapes of dataset 55, nodes of 15 and 2411, units of 164.

Reference: Structural Dynamics Research Corporation, Universal file datasets 15, 55, 164, 2411.
"""

from __future__ import annotations

import re
import warnings
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from trundle._typing import Array
from trundle.errors import InputError, Problem
from trundle.imports.guard import guarded
from trundle.imports.known_nodes import NodeTable, read_nodes
from trundle.imports.model_format import ReadModel
from trundle.imports.modes import GivenModes, modal_model
from trundle.imports.number_tables import read_table
from trundle.imports.stand_on import SurfaceChoice
from trundle.imports.unit_system import Units, agreed_units
from trundle.structure import FaceGroup

__all__ = ["is_universal", "read_universal_modes"]

_LARGEST = 2_000_000_000  # bytes
_NORMAL, _COMPLEX = 2, 3  # kinds of analysis of dataset 55
_READ = {15, 55, 164, 2411, 2412}
_REAL = 0.1  # largest share of a shape that may be off its one phase
_FACES = {41: 3, 42: 3, 44: 4, 45: 4, 91: 3, 92: 3, 94: 4, 95: 4, 74: 3}  # thin and plane elements
_BEGINS = re.compile(rb"^\s*-1[ \t]*\r?\n\s*\d{2,4}[ \t\r\n]")


def is_universal(first: bytes) -> bool:
    """Return whether a file is a universal one, by its first bytes."""
    return _BEGINS.match(first) is not None


def read_universal_modes(
    path: Path,
    *,
    units: Units | None = None,
    unit_mass: bool = False,
    reach: float | None = None,
    nodes: Path | None = None,
    elements: Path | None = None,
    surfaces: Sequence[SurfaceChoice] = (),
) -> ReadModel:
    """Read the modes of a universal file into SI.

    Parameters
    ----------
    path : Path
        The file.
    units : Units, optional
        Of its numbers, where it does not say them (dataset 164).
    unit_mass : bool
        Whether shapes are scaled to unit modal mass; needed where the file gives none.
    reach : float, optional
        Frequency below which these are all the modes [Hz]; that of the last unless given.
    nodes, elements : Path, optional
        Tables of them, where the file has none.
    surfaces : sequence of SurfaceChoice
        What is stood on; none for all levels.
    """
    files = tuple(one for one in (path, nodes, elements) if one is not None)
    try:
        with guarded(path.name):
            sets = _sets(path)
            taken, said = agreed_units(_stated(sets), units)
            odd = [one["type"] for one in sets if one.get("unread")]
            said += tuple(f"passed over: dataset {kind}" for kind in odd)
            where = (
                _nodes(sets, path, taken)
                if nodes is None
                else read_nodes(read_table(nodes), taken.length)
            )
            given, more = _modes(sets, where, path)
            faces = _faces(sets, where, given) if elements is None else ()
            model, told = modal_model(
                given, where, units=taken, unit_mass=unit_mass, reach=reach, surfaces=surfaces,
                elements=elements, name=path.stem, faces=faces,
            )  # fmt: skip
    except InputError as error:
        problem = Problem(
            place=path.name, value="the modes", rule=str(error), remedy="docs/models.md"
        )
        return ReadModel(structure=None, problems=(problem,), files=files)
    return ReadModel(structure=model, units=taken, told=(*said, *more, *told), files=files)


def _sets(path: Path) -> list[dict[str, Any]]:
    """Return the datasets of a file that are looked at."""
    try:
        import pyuff  # noqa: PLC0415 - an extra
    except ImportError:
        raise InputError("universal files need pyuff: pip install 'trundle[records]'") from None
    try:
        if not path.is_file():
            raise InputError(f"{path}: no such file")
        data = path.read_bytes() if path.stat().st_size <= _LARGEST else b""
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror})") from None
    if not is_universal(data[:400]):
        raise InputError(f"{path.name}: is no universal file")
    if sum(line.strip() == b"-1" for line in data.splitlines()) % 2:
        raise InputError(f"{path.name}: is cut short: its last dataset does not end")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            file = pyuff.UFF(str(path))
            kinds = [int(kind) for kind in file.get_set_types()]
            wanted = [i for i, kind in enumerate(kinds) if kind in _READ]
            sets = [file.read_sets(i) for i in wanted]
            odd = {kind for kind in kinds if kind not in _READ}
            sets += [{"type": kind, "unread": True} for kind in sorted(odd)]
    except Exception as error:  # its reader raises whatever its parsing meets
        told = str(error).replace(str(path), path.name) or type(error).__name__
        raise InputError(f"{path.name}: is a damaged universal file ({told[:120]})") from None
    return [one for one in sets if isinstance(one, dict)]


def _stated(sets: Sequence[dict[str, Any]]) -> Units | None:
    one = next((s for s in sets if s["type"] == 164), None)
    if one is None:
        return None
    length, force = float(one.get("length") or 0.0), float(one.get("force") or 0.0)
    if not (np.isfinite([length, force]).all() and length > 0.0 and force > 0.0):
        raise InputError(f"its units (dataset 164) have factors {length:g} and {force:g}")
    said = "N, m" if length == force == 1.0 else f"{1 / force:.6g} N, {1 / length:.6g} m"
    return Units(force=1.0 / force, length=1.0 / length, said=said)


def _nodes(sets: Sequence[dict[str, Any]], path: Path, units: Units) -> NodeTable:
    some = [one for one in sets if one["type"] in {15, 2411}]
    if not some:
        raise InputError("has no nodes (dataset 15 or 2411): give them as a table, nodes = ...")
    labels = np.concatenate([np.asarray(one["node_nums"]) for one in some])
    places = np.concatenate([np.column_stack([one[a] for a in "xyz"]) for one in some])
    turned = np.concatenate([np.asarray(one["disp_cs"]) for one in some])
    if np.any(turned != 0) and any(one["type"] == 55 for one in sets):
        node = labels[np.flatnonzero(turned)[0]]
        raise InputError(
            f"node {node:.0f} moves in a system of its own ({turned[turned != 0][0]:.0f}), which "
            "is not read: export shapes in the global system"
        )
    own = np.concatenate([np.asarray(one["def_cs"]) for one in some])
    if np.any(own > 1):  # 0 and 1 are the global system
        raise InputError(
            f"node {labels[np.flatnonzero(own > 1)[0]]:.0f} is placed in a system of its own "
            f"({own[own > 1][0]:.0f}), which is not read: export places in the global system"
        )
    names = np.array([str(int(one)) for one in labels])
    if len(set(names.tolist())) < len(names):
        raise InputError("a node stands in it twice")
    return NodeTable(labels=names, places=units.length * places.astype(float), name=path.name)


def _modes(
    sets: Sequence[dict[str, Any]], nodes: NodeTable, path: Path
) -> tuple[GivenModes, tuple[str, ...]]:
    """Return the modes of all datasets 55, and what was assumed."""
    some = [one for one in sets if one["type"] == 55]
    if not some:
        raise InputError("has no modes (dataset 55)")
    kinds = {int(one["analysis_type"]) for one in some}
    if not kinds <= {_NORMAL, _COMPLEX}:
        raise InputError(
            f"dataset 55 of analysis type {max(kinds)} is not read; modes, 2 and 3, are"
        )
    if other := {int(one["spec_data_type"]) for one in some} - {8}:
        raise InputError(
            f"dataset 55 holds data of type {min(other)}; shapes of displacement, 8, are read"
        )
    shapes = np.full((len(nodes.labels), 6, len(some)), np.nan)
    frequencies, masses, crooked = np.empty(len(some)), np.empty(len(some)), 0.0
    for i, one in enumerate(some):
        rows = nodes.rows(np.array([str(int(n)) for n in one["node_nums"]]), path.name)
        motion = np.column_stack([one[f"r{k}"] for k in range(1, 7) if f"r{k}" in one])
        scale, frequencies[i] = _mass(one), _frequency(one)
        real, off = _straight(motion)
        crooked = max(crooked, off)
        shapes[rows[:, None], np.arange(real.shape[1]), i] = real
        masses[i] = scale
    if crooked > _REAL:
        raise InputError(
            f"its shapes are complex: {100 * crooked:.0f} % of one is off its phase; give real ones"
        )
    still = np.nan_to_num(np.abs(shapes)).max(axis=(0, 2)) == 0.0
    shapes[:, still] = np.nan  # zero everywhere in every mode: not measured
    told = [f"complex shapes were taken by their real part: {100 * crooked:.2g} % is off"]
    known = np.all(masses > 0.0)
    return (
        GivenModes(frequencies=frequencies, masses=masses if known else None, shapes=shapes),
        tuple(told) if crooked > 0.0 else (),
    )


def _frequency(one: dict[str, Any]) -> float:
    if int(one["analysis_type"]) == _NORMAL:
        found = float(one["freq"])
    else:
        found = float(np.abs(one["eig"]) / (2.0 * np.pi))
    if not (np.isfinite(found) and found > 0.0):
        raise InputError(f"mode {one.get('mode_n')}: a frequency must be above 0; got {found:g} Hz")
    return found


def _mass(one: dict[str, Any]) -> float:
    """Return a mode's modal mass; 0 where the file gives none.

    Of a complex mode modal A is ``2 i omega_d m`` for one of proportional damping.
    """
    if int(one["analysis_type"]) == _NORMAL:
        return float(one.get("modal_m") or 0.0)
    size, damped = abs(complex(one.get("modal_a") or 0.0)), abs(float(np.imag(one["eig"])))
    return size / (2.0 * damped) if damped > 0.0 else 0.0


def _straight(motion: Array) -> tuple[Array, float]:
    """Return a shape turned to its own phase, real, and how much of it is off that phase."""
    if not np.iscomplexobj(motion):
        return motion.astype(float), 0.0
    phase = 0.5 * np.angle(np.sum(motion**2))
    turned = motion * np.exp(-1j * phase)
    size = float(np.linalg.norm(turned))
    off = float(np.linalg.norm(turned.imag)) / size if size > 0.0 else 0.0
    return np.ascontiguousarray(turned.real), off


def _elements(sets: Sequence[dict[Any, Any]]) -> Iterator[tuple[int, dict[str, Any]]]:
    """Give the elements of datasets 2412, each with its kind."""
    for one in sets:
        for kind, elements in one.items() if one["type"] == 2412 else ():
            for element in elements if isinstance(kind, int) else ():
                yield kind, element


def _faces(
    sets: Sequence[dict[str, Any]], nodes: NodeTable, given: GivenModes
) -> tuple[FaceGroup, ...]:
    """Return the plane elements of dataset 2412 between nodes whose motion is known."""
    known: Array = np.all(~np.isnan(given.shapes[:, 2]), axis=1)
    smooth = not bool(np.isnan(given.shapes[known][:, 3:5]).any())
    found: dict[int, list[Array]] = {3: [], 4: []}
    for kind, element in _elements(sets):
        corners = _FACES.get(kind, 0)
        names = np.array([str(n) for n in element["nodes_nums"][:corners]])
        rows = nodes.rows(names, nodes.name)
        if len(rows) == corners > 0 and bool(np.all(known[rows])):
            found[corners].append(rows)
    return tuple(
        FaceGroup(connectivity=np.array(rows), smooth=smooth, name=f"{corners} nodes")
        for corners, rows in found.items()
        if rows
    )

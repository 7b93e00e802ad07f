"""Read modes alone: frequencies, shapes at nodes, and modal masses, from tables.

A shape may be scaled in any way if its modal mass is told, or else to unit modal mass.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Float

from trundle._typing import Array
from trundle.errors import InputError, Problem
from trundle.imports.guard import guarded
from trundle.imports.known_nodes import DOFS, NODE, NodeTable, faces_of, read_nodes
from trundle.imports.model_format import ReadModel
from trundle.imports.number_tables import NumberTable, read_table
from trundle.imports.stand_on import SurfaceChoice, surfaces_of
from trundle.imports.unit_system import Units
from trundle.structure import FaceGroup, ModalModel

__all__ = ["GivenModes", "ModeFiles", "given_modes_of", "modal_model", "read_modes"]

MODE = ("mode", "stepnum", "mode_number", "mode_no", "step")
FREQUENCY = ("frequency", "freq", "f", "frequency_hz", "hz")
MASS = ("modal_mass", "generalized_mass", "generalised_mass", "gen_mass", "modalmass")
_HERTZ = {"", "hz", "1/s", "cyc/sec", "cycles/s", "cps", "s-1"}
_ABOVE = 1e-9  # relative, by which modes reach beyond the last of them


@dataclass(frozen=True, kw_only=True)
class ModeFiles:
    """Hold where modes stand.

    Attributes
    ----------
    frequencies : Path
        Table with columns mode, frequency [Hz] and, unless shapes are scaled to it, modal_mass.
    shapes : Path
        Table with columns node, mode and ux .. rz, or node and the vertical motion in columns
        mode_1, mode_2 ...; x, y, z may stand in it too.
    nodes : Path or None
        Table with columns node, x, y, z; None where `shapes` has them.
    elements : Path or None
        Table of faces between nodes.
    """

    frequencies: Path
    shapes: Path
    nodes: Path | None = None
    elements: Path | None = None


@dataclass(frozen=True, kw_only=True, eq=False)
class GivenModes:
    """Hold modes as a file has them.

    Attributes
    ----------
    frequencies : ndarray of float, shape (n_modes,)
        [Hz].
    masses : ndarray of float, shape (n_modes,), or None
        Modal masses, in the file's unit; None where none are given.
    shapes : ndarray of float, shape (n_nodes, 6, n_modes)
        Motion of each node; NaN where it is not known.
    """

    frequencies: Float[Array, " modes"]
    masses: Float[Array, " modes"] | None
    shapes: Float[Array, "nodes 6 modes"]


def read_modes(
    files: ModeFiles,
    *,
    units: Units,
    unit_mass: bool = False,
    reach: float | None = None,
    surfaces: Sequence[SurfaceChoice] = (),
) -> ReadModel:
    """Read modes from tables into SI.

    Parameters
    ----------
    files : ModeFiles
        Where they stand.
    units : Units
        Of places, of modal masses, and of what shapes are scaled to.
    unit_mass : bool
        Whether shapes are scaled to unit modal mass; needed where no modal mass is given.
    reach : float, optional
        Frequency below which these are all the modes [Hz]; that of the last unless given.
    surfaces : sequence of SurfaceChoice
        What is stood on; none for all levels.
    """
    named = (files.frequencies, files.shapes, files.nodes, files.elements)
    read = tuple(path for path in named if path is not None)
    try:
        with guarded(files.shapes.name):
            shapes = read_table(files.shapes)
            where = shapes if files.nodes is None else read_table(files.nodes)
            nodes = read_nodes(where, units.length)
            frequencies = read_table(files.frequencies)
            given = given_modes_of(frequencies, shapes, nodes)
            model, told = modal_model(
                given, nodes, units=units, unit_mass=unit_mass, reach=reach, surfaces=surfaces,
                elements=files.elements, name=files.shapes.stem,
            )  # fmt: skip
    except InputError as error:
        problem = Problem(
            place=files.shapes.name, value="the modes", rule=str(error), remedy="docs/models.md"
        )
        return ReadModel(structure=None, problems=(problem,), files=read)
    tables = {id(one): one for one in (where, shapes, frequencies)}.values()
    told += tuple(said for one in tables for said in one.unused)
    return ReadModel(structure=model, units=units, told=told, files=read)


def given_modes_of(frequencies: NumberTable, shapes: NumberTable, nodes: NodeTable) -> GivenModes:
    """Return the modes that two tables hold.

    Parameters
    ----------
    frequencies, shapes : NumberTable
        See `ModeFiles`.
    nodes : NodeTable
        Where they are.

    Raises
    ------
    InputError
        Columns that are missing, modes of one table that are not in the other, or a node's motion
        that stands there twice.
    """
    numbers = frequencies.whole(MODE)
    if len(np.unique(numbers)) < len(numbers):
        raise InputError(f"{frequencies.name}: a mode stands in it twice")
    found = frequencies.need(FREQUENCY)
    if (unit := frequencies.unit_of(FREQUENCY)) not in _HERTZ:
        raise InputError(f"{frequencies.name}: frequencies are read in Hz; these are in {unit!r}")
    masses = frequencies.find(MASS)
    if masses is not None and not np.all(masses > 0.0):
        row = frequencies.lines[np.flatnonzero(~(masses > 0.0))[0]]
        raise InputError(f"{frequencies.name}, line {row}: a modal mass must be above 0")
    if np.any(found <= 0.0):
        row = frequencies.lines[np.flatnonzero(found <= 0.0)[0]]
        raise InputError(
            f"{frequencies.name}, line {row}: a frequency must be above 0; of a body that nothing "
            "holds modes alone cannot be run"
        )
    given = _long(shapes, nodes, numbers) if shapes.find(MODE) is not None else None
    given = _wide(shapes, nodes, numbers) if given is None else given
    empty = np.isnan(given).all(axis=(0, 1))
    if empty.any():
        raise InputError(f"{shapes.name}: has no shape of mode {numbers[empty][0]}")
    return GivenModes(frequencies=found, masses=masses, shapes=given)


def _long(shapes: NumberTable, nodes: NodeTable, modes: Array) -> Array:
    """Return shapes of a table with a row for each node and mode."""
    at = nodes.rows(shapes.labels(NODE), shapes.name)
    order = np.argsort(modes, kind="stable")
    mode = shapes.whole(MODE)
    column = order[np.minimum(np.searchsorted(modes[order], mode), len(modes) - 1)]
    if wrong := np.flatnonzero(modes[column] != mode).tolist():
        raise InputError(
            f"{shapes.name}, line {shapes.lines[wrong[0]]}: mode {mode[wrong[0]]} has no frequency"
        )
    pairs = at * len(modes) + column
    if len(np.unique(pairs)) < len(pairs):
        raise InputError(f"{shapes.name}: a node stands twice in one mode")
    given = np.full((len(nodes.labels), 6, len(modes)), np.nan)
    motion = [shapes.find(words) for words in DOFS]
    if motion[2] is None:
        raise InputError(f"{shapes.name}: no column uz: nothing says how nodes move vertically")
    for dof, values in enumerate(motion):
        if values is not None:
            given[at, dof, column] = values
    return given


def _wide(shapes: NumberTable, nodes: NodeTable, modes: Array) -> Array:
    """Return the vertical shapes of a table with a column for each mode."""
    at = nodes.rows(shapes.labels(NODE), shapes.name)
    if len(np.unique(at)) < len(at):
        raise InputError(f"{shapes.name}: a node stands in it twice")
    given = np.full((len(nodes.labels), 6, len(modes)), np.nan)
    for i, number in enumerate(modes.tolist()):
        given[at, 2, i] = shapes.need((f"mode_{number}", f"mode{number}", str(number)))
    return given


def modal_model(
    given: GivenModes,
    nodes: NodeTable,
    *,
    units: Units,
    unit_mass: bool,
    reach: float | None,
    surfaces: Sequence[SurfaceChoice],
    elements: Path | None,
    name: str,
    faces: tuple[FaceGroup, ...] = (),
) -> tuple[ModalModel, tuple[str, ...]]:
    """Return a structure that is known by modes, in SI, and what was assumed.

    Parameters
    ----------
    given : GivenModes
        As their file has them.
    nodes : NodeTable
        Where they are.
    units : Units
        Of the file.
    unit_mass : bool
        Whether shapes are scaled to unit modal mass.
    reach : float or None
        Frequency below which they are all [Hz]; None for that of the last.
    surfaces : sequence of SurfaceChoice
        What is stood on.
    elements : Path or None
        Table of faces between nodes.
    name : str
        Of the structure.
    faces : tuple of FaceGroup
        Faces between nodes, where the modes' own file has them.

    Raises
    ------
    InputError
        Modes whose scale nothing tells, or nodes of which no vertical motion is known.
    """
    order = np.argsort(given.frequencies, kind="stable")
    frequencies = given.frequencies[order]
    scale = _scale(given, units, unit_mass=unit_mass)[order]
    index, shapes = _rows(given.shapes[:, :, order], units)
    last = float(frequencies[-1]) * (1.0 + _ABOVE)
    if reach is not None and reach < frequencies[0]:
        raise InputError(f"no mode lies below {reach:g} Hz; the first is at {frequencies[0]:g} Hz")
    known = np.flatnonzero(index[:, 2] >= 0)
    smooth = bool((index[known, 3:5] >= 0).all())
    told: tuple[str, ...] = ()
    if not faces:
        faces, told = faces_of(nodes, elements, smooth=smooth, known=known)
    stood_on = np.unique(np.concatenate([face.connectivity.ravel() for face in faces]))
    lost = stood_on[index[stood_on, 2] < 0]
    if lost.size:
        raise InputError(
            f"node {nodes.labels[lost[0]]} is stood on, and its vertical motion is not known"
        )
    for dof in (0, 1):  # known at some nodes alone, motion along it would be too small elsewhere
        if (index[stood_on, dof] < 0).any():
            index[:, dof] = -1
    decks = surfaces_of(nodes.places, faces, surfaces)
    for deck in decks:
        if deck.frame.normal[2] < 1.0 and (index[stood_on, :2] < 0).any():
            raise InputError(f"surface {deck.name!r} slopes, and level motion is not known")
    model = ModalModel(
        nodes=nodes.places,
        dof_index=index,
        omega=2.0 * np.pi * frequencies,
        shapes=shapes * scale,
        reach=last if reach is None else reach,
        faces=faces,
        decks=decks,
        name=name,
    )
    said = f"modes: {len(frequencies)}, {frequencies[0]:.4g} to {frequencies[-1]:.4g} Hz, taken to "
    return model, (f"{said}be all below {model.reach:.4g} Hz", *told)


def _scale(given: GivenModes, units: Units, *, unit_mass: bool) -> Array:
    """Return what turns the file's shapes into those of unit modal mass, (n_modes,)."""
    if given.masses is not None and unit_mass:
        if np.abs(given.masses - 1.0).max() < 1e-6:
            return np.full(len(given.masses), 1.0 / np.sqrt(units.mass))
        raise InputError(
            "modal masses are given, and are not 1: shapes cannot be scaled to unit mass too"
        )
    if given.masses is not None:
        return 1.0 / np.sqrt(given.masses * units.mass)
    if not unit_mass:
        raise InputError(
            "nothing tells the scale of the shapes: give modal masses, or say that they are scaled "
            'to unit modal mass: scaled_to = "unit mass"'
        )
    return np.full(len(given.frequencies), 1.0 / np.sqrt(units.mass))


def _rows(shapes: Float[Array, "nodes 6 modes"], units: Units) -> tuple[Array, Array]:
    """Return the row of each dof that is known in all modes, and the shapes at them."""
    known: Array = np.all(~np.isnan(shapes), axis=2)
    if np.any(np.any(~np.isnan(shapes), axis=2) & ~known):
        raise InputError("a node's motion is known in some modes and not in others: complete it")
    if not known[:, 2].any():
        raise InputError("no node's vertical motion is known")
    index = np.full(known.shape, -1, dtype=np.intp)
    index[known] = np.arange(np.count_nonzero(known))
    turning = np.broadcast_to(np.arange(6) > 2, known.shape)[known]
    rows = shapes[known] / np.where(turning, units.length, 1.0)[:, None]
    return index, rows

"""Take slabs, openings, columns, beams and walls of a building from the layers of drawings."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from trundle._typing import Array
from trundle.errors import FitnessWarning, InputError, Problem
from trundle.imports.drawing import Drawing, read_drawing
from trundle.structure.mesh.polygons import box_round, uncovered

__all__ = ["Drawn", "drawn_of", "line_on", "place_on"]

_SLIVER = 1e-3  # m2


@dataclass(frozen=True, kw_only=True, eq=False)
class Drawn:
    """Hold what drawings add to a building.

    Attributes
    ----------
    tables : mapping of str to tuple
        Tables of each kind, as if they stood in the file.
    places : mapping of (str, int) to str
        For each, where in the file it comes from, by its number among those of its kind.
    told : tuple of FitnessWarning
        What was left out of drawings.
    layers : mapping of str to (str or None, Drawing)
        For each layer, the storey and the drawing that it is of.
    """

    tables: Mapping[str, tuple[Any, ...]] = field(default_factory=dict[str, tuple[Any, ...]])
    places: Mapping[tuple[str, int], str] = field(default_factory=dict[tuple[str, int], str])
    told: tuple[FitnessWarning, ...] = ()
    layers: Mapping[str, tuple[str, Drawing]] = field(
        default_factory=dict[str, tuple[str, Drawing]]
    )


def drawn_of(
    section: Any, folder: Path, files: Mapping[str, Path], used: Collection[str]
) -> tuple[Drawn, list[Problem]]:
    """Read the drawings of a building, and return what they add to it.

    Parameters
    ----------
    section : BuildingSection
        With its drawings.
    folder : Path
        Where files are that the study names.
    files : mapping of str to Path
        Where they are, if not there.
    used : collection of str
        Layers that routes and points name.
    """
    tables = {k: list(getattr(section, k)) for k in ("slab", "column", "beam", "wall")}
    places: dict[tuple[str, int], str] = {}
    told: list[FitnessWarning] = []
    layers: dict[str, tuple[str, Drawing]] = {}
    problems: list[Problem] = []
    for i, one in enumerate(section.drawing, start=1):
        place = f"building.drawing[{i}]"
        try:
            path = files.get(one.file, folder / one.file)
            drawing = read_drawing(path, unit=one.unit, origin=one.origin)
        except InputError as error:
            problem = Problem(
                place=f"{place}.file", value=one.file, rule=str(error),
                remedy="docs/building.md says what is read of a drawing",
            )  # fmt: skip
            problems.append(problem)
            continue
        layers |= dict.fromkeys(drawing.layers, (one.on, drawing))
        for kind, where, table in _tables(one, drawing, place, problems):
            tables[kind].append(table)
            places[kind, len(tables[kind])] = where
        told += _left_out(one, drawing, used)
    return (
        Drawn(
            tables={kind: tuple(some) for kind, some in tables.items()},
            places=places,
            told=tuple(told),
            layers=layers,
        ),
        problems,
    )


def _tables(
    one: Any, drawing: Drawing, place: str, problems: list[Problem]
) -> Iterator[tuple[str, str, Any]]:
    """Give kind, place and table of everything that a drawing's named layers show."""
    makers = {"slab": _slabs, "column": _columns, "beam": _lines, "wall": _lines}
    openings = [ring for entry in one.opening for ring in drawing.outlines(entry.layer)]
    for kind, make in makers.items():
        for j, entry in enumerate(getattr(one, kind), start=1):
            where = f"{place}.{kind}[{j}]"
            made = list(make(entry, drawing, one.on, openings))
            if not made:
                problems.append(_empty(where, entry.layer, drawing))
            yield from ((kind, where, table) for table in made)
    for j, entry in enumerate(one.opening, start=1):
        if not drawing.outlines(entry.layer):
            problems.append(_empty(f"{place}.opening[{j}]", entry.layer, drawing))


def _empty(where: str, layer: str, drawing: Drawing) -> Problem:
    return Problem(
        place=f"{where}.layer",
        value=repr(layer),
        rule="this layer of the drawing shows nothing of the kind",
        remedy=f"layers with shapes: {', '.join(sorted(drawing.layers)) or 'none'}",
    )


def _slabs(entry: Any, drawing: Drawing, on: str, openings: list[Array]) -> Iterator[Any]:
    """Give an outline a slab, with the openings inside it."""
    for outline in drawing.outlines(entry.layer):
        inside = [o for o in openings if uncovered(o, (outline, ())) <= _SLIVER]
        yield entry.table(on=on, outline=_pairs(outline), openings=tuple(map(_pairs, inside)))


def _columns(entry: Any, drawing: Drawing, on: str, openings: list[Array]) -> Iterator[Any]:
    """Give a column for each outline, circle or point; an outline says how it is turned."""
    del on, openings
    for shape in drawing.layers.get(entry.layer, ()):
        long, short, angle = box_round(shape.points) if shape.closed else (1.0, 1.0, 0.0)
        turned = np.deg2rad(angle) if long > 1.02 * short else 0.0
        yield entry.table(at=(_pair(shape.centre),), angle=float(turned))


def _lines(entry: Any, drawing: Drawing, on: str, openings: list[Array]) -> Iterator[Any]:
    """Give a beam or a wall for each line."""
    del openings
    for shape in drawing.layers.get(entry.layer, ()):
        if not shape.closed and len(shape.points) > 1:
            yield entry.table(on=on, along=_pairs(shape.points))


def _pairs(points: Array) -> tuple[tuple[float, float], ...]:
    return tuple(_pair(point) for point in points)


def _pair(point: Array) -> tuple[float, float]:
    return round(float(point[0]), 6), round(float(point[1]), 6)


def _left_out(one: Any, drawing: Drawing, used: Collection[str]) -> Iterator[FitnessWarning]:
    """Tell layers that the study does not name, and kinds that are not understood."""
    kinds = ("slab", "opening", "column", "beam", "wall")
    named = {entry.layer for kind in kinds for entry in getattr(one, kind)}
    others = sorted(set(drawing.layers) - named - set(used))
    said = [f"layer {layer!r} ({len(drawing.layers[layer])} shapes)" for layer in others]
    said += [
        f"{n} {kind} on layer {layer!r}" for (layer, kind), n in sorted(drawing.left_out.items())
    ]
    if said:
        yield FitnessWarning(
            subject=one.file,
            message=f"not taken into the building: {', '.join(said)}",
        )


def line_on(drawn: Drawn, layer: str) -> tuple[str, tuple[tuple[float, float], ...]] | None:
    """Return the storey and the corners of the only line on a layer; None unless there is one."""
    on, drawing = drawn.layers.get(layer, ("", None))
    lines = [] if drawing is None else [s for s in drawing.layers[layer] if len(s.points) > 1]
    return (on, _pairs(lines[0].points)) if len(lines) == 1 else None


def place_on(drawn: Drawn, layer: str) -> tuple[str, tuple[float, float]] | None:
    """Return the storey and the middle of the only shape on a layer; None unless there is one."""
    on, drawing = drawn.layers.get(layer, ("", None))
    shapes = () if drawing is None else drawing.layers[layer]
    return (on, _pair(shapes[0].centre)) if len(shapes) == 1 else None

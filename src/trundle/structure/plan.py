"""Build a rectangular storey: slab, beams, columns above and below, edges."""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import pairwise
from typing import Literal, get_args

import numpy as np
from jaxtyping import Float

from trundle._checks import count, finite, frozen_array, non_negative, one_of, positive, set_frozen
from trundle._kinds import kinds_checked
from trundle._typing import Array
from trundle.errors import InputError
from trundle.structure.edges import EDGES, Edge, hold_edge, hold_plane, middle_of
from trundle.structure.elements import BeamGroup, ShellGroup
from trundle.structure.floor import Floor
from trundle.structure.links import RigidLinks
from trundle.structure.model import MirrorPlane
from trundle.structure.sections import BeamSection, Material, ShellSection

__all__ = ["FloorPlan", "Rectangle", "build_floor", "mesh_lines"]

_COLUMN_ELEMENTS = 4
_SNAP = 1e-6  # m
_CLOSEST = 0.05  # m between column lines


@dataclass(frozen=True, kw_only=True)
class Rectangle:
    """Hold a rectangular beam or column.

    Attributes
    ----------
    width : float
        Horizontal size across the member; for a column along global y [m].
    depth : float
        Vertical size; for a column along global x [m].
    """

    width: float
    depth: float

    def __post_init__(self) -> None:
        """Check both sizes."""
        set_frozen(self, width=positive("width", self.width), depth=positive("depth", self.depth))


@dataclass(frozen=True, kw_only=True, eq=False)
class FloorPlan:
    """Describe one rectangular storey of bays.

    Attributes
    ----------
    x_lines, y_lines : ndarray of float, shape (n_lines,)
        Column lines [m], rising; columns stand where they cross.
    x_extent, y_extent : tuple of float
        Range of the slab [m]; it may reach beyond the outer column lines.
    slab : ShellSection
        Slab and superimposed mass.
    material : Material
        Of beams and columns.
    beams_x, beams_y : Rectangle or None
        Main beams along x on every y line, and along y on every x line; they run over the
        whole extent.
    secondary_y : Rectangle or None
        Secondary beams along y, spaced evenly inside each x bay.
    secondary_per_bay : int
        How many of them in a bay.
    column : Rectangle or None
        Columns; without them the edges must hold the floor.
    storey_below, storey_above : float
        Column lengths to their fixed far ends [m]; 0 leaves that storey out.
    edges : dict of str to str
        ``free``, ``symmetry``, ``simple``, ``pinned`` or ``clamped`` for `EDGES`, see `Edge`;
        free unless named.
        Beams and columns on a symmetry edge get half their stiffness and mass.
    eccentric_beams : bool
        Beams hang below the slab (True) or lie in its mid-plane (False).
    column_heads : {"point", "rigid"}
        A column meets the slab at one node, as a needle would, or over its cross-section, which
        moves as a rigid body: without beams only the latter settles as the mesh is refined.
    name : str
        Name for reports.
    """

    x_lines: Float[Array, " x_lines"]
    y_lines: Float[Array, " y_lines"]
    x_extent: tuple[float, float]
    y_extent: tuple[float, float]
    slab: ShellSection
    material: Material
    beams_x: Rectangle | None = None
    beams_y: Rectangle | None = None
    secondary_y: Rectangle | None = None
    secondary_per_bay: int = 1
    column: Rectangle | None = None
    storey_below: float = 0.0
    storey_above: float = 0.0
    edges: dict[str, Edge] = field(default_factory=dict[str, Edge])
    eccentric_beams: bool = True
    column_heads: Literal["point", "rigid"] = "point"
    name: str = "storey"

    def __post_init__(self) -> None:
        """Check lines against the extent, heights, and the names of edges."""
        for axis in ("x", "y"):
            lines = frozen_array(f"{axis}_lines", getattr(self, f"{axis}_lines"), shape=(None,))
            low, high = (finite(f"{axis}_extent", v) for v in getattr(self, f"{axis}_extent"))
            if high <= low:
                raise InputError(f"{axis}_extent must rise; got {low:g} to {high:g} m")
            if np.any(np.diff(lines) < _CLOSEST):
                raise InputError(
                    f"{axis}_lines must rise without repeats, {_CLOSEST:g} m or more apart; "
                    f"got {lines.tolist()} m"
                )
            if lines.size and (lines[0] < low - _SNAP or lines[-1] > high + _SNAP):
                raise InputError(
                    f"{axis}_lines must lie inside {axis}_extent {low:g} to {high:g} m; "
                    f"got {lines[0]:g} to {lines[-1]:g} m"
                )
            set_frozen(self, **{f"{axis}_lines": lines, f"{axis}_extent": (low, high)})
        for edge, kind in self.edges.items():
            one_of("edge", edge, EDGES)
            one_of(f"edges.{edge}", kind, get_args(Edge))
        for name in ("storey_below", "storey_above"):
            set_frozen(self, **{name: non_negative(name, getattr(self, name))})
        count("secondary_per_bay", self.secondary_per_bay)
        one_of("column_heads", self.column_heads, ("point", "rigid"))

    @property
    def has_columns(self) -> bool:
        """Whether columns stand under or over the floor."""
        return self.column is not None and self.storey_below + self.storey_above > 0.0

    def held_edges(self) -> dict[str, tuple[int, float]]:
        """Return edges that cannot move up and down: across which axis (0, 1), and where [m]."""
        names, places = ("x_min", "x_max", "y_min", "y_max"), (*self.x_extent, *self.y_extent)
        lines = {name: (i // 2, float(places[i])) for i, name in enumerate(names)}
        held = ("simple", "pinned", "clamped")
        return {name: at for name, at in lines.items() if self.edges.get(name) in held}

    @property
    def secondary_lines(self) -> Float[Array, " lines"]:
        """Where the secondary beams stand along x [m]."""
        if self.secondary_y is None or len(self.x_lines) < 2:
            return np.zeros(0)
        shares = np.arange(1, self.secondary_per_bay + 1) / (self.secondary_per_bay + 1)
        starts, spans = self.x_lines[:-1], np.diff(self.x_lines)
        return (starts[:, None] + spans[:, None] * shares).ravel()


@kinds_checked
def build_floor(plan: FloorPlan, *, mesh_size: float) -> Floor:
    """Mesh a plan with rectangular shells no longer than a size.

    Parameters
    ----------
    plan : FloorPlan
        The storey.
    mesh_size : float
        Largest element edge [m]; mesh lines fall on every column and beam line.

    Returns
    -------
    Floor
        The slab's nodes come first, x running fastest; column nodes follow.

    Raises
    ------
    InputError
        A mesh size that is not positive, or beyond half a bay.
    """
    mesh_size = positive("mesh_size", mesh_size)
    x, y = mesh_lines(plan, mesh_size=mesh_size)
    grid = np.arange(len(x) * len(y)).reshape(len(y), len(x))
    slab_nodes = np.column_stack(
        [np.tile(x, len(y)), np.repeat(y, len(x)), np.zeros(len(x) * len(y))]
    )
    fixed = np.zeros((len(slab_nodes), 6), dtype=bool)
    mirrored = np.zeros_like(fixed)
    for edge, kind in plan.edges.items():
        hold_edge(fixed, _edge_nodes(grid, edge), edge, kind)
        if kind == "symmetry":
            hold_edge(mirrored, _edge_nodes(grid, edge), edge, kind)
    if "simple" in plan.edges.values() and not plan.has_columns:
        hold_plane(fixed, slab_nodes, middle_of((plan.x_extent, plan.y_extent), plan.edges))
    beams = _beams(plan, x, y, grid)
    columns, column_nodes, column_fixed = _columns(plan, x, y, grid, mirrored)
    corners = [grid[:-1, :-1], grid[:-1, 1:], grid[1:, 1:], grid[1:, :-1]]
    elements = np.stack([corner.ravel() for corner in corners], axis=1)
    return Floor(
        nodes=np.vstack([slab_nodes, column_nodes]),
        fixed=np.vstack([fixed, column_fixed]),
        shells=(ShellGroup(elements=elements, section=plan.slab),),
        beams=(*beams, *columns),
        links=_heads(plan, x, y, grid),
        mirrors=_mirrors(plan),
        name=plan.name,
    )


def mesh_lines(
    plan: FloorPlan, *, mesh_size: float
) -> tuple[Float[Array, " columns"], Float[Array, " rows"]]:
    """Return the lines of a plan's mesh along x and along y [m]; its nodes are their crossings."""
    return (
        _mesh_line(
            plan.x_extent, [plan.x_lines, plan.secondary_lines, _faces(plan, "x")], mesh_size
        ),
        _mesh_line(plan.y_extent, [plan.y_lines, _faces(plan, "y")], mesh_size),
    )


def _faces(plan: FloorPlan, axis: str) -> Array:
    """Return where the faces of columns that are joined over their cross-section stand [m]."""
    if plan.column is None or not plan.has_columns or plan.column_heads == "point":
        return np.zeros(0)
    lines, size = (
        (plan.x_lines, plan.column.depth) if axis == "x" else (plan.y_lines, plan.column.width)
    )
    low, high = plan.x_extent if axis == "x" else plan.y_extent
    both = np.concatenate([lines - 0.5 * size, lines + 0.5 * size])
    return both[(both > low) & (both < high)]


def _heads(plan: FloorPlan, x: Array, y: Array, grid: Array) -> tuple[RigidLinks, ...]:
    """Return the slab's nodes within each column, which follow the one on its axis."""
    if plan.column is None or not plan.has_columns or plan.column_heads == "point":
        return ()
    leads, behind = [], []
    for x_station in plan.x_lines:
        for y_station in plan.y_lines:
            head = int(grid[_at(y, y_station), _at(x, x_station)])
            within_x = np.abs(x - x_station) <= 0.5 * plan.column.depth + _SNAP
            within_y = np.abs(y - y_station) <= 0.5 * plan.column.width + _SNAP
            inside = grid[np.ix_(within_y, within_x)].ravel()
            follow = inside[inside != head]
            behind.append(follow)
            leads.append(np.full(len(follow), head))
    return (RigidLinks(leads=np.concatenate(leads), follows=np.concatenate(behind)),)


def _mirrors(plan: FloorPlan) -> tuple[MirrorPlane, ...]:
    places = (*plan.x_extent, *plan.y_extent)
    return tuple(
        MirrorPlane.across(0 if edge.startswith("x") else 1, place)
        for edge, place in zip(EDGES, places, strict=True)
        if plan.edges.get(edge) == "symmetry"
    )


def _mesh_line(extent: tuple[float, float], lines: list[Array], size: float) -> Array:
    hard = np.unique(np.round(np.concatenate([np.array(extent), *lines]) / _SNAP)) * _SNAP
    parts = [
        np.linspace(low, high, int(np.ceil((high - low) / size - _SNAP)) + 1)[:-1]
        for low, high in pairwise(hard)
    ]
    return np.concatenate([*parts, hard[-1:]])


def _at(line: Array, station: float) -> int:
    return int(np.argmin(np.abs(line - station)))


def _edge_nodes(grid: Array, edge: str) -> Array:
    sides = {"x_min": grid[:, 0], "x_max": grid[:, -1], "y_min": grid[0], "y_max": grid[-1]}
    return sides[edge]


def _beams(plan: FloorPlan, x: Array, y: Array, grid: Array) -> list[BeamGroup]:
    groups = []
    for station in plan.y_lines if plan.beams_x else ():
        on_mirror = _on_mirror(plan, "y", station)
        groups.append(_beam_group(plan, plan.beams_x, grid[_at(y, station)], on_mirror, "beam x"))
    for station in plan.x_lines if plan.beams_y else ():
        on_mirror = _on_mirror(plan, "x", station)
        groups.append(
            _beam_group(plan, plan.beams_y, grid[:, _at(x, station)], on_mirror, "beam y")
        )
    for station in plan.secondary_lines:
        row = grid[:, _at(x, station)]
        groups.append(_beam_group(plan, plan.secondary_y, row, False, "secondary y"))
    return groups


def _beam_group(
    plan: FloorPlan, size: Rectangle | None, row: Array, on_mirror: bool, name: str
) -> BeamGroup:
    assert size is not None  # the callers ask for a group only where a size is given
    section = BeamSection.rectangle(size.width, size.depth, plan.material)
    drop = -0.5 * (plan.slab.thickness + size.depth) if plan.eccentric_beams else 0.0
    return BeamGroup(
        elements=np.column_stack([row[:-1], row[1:]]),
        section=section.scaled(0.5) if on_mirror else section,
        offset=np.array([0.0, 0.0, drop]),
        name=name,
    )


def _on_mirror(plan: FloorPlan, axis: str, station: float) -> bool:
    low, high = plan.x_extent if axis == "x" else plan.y_extent
    sides = ((f"{axis}_min", low), (f"{axis}_max", high))
    return any(
        plan.edges.get(edge) == "symmetry" and abs(station - place) < _SNAP for edge, place in sides
    )


def _columns(
    plan: FloorPlan, x: Array, y: Array, grid: Array, mirrored: Array
) -> tuple[list[BeamGroup], Array, Array]:
    nodes, fixed, groups = [np.zeros((0, 3))], [np.zeros((0, 6), dtype=bool)], []
    next_node = grid.size
    column = plan.column
    heights = [h for h in (-plan.storey_below, plan.storey_above) if h and column]
    for x_station in plan.x_lines if column else ():
        for y_station in plan.y_lines:
            head = int(grid[_at(y, y_station), _at(x, x_station)])
            mirror = 0.5 ** (_on_mirror(plan, "x", x_station) + _on_mirror(plan, "y", y_station))
            for height in heights:
                new = np.arange(next_node, next_node + _COLUMN_ELEMENTS)
                next_node += _COLUMN_ELEMENTS
                z = height * np.arange(1, _COLUMN_ELEMENTS + 1) / _COLUMN_ELEMENTS
                nodes.append(
                    np.column_stack([np.full_like(z, x_station), np.full_like(z, y_station), z])
                )
                # A column on a mirror plane is held by it along its whole length.
                held = np.tile(mirrored[head], (_COLUMN_ELEMENTS, 1))
                held[-1] = True
                fixed.append(held)
                groups.append((np.column_stack([np.r_[head, new[:-1]], new]), mirror))
    if not groups or column is None:
        return [], nodes[0], fixed[0]
    # Local z of a vertical member is global x, so depth lies along x and width along y.
    section = BeamSection.rectangle(column.width, column.depth, plan.material)
    beams = [
        BeamGroup(
            elements=np.vstack([elements for elements, share in groups if share == wanted]),
            section=section.scaled(wanted),
            name="column",
        )
        for wanted in sorted({share for _, share in groups}, reverse=True)
    ]
    return beams, np.vstack(nodes), np.vstack(fixed)

"""Areas of SAP2000's tables: meshed as they say, into plates by their sections."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float, Int
from scipy.sparse import coo_array, csgraph
from scipy.spatial import cKDTree

from trundle._typing import Array
from trundle.errors import InputError
from trundle.imports.sap_joints import Joints
from trundle.imports.sap_makes import AreaMake, modified_area, used_make
from trundle.imports.sap_tables import Row, Table
from trundle.structure import OrthotropicSection, ShellGroup, TriangleGroup

__all__ = ["Area", "areas_placed", "cracks", "plates_of", "unjoined"]

_MERGED = 1e-5  # of the model's size: nodes of meshes nearer than that are one


@dataclass(frozen=True, kw_only=True, eq=False)
class Area:
    """Hold an area: its section, its local axis 1, and its elements."""

    name: str
    make: AreaMake
    section: str
    axis: tuple[float, float, float]
    elements: Int[Array, "elements corners"]


def areas_placed(
    joints: Joints, tables: Mapping[str, Table], makes: Mapping[str, AreaMake | InputError]
) -> list[Area]:
    """Return all areas with their elements; nodes that meshes add are joints' where those are.

    Parameters
    ----------
    joints : Joints
        Takes new nodes.
    tables : mapping of str to Table
        CONNECTIVITY - AREA and what is assigned to areas.
    makes : mapping of str to AreaMake
        Sections by name.

    Raises
    ------
    InputError
        An area without a section, of more corners than four, or meshed in another way.
    """
    connected = tables.get("CONNECTIVITY - AREA")
    if connected is None:
        return []
    sections = _by_area(tables.get("AREA SECTION ASSIGNMENTS"))
    meshes = _by_area(tables.get("AREA AUTO MESH ASSIGNMENTS"))
    angles = _by_area(tables.get("AREA LOCAL AXES ASSIGNMENTS 1 - TYPICAL"))
    modified = _by_area(tables.get("AREA STIFFNESS MODIFIERS"))
    for name, row in _by_area(tables.get("AREA EDGE CONSTRAINT ASSIGNMENTS")).items():
        if row.yes("Constrained", default=True):
            raise InputError(f"{row.place}: edge constraints (of area {name!r}) are not read")
    n_joints, found, seen = len(joints.places), list[Area](), set[str]()
    for row in connected.rows:
        name = row.text("Area")
        if name in seen:
            raise InputError(f"{row.place}: area {name!r} is there twice")
        seen.add(name)
        corners = _corners(joints, row)
        if name not in sections:
            raise InputError(f"{row.place}: area {name!r} has no section")
        section = sections[name].text("Section")
        if section.lower() == "none":
            continue
        make = used_make(makes, sections[name], section)
        if name in modified:
            make, section = modified_area(make, modified[name]), _changed(section, modified[name])
        angle = 0.0
        if name in angles:
            if angles[name].yes("AdvanceAxes"):
                raise InputError(f"{angles[name].place}: advanced axes are not read; an angle is")
            angle = angles[name].number("Angle", 0.0)
        elements = _meshed(joints, corners, meshes.get(name))
        axis = _axis(joints.at(corners), angle, row.place)
        found.append(Area(name=name, make=make, section=section, axis=axis, elements=elements))
    return _merged(joints, found, n_joints)


def plates_of(areas: list[Area]) -> tuple[list[ShellGroup], list[TriangleGroup]]:
    """Return the plates of areas, a group a section and direction."""
    some: dict[tuple[str, tuple[float, ...], int], list[Array]] = defaultdict(list)
    makes: dict[str, AreaMake] = {}
    for area in areas:
        some[area.section, area.axis, area.elements.shape[1]].append(area.elements)
        makes[area.section] = area.make
    shells, triangles = list[ShellGroup](), list[TriangleGroup]()
    for (name, axis, corners), blocks in some.items():
        section = makes[name].section
        if isinstance(section, OrthotropicSection):
            section = replace(section, axis=np.array(axis))
        elements = np.concatenate(blocks)
        if corners == 4:
            shells.append(ShellGroup(elements=elements, section=section, name=name))
        else:
            triangles.append(TriangleGroup(connectivity=elements, section=section, name=name))
    return shells, triangles


def cracks(joints: Joints, areas: list[Area]) -> Float[Array, "n 3"]:
    """Return where a corner of an area lies on the side of another that does not share it.

    Parameters
    ----------
    joints : Joints
        All nodes.
    areas : list of Area
        Meshed ones.
    """
    places, sides = np.array(joints.places), list[Array]()
    for area in areas:
        sides.append(
            np.stack([area.elements, np.roll(area.elements, -1, axis=1)], axis=2).reshape(-1, 2)
        )
    if not sides:
        return np.zeros((0, 3))
    both, times = np.unique(np.sort(np.concatenate(sides), axis=1), axis=0, return_counts=True)
    free = both[times == 1]
    used = np.unique(free)
    start, end = places[free[:, 0]], places[free[:, 1]]
    length = np.linalg.norm(end - start, axis=1)
    near = cKDTree(places[used]).query_ball_point(0.5 * (start + end), 0.5 * length * (1 - _MERGED))
    edge = np.repeat(np.arange(len(free)), [len(one) for one in near])
    node = used[np.concatenate([*near, []]).astype(int)]
    along = (end - start)[edge] / length[edge, None]
    gap = places[node] - start[edge]
    off = np.linalg.norm(gap - np.sum(gap * along, axis=1)[:, None] * along, axis=1)
    return places[np.unique(node[off < 1e-4 * length[edge]])]


def unjoined(joints: Joints, areas: list[Area], nodes: Int[Array, " nodes"]) -> Float[Array, "n 3"]:
    """Return where some nodes lie in the plane of an area, within it, and are none of its nodes.

    Parameters
    ----------
    joints : Joints
        All nodes.
    areas : list of Area
        Meshed ones.
    nodes : ndarray of int, shape (n_nodes,)
        Of frames.
    """
    places = np.array(joints.places)
    quads = [area.elements[:, [0, 1, 2, -1]] for area in areas]
    if not quads:
        return np.zeros((0, 3))
    every = np.concatenate(quads)
    free = np.setdiff1d(nodes, every)
    corners = places[every]
    middle = corners.mean(axis=1)
    reach = np.linalg.norm(corners - middle[:, None], axis=2).max()
    lost = list[int]()
    for node, near in zip(free, cKDTree(middle).query_ball_point(places[free], reach), strict=True):
        if len(near) and _inside(places[node], corners[near]).any():
            lost.append(int(node))
    return places[lost]


def _inside(place: Array, corners: Array) -> Array:
    """Return within which quadrilaterals a place lies, in their plane."""
    normal = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    size = np.linalg.norm(normal, axis=1)
    normal = normal / np.where(size > 0.0, size, 1.0)[:, None]
    off = np.abs(np.sum((place - corners[:, 0]) * normal, axis=1))
    sides = np.roll(corners, -1, axis=1) - corners
    across = np.cross(sides, place - corners)
    same = np.einsum("nkj,nj->nk", across, normal) >= -1e-9 * size[:, None]
    return same.all(axis=1) & (off < 1e-4 * np.sqrt(size))


def _by_area(table: Table | None) -> dict[str, Row]:
    return {} if table is None else {row.text("Area"): row for row in table.rows}


def _changed(section: str, row: Row) -> str:
    """Return what a section is called that is changed by modifiers of its area."""
    by = ", ".join(f"{k} {v}" for k, v in row.cells.items() if k != "area" and v not in {"1", "1."})
    return f"{section}, {by}" if by else section


def _corners(joints: Joints, row: Row) -> Array:
    n = row.whole("NumJoints")
    if n not in (3, 4):
        raise InputError(f"{row.place}: an area of {n} corners is not read; divide it into four")
    return np.array([joints.node(row.text(f"Joint{i}"), row.place) for i in range(1, n + 1)])


def _meshed(joints: Joints, corners: Array, mesh: Row | None) -> Array:
    """Return the elements of an area, as its automatic mesh says."""
    kind = "none" if mesh is None else mesh.text("MeshType", "None").lower()
    if mesh is None or kind in {"none", "no auto mesh", "default"}:
        return corners[None]
    if len(corners) != 4:
        raise InputError(f"{mesh.place}: a mesh of a triangle is not read; divide it")
    for key in ("SuppEdge", "SuppFace", "SubMesh", "LocalEdge", "LocalFace"):
        if mesh.yes(key):
            raise InputError(f"{mesh.place}: {key} is not read")
    at = joints.at(corners)
    if kind in {"num intervals", "number of objects", "numbers"}:
        n1, n2 = mesh.whole("Number1"), mesh.whole("Number2")
    elif kind in {"max size", "maximum size"}:
        along = [max(_side(at, 0, 1), _side(at, 3, 2)), max(_side(at, 0, 3), _side(at, 1, 2))]
        sizes = (mesh.number("MaxSize1"), mesh.number("MaxSize2"))
        n1, n2 = (
            max(1, int(np.ceil(a / s - 1e-9))) if s > 0.0 else 1
            for a, s in zip(along, sizes, strict=True)
        )
    else:
        raise InputError(
            f"{mesh.place}: a mesh by {kind!r} is not read; intervals and largest sizes are, or "
            "convert the areas to their mesh (Edit Areas > Divide Areas)"
        )
    if not (0 < n1 <= 1000 and 0 < n2 <= 1000):
        raise InputError(f"{mesh.place}: must be 1 to 1000 intervals; got {n1} and {n2}")
    return _grid(joints, corners, n1, n2)


def _side(at: Array, a: int, b: int) -> float:
    return float(np.linalg.norm(at[b] - at[a]))


def _grid(joints: Joints, corners: Array, n1: int, n2: int) -> Array:
    """Return n1 by n2 elements between four corners, with new nodes."""
    s, t = np.meshgrid(np.linspace(0, 1, n1 + 1), np.linspace(0, 1, n2 + 1), indexing="ij")
    at = joints.at(corners)
    weights = np.stack([(1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t], axis=-1)
    places = weights @ at
    first = len(joints.places)
    joints.places.extend(places.reshape(-1, 3))
    number = first + np.arange(s.size).reshape(s.shape)
    return np.stack(
        [number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]], axis=-1
    ).reshape(-1, 4)


def _merged(joints: Joints, areas: list[Area], n_joints: int) -> list[Area]:
    """Return areas whose new nodes are joints, or each other's, where they are at one place."""
    n = len(joints.places)
    if n == n_joints:
        return areas
    places = np.array(joints.places)
    within = _MERGED * float(np.ptp(places, axis=0).max())
    pairs = cKDTree(places).query_pairs(within, output_type="ndarray")
    pairs = pairs[pairs.max(axis=1) >= n_joints]  # joints of the file stay apart
    graph = coo_array((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(n, n))
    _, label = csgraph.connected_components(graph, directed=False)
    first = np.full(label.max() + 1, n)
    np.minimum.at(first, label, np.arange(n))
    to = np.where(np.arange(n) < n_joints, np.arange(n), first[label])
    kept = np.unique(to)
    number = np.full(n, -1)
    number[kept] = np.arange(len(kept))
    joints.places[:] = list(places[kept])
    return [replace(area, elements=number[to[area.elements]]) for area in areas]


def _axis(at: Float[Array, "corners 3"], angle: float, place: str) -> tuple[float, float, float]:
    """Return an area's local axis 1: 2 points up, or along Y where the area is level."""
    if len(at) == 4:
        normal = np.cross(at[2] - at[0], at[3] - at[1])
    else:
        normal = np.cross(at[1] - at[0], at[2] - at[0])
    size = float(np.linalg.norm(normal))
    if not size > 0.0:
        raise InputError(f"{place}: an area without extent")
    third = normal / size
    level = np.linalg.norm(third[:2]) < 1e-3
    up = np.array([0.0, 1.0, 0.0]) if level else np.array([0.0, 0.0, 1.0])
    first = np.cross(up, third)
    first /= np.linalg.norm(first)
    turn = np.deg2rad(angle)
    turned = np.cos(turn) * first + np.sin(turn) * np.cross(third, first)
    rounded = np.round(turned, 9) + 0.0
    return float(rounded[0]), float(rounded[1]), float(rounded[2])

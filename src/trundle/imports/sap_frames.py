"""Frames of SAP2000's tables: divided at joints, with releases, end offsets and insertion points.

Local axis 1 runs from I to J; 2 points up, along X where the frame stands; an angle turns 2 and 3
about 1. M3 bends in the plane of 1 and 2.
"""

from __future__ import annotations

import itertools
from collections import defaultdict
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int
from scipy.spatial import cKDTree

from trundle._typing import Array
from trundle.errors import InputError
from trundle.imports.sap_ends import insertion_of, releases_of, rigid_ends_of
from trundle.imports.sap_joints import Joints
from trundle.imports.sap_makes import FrameMake, modified_frame, used_make
from trundle.imports.sap_tables import Row, Table
from trundle.structure import BeamGroup
from trundle.structure.elements import ReleasedBeams

__all__ = ["FramePart", "beams_of", "frames_placed"]

_ON = 1e-5  # of the frame's length, by which a joint on it may be off
_UPRIGHT = 1e-3  # sine of the angle to Z below which a frame stands


@dataclass(frozen=True, kw_only=True, eq=False)
class FramePart:
    """Hold a frame, or a part of it between joints.

    Attributes
    ----------
    name : str
        Of the frame.
    nodes : tuple of int
        Both nodes that carry its mass.
    ends : tuple of int
        Both nodes between which it bends: others where ends are offset.
    length : float
        Between `nodes`, in the file's units.
    """

    name: str
    section: str
    make: FrameMake
    nodes: tuple[int, int]
    ends: tuple[int, int]
    up: tuple[float, float, float]
    offset: tuple[float, float, float]
    released: tuple[tuple[bool, ...], tuple[bool, ...]]
    length: float


def frames_placed(
    joints: Joints, tables: Mapping[str, Table], makes: Mapping[str, FrameMake | InputError]
) -> list[FramePart]:
    """Return all frames, divided as they say.

    Parameters
    ----------
    joints : Joints
        Takes new nodes.
    tables : mapping of str to Table
        CONNECTIVITY - FRAME and what is assigned to frames.
    makes : mapping of str to FrameMake
        Sections by name.

    Raises
    ------
    InputError
        A frame without a section or a length, or assignments that are not read.
    """
    connected = tables.get("CONNECTIVITY - FRAME")
    if connected is None:
        return []
    assigned = _Assigned(tables)
    tree, everywhere = cKDTree(np.array(joints.places)), np.array(joints.places)
    found, seen = list[FramePart](), set[str]()
    for row in connected.rows:
        if row.yes("IsCurved"):
            raise InputError(f"{row.place}: a curved frame is not read; divide it")
        name = row.text("Frame")
        if name in seen:
            raise InputError(f"{row.place}: frame {name!r} is there twice")
        seen.add(name)
        if assigned.is_nothing(name):
            continue
        ends = tuple(joints.node(row.text(key), row.place) for key in ("JointI", "JointJ"))
        length = float(np.linalg.norm(everywhere[ends[1]] - everywhere[ends[0]]))
        if not length > 0.0:
            raise InputError(f"{row.place}: frame {name!r} has no length")
        between = _on_it(tree, everywhere, ends, length) if assigned.at_joints(name) else []
        stations = _stations(assigned, name, length, between)
        line = _Line(
            name=name,
            place=row.place,
            ends=ends,
            length=length,
            nodes=[_node_at(joints, ends, share, node) for share, node in stations],
            shares=[share for share, _ in stations],
        )
        found += _parts(joints, assigned, makes, line)
    return found


@dataclass(frozen=True, kw_only=True)
class _Line:
    """A frame: its joints, the nodes that divide it, and their shares of its length."""

    name: str
    place: str
    ends: tuple[int, ...]
    length: float
    nodes: list[int]
    shares: list[float]


class _Assigned:
    """What tables assign to frames, by frame."""

    def __init__(self, tables: Mapping[str, Table]) -> None:
        def rows(*names: str) -> dict[str, Row]:
            """Return the rows of the first table that is there, by frame."""
            table = next((tables[name] for name in names if name in tables), None)
            return {} if table is None else {row.text("Frame"): row for row in table.rows}

        self.sections = rows("FRAME SECTION ASSIGNMENTS")
        self.angles = rows("FRAME LOCAL AXES ASSIGNMENTS 1 - TYPICAL")
        self.releases = rows("FRAME RELEASE ASSIGNMENTS 1 - GENERAL")
        self.offsets = rows(
            "FRAME OFFSET (LENGTH) ASSIGNMENTS", "FRAME OFFSET ALONG LENGTH ASSIGNMENTS"
        )
        self.insertions = rows("FRAME INSERTION POINT ASSIGNMENTS")
        self.meshes = rows("FRAME AUTO MESH ASSIGNMENTS")
        self.modifiers = rows("FRAME PROPERTY MODIFIERS")

    def is_nothing(self, name: str) -> bool:
        """Return whether a frame is a line alone, without a section."""
        row = self.sections.get(name)
        return row is not None and row.text("AnalSect", row.text("Section", "-")).lower() == "none"

    def at_joints(self, name: str) -> bool:
        """Return whether joints that lie on a frame divide it."""
        row = self.meshes.get(name)
        if row is None:
            return True
        if row.yes("AtFrames"):
            raise InputError(
                f"{row.place}: frames that divide each other without a joint are not read; divide "
                "them (Edit Lines > Divide Frames at intersections)"
            )
        return row.yes("AutoMesh", default=True) and row.yes("AtJoints", default=True)


def _on_it(
    tree: cKDTree, places: Array, ends: tuple[int, ...], length: float
) -> list[tuple[float, int]]:
    """Return the joints that lie on a frame between its ends, by their shares of its length."""
    start, along = places[ends[0]], places[ends[1]] - places[ends[0]]
    near = np.array(tree.query_ball_point(start + 0.5 * along, 0.5 * length * (1.0 + 1e-9)))
    gap = places[near] - start
    share = gap @ along / length**2
    off = np.linalg.norm(gap - share[:, None] * along, axis=1)
    some = (off < _ON * length) & (share > 2 * _ON) & (share < 1.0 - 2 * _ON)
    return sorted(zip(share[some].tolist(), near[some].tolist(), strict=True))


def _stations(
    assigned: _Assigned, name: str, length: float, between: list[tuple[float, int]]
) -> list[tuple[float, int]]:
    """Return where a frame is divided: ends, joints on it, equal parts; -1 for a new node."""
    row = assigned.meshes.get(name)
    n = 1
    if row is not None and row.yes("AutoMesh", default=True):
        n = max(row.whole("NumSegments", 0), 1)
        longest = row.number("MaxLength", 0.0)
        n = max(n, int(np.ceil(length / longest - 1e-9))) if longest > 0.0 else n
        if n > 1000:
            raise InputError(f"{row.place}: must be 1000 segments at most; got {n}")
    even = [(i / n, -1) for i in range(1, n)]
    taken = np.array([share for share, _ in between])
    even = [one for one in even if not len(taken) or np.abs(taken - one[0]).min() > 2 * _ON]
    return [(0.0, -2), *sorted(between + even), (1.0, -3)]


def _node_at(joints: Joints, ends: tuple[int, ...], share: float, node: int) -> int:
    if node == -2:
        return ends[0]
    if node == -3:
        return ends[1]
    if node >= 0:
        return node
    first, last = joints.places[ends[0]], joints.places[ends[1]]
    return joints.add(first + share * (last - first))


def _parts(
    joints: Joints, assigned: _Assigned, makes: Mapping[str, FrameMake | InputError], line: _Line
) -> Iterator[FramePart]:
    """Give the parts of a frame between the nodes that divide it."""
    section, make = _made(assigned, makes, line)
    frame = _frame(joints, line.ends, assigned.angles.get(line.name))
    first, last = insertion_of(assigned.insertions.get(line.name), make, frame)
    rigid = rigid_ends_of(assigned.offsets.get(line.name), line.length)
    released = releases_of(assigned.releases.get(line.name))
    same = bool(np.allclose(first, last, atol=1e-9 * line.length))

    def bending(i: int) -> int:
        """Return the node at which part i begins to bend: off its joint by what is rigid."""
        at = np.clip(line.shares[i] * line.length, rigid[0], line.length - rigid[1])
        out = (at - line.shares[i] * line.length) * frame[0]
        if not same:
            out = out + first + at / line.length * (last - first)
        return joints.behind(line.nodes[i], out * (np.linalg.norm(out) > 1e-9 * line.length))

    end = len(line.nodes) - 1
    inner = (rigid[0] < s * line.length < line.length - rigid[1] for s in line.shares)
    used = [i for i, bends in enumerate(inner) if bends or i in {0, end}]
    nodes = {i: bending(i) for i in used}
    for a, b in itertools.pairwise(used):
        yield FramePart(
            name=line.name,
            section=section,
            make=make,
            nodes=(line.nodes[a], line.nodes[b]),
            ends=(nodes[a], nodes[b]),
            up=_rounded(frame[1]),
            offset=_rounded(first if same else np.zeros(3)),
            released=(
                released[0] if a == 0 else (False,) * 3,
                released[1] if b == end else (False,) * 3,
            ),
            length=(line.shares[b] - line.shares[a]) * line.length,
        )


def _made(
    assigned: _Assigned, makes: Mapping[str, FrameMake | InputError], line: _Line
) -> tuple[str, FrameMake]:
    row = assigned.sections.get(line.name)
    if row is None:
        raise InputError(f"{line.place}: frame {line.name!r} has no section")
    name = row.text("AnalSect", row.text("Section", "-"))
    make = used_make(makes, row, name)
    if line.name in assigned.modifiers:
        by = assigned.modifiers[line.name]
        cells = (f"{k} {v}" for k, v in by.cells.items() if k != "frame" and v not in {"1", "1."})
        return ", ".join([name, *cells]), modified_frame(make, by)
    return name, make


def _rounded(vector: Array) -> tuple[float, float, float]:
    x, y, z = (np.round(vector, 12) + 0.0).tolist()
    return x, y, z


def _frame(joints: Joints, ends: tuple[int, ...], angle: Row | None) -> Float[Array, "3 3"]:
    """Return local axes 1, 2 and 3 of a frame, as rows."""
    along = joints.places[ends[1]] - joints.places[ends[0]]
    first = along / np.linalg.norm(along)
    stands = np.linalg.norm(first[:2]) < _UPRIGHT
    up = np.array([1.0, 0.0, 0.0]) if stands else np.array([0.0, 0.0, 1.0])
    second = up - (up @ first) * first
    second /= np.linalg.norm(second)
    if angle is not None:
        if angle.yes("MirrorAbt2") or angle.yes("MirrorAbt3"):
            raise InputError(f"{angle.place}: mirrored axes are not read")
        if angle.yes("AdvanceAxes"):
            raise InputError(f"{angle.place}: advanced axes are not read; an angle is")
        turn = np.deg2rad(angle.number("Angle", 0.0))
        second = np.cos(turn) * second + np.sin(turn) * np.cross(first, second)
    return np.array([first, second, np.cross(first, second)])


def beams_of(parts: list[FramePart]) -> tuple[list[BeamGroup], list[ReleasedBeams]]:
    """Return the beams of frames, a group for all that are alike."""
    some: dict[tuple[object, ...], list[FramePart]] = defaultdict(list)
    for part in parts:
        some[part.section, part.up, part.offset, part.released].append(part)
    beams, released = list[BeamGroup](), list[ReleasedBeams]()
    for alike in some.values():
        one = alike[0]
        elements: Int[Array, "elements 2"] = np.array([part.ends for part in alike])
        group = BeamGroup(
            elements=elements,
            section=one.make.section,
            offset=np.array(one.offset),
            up=np.array(one.up),
            name=one.section,
        )
        pins = np.array(one.released)
        if pins.any():
            released.append(ReleasedBeams(beams=group, released=pins))
        else:
            beams.append(group)
    return beams, released

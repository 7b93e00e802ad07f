"""Nastran bulk data: a model as it is solved here, so that any other program can check it.

Masses are consistent (PARAM COUPMASS 1); fields are large, with ten digits. Lengths in m, forces
in N, masses in kg.

Reference: MSC Nastran 2021 Quick Reference Guide, bulk data entries.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from trundle._typing import Array
from trundle.errors import InputError
from trundle.exports.export_format import ExportFormat, Subject
from trundle.structure import (
    BeamGroup,
    BeamSection,
    Floor,
    Material,
    OrthotropicSection,
    PointMasses,
    RigidLinks,
    ShellGroup,
    ShellSection,
    SpringGroup,
    TriangleGroup,
)
from trundle.structure.elements import GROUND, Elements, NodeInertia, ReleasedBeams
from trundle.structure.frames import beam_frames

__all__ = ["EXPORT"]

_SHEAR = 5.0 / 6.0


class _Writer:
    """Writes the cards of a floor, with numbers of their own for all that needs one."""

    def __init__(self, floor: Floor) -> None:
        self._floor = floor
        self._numbers: dict[str, int] = {}
        self._materials: dict[Material, int] = {}
        self.lines: list[str] = []

    def next(self, kind: str) -> int:
        """Return the next number of a kind."""
        self._numbers[kind] = self._numbers.get(kind, 0) + 1
        return self._numbers[kind]

    def card(self, name: str, *fields: Any) -> None:  # noqa: ANN401 - numbers, words, blanks
        """Write a card in large fields, four a line."""
        cells = [_field(one) for one in fields]
        while cells and not cells[-1].strip():
            cells.pop()
        rows = [cells[i : i + 4] for i in range(0, max(len(cells), 1), 4)]
        rows += [[]] * (len(rows) % 2)  # both halves of a card's line
        for i, row in enumerate(rows):
            head = f"{name}*" if i == 0 else "*"
            self.lines.append(f"{head:<8}{''.join(row)}".rstrip())

    def angle(self, node: int) -> float:
        """Return by how much the axes along which a node is held are turned about z [rad]."""
        angles = self._floor.angles
        return 0.0 if angles is None else float(angles[node, 0])

    def own(self, node: int, vector: Array) -> list[float]:
        """Return a vector along the axes in which a node moves: cards of bars count in them."""
        x, y, z = vector.tolist()
        if not (angle := self.angle(node)):
            return [x, y, z]
        c, s = float(np.cos(angle)), float(np.sin(angle))
        return [c * x + s * y, c * y - s * x, z]

    def level_alike(self, node: int, six: Array) -> bool:
        """Return whether it is the same along x and y as along a node's own axes."""
        return not self.angle(node) or bool(six[0] == six[1] and six[3] == six[4])

    def material(self, material: Material) -> int:
        """Return the number of a material, writing it when it is new."""
        if material not in self._materials:
            self._materials[material] = number = self.next("material")
            g = material.shear_modulus
            e, nu = material.elastic_modulus, material.poisson_ratio
            self.card("MAT1", number, e, g, nu, material.density)
        return self._materials[material]


def write(subject: Subject, stem: str) -> Mapping[str, bytes]:
    """Return a deck that asks for natural frequencies up to 100 Hz.

    Parameters
    ----------
    subject : Subject
        A finite-element model.
    stem : str
        Title of the deck.

    Raises
    ------
    InputError
        A structure of which only matrices or modes are known, or elements that have no card.
    """
    floor = subject.structure
    if not isinstance(floor, Floor):
        raise InputError(f"{floor.name} is no finite-element model: it has no cards")
    out = _Writer(floor)
    _grids(out, floor)
    for group in floor.elements:
        _group(out, floor.nodes, group)
    for link in floor.links:
        _link(out, link)
    _supports(out, floor.fixed)
    title = "".join(c if c.isascii() and c.isprintable() else "?" for c in stem)[:60]
    head = (
        "SOL 103", "CEND", f"TITLE = {title}", "SPC = 1", "METHOD = 1", "BEGIN BULK",
        "$ lengths in m, forces in N, masses in kg; consistent masses",
        "PARAM,COUPMASS,1", "PARAM,AUTOSPC,YES", "EIGRL,1,,100.",
    )  # fmt: skip
    text = "\n".join([*head, *out.lines, "ENDDATA"]) + "\n"
    return {".bdf": text.encode("ascii", "replace")}


def _field(value: object) -> str:
    """Return a field of 16 characters."""
    if value is None:
        return " " * 16
    if isinstance(value, float | np.floating):
        return f"{float(value):16.9E}" if value != 0.0 else f"{'0.':>16}"
    return f"{value!s:>16}"


def _grids(out: _Writer, floor: Floor) -> None:
    systems = np.zeros(len(floor.nodes), dtype=int)
    if floor.angles is not None:
        turned = floor.angles.any(axis=1)
        if np.any(np.abs(floor.angles[:, 0] - floor.angles[:, 1]) > 1e-9):
            raise InputError("supports that turn translations and rotations apart have no card")
        for angle in np.unique(floor.angles[turned, 0]):
            number = out.next("system")
            c, s = float(np.cos(angle)), float(np.sin(angle))
            out.card("CORD2R", number, 0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, c, s, 0.0)
            systems[turned & (floor.angles[:, 0] == angle)] = number
    for i, (x, y, z) in enumerate(floor.nodes.tolist()):
        out.card("GRID", i + 1, None, x, y, z, int(systems[i]) or None)


def _group(out: _Writer, nodes: Array, group: Elements) -> None:
    if isinstance(group, ShellGroup):
        _plates(out, "CQUAD4", group.elements, group.section, group.name)
    elif isinstance(group, TriangleGroup):
        _plates(out, "CTRIA3", group.connectivity, group.section, group.name)
    elif isinstance(group, BeamGroup):
        _bars(out, nodes, group, None)
    elif isinstance(group, ReleasedBeams):
        _bars(out, nodes, group.beams, group.released)
    elif isinstance(group, SpringGroup):
        _springs(out, nodes, group)
    elif isinstance(group, PointMasses):
        masses = np.broadcast_to(group.mass, group.nodes.shape)
        for node, mass in zip(group.nodes.tolist(), masses.tolist(), strict=True):
            out.card("CONM2", out.next("element"), node + 1, None, mass)
    elif isinstance(group, NodeInertia):
        _inertia(out, group)
    else:
        raise InputError(f"{group.name}: {type(group).__name__} has no card")


def _inertia(out: _Writer, group: NodeInertia) -> None:
    for node, six in zip(group.nodes.tolist(), group.inertia, strict=True):
        if not out.level_alike(node, six):
            raise InputError(
                f"{group.name}: inertia that differs along x and y has no card at node "
                f"{node + 1}, whose supports are turned"
            )
        for dof, mass in enumerate(six.tolist(), start=1):
            if mass:
                out.card("CMASS2", out.next("element"), mass, node + 1, dof)


def _plates(out: _Writer, card: str, corners: Array, section: Any, name: str) -> None:  # noqa: ANN401
    number, system = out.next("property"), None
    out.lines.append(f"$ {_plain(name)}")
    if isinstance(section, ShellSection):
        m = out.material(section.material)
        out.card(
            "PSHELL", number, m, section.thickness, m, 1.0, m, _SHEAR, section.superimposed_mass
        )
    elif isinstance(section, OrthotropicSection):
        system = _orthotropic(out, number, section)
    else:
        raise InputError(f"{name}: a plate of {type(section).__name__} has no card")
    for nodes in (corners + 1).tolist():
        out.card(card, out.next("element"), number, *nodes, system)


def _orthotropic(out: _Writer, number: int, section: OrthotropicSection) -> int:
    """Write a plate by three laws; return the system whose x axis is its own."""
    t = section.thickness
    laws = []
    for law, unit in ((section.membrane, t), (section.bending, t**3 / 12.0)):
        x, y, both, twist = (value / unit for value in law)
        laws.append(out.next("material"))
        out.card("MAT2", laws[-1], x, both, 0.0, y, 0.0, twist)
    laws.append(out.next("material"))
    x, y = (value / (_SHEAR * t) for value in section.shear)
    out.card("MAT2", laws[-1], x, 0.0, 0.0, y, 0.0, min(x, y))
    out.card("PSHELL", number, laws[0], t, laws[1], 1.0, laws[2], _SHEAR, section.mass_per_area)
    system = out.next("system")
    first = section.axis / np.linalg.norm(section.axis)
    up = np.eye(3)[2] if abs(first[2]) < 0.9 else np.eye(3)[0]
    third = np.cross(first, np.cross(up, first))
    out.card("CORD2R", system, 0, 0.0, 0.0, 0.0, *third.tolist(), *first.tolist())
    return system


def _bars(out: _Writer, nodes: Array, group: BeamGroup, released: Array | None) -> None:
    number = out.next("property")
    out.lines.append(f"$ {_plain(group.name)}")
    _bar_property(out, number, group.section)
    ends = np.zeros((2, 3), dtype=bool) if released is None else released
    # dofs about a member's own x, y and z: y is the axis of bending in plane 1, about z there
    pins = ["".join(p for p, let in zip("465", end, strict=True) if let) for end in ends]
    _, frames = beam_frames(nodes[group.elements], group.up)
    for (first, last), up in zip(group.elements.tolist(), frames[:, 2], strict=True):
        numbers = out.next("element"), number, first + 1, last + 1
        flags = ["".join(sorted(pin)) or None for pin in pins]
        off = [*out.own(first, group.offset), *out.own(last, group.offset)]
        off = off if np.any(group.offset) else [None] * 6
        out.card("CBAR", *numbers, *out.own(first, up), None, *flags, *off)


def _bar_property(out: _Writer, number: int, section: BeamSection) -> None:
    area = section.area
    k = [a / area if np.isfinite(a) else None for a in (section.shear_area_z, section.shear_area_y)]
    fields = [number, out.material(section.material), area, section.inertia_y, section.inertia_z,
              section.torsion_constant]  # fmt: skip
    # C1 to F2 are of stresses; then K1, K2
    out.card("PBAR", *fields, 0.0, None, *[None] * 8, *k)


def _springs(out: _Writer, nodes: Array, group: SpringGroup) -> None:
    for first, last in group.elements.tolist():
        if not _along_own(out, group, (first, last)):
            _bush(out, nodes, group, (first, last))
            continue
        for dof, k in enumerate(group.stiffness.tolist(), start=1):
            if k:
                other = (None, None) if last == GROUND else (last + 1, dof)
                out.card("CELAS2", out.next("element"), k, first + 1, dof, *other)


def _along_own(out: _Writer, group: SpringGroup, ends: tuple[int, int]) -> bool:
    """Return whether a spring is along the axes in which its nodes move, dof by dof."""
    turned = any(out.angle(node) for node in ends if node != GROUND)
    return not turned or not group.stiffness[[0, 1, 3, 4]].any()


def _bush(out: _Writer, nodes: Array, group: SpringGroup, ends: tuple[int, int]) -> None:
    """Write a spring along the basic axes, at a node that moves along others."""
    first, last = ends
    if last != GROUND and np.ptp(nodes[[first, last]], axis=0).max() > 0.0:
        raise InputError(
            f"{group.name}: a spring between two places has no card at nodes {first + 1} and "
            f"{last + 1}, whose supports are turned"
        )
    number, other = out.next("property"), None if last == GROUND else last + 1
    out.card("PBUSH", number, "K", *group.stiffness.tolist())
    out.card("CBUSH", out.next("element"), number, first + 1, other, None, None, None, 0)


def _link(out: _Writer, link: RigidLinks) -> None:
    tied = link.dofs.astype(float)
    aslant = [node + 1 for node in link.follows.tolist() if not out.level_alike(node, tied)]
    if aslant:
        raise InputError(
            f"a rigid link along x or y alone has no card at node {aslant[0]}, whose supports are "
            "turned"
        )
    dofs = "".join(str(i) for i, tied in enumerate(link.dofs, start=1) if tied)
    for lead in np.unique(link.leads).tolist():
        behind = (link.follows[link.leads == lead] + 1).tolist()
        out.card("RBE2", out.next("element"), lead + 1, dofs, *behind)


def _supports(out: _Writer, fixed: Array) -> None:
    for held in np.unique(fixed[fixed.any(axis=1)], axis=0):
        dofs = "".join(str(i) for i, one in enumerate(held, start=1) if one)
        nodes: Sequence[int] = (np.flatnonzero((fixed == held).all(axis=1)) + 1).tolist()
        for i in range(0, len(nodes), 6):
            out.card("SPC1", 1, dofs, *nodes[i : i + 6])


def _plain(name: str) -> str:
    return "".join(c if c.isascii() and c.isprintable() else "?" for c in name)[:60]


EXPORT = ExportFormat(kind="nastran", name="Nastran bulk data", suffix=".bdf", write=write)

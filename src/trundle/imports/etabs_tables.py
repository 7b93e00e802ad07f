"""Turn an ETABS text file (.e2k) into the tables that SAP2000's have, storey by storey.

ETABS says where points are in plan, how lines and areas join them, and on which storeys each is;
here every point of a storey becomes a joint, every line and area of a storey a frame and an area.

Reference: the format is described nowhere in full; this follows what ETABS files in public reports
show (Computers and Structures, Inc., ETABS text file, versions 9 to 20).
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from trundle.errors import InputError
from trundle.imports.etabs_makes import Rows, area_section, frame_section
from trundle.imports.etabs_statements import HOLDS_NOTHING, Statement, number_of
from trundle.imports.sap_tables import Table

__all__ = ["tables_of"]

_MESH = 1.0  # m: the largest side of elements of floors and walls
_ENDS = ("TI", "M2I", "M3I", "TJ", "M2J", "M3J")
_DOFS = {"UX": "U1", "UY": "U2", "UZ": "U3", "RX": "R1", "RY": "R2", "RZ": "R3"}


@dataclass(kw_only=True)
class _Model:
    """What statements say, and the tables that become of it."""

    levels: list[tuple[str, float]] = field(default_factory=list[tuple[str, float]])
    points: dict[str, tuple[float, float, float]] = field(default_factory=dict)
    lines: dict[str, tuple[str, str, str, int]] = field(default_factory=dict)
    outlines: set[str] = field(default_factory=set[str])
    areas: dict[str, tuple[tuple[str, ...], tuple[int, ...]]] = field(default_factory=dict)
    rigid: set[str] = field(default_factory=set[str])
    diaphragms: set[str] = field(default_factory=set[str])
    assigned: set[tuple[str, ...]] = field(default_factory=set[tuple[str, ...]])
    rows: Rows = field(default_factory=Rows)
    joints: dict[str, tuple[float, float, float]] = field(default_factory=dict)
    units: str = ""
    length: float = 1.0

    def storey(self, name: str, place: str) -> int:
        """Return the number of a storey, from the lowest."""
        names = [one for one, _ in self.levels]
        if name not in names:
            raise InputError(f"{place}: names storey {name!r}, which is not there")
        return names.index(name)

    def joint(self, point: str, storey: int, place: str) -> str:
        """Return the joint of a point on a storey, making it when it is new."""
        if point not in self.points:
            raise InputError(f"{place}: names point {point!r}, which is not there")
        if not 0 <= storey < len(self.levels):
            raise InputError(f"{place}: reaches below the lowest storey")
        level, height = self.levels[storey]
        name = f"{point} {level}"
        if name not in self.joints:
            x, y, drop = self.points[point]
            self.joints[name] = x, y, height - drop
            self.rows.row(
                "JOINT COORDINATES", place, Joint=name, GlobalX=x, GlobalY=y, GlobalZ=height - drop
            )
        return name


def tables_of(
    statements: list[Statement], metres: Callable[[str], float]
) -> tuple[dict[str, Table], str, tuple[str, ...]]:
    """Return tables, the units, and what was passed over.

    Parameters
    ----------
    statements : list of Statement
        Of the file.
    metres : callable
        Returns how many metres one unit of length of some units is.

    Raises
    ------
    InputError
        Storeys, points or properties that are not there, or what is not read.
    """
    model = _Model()
    _read_controls(model, statements, metres)
    _read_storeys(model, statements)
    passed: dict[str, int] = {}
    for one in statements:
        kind = one.words[0].upper()
        if kind in _TAKEN:
            _TAKEN[kind](model, one)
        elif kind not in {"UNITS", "STORY"}:
            passed[kind] = passed.get(kind, 0) + 1
    for kind in ("LINEASSIGN", "AREAASSIGN", "POINTASSIGN"):
        for one in statements:
            if one.words[0].upper() == kind:
                _ASSIGNS[kind](model, one)
    for one in statements:
        kind = one.words[0].upper()
        if kind in passed and kind not in _ASSIGNS and not HOLDS_NOTHING.match(kind):
            raise InputError(
                f"{one.place}: {kind} is not read, and may be of the structure; if it is nothing "
                "of it, put it into ignore = [..]"
            )
    told = tuple(
        f"passed over: {kind} ({n})" for kind, n in sorted(passed.items()) if kind not in _ASSIGNS
    )
    return model.rows.tables, model.units, told


def _read_controls(
    model: _Model, statements: list[Statement], metres: Callable[[str], float]
) -> None:
    stated = [s for s in statements if s.words[0].upper() == "UNITS"]
    if len(stated) != 1:
        raise InputError("states no UNITS" if not stated else f"{stated[1].place}: UNITS twice")
    one = stated[0]
    model.units = ", ".join(one.words[1:])
    model.length = metres(model.units)
    model.rows.gravity = 9.80665 / model.length
    model.rows.length = model.length


def _read_storeys(model: _Model, statements: list[Statement]) -> None:
    """Take storeys from the top down: heights above the one below, the last with its level."""
    stories = [s for s in statements if s.words[0].upper() == "STORY"]
    if not stories:
        raise InputError("has no storeys")
    if len({one.word(1) for one in stories}) < len(stories):
        raise InputError(f"{stories[0].place}: two storeys have one name")
    base, heights = 0.0, list[tuple[str, float]]()
    for one in reversed(stories):
        keys = one.keys(2)
        if "ELEV" in keys:
            base = number_of(one, keys["ELEV"])
            heights.append((one.words[1], base))
            continue
        rise = number_of(one, keys.get("HEIGHT", "-"))
        if not rise > 0.0:
            raise InputError(f"{one.place}: a storey's height must be above 0")
        base += rise
        heights.append((one.words[1], base))
    model.levels = heights


def _point(model: _Model, one: Statement) -> None:
    numbers = [number_of(one, text) for text in one.words[2:5]]
    if len(numbers) < 2 or one.words[1] in model.points:
        raise InputError(f"{one.place}: a point has x and y, and is there once")
    model.points[one.words[1]] = numbers[0], numbers[1], numbers[2] if len(numbers) > 2 else 0.0


def _line(model: _Model, one: Statement) -> None:
    if len(one.words) < 6 or one.words[2].upper() not in {"COLUMN", "BEAM", "BRACE"}:
        raise InputError(f"{one.place}: must be a COLUMN, BEAM or BRACE between two points")
    model.lines[one.words[1]] = (
        one.words[2].upper(), one.words[3], one.words[4], int(number_of(one, one.words[5]))
    )  # fmt: skip


def _area(model: _Model, one: Statement) -> None:
    kind, n = one.word(2).upper(), int(number_of(one, one.word(3)))
    if kind == "AREA":
        model.outlines.add(one.words[1])
        return
    if kind not in {"FLOOR", "PANEL", "RAMP"} or n not in (3, 4):
        raise InputError(f"{one.place}: floors and panels of three or four corners are read")
    one.word(3 + n)
    drops = tuple(int(number_of(one, text)) for text in one.words[4 + n : 4 + 2 * n])
    if len(drops) not in (0, n):
        raise InputError(f"{one.place}: says of {len(drops)} of {n} corners how deep they are")
    model.areas[one.words[1]] = one.words[4 : 4 + n], drops or (0,) * n


def _material(model: _Model, one: Statement) -> None:
    model.rows.properties.setdefault(f"material {one.word(1)}", {}).update(
        one.keys(
            2,
            r"TYPE|SYMTYPE|GRADE|WEIGHTPERVOLUME|M|W|E|U|A|DESIGNTYPE|F[A-Z]+|COLOR|NOTES|GUID|SS.*|HYSTYPE|.*DAMP.*|FC|FY|FU|FYE|FUE|LAMBDA|CONFINED.*|MANDER.*|LTWTCONC|ORIGINALTEMP|ISLIGHTWEIGHT",
        )
    )


def _section(model: _Model, one: Statement) -> None:
    model.rows.properties.setdefault(f"section {one.word(1)}", {}).update(
        one.keys(
            2,
            r"MATERIAL|SHAPE|D|B|TF|TW|T|[A-Z0-9]+MOD|COLOR|NOTES|GUID|FILE|FILLET.*|AUTOSELECT|ROTATION|TOPCOVER|BOTCOVER",
        )
    )


def _plate(model: _Model, one: Statement) -> None:
    model.rows.properties.setdefault(f"plate {one.word(1)}", {}).update(
        one.keys(
            2,
            r"MATERIAL|PROPTYPE|TYPE|MODELINGTYPE|SLABTYPE|SLABTHICKNESS|WALLTHICKNESS|TM|TB|[A-Z0-9]+MOD|COLOR|NOTES|GUID",
        )
    )


def _diaphragm(model: _Model, one: Statement) -> None:
    model.diaphragms.add(one.word(1))
    if one.keys(2, "TYPE|COLOR|GUID").get("TYPE", "RIGID").upper() == "RIGID":
        model.rigid.add(one.word(1))


def _mass_source(model: _Model, one: Statement) -> None:
    del model
    text = " ".join(one.words[1:]).upper()
    if re.search(r"INCLUDELOADS\s+YES|INCLUDE\s+LOADS|INCLUDEELEMENTS\s+NO", text):
        raise InputError(f"{one.place}: mass by loads is not read, only that of elements")


_TAKEN: Mapping[str, Callable[[_Model, Statement], None]] = {
    "POINT": _point,
    "LINE": _line,
    "AREA": _area,
    "MATERIAL": _material,
    "FRAMESECTION": _section,
    "SHELLPROP": _plate,
    "DIAPHRAGM": _diaphragm,
    "MASSSOURCE": _mass_source,
}


_ON_LINES = (
    "SECTION|ANG|RELEASE|CARDINALPT|TRANSFORM.*|MINNUMSTA|MAXSTASPC|AUTOMESH|MESHATINTERSECTIONS|"
    "PIER|PIERNAME|SPANDREL|DESIGNTYPE|DESIGN|GUID|COLOR|OUTPUT.*|LABEL|PROPMOD.*"
)
_ON_AREAS = (
    "SECTION|ANG|DIAPH|OBJMESHTYPE|PIER|PIERNAME|SPANDREL|DESIGN.*|GUID|COLOR|LABEL|PROPMOD.*|"
    "ADDRESTRAINT|OPENING"
)
_ON_POINTS = "RESTRAINT|DIAPH|GUID|LABEL|USERJOINT|PANELZONE"


def _assigned(model: _Model, one: Statement, known: str) -> dict[str, str]:
    """Return what is assigned, once; what is not read and would change the structure is refused."""
    one.word(2)
    if one.words[:3] in model.assigned and one.words[0].upper() != "POINTASSIGN":
        raise InputError(f"{one.place}: {one.words[1]!r} is assigned twice on {one.words[2]!r}")
    model.assigned.add(one.words[:3])
    keys = one.keys(3, known)
    for key, value in keys.items():
        if key.startswith("PROPMOD") and number_of(one, value) != 1.0:
            raise InputError(
                f"{one.place}: {key} of a line or area is not read; of a section it is"
            )
        if key in {"ADDRESTRAINT", "OPENING"} and value.upper() not in {"NO", "NONE"}:
            raise InputError(f"{one.place}: {key} is not read")
    if keys.get("DIAPH", "") not in {"", "NONE", "None", *model.diaphragms}:
        raise InputError(f"{one.place}: names diaphragm {keys['DIAPH']!r}, which is not there")
    return keys


def _line_assign(model: _Model, one: Statement) -> None:
    name, storey = one.word(1), model.storey(one.word(2), one.place)
    if name not in model.lines:
        raise InputError(f"{one.place}: names line {name!r}, which is not there")
    keys = _assigned(model, one, _ON_LINES)
    if keys.get("SECTION", "NONE").upper() == "NONE":
        return
    kind, first, last, drop = model.lines[name]
    lower = storey - drop if kind != "BEAM" else storey
    ends = model.joint(first, lower, one.place), model.joint(last, storey, one.place)
    frame = f"{name} {one.words[2]}"
    model.rows.row("CONNECTIVITY - FRAME", one.place, Frame=frame, JointI=ends[0], JointJ=ends[1])
    model.rows.row("FRAME SECTION ASSIGNMENTS", one.place, Frame=frame, AnalSect=keys["SECTION"])
    frame_section(model.rows, one, keys["SECTION"])
    if "ANG" in keys:
        model.rows.row(
            "FRAME LOCAL AXES ASSIGNMENTS 1 - TYPICAL", one.place, Frame=frame, Angle=keys["ANG"]
        )
    if let := keys.get("RELEASE", "").split():
        if odd := [end for end in let if end.upper() not in _ENDS]:
            raise InputError(f"{one.place}: a release {odd[0]!r} is not read: {' '.join(_ENDS)}")
        cells = dict.fromkeys((end.upper() for end in let), "Yes")
        model.rows.row("FRAME RELEASE ASSIGNMENTS 1 - GENERAL", one.place, Frame=frame, **cells)
    if "CARDINALPT" in keys:
        model.rows.row(
            "FRAME INSERTION POINT ASSIGNMENTS", one.place, Frame=frame,
            CardinalPt=keys["CARDINALPT"], TransStiff=_transformed(keys),
        )  # fmt: skip


def _transformed(keys: Mapping[str, str]) -> str:
    """Return whether stiffness follows the cardinal point, by whatever its key is called."""
    return next((v for k, v in keys.items() if k.startswith("TRANSFORM")), "Yes")


def _area_assign(model: _Model, one: Statement) -> None:
    name, storey = one.word(1), model.storey(one.word(2), one.place)
    keys = _assigned(model, one, _ON_AREAS)
    if name in model.outlines:
        return  # null: an outline of loads
    if name not in model.areas:
        raise InputError(f"{one.place}: names area {name!r}, which is not there")
    points, drops = model.areas[name]
    joints = [
        model.joint(point, storey - drop, one.place)
        for point, drop in zip(points, drops, strict=True)
    ]
    if "DIAPH" in keys and keys["DIAPH"] in model.rigid:
        for joint in joints:
            _ties(model, one, joint, keys["DIAPH"])
    if keys.get("SECTION", "NONE").upper() == "NONE":
        return
    area = f"{name} {one.words[2]}"
    corners = {f"Joint{i}": joint for i, joint in enumerate(joints, start=1)}
    model.rows.row("CONNECTIVITY - AREA", one.place, Area=area, NumJoints=len(joints), **corners)
    model.rows.row("AREA SECTION ASSIGNMENTS", one.place, Area=area, Section=keys["SECTION"])
    area_section(model.rows, one, keys["SECTION"])
    if len(joints) == 4:
        size = _MESH / model.length
        model.rows.row(
            "AREA AUTO MESH ASSIGNMENTS", one.place, Area=area, MeshType="Max Size",
            MaxSize1=size, MaxSize2=size,
        )  # fmt: skip


def _point_assign(model: _Model, one: Statement) -> None:
    joint = model.joint(one.word(1), model.storey(one.word(2), one.place), one.place)
    keys = _assigned(model, one, _ON_POINTS)
    if odd := [w for w in keys.get("RESTRAINT", "").upper().split() if w not in _DOFS]:
        raise InputError(f"{one.place}: {odd[0]} is no dof: UX to RZ are")
    if held := keys.get("RESTRAINT", "").upper().split():
        cells = {dof: "Yes" if name in held else "No" for name, dof in _DOFS.items()}
        model.rows.row("JOINT RESTRAINT ASSIGNMENTS", one.place, Joint=joint, **cells)
    if keys.get("DIAPH", "") in model.rigid:
        _ties(model, one, joint, keys["DIAPH"])


_ASSIGNS: Mapping[str, Callable[[_Model, Statement], None]] = {
    "LINEASSIGN": _line_assign,
    "AREAASSIGN": _area_assign,
    "POINTASSIGN": _point_assign,
}


def _ties(model: _Model, one: Statement, joint: str, name: str) -> None:
    """Tie a joint into the diaphragm of its storey."""
    height = model.joints[joint][2]
    tie = f"{name} {height:g}"
    if model.rows.once("CONSTRAINT DEFINITIONS - DIAPHRAGM", tie):
        model.rows.row("CONSTRAINT DEFINITIONS - DIAPHRAGM", one.place, Name=tie, Axis="Z")
    if model.rows.once("JOINT CONSTRAINT ASSIGNMENTS", joint):
        model.rows.row("JOINT CONSTRAINT ASSIGNMENTS", one.place, Joint=joint, Constraint=tie)

"""Read OpenCRG files: curved regular grids of a road's surface (ASAM OpenCRG 1.2).

pyopencrg parses them; this is the only module that knows it. Long cuts become tracks at their
distance from the reference line. What the library would take on trust is refused here: a file that
names another file, a grid shorter than its header says, numbers that are not there.
"""

# pyright: reportUnknownMemberType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false
from __future__ import annotations

import re
import tempfile
import warnings
from pathlib import Path
from typing import Any

import numpy as np

from trundle.errors import InputError
from trundle.profiles.profile_format import ProfileFormat
from trundle.profiles.survey import Survey

__all__ = ["FORMAT", "read_crg"]

_END = re.compile(rb"^\$\$", re.MULTILINE)
_OTHER_FILE = re.compile(rb"^\s*\$ROAD_CRG_FILE", re.MULTILINE | re.IGNORECASE)
_SHORT = re.compile("header u range gives", re.IGNORECASE)
_COLUMNS = {b"#:LRFI": 10, b"#:LDFI": 20}  # of a number as text
_KEY = re.compile(
    rb"^\s*((?:reference_line|long_section)_\w+)\s*=\s*([^\s!]+)", re.MULTILINE | re.IGNORECASE
)
_SAME_PLACE = 1e-3  # m
_MOST = 50_000_000  # numbers of a grid


def read_crg(data: bytes, path: Path) -> Survey:
    """Read an OpenCRG file.

    Parameters
    ----------
    data : bytes
        The file, with its numbers as text or binary.
    path : Path
        Its name, for messages.

    Raises
    ------
    InputError
        The extra is not installed, a file that is damaged or cut short or names another one, a
        grid with holes.
    """
    head = data[: end.start()] if (end := _END.search(data)) else data
    if _OTHER_FILE.search(head):
        raise InputError(
            f"{path}: keeps its numbers in another file ($ROAD_CRG_FILE), which is not opened: "
            "give that file, or write both into one"
        )
    if not re.search(rb"^\s*reference_line_end_u\s*=", head, re.MULTILINE | re.IGNORECASE):
        raise InputError(
            f"{path}: its header does not say where the reference line ends "
            "(reference_line_end_u), so nobody can tell whether it is whole: add it"
        )
    _check_last_line(data, head, path)
    said = _said(head, path)
    road = _road(data, path)
    _check_places(road, said, path)
    holes = int(np.isnan(road.z).sum())
    if holes:
        u, v = np.argwhere(np.isnan(road.z))[0]
        raise InputError(
            f"{path}: {holes} heights are missing, the first at u = {road.u[u]:g} m, v = "
            f"{road.v[v]:g} m: fill them, or cut the road to where it is whole"
        )
    return Survey(
        station=np.asarray(road.u, dtype=float),
        elevation=np.asarray(road.surface_z(), dtype=float).T.copy(),
        names=tuple(f"v = {v:.3g} m" for v in road.v),
        station_unit="m",
        units=("m",) * len(road.v),
        lateral=tuple(float(v) for v in road.v),
        where="sample",
        lines=np.arange(1, len(road.u) + 1),
        notes=_notes(head, road),
    )  # fmt: skip


def _said(head: bytes, path: Path) -> dict[str, float]:
    """Return the numbers of the header; one that is none, or not finite, is refused."""
    said: dict[str, float] = {}
    for key, word in _KEY.findall(head):
        try:
            value = float(word)
        except ValueError:
            value = np.nan
        if not np.isfinite(value):
            raise InputError(
                f"{path}: {key.decode()} must be a number; got {word.decode('latin-1')!r}"
            )
        said[key.decode().lower()] = value
    return said


def _check_places(road: Any, said: dict[str, float], path: Path) -> None:  # noqa: ANN401
    """Refuse cuts that do not lie where the header says."""
    for key, found in (("long_section_v_right", road.v[0]), ("long_section_v_left", road.v[-1])):
        if key in said and abs(said[key] - float(found)) > _SAME_PLACE:
            raise InputError(
                f"{path}: its header says {key} = {said[key]:g} m, and its {len(road.v)} cuts lie "
                f"from {road.v[0]:g} to {road.v[-1]:g} m: which is wrong?"
            )


def _notes(head: bytes, road: Any) -> tuple[str, ...]:  # noqa: ANN401 - the library's own
    notes: list[str] = []
    if not road.is_straight:
        notes.append(
            "its reference line is curved: stations are along it, and tracks beside it are laid "
            "under the wheels by station"
        )
    if re.search(rb"^\s*\$ROAD_CRG_MODS", head, re.MULTILINE | re.IGNORECASE):
        notes.append("its modifiers ($ROAD_CRG_MODS) are not applied: the grid is read as it is")
    return tuple(notes)


def _check_last_line(data: bytes, head: bytes, path: Path) -> None:
    """Refuse a last number without its last digits, which would be read as another number."""
    kind = next((w for k, w in _COLUMNS.items() if k in head.upper()), 0)
    last = data.rstrip(b"\r\n").rsplit(b"\n", 1)[-1].rstrip(b"\r")
    if kind and len(last) % kind:
        raise InputError(
            f"{path}: its last line has {len(last)} columns, which are no whole numbers of {kind} "
            "columns each: it is cut short; copy it again"
        )


def _road(data: bytes, path: Path) -> Any:  # noqa: ANN401 - the library's own
    try:
        import pyopencrg as crg  # noqa: PLC0415 - an extra
    except ImportError:
        raise InputError(
            f"{path}: OpenCRG files need the extra 'roads': pip install 'trundle[roads]'"
        ) from None
    with tempfile.TemporaryDirectory(prefix="trundle-") as folder, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        copy = Path(folder) / "road.crg"
        copy.write_bytes(data)
        try:
            road = crg.read(str(copy), dtype="float64")
        except (ValueError, ArithmeticError, LookupError, OSError, MemoryError) as error:
            said = str(error).replace(str(copy), path.name).split("To open it anyway")[0]
            words = " ".join(said.split())[:160]
            raise InputError(f"{path}: cannot be read as OpenCRG: {words}") from None
        doubts = [str(one) for one in (*road.read_errors, *road.read_warnings)]
    short = next((one for one in doubts if _SHORT.search(one)), None)
    if short is not None:
        raise InputError(f"{path}: its grid is cut short: {short}; copy it again")
    if road.z.size > _MOST:
        raise InputError(f"{path}: has {road.z.size} heights; at most {_MOST:g} are read")
    return road


FORMAT = ProfileFormat(
    name="OpenCRG",
    claims=lambda head: bool(re.search(rb"^\s*\$(CT|ROAD_CRG|KD_DEFINITION)", head, re.MULTILINE)),
    read=read_crg,
)

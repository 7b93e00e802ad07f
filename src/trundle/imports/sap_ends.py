"""How frames of SAP2000's tables end: releases, rigid ends, insertion points."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from trundle._typing import Array
from trundle.errors import InputError
from trundle.imports.sap_makes import FrameMake
from trundle.imports.sap_tables import Row

__all__ = ["insertion_of", "releases_of", "rigid_ends_of"]

_RELEASES = (("TI", "M3I", "M2I"), ("TJ", "M3J", "M2J"))  # about our x, y, z
_CARDINAL = {  # shares of half depth along 2, of half width along 3
    1: (-1, 1), 2: (-1, 0), 3: (-1, -1), 4: (0, 1), 5: (0, 0), 6: (0, -1), 7: (1, 1), 8: (1, 0),
    9: (1, -1), 10: (0, 0), 11: (0, 0),
}  # fmt: skip


def releases_of(row: Row | None) -> tuple[tuple[bool, ...], tuple[bool, ...]]:
    """Return which rotations the ends let go, about our x, y and z.

    Parameters
    ----------
    row : Row or None
        Of FRAME RELEASE ASSIGNMENTS 1 - GENERAL.

    Raises
    ------
    InputError
        Partial fixity, or forces that are let go.
    """
    if row is None:
        return (False,) * 3, (False,) * 3
    if row.yes("PartialFix"):
        raise InputError(f"{row.place}: partial fixity is not read")
    if any(row.yes(key) for key in ("PI", "V2I", "V3I", "PJ", "V2J", "V3J")):
        raise InputError(f"{row.place}: releases of forces are not read; those of moments are")
    first, last = (tuple(row.yes(key) for key in keys) for keys in _RELEASES)
    return first, last


def rigid_ends_of(row: Row | None, length: float) -> tuple[float, float]:
    """Return how far a frame is rigid at both ends.

    Parameters
    ----------
    row : Row or None
        Of the table of end offsets.
    length : float
        Of the frame.

    Raises
    ------
    InputError
        A factor without lengths, or offsets that leave nothing to bend.
    """
    if row is None:
        return 0.0, 0.0
    if row.text("Type", "User").lower().startswith("auto"):
        row.text("LengthI", "0")
    key = next((k for k in ("RigidFact", "RigidFactor") if k.lower() in row.cells), "RigidFact")
    factor = row.number(key)
    if not 0.0 <= factor <= 1.0:
        raise InputError(f"{row.place}: a rigid zone factor is 0 to 1; got {factor:g}")
    given = [key for key in ("LengthI", "LengthJ") if key.lower() in row.cells]
    if factor > 0.0 and not given:
        raise InputError(f"{row.place}: offsets without their lengths are not read: give them")
    first, last = (factor * row.number(key, 0.0) for key in ("LengthI", "LengthJ"))
    if min(first, last) < 0.0 or first + last >= length:
        raise InputError(f"{row.place}: end offsets leave nothing that bends")
    return first, last


def insertion_of(
    row: Row | None, make: FrameMake, frame: Float[Array, "3 3"]
) -> tuple[Float[Array, " 3"], Float[Array, " 3"]]:
    """Return the vectors from both joints to the frame's axis.

    Parameters
    ----------
    row : Row or None
        Of FRAME INSERTION POINT ASSIGNMENTS.
    make : FrameMake
        Its section.
    frame : ndarray of float, shape (3, 3)
        Its local axes, as rows.

    Raises
    ------
    InputError
        A cardinal point of a section whose box is not known, or another system.
    """
    none = np.zeros(3)
    if row is None:
        return none, none
    transform = next(
        (k for k in ("Transform", "TransStiff") if k.lower() in row.cells), "Transform"
    )
    if not row.yes(transform, default=True):
        return none, none
    cardinal = row.text("CardinalPt", "10").split()[0]
    number = int(cardinal) if cardinal.isdigit() else 0
    if number not in _CARDINAL:
        raise InputError(f"{row.place}: a cardinal point is 1 to 11; got {cardinal!r}")
    two, three = _CARDINAL[number]
    two = -two if row.yes("Mirror3") or row.yes("MirrorAbt3") else two
    three = -three if row.yes("Mirror2") or row.yes("MirrorAbt2") else three
    if (two or three) and not make.symmetric:
        raise InputError(
            f"{row.place}: where the box of this section lies round its centroid is not known; "
            "use joint offsets, with cardinal point 10"
        )
    # the joint is at the cardinal point: the axis lies the other way
    base = -0.5 * (two * make.depth * frame[1] + three * make.width * frame[2])
    system = row.text("CoordSys", "Local")
    turn = frame if system.lower() == "local" else np.eye(3)
    if system.lower() not in {"local", "global"}:
        raise InputError(f"{row.place}: offsets in {system!r} are not read; Local and GLOBAL are")
    # along 1, 2, 3 of the frame's own axes; later versions call these X, Y, Z too
    shift = [
        np.array(
            [
                row.number(f"JtOffset{a}{end}", row.number(f"JtOffset{b}{end}", 0.0))
                for a, b in zip("123", "XYZ", strict=True)
            ]
        )
        @ turn
        for end in "IJ"
    ]
    return base + shift[0], base + shift[1]

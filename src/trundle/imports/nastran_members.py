"""Take the cards of Nastran bulk data for bars, beams and rods, and their properties."""

from __future__ import annotations

import re
from collections.abc import Callable

import numpy as np

from trundle._checks import non_negative, positive
from trundle.errors import InputError
from trundle.imports.nastran_cards import Card, real, whole
from trundle.imports.nastran_deck import Deck, Member, MemberMake
from trundle.structure import STEEL, BeamSection
from trundle.structure.building import Profile

__all__ = ["MEMBER_CARDS"]

_ANY = STEEL  # a section is made before its material is known
_ALIKE = 1e-6  # of its size, within which both ends of a beam are one


def _section(
    area: float, bending: tuple[float, float], torsion: float, shear: tuple[float, float]
) -> BeamSection:
    """Return a section whose plane 1 holds the orientation; K of 0 is a bar without shear."""
    return BeamSection(
        area=area,
        inertia_y=bending[0],
        inertia_z=bending[1],
        torsion_constant=torsion,
        shear_area_y=shear[1] * area if shear[1] else np.inf,
        shear_area_z=shear[0] * area if shear[0] else np.inf,
        material=_ANY,
    )


def _pbar(deck: Deck, card: Card) -> None:
    if real(card.get(20), 0.0):
        raise InputError("I12 is not 0: principal axes that lie aslant are not read")
    area, plane_1, plane_2, torsion = (
        positive(f"field {i}", real(card.get(i), 0.0)) for i in (4, 5, 6, 7)
    )
    more, k1, k2 = (non_negative(f"field {i}", real(card.get(i), 0.0)) for i in (8, 18, 19))
    deck.members[deck.claim("property", whole(card.get(2)))] = MemberMake(
        material=whole(card.get(3)),
        section=_section(area, (plane_1, plane_2), torsion, (k1, k2)),
        more=more,
    )


def _pbeam(deck: Deck, card: Card) -> None:
    """Keep a beam that is the same from end to end; shear counts unless K is 0 (1 if blank)."""
    rows = [[*card.fields[i : i + 8], *[""] * 8][:8] for i in range(0, len(card.fields), 8)]
    first = [real(value, 0.0) for value in rows[0][2:8]]
    _check_constant(rows[1:], first)
    area, plane_1, plane_2, product, torsion, more = first
    if product:
        raise InputError("I12 is not 0: principal axes that lie aslant are not read")
    positive("A", area)
    deck.members[deck.claim("property", whole(card.get(2)))] = MemberMake(
        material=whole(card.get(3)),
        section=_section(area, (plane_1, plane_2), torsion, _shear_factors(rows[1:])),
        more=non_negative("NSM", more),
    )


def _is_station(row: list[str]) -> bool:
    return row[0].upper() in {"YES", "YESA", "NO"}


def _check_constant(rows: list[list[str]], first: list[float]) -> None:
    """Refuse a beam that has other values at a station than at its end A."""
    for row in filter(_is_station, rows):
        values = [real(value, first[i]) for i, value in enumerate(row[2:8])]
        if not np.allclose(values, first, rtol=_ALIKE, atol=0.0):
            raise InputError("a beam that tapers is not read")


def _shear_factors(rows: list[list[str]]) -> tuple[float, float]:
    """Return K1 and K2, which stand behind points for stress (of end A, and after ``YES``).

    Refused is what stands behind them: shear relief, warping, and axes beside the shear centre.
    """
    if not rows:
        return 1.0, 1.0
    after_points = [_is_station(row) and row[0].upper() == "YES" for row in [["YES"], *rows[:-1]]]
    if _is_station(rows[0]):
        after_points[0] = False
    behind = [
        row for row, points in zip(rows, after_points, strict=True)
        if not points and not _is_station(row)
    ]  # fmt: skip
    if any(
        real(value, 0.0) for row in (behind[0][2:] if behind else [], *behind[1:]) for value in row
    ):
        raise InputError(
            "shear relief, warping, inertia of a beam's mass and axes beside its shear centre are "
            "not read"
        )
    return (real(behind[0][0], 1.0), real(behind[0][1], 1.0)) if behind else (1.0, 1.0)


_DIMENSIONS: dict[str, tuple[int, Callable[..., Profile]]] = {
    "BAR": (2, lambda w, h: Profile.rectangle(w, h, _ANY)),
    "ROD": (1, lambda r: Profile.circle(2.0 * r, _ANY)),
    "TUBE": (2, lambda r, inner: Profile.tube(2.0 * r, r - inner, _ANY)),
    "BOX": (4, lambda w, h, flange, side: Profile.box(h, w, side, flange, _ANY)),
    "I": (6, lambda h, low, up, web, t_low, t_up: _i_profile(h, (low, up), web, (t_low, t_up))),
}
"""How many dimensions a shape has, and what it is by them (DIM1, DIM2, ...)."""


def _i_profile(
    depth: float, widths: tuple[float, float], web: float, flanges: tuple[float, float]
) -> Profile:
    if widths[0] != widths[1] or flanges[0] != flanges[1]:
        raise InputError("an I whose flanges differ is not read")
    return Profile.i(depth, widths[0], web, flanges[0], _ANY)


def _by_dimensions(deck: Deck, card: Card) -> None:
    """Keep a PBARL or PBEAML by its shape and dimensions."""
    shape = card.get(5).upper()
    if shape not in _DIMENSIONS:
        raise InputError(f"shapes read are {', '.join(_DIMENSIONS)}; got {shape or 'nothing'}")
    n, make = _DIMENSIONS[shape]
    values = card.fields[8:]
    if any(value.upper() in {"YES", "NO"} for value in values):
        raise InputError("a beam with stations is not read")
    sizes = [positive(f"DIM{i + 1}", real(v, 0.0)) for i, v in enumerate([*values, *[""] * n][:n])]
    deck.members[deck.claim("property", whole(card.get(2)))] = MemberMake(
        material=whole(card.get(3)),
        section=make(*sizes).section,
        more=real(values[n], 0.0) if len(values) > n else 0.0,
    )


def _rod_make(card: Card, at: int) -> MemberMake:
    """Return a rod by its material, area, torsion constant and mass, which begin at a field."""
    area, torsion = positive("A", real(card.get(at + 1), 0.0)), real(card.get(at + 2), 0.0)
    bends = area**2 / (4.0 * np.pi)  # of a circle; hinges leave nothing of it
    return MemberMake(
        material=whole(card.get(at)),
        section=_section(area, (bends, bends), torsion or 2.0 * bends, (0.0, 0.0)),
        more=real(card.get(at + 4), 0.0),
        rod=True,
        twists=torsion > 0.0,
    )


def _prod(deck: Deck, card: Card) -> None:
    deck.members[deck.claim("property", whole(card.get(2)))] = _rod_make(card, 3)


def _crod(deck: Deck, card: Card) -> None:
    number = deck.claim("element", whole(card.get(2)))
    ends = whole(card.get(4)), whole(card.get(5))
    deck.bars.append(Member(ends=ends, property=whole(card.get(3), number), place=card.place))


def _conrod(deck: Deck, card: Card) -> None:
    number = deck.claim("element", whole(card.get(2)))
    ends = whole(card.get(3)), whole(card.get(4))
    deck.members[-number] = _rod_make(card, 5)  # a property of its own, which no card can name
    deck.bars.append(Member(ends=ends, property=-number, place=card.place))


def _bar(deck: Deck, card: Card) -> None:
    """Keep a CBAR or CBEAM."""
    ends = whole(card.get(4)), whole(card.get(5))
    first, last = (_triple(card, at) for at in (12, 15))
    if not re.fullmatch(r"([GB][GO][GO])?", card.get(9)) or (
        "O" in card.get(9) and any(first + last)
    ):
        raise InputError(f"offsets along the bar itself are not read; got {card.get(9)}")
    if any(card.get(i) for i in (18, 19)):
        raise InputError("warping grids are not read")
    towards = not card.get(7) and not card.get(8) and card.get(6).isdigit()
    deck.bars.append(
        Member(
            ends=ends,
            property=whole(card.get(3), deck.claim("element", whole(card.get(2)))),
            up=None if towards else _triple(card, 6),
            towards=whole(card.get(6)) if towards else None,
            up_in_basic=card.get(9).startswith("B"),
            offsets=(first, last),
            pins=(card.get(10), card.get(11)),
            place=card.place,
        )
    )


def _triple(card: Card, at: int) -> tuple[float, float, float]:
    x, y, z = (real(card.get(at + i), 0.0) for i in range(3))
    return x, y, z


MEMBER_CARDS: dict[str, Callable[[Deck, Card], None]] = {
    "PBAR": _pbar,
    "PBARL": _by_dimensions,
    "PBEAM": _pbeam,
    "PBEAML": _by_dimensions,
    "PROD": _prod,
    "CBAR": _bar,
    "CBEAM": _bar,
    "CROD": _crod,
    "CONROD": _conrod,
}
"""What is read, and who takes it."""

"""Take cards of Nastran bulk data for what they say, by the numbers that they use."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from trundle._checks import non_negative, positive
from trundle._typing import Array
from trundle.errors import InputError
from trundle.imports.nastran_cards import Card, real, whole
from trundle.structure import Material

__all__ = ["CARDS", "Bar", "Deck"]

_HARMLESS = frozenset(
    ("POST", "AUTOSPC", "PRGPCHK", "GRDPNT", "COUPMASS", "BAILOUT", "PRTMAXIM", "OGEOM", "K6ROT")
)


@dataclass(frozen=True, kw_only=True)
class Bar:
    """Hold a CBAR: its grids, its property, how it lies."""

    ends: tuple[int, int]
    property: int
    up: tuple[float, float, float] | None  # in the plane of its first bending; None:
    towards: int  # a grid that it points to
    offset: tuple[float, float, float]


@dataclass(kw_only=True)
class Deck:
    """What the cards say, by the numbers that they use."""

    grids: dict[int, tuple[int, Array, str]] = field(default_factory=dict)
    systems: dict[int, tuple[int, Array]] = field(default_factory=dict)
    materials: dict[int, Material] = field(default_factory=dict)
    shells: dict[int, tuple[int, float, float]] = field(default_factory=dict)
    bars: dict[int, tuple[int, tuple[float, ...]]] = field(default_factory=dict)
    faces: list[tuple[int, tuple[int, ...], str]] = field(default_factory=list)
    members: list[tuple[Bar, str]] = field(default_factory=list)
    masses: list[tuple[int, float]] = field(default_factory=list)
    supports: dict[int, list[tuple[range, str]]] = field(default_factory=lambda: defaultdict(list))
    added: dict[int, list[int]] = field(default_factory=dict)
    weight_to_mass: float = 1.0
    taken: set[tuple[str, int]] = field(default_factory=set)

    def claim(self, kind: str, number: int) -> int:
        """Return a number that nothing else of its kind has; refuse one that is taken."""
        if (kind, number) in self.taken:
            raise InputError(f"{kind} {number} is there twice")
        self.taken.add((kind, number))
        return number


def _grid(deck: Deck, card: Card) -> None:
    if whole(card.get(7), 0):
        raise InputError("displacements in a system of their own (CD) are not read")
    place = np.array([real(card.get(i), 0.0) for i in (4, 5, 6)])
    deck.grids[deck.claim("grid", whole(card.get(2)))] = (whole(card.get(3), 0), place, card.get(8))


def _cord2r(deck: Deck, card: Card) -> None:
    points = np.array([real(card.get(i), 0.0) for i in range(4, 13)]).reshape(3, 3)
    along, aside = points[1] - points[0], points[2] - points[0]
    across = float(np.linalg.norm(np.cross(along, aside)))
    if not across > 1e-9 * float(np.linalg.norm(along) * np.linalg.norm(aside)):
        raise InputError("its three points lie on one line")
    deck.systems[deck.claim("coordinate system", whole(card.get(2)))] = (
        whole(card.get(3), 0),
        points,
    )


def _mat1(deck: Deck, card: Card) -> None:
    modulus, shear = card.get(3), card.get(4)
    if not modulus:
        raise InputError("a material needs its modulus E")
    e = positive("E", real(modulus))
    g = positive("G", real(shear, 0.5 * e))
    nu = real(card.get(5)) if card.get(5) else e / (2.0 * g) - 1.0
    if shear and card.get(5) and abs(2.0 * g * (1.0 + nu) / e - 1.0) > 0.01:
        raise InputError("E, G and NU contradict each other; only isotropic materials are read")
    deck.materials[deck.claim("material", whole(card.get(2)))] = Material(
        elastic_modulus=e, poisson_ratio=nu, density=real(card.get(6), 0.0)
    )


def _pshell(deck: Deck, card: Card) -> None:
    material, bending = whole(card.get(3)), whole(card.get(5), 0)
    if bending != material or abs(real(card.get(6), 1.0) - 1.0) > 1e-9:
        raise InputError("only solid plates are read: MID2 as MID1, and 12 I / T^3 of 1")
    deck.shells[deck.claim("property", whole(card.get(2)))] = (
        material,
        real(card.get(4)),
        real(card.get(9), 0.0),
    )


def _pbar(deck: Deck, card: Card) -> None:
    if real(card.get(20), 0.0):
        raise InputError("I12 is not 0: principal axes that lie aslant are not read")
    sizes = [positive(f"field {i}", real(card.get(i), 0.0)) for i in (4, 5, 6, 7)]
    numbers = sizes + [non_negative(f"field {i}", real(card.get(i), 0.0)) for i in (8, 18, 19)]
    deck.bars[deck.claim("property", whole(card.get(2)))] = (whole(card.get(3)), tuple(numbers))


def _face(deck: Deck, card: Card, corners: int) -> None:
    if real(card.get(5 + corners), 0.0) or any(card.get(i) for i in range(6 + corners, 20)):
        raise InputError("an offset, an angle of material or thicknesses at corners are not read")
    numbers = tuple(whole(card.get(4 + i)) for i in range(corners))
    number = deck.claim("element", whole(card.get(2)))
    deck.faces.append((whole(card.get(3), number), numbers, card.place))


def _triple(card: Card, at: int) -> tuple[float, float, float]:
    x, y, z = (real(card.get(at + i), 0.0) for i in range(3))
    return x, y, z


def _cbar(deck: Deck, card: Card) -> None:
    ends = whole(card.get(4)), whole(card.get(5))
    if card.get(9) not in {"", "GGG"}:
        raise InputError(f"offsets and orientation are read in the basic system; got {card.get(9)}")
    if card.get(10) or card.get(11):
        raise InputError("pins (PA, PB) are not read")
    first, last = (_triple(card, at) for at in (12, 15))
    if first != last:
        raise InputError("offsets that differ at both ends are not read")
    towards = not card.get(7) and not card.get(8) and card.get(6).isdigit()
    bar = Bar(
        ends=ends,
        property=whole(card.get(3), deck.claim("element", whole(card.get(2)))),
        up=None if towards else _triple(card, 6),
        towards=whole(card.get(6)) if towards else 0,
        offset=first,
    )
    deck.members.append((bar, card.place))


def _conm2(deck: Deck, card: Card) -> None:
    if any(real(card.get(i), 0.0) for i in (6, 7, 8, 10, 11, 12, 13, 14, 15)):
        raise InputError("masses beside their grid, and moments of inertia, are not read")
    deck.claim("element", whole(card.get(2)))
    deck.masses.append((whole(card.get(3)), non_negative("M", real(card.get(5)))))


def _spc(deck: Deck, card: Card) -> None:
    for at in (3, 6):
        if card.get(at):
            if real(card.get(at + 2), 0.0):
                raise InputError("a displacement that is enforced is not read")
            number = whole(card.get(at))
            held = (range(number, number + 1), card.get(at + 1))
            deck.supports[whole(card.get(2))].append(held)


def _spc1(deck: Deck, card: Card) -> None:
    named = [value for value in card.fields[2:] if value]
    if len(named) == 3 and named[1].upper() == "THRU":
        ranges = [range(whole(named[0]), whole(named[2]) + 1)]
    else:
        ranges = [range(n, n + 1) for n in (whole(value) for value in named)]
    deck.supports[whole(card.get(2))].extend((numbers, card.get(3)) for numbers in ranges)


def _spcadd(deck: Deck, card: Card) -> None:
    deck.added[whole(card.get(2))] = [whole(value) for value in card.fields[1:] if value]


def _param(deck: Deck, card: Card) -> None:
    name = card.get(2).upper()
    if name == "WTMASS":
        deck.weight_to_mass = real(card.get(3))
    elif name not in _HARMLESS:
        raise InputError(f"PARAM {name} is not known: it may change the model")


CARDS: dict[str, Callable[[Deck, Card], None]] = {
    "GRID": _grid,
    "CORD2R": _cord2r,
    "MAT1": _mat1,
    "PSHELL": _pshell,
    "PBAR": _pbar,
    "CQUAD4": lambda deck, card: _face(deck, card, 4),
    "CTRIA3": lambda deck, card: _face(deck, card, 3),
    "CBAR": _cbar,
    "CONM2": _conm2,
    "SPC": _spc,
    "SPC1": _spc1,
    "SPCADD": _spcadd,
    "PARAM": _param,
}
"""What is read, and who takes it."""

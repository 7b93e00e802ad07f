"""Take the cards of Nastran bulk data for materials, shells, springs and masses."""

from __future__ import annotations

from collections.abc import Callable

from trundle._checks import non_negative, positive
from trundle.errors import InputError
from trundle.imports.nastran_cards import Card, real, whole
from trundle.imports.nastran_deck import Deck, Plate, Spring
from trundle.structure import Material

__all__ = ["PART_CARDS"]

_SHEAR = 5.0 / 6.0
_ALIKE = 1e-3


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
    shear = whole(card.get(7), 0)
    if shear not in {0, material} or abs(real(card.get(8), _SHEAR) / _SHEAR - 1.0) > _ALIKE:
        raise InputError("only solid plates are read: MID3 as MID1 or blank, and TS / T of 5/6")
    deck.shells[deck.claim("property", whole(card.get(2)))] = Plate(
        material=material,
        thickness=real(card.get(4)),
        more=real(card.get(9), 0.0),
        shears=shear > 0,
    )


def _face(deck: Deck, card: Card, corners: int) -> None:
    if real(card.get(5 + corners), 0.0) or any(card.get(i) for i in range(6 + corners, 20)):
        raise InputError("an offset, an angle of material or thicknesses at corners are not read")
    numbers = tuple(whole(card.get(4 + i)) for i in range(corners))
    number = deck.claim("element", whole(card.get(2)))
    deck.faces.append((whole(card.get(3), number), numbers, card.place))


def _conm2(deck: Deck, card: Card) -> None:
    if any(real(card.get(i), 0.0) for i in (6, 7, 8, 10, 11, 12, 13, 14, 15)):
        raise InputError("masses beside their grid, and moments of inertia, are not read")
    deck.claim("element", whole(card.get(2)))
    deck.masses.append((whole(card.get(3)), non_negative("M", real(card.get(5)))))


def _pelas(deck: Deck, card: Card) -> None:
    for at in (2, 6):
        if card.get(at):
            number = deck.claim("property", whole(card.get(at)))
            deck.stiffnesses[number] = (non_negative("K", real(card.get(at + 1), 0.0)),)


def _celas1(deck: Deck, card: Card) -> None:
    number = deck.claim("element", whole(card.get(2)))
    _scalar_spring(deck, card, property_number=whole(card.get(3), number), stiffness=None)


def _celas2(deck: Deck, card: Card) -> None:
    deck.claim("element", whole(card.get(2)))
    stiffness = (non_negative("K", real(card.get(3), 0.0)),)
    _scalar_spring(deck, card, property_number=0, stiffness=stiffness)


def _scalar_spring(
    deck: Deck, card: Card, *, property_number: int, stiffness: tuple[float, ...] | None
) -> None:
    """Keep a spring between a dof of one grid and the same of another, or the ground."""
    ends = [(whole(card.get(at), 0), whole(card.get(at + 1), 0)) for at in (4, 6)]
    there = [(grid, dof) for grid, dof in ends if grid]
    if not there:
        raise InputError("a spring needs a grid at one end")
    dofs = {dof for _, dof in there}
    if len(dofs) > 1 or not dofs <= {1, 2, 3, 4, 5, 6}:
        raise InputError("a spring joins one dof of a grid, 1 to 6, to the same of another")
    deck.springs.append(
        Spring(
            ends=(there[0][0], there[1][0] if len(there) > 1 else None),
            stiffness=stiffness,
            property=property_number,
            dof=there[0][1],
            place=card.place,
        )
    )


def _pbush(deck: Deck, card: Card) -> None:
    number, rows = (
        whole(card.get(2)),
        [card.fields[i : i + 8] for i in range(0, len(card.fields), 8)],
    )
    six = (0.0,) * 6
    for row in rows:
        kind, values = row[1].upper(), [*row[2:8], *[""] * 6][:6]
        if kind == "K":
            if any(value.upper() == "RIGID" for value in values):
                raise InputError("RIGID is not read: give a large stiffness")
            six = tuple(non_negative("K", real(value, 0.0)) for value in values)
        elif kind not in {"B", "GE", "RCV", "M", ""}:
            raise InputError(f"{kind} is not read")
    deck.stiffnesses[deck.claim("property", number)] = six


def _cbush(deck: Deck, card: Card) -> None:
    number = deck.claim("element", whole(card.get(2)))
    if any(card.get(i) for i in (6, 7, 8)) or whole(card.get(9), 0):
        raise InputError("a bush lies along the basic axes (CID 0), or is not read")
    if not card.get(9):
        raise InputError("a bush without CID lies along its grids: give CID 0")
    other = whole(card.get(5)) if card.get(5) else None
    deck.springs.append(
        Spring(
            ends=(whole(card.get(4)), other),
            stiffness=None,
            property=whole(card.get(3), number),
            place=card.place,
        )
    )


PART_CARDS: dict[str, Callable[[Deck, Card], None]] = {
    "MAT1": _mat1,
    "PSHELL": _pshell,
    "CQUAD4": lambda deck, card: _face(deck, card, 4),
    "CTRIA3": lambda deck, card: _face(deck, card, 3),
    "CONM2": _conm2,
    "PELAS": _pelas,
    "CELAS1": _celas1,
    "CELAS2": _celas2,
    "PBUSH": _pbush,
    "CBUSH": _cbush,
}
"""What is read, and who takes it."""

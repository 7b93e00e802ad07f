"""Take the cards of Nastran bulk data for materials, shells, springs and masses."""

from __future__ import annotations

from collections.abc import Callable

from trundle._checks import non_negative, positive
from trundle.errors import InputError
from trundle.imports.nastran_cards import Card, real, whole
from trundle.imports.nastran_deck import Deck, Face, Laminate, PlaneLaw, Plate, Spring
from trundle.structure import Material

__all__ = ["PART_CARDS"]

_SHEAR = 5.0 / 6.0


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


def _mat2(deck: Deck, card: Card) -> None:
    x, both, skew_x, y, skew_y, twist = (real(card.get(i), 0.0) for i in range(3, 9))
    if skew_x or skew_y:
        raise InputError("G13 and G23 couple stretching and shear: not read")
    deck.laws[deck.claim("material", whole(card.get(2)))] = PlaneLaw(
        plane=(positive("G11", x), positive("G22", y), both, positive("G33", twist)),
        across=(x, y),  # where it is the third material of a plate: G11 and G22 are across
        density=non_negative("RHO", real(card.get(9), 0.0)),
    )


def _mat8(deck: Deck, card: Card) -> None:
    e1, e2, nu12 = positive("E1", real(card.get(3))), positive("E2", real(card.get(4))), card.get(5)
    nu, g12 = real(nu12, 0.0), positive("G12", real(card.get(6)))
    rest = 1.0 - nu**2 * e2 / e1
    if rest <= 0.0:
        raise InputError(f"E1, E2 and NU12 of {nu:g} leave no energy in some strain")
    across = (real(card.get(7), 0.0), real(card.get(8), 0.0))
    deck.laws[deck.claim("material", whole(card.get(2)))] = PlaneLaw(
        plane=(e1 / rest, e2 / rest, nu * e2 / rest, g12),
        across=across if all(across) else None,
        density=non_negative("RHO", real(card.get(9), 0.0)),
    )


def _pshell(deck: Deck, card: Card) -> None:
    stretching, bending = whole(card.get(3), 0), whole(card.get(5), 0)
    if not stretching or not bending:
        raise InputError("a plate that only stretches, or only bends, is not read: give both MID")
    deck.shells[deck.claim("property", whole(card.get(2)))] = Plate(
        materials=(stretching, bending, whole(card.get(7), 0)),
        thickness=positive("T", real(card.get(4))),
        bending=positive("12 I / T^3", real(card.get(6), 1.0)),
        shear=positive("TS / T", real(card.get(8), _SHEAR)),
        more=real(card.get(9), 0.0),
    )


def _pcomp(deck: Deck, card: Card) -> None:
    number, words = whole(card.get(2)), card.fields[8:]
    symmetric = card.get(9).upper()
    if symmetric not in {"", "SYM"}:
        raise InputError(f"a laminate of {symmetric} is not read; SYM, or none, is")
    plies = list[tuple[int, float, float]]()
    for at in range(0, len(words), 4):
        ply = [*words[at : at + 4], "", "", ""]
        if any(ply[:3]):
            material = whole(ply[0], plies[-1][0] if plies else 0)
            thick = real(ply[1], plies[-1][1] if plies else 0.0)
            plies.append((material, positive("the thickness of a ply", thick), real(ply[2], 0.0)))
    if not plies:
        raise InputError("a laminate without plies")
    plies += plies[::-1] if symmetric else []
    whole_thickness = sum(thick for _, thick, _ in plies)
    deck.shells[deck.claim("property", number)] = Laminate(
        plies=tuple(plies),
        bottom=real(card.get(3), -0.5 * whole_thickness),
        more=real(card.get(4), 0.0),
    )


def _face(deck: Deck, card: Card, corners: int) -> None:
    if real(card.get(5 + corners), 0.0) or any(card.get(i) for i in range(6 + corners, 20)):
        raise InputError("an offset, or thicknesses at corners, are not read")
    numbers = tuple(whole(card.get(4 + i)) for i in range(corners))
    number, way = deck.claim("element", whole(card.get(2))), card.get(4 + corners)
    system = whole(way) if way and way.lstrip("+").isdigit() else None
    deck.faces.append(
        Face(
            property=whole(card.get(3), number),
            corners=numbers,
            angle=0.0 if system is not None else real(way, 0.0),
            system=system,
            place=card.place,
        )
    )


def _conm2(deck: Deck, card: Card) -> None:
    if any(real(card.get(i), 0.0) for i in (6, 7, 8, 11, 13, 14)):
        raise InputError("masses beside their grid, and products of inertia, are not read")
    deck.claim("element", whole(card.get(2)))
    mass = non_negative("M", real(card.get(5)))
    about = (non_negative("I", real(card.get(i), 0.0)) for i in (10, 12, 15))
    deck.masses.append((whole(card.get(3)), (mass, mass, mass, *about)))


def _cmass2(deck: Deck, card: Card) -> None:
    deck.claim("element", whole(card.get(2)))
    mass, grid, dof = non_negative("M", real(card.get(3))), whole(card.get(4)), whole(card.get(5))
    if card.get(6) or not 1 <= dof <= 6:
        raise InputError("a scalar mass is read at one dof of one grid, 1 to 6")
    deck.own_masses[grid][dof - 1] += mass


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
    "MAT2": _mat2,
    "MAT8": _mat8,
    "PSHELL": _pshell,
    "PCOMP": _pcomp,
    "CQUAD4": lambda deck, card: _face(deck, card, 4),
    "CTRIA3": lambda deck, card: _face(deck, card, 3),
    "CONM2": _conm2,
    "CMASS2": _cmass2,
    "PELAS": _pelas,
    "CELAS1": _celas1,
    "CELAS2": _celas2,
    "PBUSH": _pbush,
    "CBUSH": _cbush,
}
"""What is read, and who takes it."""

"""Take the cards of Nastran bulk data that place, hold and join grids, and its parameters."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from trundle.errors import InputError
from trundle.imports.nastran_cards import Card, real, whole
from trundle.imports.nastran_deck import Deck, Grid, System

__all__ = ["GRID_CARDS"]

_HARMLESS = frozenset(
    (
        "POST", "AUTOSPC", "PRGPCHK", "PRGPST", "GRDPNT", "BAILOUT", "PRTMAXIM", "OGEOM", "K6ROT",
        "SNORM", "GPWG", "LAMA", "OMACHPR", "POSTEXT", "OUGCORD", "MAXRATIO", "EPSRAT", "NOCOMPS",
        "USETPRT", "EXTOUT", "FIXEDB", "LMODES", "RESVEC", "UNITSYS",
    )
)  # fmt: skip
"""Parameters of output and solution. UNITSYS names units, which are taken as they are."""


def _grid(deck: Deck, card: Card) -> None:
    number = deck.claim("grid", whole(card.get(2)))
    deck.grids[number] = Grid(
        system=whole(card.get(3)) if card.get(3) else None,
        place=np.array([real(card.get(i), 0.0) for i in (4, 5, 6)]),
        moves_in=whole(card.get(7)) if card.get(7) else None,
        held=card.get(8),
    )


def _grdset(deck: Deck, card: Card) -> None:
    deck.claim("GRDSET", 0)
    deck.every_grid = Grid(
        system=whole(card.get(3)) if card.get(3) else None,
        moves_in=whole(card.get(7)) if card.get(7) else None,
        held=card.get(8),
    )


def _by_points(kind: str) -> Callable[[Deck, Card], None]:
    """Return what takes a CORD2R, CORD2C or CORD2S."""

    def take(deck: Deck, card: Card) -> None:
        """Keep its three points."""
        points = np.array([real(card.get(i), 0.0) for i in range(4, 13)]).reshape(3, 3)
        along, aside = points[1] - points[0], points[2] - points[0]
        across = float(np.linalg.norm(np.cross(along, aside)))
        if not across > 1e-9 * float(np.linalg.norm(along) * np.linalg.norm(aside)):
            raise InputError("its three points lie on one line")
        number = deck.claim("coordinate system", whole(card.get(2)))
        deck.systems[number] = System(kind=kind, under=whole(card.get(3), 0), points=points)

    return take


def _by_grids(kind: str) -> Callable[[Deck, Card], None]:
    """Return what takes a CORD1R, CORD1C or CORD1S, which name grids; a card has one or two."""

    def take(deck: Deck, card: Card) -> None:
        """Keep its three grids."""
        for at in (2, 6):
            if card.get(at):
                number = deck.claim("coordinate system", whole(card.get(at)))
                a, b, c = (whole(card.get(at + i)) for i in (1, 2, 3))
                deck.systems[number] = System(kind=kind, grids=(a, b, c))

    return take


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
    if not named:
        raise InputError("names no grid that is held")
    ranges = _ranges(named)
    deck.supports[whole(card.get(2))].extend((numbers, card.get(3)) for numbers in ranges)


def _ranges(named: list[str]) -> list[range]:
    """Return the grids of a list in which ``THRU`` stands between the ends of a range."""
    if len(named) == 3 and named[1].upper() == "THRU":
        return [range(whole(named[0]), whole(named[2]) + 1)]
    return [range(n, n + 1) for n in (whole(value) for value in named)]


def _spcadd(deck: Deck, card: Card) -> None:
    deck.added[whole(card.get(2))] = [whole(value) for value in card.fields[1:] if value]


def _rbe2(deck: Deck, card: Card) -> None:
    deck.claim("element", whole(card.get(2)))
    dofs = "".join(sorted(card.get(4)))
    if not dofs or not set(dofs) <= set("123456") or len(set(dofs)) < len(dofs):
        raise InputError(f"grids follow in dofs 1 to 6; got {card.get(4)!r}")
    named = [value for value in card.fields[3:] if value]
    if named and not named[-1].lstrip("+-").isdigit():
        real(named.pop())  # a coefficient of thermal expansion
    ranges = tuple(_ranges(named))
    if not any(len(some) for some in ranges):
        raise InputError("names no grid that follows")
    deck.rigid.append((whole(card.get(3)), ranges, dofs, card.place))


def _param(deck: Deck, card: Card) -> None:
    name, value = card.get(2).upper(), card.get(3).upper()
    if name == "WTMASS":
        deck.weight_to_mass = real(card.get(3))
    elif name == "COUPMASS":
        deck.consistent = value == "YES" or (value not in {"NO", ""} and whole(value) > 0)
    elif name not in _HARMLESS:
        raise InputError(f"PARAM {name} is not known: it may change the model")


GRID_CARDS: dict[str, Callable[[Deck, Card], None]] = {
    "GRID": _grid,
    "GRDSET": _grdset,
    "CORD2R": _by_points("R"),
    "CORD2C": _by_points("C"),
    "CORD2S": _by_points("S"),
    "CORD1R": _by_grids("R"),
    "CORD1C": _by_grids("C"),
    "CORD1S": _by_grids("S"),
    "SPC": _spc,
    "SPC1": _spc1,
    "SPCADD": _spcadd,
    "RBE2": _rbe2,
    "PARAM": _param,
}
"""What is read, and who takes it."""

"""Nastran bulk data: shells, bars, masses and supports; every other card is told, none is dropped.

Read are grids in systems of all kinds, CQUAD4, CTRIA3, CBAR, CBEAM, CROD and CONROD with their
properties, springs, RBE2, MAT1, CONM2, SPC, SPC1, SPCADD and INCLUDE, in all three forms of fields;
lengths in m, forces in N, masses in kg. Masses are lumped, as Nastran's are, unless PARAM COUPMASS
asks for consistent ones.

Reference: MSC Nastran 2021 Quick Reference Guide, bulk data entries.
"""

from __future__ import annotations

import re
from collections import Counter
from pathlib import Path

from trundle.errors import InputError, Problem
from trundle.imports.model_format import Asked, ModelFormat, ReadModel
from trundle.imports.nastran_cards import Card, cards_of, case_control
from trundle.imports.nastran_deck import Deck
from trundle.imports.nastran_grids import GRID_CARDS
from trundle.imports.nastran_members import MEMBER_CARDS
from trundle.imports.nastran_model import floor_of
from trundle.imports.nastran_parts import PART_CARDS
from trundle.imports.unit_system import agreed_units, in_si

__all__ = ["FORMAT"]

_MOST = 100  # problems that are told: more say nothing new
_CARDS = {**GRID_CARDS, **PART_CARDS, **MEMBER_CARDS}

_NOTHING_OF_THE_MODEL = frozenset(
    (
        "EIGRL", "EIGR", "EIGB", "FORCE", "MOMENT", "PLOAD", "PLOAD1", "PLOAD2", "PLOAD4", "GRAV",
        "LOAD", "TEMP", "TEMPD", "TLOAD1", "TLOAD2", "RLOAD1", "RLOAD2", "DLOAD", "DAREA",
        "TABLED1", "TSTEP", "FREQ", "FREQ1", "MDLPRM", "SPOINT", "ASET", "ASET1", "QSET", "QSET1",
        "USET", "USET1", "EIGC", "TABDMP1", "SUPORT", "SUPORT1", "BNDFREE", "BNDFIX", "BNDFREE1",
        "BNDFIX1", "CSET", "CSET1", "BSET", "BSET1", "MAT4", "MAT5", "MATT1", "TABLEM1", "TABLEM2",
        "TABLEST",
    )
)  # fmt: skip
"""Loads, what is asked for, heat and temperature, and points of a reduction, which hold nothing."""


def read(path: Path, asked: Asked) -> ReadModel:
    """Read bulk data.

    Parameters
    ----------
    path : Path
        A file with or without executive and case control; masses after WTMASS.
    asked : Asked
        Cards to be passed over.
    """
    deck, problems = Deck(), list[Problem]()
    passed, files = Counter[str](), dict[Path, None]()
    for card in cards_of(path, files):
        if card.name in _NOTHING_OF_THE_MODEL or card.name in asked.ignore:
            passed[card.name] += 1
            continue
        problem = _taken(deck, card)
        if problem is not None:
            problems.append(problem)
        if len(problems) == _MOST:
            break
    told = tuple(f"passed over: {name} ({times})" for name, times in sorted(passed.items()))
    floor, units = None, None
    if not problems:
        try:
            units, said = agreed_units(None, asked.units)
            told = (*said, *told)
            control = case_control(path)
            if "MPC" in control:
                raise InputError(f"case control asks for MPC {control['MPC']}, which is not read")
            floor = in_si(floor_of(deck, control.get("SPC"), path.stem), units)
        except InputError as error:
            problem = Problem(
                place=path.name, value="the model", rule=str(error), remedy="correct the model"
            )
            problems.append(problem)
    return ReadModel(
        structure=floor, problems=tuple(problems), units=units, told=told, files=tuple(files)
    )


def _taken(deck: Deck, card: Card) -> Problem | None:
    """Take a card into the deck; return why it cannot be."""
    if card.name == "INCLUDE":
        return Problem(
            place=card.place,
            value=card.get(2),
            rule="no such file: what it holds of the model is not known",
            remedy="put it beside the model",
        )
    if card.name not in _CARDS:
        return Problem(
            place=card.place,
            value=card.name,
            rule="this card is not read, and nothing is left out in silence",
            remedy="if it is nothing of the model, put it into ignore = [..]; read are "
            + ", ".join(_CARDS),
        )
    try:
        _CARDS[card.name](deck, card)
        _check_whole(card)
    except InputError as error:
        rule, _, value = str(error).partition("; got ")
        shown = f"{card.name} {card.get(2)}" + (f": {value}" if value else "")
        return Problem(place=card.place, value=shown, rule=rule, remedy="correct the card")
    return None


_OF_NO_MATTER = {
    "MAT1": range(7, 14), "MAT2": range(10, 19), "MAT8": range(10, 26), "PSHELL": range(10, 12),
    "PBAR": range(10, 18), "GRID": range(9, 10), "CELAS2": range(8, 10), "PROD": range(6, 7),
    "CONROD": range(8, 9), "PARAM": range(4, 10),
}  # fmt: skip
"""Fields of stresses, heat, damping and superelements, by their numbers."""

_LISTS = {"PBEAM", "PBEAML", "PBARL", "PCOMP", "PBUSH", "PELAS", "SPC", "SPC1", "SPCADD", "RBE2"}
"""Cards whose fields are taken as lists: they look at all of them."""


def _check_whole(card: Card) -> None:
    """Refuse fields that nobody reads: a card that is damaged swallows the next."""
    ignored = _OF_NO_MATTER.get(card.name, ())
    odd = [i for i in card.unread if i not in ignored and card.name not in _LISTS]
    if odd:
        raise InputError(f"field {odd[0]} is not read; got {card.get(odd[0])!r}")


FORMAT = ModelFormat(
    kind="nastran",
    name="Nastran bulk data",
    suffixes=(".bdf", ".dat", ".nas"),
    claims=lambda data: re.search(rb"^\s*(BEGIN\s+BULK|GRID[*, ])", data, re.I | re.M) is not None,
    read=read,
)

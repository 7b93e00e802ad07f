"""Choose channels of a record by name, number, unit or axis."""

from __future__ import annotations

from trundle.errors import InputError
from trundle.records.headings import usual_unit
from trundle.records.raw import RawRecord
from trundle.signals import axis_of

__all__ = ["choose"]

_AXES = {"vertical", "horizontal"}


def choose(raw: RawRecord, wanted: str, source: str) -> RawRecord:
    """Return the channels that are asked for.

    Parameters
    ----------
    raw : RawRecord
        The record.
    wanted : str
        Names, numbers from 1, units or axes, between commas; empty for all. A name wins over a
        number, for it is what the file says.
    source : str
        The file's name, for messages.

    Raises
    ------
    InputError
        Something that no channel is.
    """
    found: list[int] = []
    for part in filter(None, (part.strip() for part in wanted.split(","))):
        here = _matching(raw, part)
        if not here:
            there = ", ".join(
                f"{i + 1} {name!r}" + (f" [{unit}]" if unit else "")
                for i, (name, unit) in enumerate(zip(raw.names, raw.units, strict=True))
            )
            raise InputError(f"{source}: no channel is {part!r}; there are {there}")
        found += [i for i in here if i not in found]
    return raw.chosen(found) if found else raw


def _matching(raw: RawRecord, part: str) -> list[int]:
    names = [name.casefold() for name in raw.names]
    word = part.casefold()
    exact = [i for i, name in enumerate(names) if name == word]
    if exact:
        return exact
    if part.isdecimal() and 1 <= int(part) <= len(names):
        return [int(part) - 1]
    axes = [a or axis_of(n) for a, n in zip(raw.axes or ("",) * len(names), raw.names, strict=True)]
    if word in _AXES:
        return [i for i, axis in enumerate(axes) if axis == word]
    of_unit = [
        i for i, unit in enumerate(raw.units) if unit and usual_unit(unit) == usual_unit(part)
    ]
    if of_unit:
        return of_unit
    ends = [i for i, name in enumerate(names) if len(word) > 1 and name.endswith(word)]
    return ends or [i for i, name in enumerate(names) if name.split()[-1:] == [word]]

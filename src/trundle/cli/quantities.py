"""Read quantities that options give."""

from __future__ import annotations

from trundle.errors import InputError
from trundle.units import to_si

__all__ = ["quantity_of"]


def quantity_of(option: str, text: str, dimension: str) -> float:
    """Return what an option gives, in SI.

    Parameters
    ----------
    option : str
        Its name, for messages.
    text : str
        Such as ``"15 km/h"``.
    dimension : str
        What it must be, see `trundle.units.to_si`.

    Raises
    ------
    InputError
        With the option, what it says, and what is wrong with it.
    """
    try:
        return to_si(text, dimension)
    except InputError as error:
        raise InputError(f"{option} {text!r}: {error}") from None

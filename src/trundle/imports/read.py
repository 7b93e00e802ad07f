"""Read a structural model, whatever format its file is in."""

from __future__ import annotations

from pathlib import Path

from trundle.errors import InputError
from trundle.imports.model_format import ReadModel, all_formats

__all__ = ["read_model"]

_FIRST = 4096  # bytes by which formats are told
_LARGEST = 2_000_000_000  # bytes


def read_model(path: Path) -> ReadModel:
    """Read a structural model.

    Parameters
    ----------
    path : Path
        A file of one of the formats that are known.

    Raises
    ------
    InputError
        A file that cannot be read, or that is of no format that is known.
    """
    try:
        if not path.is_file():
            raise InputError(f"{path}: no such file; name the file of a structural model")
        if path.stat().st_size > _LARGEST:
            raise InputError(f"{path}: a model may have {_LARGEST / 1e9:g} GB")
        with path.open("rb") as opened:
            first = opened.read(_FIRST)
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror})") from None
    found = next((one for one in all_formats() if one.claims(first)), None)
    if found is None:
        names = ", ".join(f"{one.name} ({', '.join(one.suffixes)})" for one in all_formats())
        raise InputError(f"{path}: of no format that is known: {names}")
    return found.read(path)

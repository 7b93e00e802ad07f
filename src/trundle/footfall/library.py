"""Offer the load functions that ship with trundle, one file each."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from functools import cache
from importlib import resources
from types import MappingProxyType

from trundle._checks import one_of
from trundle.footfall.load import FootfallLoad, Harmonic, Impulse

__all__ = ["FOOTFALLS", "footfall_load"]


def _shipped() -> Mapping[str, str]:
    """Return the text of every file by its name."""
    folder = resources.files("trundle.footfall").joinpath("data")
    files = sorted((f for f in folder.iterdir() if f.name.endswith(".toml")), key=lambda f: f.name)
    return MappingProxyType({f.name.removesuffix(".toml"): f.read_text("utf-8") for f in files})


_TEXTS = _shipped()
FOOTFALLS: tuple[str, ...] = tuple(_TEXTS)
"""Names of all load functions."""


@cache
def footfall_load(name: str) -> FootfallLoad:
    """Return a load function by its name.

    Parameters
    ----------
    name : str
        One of `FOOTFALLS`.

    Raises
    ------
    InputError
        No such load function; the message lists what there is.
    """
    data = tomllib.loads(_TEXTS[one_of("footfall", name, FOOTFALLS)])
    low, high = data["paces"]
    return FootfallLoad(
        name=name,
        title=data["title"],
        source=data["source"],
        confidence=data["confidence"],
        assumption=data.get("assumption", ""),
        weight=data["weight"],
        paces=(low, high),
        harmonics=tuple(Harmonic(**one) for one in data["harmonic"]),
        impulse=Impulse(**data["impulse"]) if "impulse" in data else None,
        speed=tuple(data.get("speed", ())),
    )

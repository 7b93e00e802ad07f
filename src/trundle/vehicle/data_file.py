"""Read vehicles that ship as data: one file a vehicle, a source beside every number."""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial
from importlib import resources
from importlib.resources.abc import Traversable
from typing import Any, TypeVar

from trundle.errors import InputError
from trundle.vehicle.model import Vehicle
from trundle.vehicle.planar import Axle, Body, Hinge, LumpedMass, build_vehicle

__all__ = ["VehicleFile", "read_vehicle", "shipped_vehicles"]

Part = TypeVar("Part")

_KEYS = ("title", "source", "body", "hinge", "axle", "worn", "payload")


@dataclass(frozen=True, kw_only=True, eq=False)
class VehicleFile:
    """Hold a vehicle as its file tells it, with the states that it can be built in.

    Attributes
    ----------
    name : str
        Name that a study file uses: the file's own.
    title, source : str
        Name for tables, and where the numbers come from.
    bodies, hinges, axles : tuple
        The parts, see `build_vehicle`.
    worn : tuple of float
        Suspension damping of each axle with worn dampers [N s/m]; empty where the file has none.
    payload : LumpedMass or None
        What it can carry.
    """

    name: str
    title: str
    source: str
    bodies: tuple[Body, ...]
    hinges: tuple[Hinge, ...]
    axles: tuple[Axle, ...]
    worn: tuple[float, ...] = ()
    payload: LumpedMass | None = None

    def build(self, *, worn: bool = False, laden: bool = False) -> Vehicle:
        """Build the vehicle, with worn dampers or its payload if asked.

        Raises
        ------
        InputError
            A state that the file does not tell.
        """
        if (worn and not self.worn) or (laden and self.payload is None):
            raise InputError(
                f"vehicle {self.name!r} has no {'worn dampers' if worn else 'payload'}"
            )
        axles = self.axles
        if worn:
            pairs = zip(self.axles, self.worn, strict=True)
            axles = tuple(replace(axle, damping=damping) for axle, damping in pairs)
        notes = ", worn dampers" * worn + ", laden" * laden
        return build_vehicle(
            name=self.title + notes,
            bodies=self.bodies,
            hinges=self.hinges,
            axles=axles,
            lumped=(self.payload,) if laden and self.payload else (),
            source=self.source,
        )

    def states(self) -> Iterator[tuple[str, Callable[[], Vehicle]]]:
        """Give a name and a builder for every state.

        Yields
        ------
        tuple of str and callable
            As it is; with worn dampers, laden, and both, where the file tells them.
        """
        yield self.name, self.build
        if self.worn:
            yield f"{self.name}_worn", partial(self.build, worn=True)
        if self.payload:
            yield f"{self.name}_laden", partial(self.build, laden=True)
        if self.worn and self.payload:
            yield f"{self.name}_laden_worn", partial(self.build, worn=True, laden=True)


def shipped_vehicles() -> dict[str, Callable[[], Vehicle]]:
    """Return every vehicle of the data folder by name; each file there is found by itself."""
    folder = resources.files("trundle.vehicle").joinpath("data")
    files = sorted((f for f in folder.iterdir() if f.name.endswith(".toml")), key=lambda f: f.name)
    return dict(state for file in files for state in read_vehicle(file).states())


def read_vehicle(file: Traversable) -> VehicleFile:
    """Read a vehicle file.

    Parameters
    ----------
    file : path-like
        TOML in SI units. ``title`` and ``source``; tables ``[[body]]``, ``[[hinge]]`` and
        ``[[axle]]`` with the attributes of `Body`, `Hinge` and `Axle`; ``[worn]`` with a
        ``damping`` for each axle; ``[payload]`` with ``mass``, ``body`` and ``setback``.
        Every table has a ``source`` of its own numbers.

    Raises
    ------
    InputError
        A key too many or too few, a table without a source, a number that cannot be.
    """
    data = tomllib.loads(file.read_text("utf-8"))
    unknown = sorted(set(data) - set(_KEYS))
    if unknown:
        raise InputError(f"{file.name}: unknown key {unknown[0]!r}; known: {', '.join(_KEYS)}")
    for key in ("title", "source"):
        if not str(data.get(key, "")).strip():
            raise InputError(f"{file.name}: a vehicle needs a {key}")
    axles = _parts(file.name, "axle", data.get("axle", []), Axle)
    loads = _parts(file.name, "payload", [data["payload"]] if "payload" in data else [], LumpedMass)
    return VehicleFile(
        name=file.name.removesuffix(".toml"),
        title=data["title"],
        source=data["source"],
        bodies=_parts(file.name, "body", data.get("body", []), Body),
        hinges=_parts(file.name, "hinge", data.get("hinge", []), Hinge),
        axles=axles,
        worn=_worn(file.name, data["worn"], len(axles)) if "worn" in data else (),
        payload=loads[0] if loads else None,
    )


def _parts(
    file: str, key: str, tables: list[dict[str, Any]], make: Callable[..., Part]
) -> tuple[Part, ...]:
    found: list[Part] = []
    for number, table in enumerate(tables, start=1):
        place = f"{file}, {key} {number}"
        values = _sourced(place, table)
        try:
            found.append(make(**{k: tuple(v) if k == "bodies" else v for k, v in values.items()}))
        except (TypeError, InputError) as error:  # an unknown or a missing key is a TypeError
            raise InputError(f"{place}: {error}") from None
    return tuple(found)


def _worn(file: str, table: dict[str, Any], n_axles: int) -> tuple[float, ...]:
    damping = tuple(float(c) for c in _sourced(f"{file}, worn", table)["damping"])
    if len(damping) != n_axles or min(damping) < 0.0:
        raise InputError(
            f"{file}, worn: damping must be {n_axles} numbers of 0 or more, one an axle; "
            f"got {list(damping)}"
        )
    return damping


def _sourced(place: str, table: dict[str, Any]) -> dict[str, Any]:
    if not str(table.get("source", "")).strip():
        raise InputError(f"{place}: every table needs the source of its numbers")
    return {key: value for key, value in table.items() if key != "source"}

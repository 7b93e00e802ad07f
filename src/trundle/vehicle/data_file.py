"""Read vehicles that ship as data: one file a vehicle, a source beside every number."""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from importlib import resources
from importlib.resources.abc import Traversable
from typing import Any, TypeVar, get_args

from trundle._checks import one_of
from trundle.errors import InputError
from trundle.vehicle.description import Description
from trundle.vehicle.model import Confidence, Vehicle
from trundle.vehicle.parts import Axle, Body, Bogie, Hinge, LumpedMass, Unit
from trundle.vehicle.sheet import DataSheet

__all__ = ["VehicleFile", "read_vehicle", "shipped_files"]

Part = TypeVar("Part")

_TEXTS = ("title", "source", "confidence")
_KEYS = (
    *_TEXTS, "assumption", "contact_patch", "wheel_radius",
    "body", "hinge", "axle", "bogie", "unit", "worn", "payload", "sheet",
)  # fmt: skip


@dataclass(frozen=True, kw_only=True, eq=False)
class VehicleFile:
    """Hold a vehicle as its file tells it, with the states that it can be built in.

    Attributes
    ----------
    name : str
        Name that a study file uses: the file's own.
    parts : Description or DataSheet
        Its parts, or what its data sheet says.
    confidence : {"high", "medium", "low"}
        How far the numbers can be trusted.
    worn : tuple of float
        Suspension damping of each axle with worn dampers [N s/m]; empty where the file has none.
    payload : LumpedMass or None
        What it can carry.
    """

    name: str
    parts: Description | DataSheet
    confidence: Confidence
    worn: tuple[float, ...] = ()
    payload: LumpedMass | None = None

    def describe(
        self, *, worn: bool = False, laden: bool = False, changes: Mapping[str, Any] | None = None
    ) -> Description:
        """Return the vehicle's parts, with worn dampers or its payload if asked.

        Parameters
        ----------
        worn, laden : bool
            With worn dampers; with its payload.
        changes : mapping, optional
            Fields of its data sheet in place of what the file says.

        Raises
        ------
        InputError
            A state that the file does not tell, or changes of one that has no data sheet.
        """
        if (worn and not self.worn) or (laden and not self._can_carry):
            raise InputError(
                f"vehicle {self.name!r} has no {'worn dampers' if worn else 'payload'}"
            )
        if isinstance(self.parts, DataSheet):
            sheet = replace(self.parts, **_in_place_of(changes or {}))
            return replace(sheet.description(laden=laden), confidence=self.confidence)
        if changes:
            raise InputError(
                f"vehicle {self.name!r} is known by its parts: {', '.join(changes)} cannot be "
                "changed"
            )
        return self._in_state(self.parts, worn=worn, laden=laden)

    def build(self, *, worn: bool = False, laden: bool = False) -> Vehicle:
        """Build the vehicle, with worn dampers or its payload if asked.

        Raises
        ------
        InputError
            A state that the file does not tell.
        """
        return self.describe(worn=worn, laden=laden).build()

    def _in_state(self, parts: Description, *, worn: bool, laden: bool) -> Description:
        axles = parts.axles
        if worn:
            pairs = zip(axles, self.worn, strict=True)
            axles = tuple(replace(axle, damping=damping) for axle, damping in pairs)
        notes = ", worn dampers" * worn + ", laden" * laden
        return replace(
            parts,
            name=parts.name + notes,
            axles=axles,
            lumped=(*parts.lumped, self.payload) if laden and self.payload else parts.lumped,
            confidence=self.confidence,
        )

    @property
    def _can_carry(self) -> bool:
        return bool(self.parts.laden) if isinstance(self.parts, DataSheet) else bool(self.payload)

    def states(self) -> Iterator[tuple[str, dict[str, bool]]]:
        """Give a name for every state, and what to ask for.

        Yields
        ------
        tuple of str and dict
            As it is; with worn dampers, laden, and both, where the file tells them.
        """
        yield self.name, {}
        if self.worn:
            yield f"{self.name}_worn", {"worn": True}
        if self._can_carry:
            yield f"{self.name}_laden", {"laden": True}
        if self.worn and self.payload:
            yield f"{self.name}_laden_worn", {"worn": True, "laden": True}


def _in_place_of(changes: Mapping[str, Any]) -> dict[str, Any]:
    """Return changes of a data sheet: a tyre's stiffness takes the place of a frequency."""
    if "tyre_stiffness" in changes:
        return {"bounce": 0.0, "hop": 0.0, **changes}
    if "bounce" in changes:
        return {"stiffness": (), "tyre_stiffness": (), **changes}
    return dict(changes)


def shipped_files() -> list[VehicleFile]:
    """Return every vehicle of the data folder; each file there is found by itself."""
    folder = resources.files("trundle.vehicle").joinpath("data")
    files = sorted((f for f in folder.iterdir() if f.name.endswith(".toml")), key=lambda f: f.name)
    return [read_vehicle(file) for file in files]


def read_vehicle(file: Traversable) -> VehicleFile:
    """Read a vehicle file.

    Parameters
    ----------
    file : path-like
        TOML in SI units. ``title``, ``source`` and ``confidence`` (high, medium or low), and if
        need be ``assumption``, ``contact_patch`` and ``wheel_radius``; then either ``[sheet]`` with
        the attributes of `DataSheet`, or tables ``[[body]]``, ``[[hinge]]``, ``[[axle]]``,
        ``[[bogie]]`` and ``[[unit]]`` with those of `Body`, `Hinge`, `Axle`, `Bogie` and `Unit`;
        ``[worn]`` with a ``damping`` for each axle; ``[payload]`` with ``mass``, ``body`` and
        ``setback``. Every table has a ``source`` of its own numbers.

    Raises
    ------
    InputError
        A key too many or too few, a table without a source, a number that cannot be.
    """
    data = tomllib.loads(file.read_text("utf-8"))
    unknown = sorted(set(data) - set(_KEYS))
    if unknown:
        raise InputError(f"{file.name}: unknown key {unknown[0]!r}; known: {', '.join(_KEYS)}")
    for key in _TEXTS:
        if not str(data.get(key, "")).strip():
            raise InputError(f"{file.name}: a vehicle needs a {key}")
    one_of(f"{file.name}: confidence", data["confidence"], get_args(Confidence))
    axles = data.get("axle", [])
    loads = _parts(file.name, "payload", [data["payload"]] if "payload" in data else [], LumpedMass)
    return VehicleFile(
        name=file.name.removesuffix(".toml"),
        parts=_sheet(file.name, data) if "sheet" in data else _description(file.name, data),
        confidence=data["confidence"],
        worn=_worn(file.name, data["worn"], len(axles)) if "worn" in data else (),
        payload=loads[0] if loads else None,
    )


def _common(data: Mapping[str, Any]) -> dict[str, Any]:
    keys = ("source", "assumption", "contact_patch", "wheel_radius")
    return {"name": data["title"], **{key: data[key] for key in keys if key in data}}


def _sheet(file: str, data: dict[str, Any]) -> DataSheet:
    others = sorted({"body", "axle", "bogie", "hinge", "unit", "worn", "payload"} & set(data))
    if others:
        raise InputError(f"{file}: a vehicle with a [sheet] has no {others[0]}: leave it out")
    common = _common(data)
    (made,) = _parts(file, "sheet", [data["sheet"]], lambda **v: DataSheet(**common, **v))
    return made


def _description(file: str, data: dict[str, Any]) -> Description:
    return Description(
        **_common(data),
        bodies=_parts(file, "body", data.get("body", []), Body),
        hinges=_parts(file, "hinge", data.get("hinge", []), Hinge),
        axles=_parts(file, "axle", data.get("axle", []), Axle),
        bogies=_parts(file, "bogie", data.get("bogie", []), Bogie),
        units=_parts(file, "unit", data.get("unit", []), Unit),
    )


def _parts(
    file: str, key: str, tables: list[dict[str, Any]], make: Callable[..., Part]
) -> tuple[Part, ...]:
    found: list[Part] = []
    for number, table in enumerate(tables, start=1):
        place = f"{file}, {key} {number}"
        values = _sourced(place, table)
        try:
            found.append(make(**{k: tuple(v) if isinstance(v, list) else v
                                 for k, v in values.items()}))  # fmt: skip
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

"""Read in which units a model's numbers are, and turn a floor into SI.

Programs count in any consistent units: of force, of length and of time, the second; mass follows.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from trundle.errors import InputError
from trundle.structure import (
    BeamGroup,
    BeamSection,
    Floor,
    Material,
    OrthotropicSection,
    PointMasses,
    ShellGroup,
    ShellSection,
    SpringGroup,
    TriangleGroup,
)
from trundle.structure.elements import Elements, NodeInertia, ReleasedBeams
from trundle.units import to_si

__all__ = ["SI", "Units", "agreed_units", "in_si", "says_no_unit", "says_unit", "units_of"]

_FORCES = {
    "n": 1.0, "kn": 1e3, "kgf": 9.80665, "tonf": 9806.65, "tf": 9806.65,
    "lb": 4.4482216152605, "lbf": 4.4482216152605, "kip": 4448.2216152605, "kips": 4448.2216152605,
    "dyne": 1e-5,
}  # fmt: skip
_FORCES_BY_CASE = {"MN": 1e6, "mN": 1e-3}  # a capital M is a million, a small one a thousandth
_LENGTHS = {"m", "cm", "mm", "in", "ft", "dm", "micron", "inch", "meter", "metre"}
_MASSES = {"kg", "t", "g", "tonne", "slug", "slinch", "mg"}
_NOT_MECHANICAL = {"c", "f", "k", "s", "sec"}  # temperature, and the second
_OTHERS = {
    "sec", "s", "ms", "min", "hz", "cyc", "cycle", "cycles", "cps", "rpm", "rad", "radian",
    "radians", "deg", "degree", "degrees", "mn",
}  # fmt: skip
_NO_UNIT = {"", "-", "text", "unitless", "none", "yes/no"}  # below a heading
_PRODUCT = re.compile(r"(?:1/)?[a-z]+(?:\^?-?\d)?(?:[*/·.-][a-z]+(?:\^?-?\d)?)*")
_SAME = 1e-5  # relative, by which a mass may differ from force and length's


@dataclass(frozen=True, kw_only=True)
class Units:
    """Hold the units of a model, by what one of each is in SI.

    Attributes
    ----------
    force, length : float
        One of them [N], [m].
    said : str
        How they are written, and who says so.
    """

    force: float = 1.0
    length: float = 1.0
    said: str = "N, m"

    @property
    def mass(self) -> float:
        """One unit of mass [kg]: what a unit of force moves by a unit of length each second."""
        return self.force / self.length

    def of(self, force: int, length: int) -> float:
        """Return one unit of a quantity in SI, by its powers of force and length."""
        return self.force**force * self.length**length


SI = Units()


def units_of(text: str) -> Units:
    """Read units such as ``"kip, in, F"``, ``"N, mm, t"`` or ``"kN, m"``.

    Raises
    ------
    InputError
        No force and length, or a mass that does not go with them.
    """
    words = [word for word in re.split(r"[\s,;]+", text.strip().strip('"')) if word]
    force = next((one for one in words if _newtons(one) is not None), None)
    length = next((one for one in words if one.lower() in _LENGTHS), None)
    rest = [w for w in words if w not in (force, length) and w.lower() not in _NOT_MECHANICAL]
    newtons = None if force is None else _newtons(force)
    if newtons is None or length is None or any(one.lower() not in _MASSES for one in rest):
        raise InputError(
            f"units {text!r} are not understood; write those of force and length, such as "
            '"kN, m" or "kip, in"'
        )
    units = Units(
        force=newtons,
        length=to_si(f"1 {_spelled(length)}", "length"),
        said=f"{force}, {length}",
    )
    for one in rest:
        mass = 175.126835 if one.lower() == "slinch" else to_si(f"1 {one}", "mass")
        if abs(mass / units.mass - 1.0) > _SAME:
            raise InputError(
                f"units {text!r} do not go together: {force} moves {units.mass:.6g} kg by one "
                f"{length} a second squared, and one {one} is {mass:g} kg"
            )
    return units


def _newtons(word: str) -> float | None:
    """Return one unit of a force [N]; None where a word is none."""
    return _FORCES_BY_CASE.get(word, _FORCES.get(word.lower()))


def says_unit(word: str) -> bool:
    """Return whether a word is a unit of mechanics, or a product such as ``kN-s2/m``."""
    plain = word.strip("[]()").lower()
    if not _PRODUCT.fullmatch(plain):
        return False
    known = {*_FORCES, *_LENGTHS, *_MASSES, *_OTHERS}
    return all(part in known for part in re.findall(r"[a-z]+", plain))


def says_no_unit(word: str) -> bool:
    """Return whether a word below a heading says that its column has no unit."""
    return word.strip("[]()").lower() in _NO_UNIT


def agreed_units(stated: Units | None, asked: Units | None) -> tuple[Units, tuple[str, ...]]:
    """Return the units that a file states or its reader asks for, and what was assumed.

    Raises
    ------
    InputError
        The file states others than those asked for.
    """
    if stated is None and asked is None:
        return SI, ("units: N and m are assumed, for the file states none",)
    if stated is None or asked is None:
        return stated or asked or SI, ()
    if (stated.force, stated.length) != (asked.force, asked.length):
        raise InputError(f"the file states {stated.said}, and {asked.said} are asked for")
    return stated, ()


def _spelled(length: str) -> str:
    return {"inch": "in", "meter": "m", "metre": "m"}.get(length.lower(), length.lower())


# Powers of force and length of every number that parts of a floor hold; those that are not here
# have no dimension.
_POWERS: Mapping[type, Mapping[str, tuple[int, int]]] = {
    Material: {"elastic_modulus": (1, -2), "density": (1, -4)},
    ShellSection: {"thickness": (0, 1), "superimposed_mass": (1, -3)},
    OrthotropicSection: {
        "bending": (1, 1),
        "membrane": (1, -1),
        "shear": (1, -1),
        "mass_per_area": (1, -3),
        "rotary_inertia": (1, -1),
        "thickness": (0, 1),
    },
    BeamSection: {
        "area": (0, 2),
        "inertia_y": (0, 4),
        "inertia_z": (0, 4),
        "torsion_constant": (0, 4),
        "shear_area_y": (0, 2),
        "shear_area_z": (0, 2),
    },
    BeamGroup: {"offset": (0, 1)},
    PointMasses: {"mass": (1, -1)},
    ReleasedBeams: {},
    ShellGroup: {},
    TriangleGroup: {},
}
_INSIDE = ("section", "material", "beams")


def in_si(floor: Floor, units: Units) -> Floor:
    """Return a floor whose numbers were of some units in SI.

    Parameters
    ----------
    floor : Floor
        As its file has it.
    units : Units
        Its units.
    """
    if units.force == 1.0 and units.length == 1.0:
        return floor
    return replace(
        floor,
        nodes=floor.nodes * units.length,
        shells=tuple(_scaled(one, units) for one in floor.shells),
        beams=tuple(_scaled(one, units) for one in floor.beams),
        springs=tuple(_spring(one, units) for one in floor.springs),
        masses=tuple(_scaled(one, units) for one in floor.masses),
        others=tuple(_any(one, units) for one in floor.others),
    )


def _any(group: Elements, units: Units) -> Any:  # noqa: ANN401 - of the same kind
    if isinstance(group, NodeInertia):
        by_dof = [units.mass] * 3 + [units.mass * units.length**2] * 3
        return replace(group, inertia=group.inertia * by_dof)
    return _spring(group, units) if isinstance(group, SpringGroup) else _scaled(group, units)


def _spring(group: SpringGroup, units: Units) -> SpringGroup:
    by_dof = [units.of(1, -1)] * 3 + [units.of(1, 1)] * 3
    return replace(group, stiffness=group.stiffness * by_dof)


def _scaled(value: Any, units: Units) -> Any:  # noqa: ANN401 - a group, a section, a material
    """Return a part with its numbers, and those of parts within it, in SI."""
    powers = _POWERS.get(type(value))
    if powers is None:
        raise InputError(f"{type(value).__name__} has no units to be turned into SI")
    new = {
        name: _times(getattr(value, name), units.of(*power)) for name, power in powers.items()
    } | {name: _scaled(getattr(value, name), units) for name in _INSIDE if hasattr(value, name)}
    return replace(value, **new)


def _times(value: Any, factor: float) -> Any:  # noqa: ANN401 - a number, numbers, an array
    return tuple(factor * one for one in value) if isinstance(value, tuple) else factor * value

"""Make the tables of what trundle ships with: criteria, and vehicles."""

from __future__ import annotations

import re
from itertools import groupby

import numpy as np
from pages import GENERATED, code, table, write_page

from trundle.criteria import BY_FREQUENCY, Criterion, all_criteria
from trundle.units import MICROMETRE_PER_SECOND
from trundle.vehicle import GRAVITY, VEHICLES, Vehicle
from trundle.views.words import limit_words

__all__ = ["write_library"]

_UNITS = {
    "band_rms_velocity": (MICROMETRE_PER_SECOND, "um/s"),
    "band_rms_displacement": (1e-6, "um"),
}
_TITLES = {
    "band_rms_velocity": "RMS velocity in one-third octaves",
    "band_rms_acceleration": "RMS acceleration in one-third octaves",
    "band_rms_displacement": "RMS displacement in one-third octaves",
    "band_peak_acceleration": "Peak acceleration in one-third octaves",
    "narrow_band_acceleration": "Acceleration on lines of 1 Hz",
    "peak_acceleration": "Peak acceleration of the whole signal",
    "response_factor": "Response factor of people",
    "vdv": "Vibration dose value",
}
_SHOWN_FREQUENCIES = 3


def write_library() -> None:
    """Write both pages."""
    write_page(GENERATED / "criteria.md", _criteria())
    write_page(GENERATED / "vehicles.md", _vehicles())


def _criteria() -> str:
    parts = ["# Criteria\n", _CRITERIA]
    ordered = sorted(all_criteria(), key=lambda one: list(_TITLES).index(one.quantity))
    for quantity, some in groupby(ordered, key=lambda one: one.quantity):
        rows = [_criterion(one) for one in some]
        parts.append(f"\n## {_TITLES[quantity]}\n")
        head = ("name", "title", "limits", "axis", "source and confidence")
        parts.append(table(head, rows, kind="sources"))
    return "\n".join(parts)


_CRITERIA = """\
`curves` in `[criteria]` of a study, and `--criteria` of `trundle assess`, name any of these. `trundle criteria --json` gives the same
numbers to programs. Curves of your own are files: `files = ["maker.csv"]`.
"""


def _criterion(one: Criterion) -> tuple[str, ...]:
    names = ", ".join(code(name) for name in (one.name, *one.aliases))
    return names, one.title, _limits(one), one.axis, f"{one.source}. *{one.confidence}*"


def _limits(one: Criterion) -> str:
    if one.quantity not in BY_FREQUENCY:
        ends = (
            ""
            if np.isinf(one.frequencies[-1])
            else f", {one.frequencies[0]:g} to {one.frequencies[-1]:g} Hz"
        )
        return limit_words(one) + ends
    scale, unit = _UNITS.get(one.quantity, (1.0, "m/s2"))
    values = [f"{value / scale:.4g}" for value in one.limits]
    pairs = zip(one.frequencies, values, strict=True)
    if len(set(values)) == 1:
        return f"{values[0]} {unit}, {one.frequencies[0]:g} to {one.frequencies[-1]:g} Hz"
    return f"{unit}: " + ", ".join(f"{value} at {f:g} Hz" for f, value in pairs)


def _vehicles() -> str:
    made = {name: build() for name, build in VEHICLES.items()}
    sources = {source: i for i, source in enumerate(_sources(made), start=1)}
    head = ("vehicle", "mass [t]", "axles [m]", "loads [t]", "f [Hz]", "trust (source)")
    rows = (_vehicle(name, one, sources[one.source]) for name, one in made.items())
    listed = [f"{number}. {source}" for source, number in sources.items()]
    parts = ["# Vehicles\n", _VEHICLES, table(head, rows, kind="wide")]
    return "\n".join(
        [*parts, "\n## Sources\n", *listed, "", "## What is assumed\n", _assumed(made)]
    )


def _sources(made: dict[str, Vehicle]) -> list[str]:
    return list(dict.fromkeys(one.source for one in made.values()))


_VEHICLES = """\
`kind` of a `[vehicle.NAME]` table names any of these. `trundle vehicles show NAME` draws one to scale, with its modes and its forces on a
class A road; [](../vehicles.md) says how to change one. Axles lie behind the front one, loads are those of each axle at rest, and `f` are the
first natural frequencies on rigid ground. Trust: *high*, read in the source; *medium*, inferred or quoted in part; *low*, mostly assumed.
"""


def _vehicle(name: str, one: Vehicle, source: int) -> tuple[str, ...]:
    axles, loads = _axles(one)
    trust = re.split(r"[:;,(]", one.confidence)[0].strip()
    return (
        f"{code(name)}<br>{one.name}",
        f"{one.total_mass / 1e3:.2f}",
        ", ".join(f"{x:.2f}" for x in axles),
        ", ".join(f"{load:.2f}" for load in loads),
        ", ".join(f"{f:.2f}" for f in one.natural_frequencies()[:_SHOWN_FREQUENCIES]),
        f"{trust} ({source})",
    )


def _axles(one: Vehicle) -> tuple[list[float], list[float]]:
    """Return places and loads [t] of axles; wheels of both sides are one."""
    loads: dict[float, float] = {}
    for x, force in zip(one.setback, one.static_forces, strict=True):
        loads[float(x)] = loads.get(float(x), 0.0) + float(force) / GRAVITY / 1e3
    return list(loads), list(loads.values())


def _assumed(made: dict[str, Vehicle]) -> str:
    rows = ((code(name), one.assumption) for name, one in made.items() if one.assumption)
    return table(("name", "assumed"), rows)
